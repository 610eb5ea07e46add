// SPDX-License-Identifier: GPL-3.0-or-later
// Sight: what the depth maps of all views know of a place, and of the way between two.

#define MARGIN 0.02           // of the way, at both ends
#define FREE_TOLERANCE 1.0005 // of the farthest depth in a texel: so far behind it still counts as seen

// Planar depth of what the view shows there; 0 outside its frame and behind it.
float depth_at(int view, vec3 projected)
{
  ivec2 texel = ivec2(floor(projected.xy)), size = views.depths.xy;
  bool inside = projected.z > NEAREST && is_inside(texel, size);
  return inside ? texelFetch(depths, texel + ivec2(0, view * size.y), 0).r : 0.0;
}

// Is the way blocked? A place blocks that lies behind the surfaces of some view and that no view sees free; and so do two
// neighbouring places between which there is a thin wall. Places along the way are bits, and views are taken one after the
// other: what a place's projection needs is linear along the way.
bool is_blocked(vec3 from, vec3 to, float jitter)
{
  int steps = views.draws.w;
  uint is_free = 0u, is_behind = 0u, enters = 0u, leaves = 0u, is_open = 0u;
  for (int view = 0; view < views.depths.w && steps > 0; view++) {
    vec4 start = projection_of(view, from), path = projection_of(view, to) - start;
    ivec2 origin = ivec2(0, view * views.depths.y);
    uint seen = 0u, hidden = 0u;
    for (int k = 0; k < steps; k++) {
      vec4 place = start + path * ((float(k) + jitter) / float(steps));
      ivec2 texel = ivec2(floor(place.xy / max(place.w, NEAREST)));
      bool inside = place.z > NEAREST && is_inside(texel, views.depths.xy);
      float depth = texelFetch(depths, origin + clamp(texel, ivec2(0), views.depths.xy - 1), 0).g * FREE_TOLERANCE;
      seen |= uint(inside && place.z < depth) << k;
      hidden |= uint(inside && place.z >= depth) << k;
    }
    is_free |= seen;
    is_behind |= hidden;
    enters |= seen & (hidden >> 1);
    leaves |= hidden & (seen >> 1);
    is_open |= seen & (seen >> 1);
  }
  // A wall too thin for any place to lie in it: one view sees the way go behind it, another sees it come out.
  uint is_crossed = enters & leaves & ~is_open;
  // Surfaces do not hide themselves.
  int least = int(ceil(MARGIN * float(steps) - jitter)), most = int(floor((1.0 - MARGIN) * float(steps) - jitter));
  uint counted = (most >= 31 ? 0xFFFFFFFFu : (1u << (most + 1)) - 1u) & ~((1u << max(least, 0)) - 1u);
  return (is_behind & ~is_free & counted) != 0u || (is_crossed & counted & (counted >> 1)) != 0u;
}
