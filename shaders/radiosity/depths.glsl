// SPDX-License-Identifier: GPL-3.0-or-later
// Depths: the depth map of one view, a texel for step x step pixels. r: the depth of the pixel in their middle, since
// depths of different surfaces have no mean. g: the farthest depth of this pixel's surface within the texel: points in
// front of it are visible; without it slopes would hide themselves.

#define MAX_REACH 1.1         // farthest depth of a surface within a texel, over its depth in the middle

void main()
{
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = views.depth_size;
  if (!is_inside(texel, size)) {
    return;
  }
  int step = views.depth_step;
  ivec2 pixel = min(texel * step + step / 2, frame.size - 1), source = pass_texel(pixel.x >> 2, pixel.y);
  float depth = texelFetch(depth_pass, source, 0)[pixel.x & 3];
  float farthest = depth;
  if (is_surface(depth)) {
    vec3 world = vec3(texelFetch(normal_x, source, 0)[pixel.x & 3], texelFetch(normal_y, source, 0)[pixel.x & 3],
                      texelFetch(normal_z, source, 0)[pixel.x & 3]);
    vec3 normal = turn_to_view(options.view, world);
    vec3 ray = vec3(view_ray(vec2(pixel) + 0.5), -1.0);
    for (int corner = 0; corner < 4; corner++) {
      vec2 end = view_ray(vec2((texel + ivec2(corner & 1, corner >> 1)) * step));
      // The depth of the plane through this pixel's surface at the texel's corner.
      float reach = is_orthographic() ? depth + dot(normal.xy, end - ray.xy) / normal.z :
                                        depth * dot(normal, ray) / dot(normal, vec3(end, -1.0));
      // Below 0 where the plane has passed behind the camera.
      bool known = is_finite(reach) && dot(world, world) > 0.0;
      farthest = max(farthest, known ? (reach > 0.0 ? min(reach, MAX_REACH * depth) : MAX_REACH * depth) : depth);
    }
  } else {
    depth = farthest = 2.0 * FARTHEST;
  }
  imageStore(depths_out, texel + ivec2(0, options.view * size.y), vec4(depth, farthest, 0.0, 0.0));
}
