// SPDX-License-Identifier: GPL-3.0-or-later
// Emit: what the blocks of one view's pixels send, a record for each in world space, of four texels:
//
//   0  place, m; area A, m^2, times the share of it that is this view's
//   1  mean normal, the shorter the less flat the block is; A
//   2  radiance of direct light and emission, W sr^-1 m^-2
//   3  albedo
//
// A surface that several views show is shared out between them by the balance heuristic, w_k = A_k^-1 / sum_j A_j^-1 over
// the views j that see it, A_j being the area of a pixel there: the view that shows it finest counts most.

// Share of a surface that is this view's.
float own_share(int own, vec3 place, vec3 normal, float depth)
{
  float mine = 1.0 / shown_area(own, place, normal, depth), all = mine;
  vec3 eye = to_eye(own, place);
  for (uint left = all_views(); left != 0u; left &= left - 1u) {
    int view = findLSB(left);
    vec3 projected = project(view, place);
    float found = view == own ? 0.0 : depth_at(view, projected);
    if (found > 0.0 && shows(view, place, normal, eye, projected, found)) {
      all += 1.0 / shown_area(view, place, normal, projected.z);
    }
  }
  return mine / all;
}

#define PASS_PIXEL(channel) texelFetch(channel, source, 0)[pixel.x & 3]

void main()
{
  int view = parameters.span.x;
  bool receives = parameters.span.y != 0;
  ivec4 grid = receives ? views.receivers[view] : views.emitters[view];
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(block, grid.yz)) {
    return;
  }
  int side = grid.w;
  float area = 0.0, own = 0.0;
  vec3 place = vec3(0.0), normal = vec3(0.0), power = vec3(0.0), albedo = vec3(0.0);
  ivec2 end = min(block * side + side, parameters.frame.xy);
  for (int y = block.y * side; y < end.y; y++) {
    for (int x = block.x * side; x < end.x; x++) {
      ivec2 pixel = ivec2(x, y), source = pass_texel(x >> 2, y);
      float depth = PASS_PIXEL(depth_pass);
      vec3 facing = vec3(PASS_PIXEL(normal_x), PASS_PIXEL(normal_y), PASS_PIXEL(normal_z));
      vec3 color = vec3(PASS_PIXEL(color_r), PASS_PIXEL(color_g), PASS_PIXEL(color_b));
      vec3 radiance = vec3(PASS_PIXEL(direct_r), PASS_PIXEL(direct_g), PASS_PIXEL(direct_b)) * color +
                      vec3(PASS_PIXEL(emission_r), PASS_PIXEL(emission_g), PASS_PIXEL(emission_b));
      float square = dot(facing, facing);
      if (!is_surface(depth) || !is_finite(square + radiance.x + radiance.y + radiance.z)) {
        continue;
      }
      vec2 centre = vec2(pixel) + 0.5;
#ifdef GEOMETRIC_NORMALS
      if (square == 0.0) {
        facing = to_world(view, geometric_normal(pixel, depth));
      }
#endif
      facing = direction(facing);
      vec3 world = to_world(view, view_place(centre, depth)) + views.eye[view].xyz;
      float shown = shown_area(view, world, facing, depth);
      float mine = receives ? shown : shown * own_share(view, world, facing, depth);
      area += shown;
      own += mine;
      place += mine * world;
      normal += mine * facing;
      power += mine * radiance;
      albedo += mine * color;
    }
  }
  // The depth map's texels are wider than the pixels that were summed.
  float scale = 1.0 / float(views.depths.z * views.depths.z), each = own > 0.0 ? 1.0 / own : 0.0;
  int record = grid.x + block.y * grid.y + block.x;
  imageStore(records_out, record_texel(record, 0, 4), vec4(place * each, own * scale));
  imageStore(records_out, record_texel(record, 1, 4), vec4(normal * each, area * scale));
  imageStore(records_out, record_texel(record, 2, 4), vec4(power * each, 0.0));
  imageStore(records_out, record_texel(record, 3, 4), vec4(albedo * each, 0.0));
}
