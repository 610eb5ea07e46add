// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow ray: is one position visible from another, as far as the depth maps of all views show it?

#define MARGIN 0.01           // of the segment, at both ends
#define THICKNESS 0.03        // of the segment: assumed of things that no view shows from behind

// Is the segment blocked? It is where some view sees it pass through a surface, and where a point of it lies close
// behind one and no view sees that point free. Farther behind a surface nothing is known, which counts as free. Points
// along the segment are bits, and views are taken one after the other, since the projection is linear along the
// segment.
bool is_blocked(vec3 from, vec3 to, float jitter, int steps)
{
  // Both ends are left out: surfaces do not hide themselves.
  int least = int(ceil(MARGIN * float(steps) - jitter)), most = int(floor((1.0 - MARGIN) * float(steps) - jitter));
  uint counted = (most >= 31 ? 0xFFFFFFFFu : (1u << (most + 1)) - 1u) & ~((1u << max(least, 0)) - 1u);
  uint is_free = 0u, is_within = 0u;
  float length = distance(from, to), each = 1.0 / float(max(steps, 1));
  for (uint left = steps > 0 ? all_views() : 0u; left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec4 start = projection_of(view, from), path = projection_of(view, to) - start;
    uint seen = 0u, hidden = 0u;
    for (int k = 0; k < steps; k++) {
      vec4 point = start + path * ((float(k) + jitter) * each);
      bool shown = point.z > NEAREST && is_inside(texel_of(point), views.depth_size);
      float gap = gap_at(view, point);
      seen |= uint(shown && gap > 0.0) << k;
      hidden |= uint(shown && gap <= 0.0) << k;
      is_within |= uint(shown && gap <= 0.0 && gap > -THICKNESS * length) << k;
    }
    is_free |= seen;
    uint changes = ((seen & (hidden >> 1)) | (hidden & (seen >> 1))) & counted & (counted >> 1);
    for (; changes != 0u; changes &= changes - 1u) {
      float low = (float(findLSB(changes)) + jitter) * each, high = low + each;
      if (passes_through(view, start, path, low, high, length * each)) {
        return true;
      }
    }
  }
  return (is_within & ~is_free & counted) != 0u;
}
