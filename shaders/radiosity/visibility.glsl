// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility: the surfaces that the depth maps of all views show, and segments that pass through them.

#define FREE_TOLERANCE 1.0005 // of the farthest depth in a texel: up to there a position counts as visible
#define BISECTIONS 4          // of a step over which visibility changes
#define MAX_GAP_LEFT 0.4      // of the change of the gap over that step, at most left after these if it is continuous
#define MAX_GAP_SLOPE 2.0     // of the step: a larger change of the gap is another object's silhouette, not a crossing
#define DEPTH_TOLERANCE 0.02  // of the depth
#define SLOPE_TOLERANCE 2.0   // texels of the depth map, times the slope

// Planar depth of the surface that the view shows there; 0 outside its frame and behind it.
float depth_at(int view, vec3 projected)
{
  ivec2 texel = ivec2(floor(projected.xy)), size = views.depth_size;
  bool inside = projected.z > NEAREST && is_inside(texel, size);
  return inside ? texelFetch(depths, texel + ivec2(0, view * size.y), 0).r : 0.0;
}

// Does a view, with `depth` in its depth map there, show this very surface, from the side that `outgoing` points to?
bool shows(int view, vec3 position, vec3 normal, vec3 outgoing, vec3 projected, float depth)
{
  vec3 other = to_camera(view, position);
  if (dot(normal, other) * dot(normal, outgoing) <= 0.0) {
    return false;
  }
  float cosine = max(abs(dot(normal, direction(other))), COSINE_FLOOR);
  vec2 side = abs(views.cameras[view].scale);
  float texel = max(side.x, side.y) * (is_orthographic(view) ? 1.0 : projected.z);
  float slope = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
  return abs(depth - projected.z) < DEPTH_TOLERANCE * projected.z + SLOPE_TOLERANCE * slope * texel;
}

// Texel of the depth map. projected: a result of projection_of().
ivec2 texel_of(vec4 projected)
{
  return ivec2(floor(projected.xy / max(projected.w, NEAREST)));
}

// Depth of the surface that a view shows there, less that of the position: above 0 where it is visible, below 0 behind
// the surface.
float gap_at(int view, vec4 projected)
{
  ivec2 texel = texel_of(projected);
  texel = clamp(texel, ivec2(0), views.depth_size - 1) + ivec2(0, view * views.depth_size.y);
  return texelFetch(depths, texel, 0).g * FREE_TOLERANCE - projected.z;
}

// A segment is visible at one end of a step and hidden at the other: does it pass through the surface, or behind the
// silhouette of something nearer? At a silhouette the gap jumps, and bisecting the step does not make the jump smaller.
// low, high: the step, as shares of the path; the bisections narrow it. length: of the step, m.
bool passes_through(int view, vec4 start, vec4 path, inout float low, inout float high, float length)
{
  float gap_low = gap_at(view, start + path * low), gap_high = gap_at(view, start + path * high);
  float whole = min(abs(gap_low - gap_high), MAX_GAP_SLOPE * length);
  for (int k = 0; k < BISECTIONS; k++) {
    float middle = 0.5 * (low + high), gap = gap_at(view, start + path * middle);
    bool before = (gap > 0.0) == (gap_low > 0.0);
    low = before ? middle : low;
    gap_low = before ? gap : gap_low;
    high = before ? high : middle;
    gap_high = before ? gap_high : gap;
  }
  return abs(gap_low - gap_high) < MAX_GAP_LEFT * whole;
}
