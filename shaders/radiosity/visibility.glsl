// SPDX-License-Identifier: GPL-3.0-or-later
// Sight: what the depth maps of all views know of a place, and of the way between two.

#define MARGIN 0.01           // of the way, at both ends
#define FREE_TOLERANCE 1.0005 // of the farthest depth in a texel: so far behind it still counts as seen
#define THICKNESS 0.03        // of the way: so thick is what no view looks behind
#define BISECTIONS 4          // of a step in which a way goes behind something or comes out
#define CONTINUOUS 0.4        // of the change in the gap over that step, that may be left after these
#define SLOPE 2.0             // of the step: more change is no surface's that it passes through, but from edge to edge of others
#define DEPTH_TOLERANCE 0.02  // of the depth
#define SLOPE_TOLERANCE 2.0   // texels of the depth map, on a slope

// Planar depth of what the view shows there; 0 outside its frame and behind it.
float depth_at(int view, vec3 projected)
{
  ivec2 texel = ivec2(floor(projected.xy)), size = views.depths.xy;
  bool inside = projected.z > NEAREST && is_inside(texel, size);
  return inside ? texelFetch(depths, texel + ivec2(0, view * size.y), 0).r : 0.0;
}

// Does another view, in whose depth map `depth` is found there, show this very surface, from the same side?
bool shows(int view, vec3 place, vec3 normal, vec3 eye, vec3 projected, float depth)
{
  vec3 other = to_eye(view, place);
  if (dot(normal, other) * dot(normal, eye) <= 0.0) {
    return false;
  }
  float cosine = max(abs(dot(normal, direction(other))), COSINE_FLOOR);
  vec2 side = abs(views.projection[view].xy);
  float texel = max(side.x, side.y) * (is_parallel(view) ? 1.0 : projected.z);
  float slope = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
  return abs(depth - projected.z) < DEPTH_TOLERANCE * projected.z + SLOPE_TOLERANCE * slope * texel;
}

// Texel of the depth map. projected: as projection_of() gives it.
ivec2 texel_of(vec4 projected)
{
  return ivec2(floor(projected.xy / max(projected.w, NEAREST)));
}

// How far before the surface that a view shows there a place lies; below 0 behind it.
float gap_at(int view, vec4 projected)
{
  ivec2 texel = texel_of(projected);
  texel = clamp(texel, ivec2(0), views.depths.xy - 1) + ivec2(0, view * views.depths.y);
  return texelFetch(depths, texel, 0).g * FREE_TOLERANCE - projected.z;
}

// A way that is seen at one end of a step and hidden at the other: does it pass through the surface, or behind the edge of
// something nearer? Then the gap jumps, and halving the step does not make the jump smaller. length: of the step, m. low,
// high: shares of the way, between which it passes, are brought close together.
bool passes_through(int view, vec4 start, vec4 path, inout float low, inout float high, float length)
{
  float gap_low = gap_at(view, start + path * low), gap_high = gap_at(view, start + path * high);
  float whole = min(abs(gap_low - gap_high), SLOPE * length);
  for (int k = 0; k < BISECTIONS; k++) {
    float middle = 0.5 * (low + high), gap = gap_at(view, start + path * middle);
    bool before = (gap > 0.0) == (gap_low > 0.0);
    low = before ? middle : low;
    gap_low = before ? gap : gap_low;
    high = before ? high : middle;
    gap_high = before ? gap_high : gap;
  }
  return abs(gap_low - gap_high) < CONTINUOUS * whole;
}

// Is the way blocked? It is where some view sees it pass through a surface, and where a place lies close behind one and no view
// sees it free. What is farther behind is not known, and free. Places along the way are bits, and views are taken one
// after the other: what a place's projection needs is linear along the way.
bool is_blocked(vec3 from, vec3 to, float jitter)
{
  int steps = views.draws.w;
  // Surfaces do not hide themselves.
  int least = int(ceil(MARGIN * float(steps) - jitter)), most = int(floor((1.0 - MARGIN) * float(steps) - jitter));
  uint counted = (most >= 31 ? 0xFFFFFFFFu : (1u << (most + 1)) - 1u) & ~((1u << max(least, 0)) - 1u);
  uint is_free = 0u, is_within = 0u;
  float length = distance(from, to), each = 1.0 / float(max(steps, 1));
  for (uint left = steps > 0 ? all_views() : 0u; left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec4 start = projection_of(view, from), path = projection_of(view, to) - start;
    uint seen = 0u, hidden = 0u;
    for (int k = 0; k < steps; k++) {
      vec4 place = start + path * ((float(k) + jitter) * each);
      bool shown = place.z > NEAREST && is_inside(texel_of(place), views.depths.xy);
      float gap = gap_at(view, place);
      seen |= uint(shown && gap > 0.0) << k;
      hidden |= uint(shown && gap <= 0.0) << k;
      is_within |= uint(shown && gap <= 0.0 && gap > -THICKNESS * length) << k;
    }
    is_free |= seen;
    uint turns = ((seen & (hidden >> 1)) | (hidden & (seen >> 1))) & counted & (counted >> 1);
    for (; turns != 0u; turns &= turns - 1u) {
      float low = (float(findLSB(turns)) + jitter) * each, high = low + each;
      if (passes_through(view, start, path, low, high, length * each)) {
        return true;
      }
    }
  }
  return (is_within & ~is_free & counted) != 0u;
}
