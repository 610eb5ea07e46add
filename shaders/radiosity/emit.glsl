// SPDX-License-Identifier: GPL-3.0-or-later
// Emit: a record for each block of one view's pixels, in world space, of four texels:
//
//   0  position, m; area A, m^2, times this view's share of it
//   1  mean normal, the shorter the less flat the block is; A
//   2  radiance of direct light and emission, W sr^-1 m^-2
//   3  albedo
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

#define PASS_PIXEL(channel) texelFetch(channel, source, 0)[pixel.x & 3]

void main()
{
  int view = options.view;
  bool receives = options.receives != 0;
  Grid grid = views.cameras[view].emitters;
  if (receives) {
    grid = views.cameras[view].receivers;
  }
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(block, grid.size)) {
    return;
  }
  int side = grid.side;
  float area = 0.0, own = 0.0;
  vec3 position = vec3(0.0), normal = vec3(0.0), power = vec3(0.0), albedo = vec3(0.0);
  ivec2 end = min(block * side + side, frame.size);
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
      vec3 world = to_world(view, view_position(centre, depth)) + views.cameras[view].position;
      float shown = shown_area(view, world, facing, depth);
      float mine = receives ? shown : shown * own_share(view, world, facing, depth);
      area += shown;
      own += mine;
      position += mine * world;
      normal += mine * facing;
      power += mine * radiance;
      albedo += mine * color;
    }
  }
  // shown_area() is that of a depth map's texel, which is wider than a pixel.
  float scale = 1.0 / float(views.depth_step * views.depth_step), each = own > 0.0 ? 1.0 / own : 0.0;
  int record = grid.first + block.y * grid.size.x + block.x;
  imageStore(records_out, record_texel(record, 0, 4), vec4(position * each, own * scale));
  imageStore(records_out, record_texel(record, 1, 4), vec4(normal * each, area * scale));
  imageStore(records_out, record_texel(record, 2, 4), vec4(power * each, 0.0));
  imageStore(records_out, record_texel(record, 3, 4), vec4(albedo * each, 0.0));
}
