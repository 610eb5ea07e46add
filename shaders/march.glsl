// SPDX-License-Identifier: GPL-3.0-or-later
// March: where a ray meets a surface that some view shows, and what comes back from there.

#define MARCH_STEPS 32        // at most, along what a view has in frame of a ray
#define LIFT 0.05             // of that: where rays begin
#define MARCH_TEXELS 6.0      // of the depth map in one step, unless that takes more of them
#define REFINEMENTS 8         // more halvings of a step in which something is met, to tell where

// The part of a ray, metres from its start, that a view has in frame, within `span`. start, rate: its projection there, and by how
// much that changes in a metre.
vec2 shown_span(int view, vec4 start, vec4 rate, vec2 span)
{
  vec2 size = vec2(views.depths.xy);
  for (int k = 0; k < 5; k++) {
    vec4 side = k == 0 ? vec4(1, 0, 0, 0) : k == 1 ? vec4(-1, 0, 0, size.x) : k == 2 ? vec4(0, 1, 0, 0) :
                k == 3 ? vec4(0, -1, 0, size.y) : vec4(0, 0, 1, 0);
    // Within where inside + t * slope > 0.
    float inside = dot(side, start) - (k == 4 ? NEAREST : 0.0), slope = dot(side, rate), at = -inside / slope;
    span.x = slope > 0.0 ? max(span.x, at) : span.x;
    span.y = slope < 0.0 ? min(span.y, at) : span.y;
    span.y = slope == 0.0 && inside <= 0.0 ? -1.0 : span.y;
  }
  return span;
}

// Metres to the first surface that some view sees the ray pass through; 0 where there is none. Steps are even in the view's
// picture. own: nearer than this a ray that comes out from behind a surface has begun on it.
float first_hit(vec3 place, vec3 towards, float own, float jitter)
{
  float reach = views.odds.w, nearest = reach;
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec4 start = projection_of(view, place), rate = projection_of(view, place + towards) - start;
    vec2 span = shown_span(view, start, rate, vec2(LIFT * own, nearest));
    if (span.x >= span.y) {
      continue;
    }
    vec4 first = start + rate * span.x, last = start + rate * span.y;
    float texels = length(first.xy / max(first.w, NEAREST) - last.xy / max(last.w, NEAREST));
    int steps = int(clamp(ceil(texels / MARCH_TEXELS), 4.0, float(MARCH_STEPS)));
    float before = span.x;
    // The main view shows where the ray begins: it comes out from behind something only once it has gone there.
    bool was_free = gap_at(view, first) > 0.0, has_begun = view != 0 || was_free;
    for (int k = 0; k <= steps; k++) {
      float share = min((float(k) + jitter) / float(steps), 1.0);
      float at = span.x + (span.y - span.x) * share * first.w / mix(last.w, first.w, share);
      bool is_free = gap_at(view, start + rate * at) > 0.0;
      if (is_free != was_free) {
        float low = before, high = at;
        if (passes_through(view, start, rate, low, high, at - before) && (was_free || (has_begun && low > own))) {
          for (int more = 0; more < REFINEMENTS; more++) {
            float middle = 0.5 * (low + high);
            bool is_before = (gap_at(view, start + rate * middle) > 0.0) == was_free;
            low = is_before ? middle : low;
            high = is_before ? high : middle;
          }
          nearest = 0.5 * (low + high);
          break;
        }
      }
      before = at;
      was_free = is_free;
      has_begun = has_begun || is_free;
    }
  }
  return nearest < reach ? nearest : 0.0;
}

// Radiance that leaves a place on a surface against `towards`: of the views that show it from that side, each by how fine it
// does. Black where none does.
vec3 radiance_at(vec3 place, vec3 towards)
{
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    ivec4 grid = views.emitters[view];
    ivec2 block = place_in_grid(view, place);
    if (!is_inside(block, grid.yz)) {
      continue;
    }
    int number = grid.x + block.y * grid.y + block.x;
    vec4 first = texelFetch(emitters, record_texel(number, 0, 4), 0);
    vec3 normal = direction(texelFetch(emitters, record_texel(number, 1, 4), 0).xyz);
    vec3 projected = project(view, place);
    float found = depth_at(view, projected);
    if (first.a > 0.0 && found > 0.0 && shows(view, place, normal, -towards, projected, found)) {
      float weight = 1.0 / shown_area(view, place, normal, projected.z);
      sum += weight * texelFetch(radiance, record_texel(number, 0, 1), 0).rgb;
      weights += weight;
    }
  }
  return weights > 0.0 ? sum / weights : vec3(0.0);
}
