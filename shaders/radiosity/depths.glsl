// SPDX-License-Identifier: GPL-3.0-or-later
// Depths: the depth map of one view, a texel for step x step pixels: the depth of the pixel in their middle, since depths
// of different surfaces have no mean, and the farthest that this pixel's surface reaches within the texel. What is nearer
// than that is seen free: without it slopes would hide themselves.

#define STEEPEST 1.1          // times its depth a surface may reach within a texel

void main()
{
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = views.depths.xy;
  if (!is_inside(texel, size)) {
    return;
  }
  int step = views.depths.z;
  ivec2 pixel = min(texel * step + step / 2, parameters.frame.xy - 1), source = pass_texel(pixel.x >> 2, pixel.y);
  float depth = texelFetch(depth_pass, source, 0)[pixel.x & 3];
  float farthest = depth;
  if (is_surface(depth)) {
    vec3 world = vec3(texelFetch(normal_x, source, 0)[pixel.x & 3], texelFetch(normal_y, source, 0)[pixel.x & 3],
                      texelFetch(normal_z, source, 0)[pixel.x & 3]);
    vec3 normal = turn_to_view(parameters.span.x, world);
    vec3 ray = vec3(view_ray(vec2(pixel) + 0.5), -1.0);
    for (int corner = 0; corner < 4; corner++) {
      vec2 end = view_ray(vec2((texel + ivec2(corner & 1, corner >> 1)) * step));
      // The plane through this pixel's place, at the texel's corner.
      float reach = is_orthographic() ? depth + dot(normal.xy, end - ray.xy) / normal.z :
                                        depth * dot(normal, ray) / dot(normal, vec3(end, -1.0));
      // Below 0 where the plane passes behind the camera before it gets there.
      bool known = is_finite(reach) && dot(world, world) > 0.0;
      farthest = max(farthest, known ? (reach > 0.0 ? min(reach, STEEPEST * depth) : STEEPEST * depth) : depth);
    }
  } else {
    depth = farthest = 2.0 * FARTHEST;
  }
  imageStore(depths_out, texel + ivec2(0, parameters.span.x * size.y), vec4(depth, farthest, 0.0, 0.0));
}
