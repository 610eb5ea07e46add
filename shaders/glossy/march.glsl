// SPDX-License-Identifier: GPL-3.0-or-later
// March: the first surface that a ray hits in the depth maps of all views, and the radiance from there.

#define MARCH_STEPS 32        // at most, along the part of a ray that a view has in frame
#define LOST -1.0             // in place of a distance: the ray ends out of sight
#define MARCH_TEXELS 6.0      // of the depth map in one step, where MARCH_STEPS are enough for that
#define REFINEMENTS 8         // further bisections of the step with the hit

// The part of a ray, (first, last) metres from its start, that a view has in frame, within `span`. start: projection of
// the ray's start; rate: its change per metre.
vec2 shown_span(int view, vec4 start, vec4 rate, vec2 span)
{
  vec2 size = vec2(views.depth_size);
  for (int k = 0; k < 5; k++) {
    vec4 side = k == 0 ? vec4(1, 0, 0, 0) : k == 1 ? vec4(-1, 0, 0, size.x) : k == 2 ? vec4(0, 1, 0, 0) :
                k == 3 ? vec4(0, -1, 0, size.y) : vec4(0, 0, 1, 0);
    // In frame where inside + t * slope > 0.
    float inside = dot(side, start) - (k == 4 ? NEAREST : 0.0), slope = dot(side, rate), at = -inside / slope;
    span.x = slope > 0.0 ? max(span.x, at) : span.x;
    span.y = slope < 0.0 ? min(span.y, at) : span.y;
    span.y = slope == 0.0 && inside <= 0.0 ? -1.0 : span.y;
  }
  return span;
}

// Number of the emitter that a view shows at a position; -1 outside its frame.
int emitter_at(int view, vec3 position)
{
  Grid grid = views.cameras[view].emitters;
  ivec2 block = grid_cell(view, position);
  return is_inside(block, grid.size) ? grid.first + block.y * grid.size.x + block.x : -1;
}

// Mean normal of an emitter, not of length 1.
vec3 normal_of(int number)
{
  return texelFetch(emitters, record_texel(number, 1, 4), 0).xyz;
}

// Can a ray enter (goes_in), or leave, the surface that a view shows at a position? It enters from the side of the
// normal and against it, and leaves from behind and along it. By depths alone, positions close behind a thin wall would
// be free.
bool can_pass(int view, vec3 position, vec3 start, vec3 towards, bool goes_in)
{
  int number = emitter_at(view, position);
  vec3 normal = normal_of(max(number, 0));
  vec3 from = start - texelFetch(emitters, record_texel(max(number, 0), 0, 4), 0).xyz;
  return number >= 0 && (dot(normal, towards) < 0.0) == goes_in && (dot(normal, from) > 0.0) == goes_in;
}

// Is a position visible in any view?
bool is_seen(vec3 position)
{
  bool is_visible = false;
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec4 projected = projection_of(view, position);
    bool is_shown = projected.z > NEAREST && is_inside(texel_of(projected), views.depth_size);
    is_visible = is_visible || (is_shown && gap_at(view, projected) > 0.0);
  }
  return is_visible;
}

// Metres to the first surface that some view sees the ray pass through; 0 where it ends in the open, and LOST where it
// stays behind something and no view sees the sky there. Steps are even in the view's picture. least, reach: metres
// from the position to the ray's start and end.
float first_hit(vec3 position, vec3 normal, vec3 towards, float least, float jitter, float reach)
{
  float nearest = reach;
  bool is_hidden = false, is_open = false;
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec4 start = projection_of(view, position), rate = projection_of(view, position + towards) - start;
    vec2 span = shown_span(view, start, rate, vec2(least, nearest));
    if (span.x >= span.y) {
      continue;
    }
    vec4 first = start + rate * span.x, last = start + rate * span.y;
    float texels = length(first.xy / max(first.w, NEAREST) - last.xy / max(last.w, NEAREST));
    int steps = int(clamp(ceil(texels / MARCH_TEXELS), 4.0, float(MARCH_STEPS)));
    float before = span.x;
    // A ray leaves a surface only from a position that no view sees: it has entered through a side that none shows.
    // Where a view shows the start of the ray, it must have been visible before: hidden at its start it is only below
    // the surface that it leaves, within a texel of the depth map.
    vec3 projected = project(view, position);
    bool was_free = gap_at(view, first) > 0.0;
    bool is_shown = view == 0 ||
                    shows(view, position, normal, to_camera(0, position), projected, depth_at(view, projected));
    bool has_begun = was_free || !is_shown;
    for (int k = 0; k <= steps; k++) {
      float share = min((float(k) + jitter) / float(steps), 1.0);
      float at = span.x + (span.y - span.x) * share * first.w / mix(last.w, first.w, share);
      bool is_free = gap_at(view, start + rate * at) > 0.0;
      if (is_free != was_free) {
        float low = before, high = at;
        if (passes_through(view, start, rate, low, high, at - before)
            && can_pass(view, position + (was_free ? high : low) * towards, position, towards, was_free)
            && (was_free || (has_begun && !is_seen(position + low * towards)))) {
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
    is_hidden = is_hidden || !was_free;
    is_open = is_open || (was_free && gap_at(view, last) > FARTHEST);
  }
  return nearest < reach ? nearest : is_hidden && !is_open ? LOST : 0.0;
}

// Radiance that leaves a position on a surface against `towards`: the mean of the views that show that side, weighted
// by the fineness of their pixels. a: 1, or 0 where none shows it.
vec4 radiance_at(vec3 position, vec3 towards)
{
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    int number = emitter_at(view, position);
    if (number < 0) {
      continue;
    }
    vec4 first = texelFetch(emitters, record_texel(number, 0, 4), 0);
    vec3 normal = direction(normal_of(number));
    float depth = project(view, position).z;
    // In the plane of the surface shown there, and on the side that the view shows: depth alone tells little on a
    // slope.
    bool is_same = abs(dot(normal, position - first.xyz)) < DEPTH_TOLERANCE * depth;
    if (first.a > 0.0 && is_same && dot(normal, towards) * dot(normal, to_camera(view, position)) < 0.0) {
      float weight = 1.0 / shown_area(view, position, normal, depth);
      sum += weight * texelFetch(radiance, record_texel(number, 0, 1), 0).rgb;
      weights += weight;
    }
  }
  return weights > 0.0 ? vec4(sum / weights, 1.0) : vec4(0.0);
}
