// SPDX-License-Identifier: GPL-3.0-or-later
// March: where a ray meets a surface that some view shows, and what comes back from there.

#define MARCH_STEPS 32        // at most, along what a view has in frame of a ray
#define LOST -1.0             // metres to nowhere: out of sight
#define MARCH_TEXELS 6.0      // of the depth map in one step, unless that takes more of them
#define REFINEMENTS 8         // more halvings of a step in which something is met, to tell where

// The part of a ray, metres from its start, that a view has in frame, within `span`. start, rate: its projection there, and
// by how much that changes in a metre.
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

// Number of the emitter that a view shows at a place; -1 outside of its frame.
int emitter_at(int view, vec3 place)
{
  ivec4 grid = views.emitters[view];
  ivec2 block = place_in_grid(view, place);
  return is_inside(block, grid.yz) ? grid.x + block.y * grid.y + block.x : -1;
}

// Mean normal of an emitter, not of length 1.
vec3 normal_of(int number)
{
  return texelFetch(emitters, record_texel(number, 1, 4), 0).xyz;
}

// Can a ray go in, or come out, at a place through what a view shows there? It begins before that surface and goes against
// it, or behind it and along its normal. A depth map alone takes what is hidden close behind a thin wall for free.
bool can_pass(int view, vec3 place, vec3 start, vec3 towards, bool goes_in)
{
  int number = emitter_at(view, place);
  vec3 normal = normal_of(max(number, 0)), from = start - texelFetch(emitters, record_texel(max(number, 0), 0, 4), 0).xyz;
  return number >= 0 && (dot(normal, towards) < 0.0) == goes_in && (dot(normal, from) > 0.0) == goes_in;
}

// Does any view see a place free?
bool is_seen(vec3 place)
{
  bool found = false;
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec4 projected = projection_of(view, place);
    found = found || (projected.z > NEAREST && is_inside(texel_of(projected), views.depths.xy) && gap_at(view, projected) > 0.0);
  }
  return found;
}

// Metres to the first surface that some view sees the ray pass through; 0 where it ends in the open, and LOST where it went
// behind something for good and no view sees the sky there. Steps are even in the view's picture. least: metres from the
// place to where the ray begins.
float first_hit(vec3 place, vec3 normal, vec3 towards, float least, float jitter)
{
  float reach = views.odds.w, nearest = reach;
  bool is_hidden = false, is_open = false;
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec4 start = projection_of(view, place), rate = projection_of(view, place + towards) - start;
    vec2 span = shown_span(view, start, rate, vec2(least, nearest));
    if (span.x >= span.y) {
      continue;
    }
    vec4 first = start + rate * span.x, last = start + rate * span.y;
    float texels = length(first.xy / max(first.w, NEAREST) - last.xy / max(last.w, NEAREST));
    int steps = int(clamp(ceil(texels / MARCH_TEXELS), 4.0, float(MARCH_STEPS)));
    float before = span.x;
    // A ray comes out through a surface only from where no view sees anything free: it has gone in by a side that none shows.
    // Where a view shows the place itself, the ray comes out from behind something only once it has gone there: what looks so at
    // its beginning is the surface that it leaves, of which a depth map knows no more than a texel.
    vec3 projected = project(view, place);
    bool was_free = gap_at(view, first) > 0.0;
    bool is_shown = view == 0 || shows(view, place, normal, to_eye(0, place), projected, depth_at(view, projected));
    bool has_begun = was_free || !is_shown;
    for (int k = 0; k <= steps; k++) {
      float share = min((float(k) + jitter) / float(steps), 1.0);
      float at = span.x + (span.y - span.x) * share * first.w / mix(last.w, first.w, share);
      bool is_free = gap_at(view, start + rate * at) > 0.0;
      if (is_free != was_free) {
        float low = before, high = at;
        if (passes_through(view, start, rate, low, high, at - before)
            && can_pass(view, place + (was_free ? high : low) * towards, place, towards, was_free)
            && (was_free || (has_begun && !is_seen(place + low * towards)))) {
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

// Radiance that leaves a place on a surface against `towards`: of the views that show it from that side, each by how fine it
// does. In the fourth channel 1, or 0 where none does.
vec4 radiance_at(vec3 place, vec3 towards)
{
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    int number = emitter_at(view, place);
    if (number < 0) {
      continue;
    }
    vec4 first = texelFetch(emitters, record_texel(number, 0, 4), 0);
    vec3 normal = direction(normal_of(number));
    float depth = project(view, place).z;
    // In the plane of what is shown there, and on the side that the view shows: a depth alone tells little along a slope.
    bool is_same = abs(dot(normal, place - first.xyz)) < DEPTH_TOLERANCE * depth;
    if (first.a > 0.0 && is_same && dot(normal, towards) * dot(normal, to_eye(view, place)) < 0.0) {
      float weight = 1.0 / shown_area(view, place, normal, depth);
      sum += weight * texelFetch(radiance, record_texel(number, 0, 1), 0).rgb;
      weights += weight;
    }
  }
  return weights > 0.0 ? vec4(sum / weights, 1.0) : vec4(0.0);
}
