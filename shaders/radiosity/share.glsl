// SPDX-License-Identifier: GPL-3.0-or-later
// Share: the emitters of all views, each with its view's share of its area.
//
// Views that show the same surface share it by the balance heuristic, w_k = A_k^-1 / sum_j A_j^-1 over the views j that
// see it, with A_j the area of a pixel there: the view with the finest pixels has the largest share.

// This view's share of a surface.
float own_share(int own, vec3 position, vec3 normal, float depth)
{
  float mine = 1.0 / shown_area(own, position, normal, depth), all = mine;
  vec3 outgoing = to_camera(own, position);
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec3 projected = project(view, position);
    float shown = view == own ? 0.0 : depth_at(view, projected);
    if (shown > 0.0 && shows(view, position, normal, outgoing, projected, shown)) {
      all += 1.0 / shown_area(view, position, normal, projected.z);
    }
  }
  return mine / all;
}

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  int number = at.y * RECORDS_WIDTH + at.x, view = view_of(number);
  Grid grid = views.cameras[view].emitters;
  if (at.x >= RECORDS_WIDTH || number - grid.first >= grid.size.x * grid.size.y) {
    return;
  }
  vec4 first = texelFetch(records, record_texel(number, 0, 4), 0);
  vec4 second = texelFetch(records, record_texel(number, 1, 4), 0);
  if (first.a > 0.0) {
    first.a *= own_share(view, first.xyz, direction(second.xyz), project(view, first.xyz).z);
  }
  imageStore(emitters_out, record_texel(number, 0, 4), first);
  imageStore(emitters_out, record_texel(number, 1, 4), second);
  imageStore(emitters_out, record_texel(number, 2, 4), texelFetch(records, record_texel(number, 2, 4), 0));
  imageStore(emitters_out, record_texel(number, 3, 4), texelFetch(records, record_texel(number, 3, 4), 0));
}
