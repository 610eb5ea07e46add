// SPDX-License-Identifier: GPL-3.0-or-later
// Depths: the depth map of one view, a texel for step x step pixels: that of the pixel in their middle, since depths
// of different surfaces have no mean.

void main()
{
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = views.depths.xy;
  if (!is_inside(texel, size)) {
    return;
  }
  int step = views.depths.z;
  ivec2 pixel = min(texel * step + step / 2, parameters.frame.xy - 1);
  float depth = texelFetch(depth_pass, pass_texel(pixel.x >> 2, pixel.y), 0)[pixel.x & 3];
  imageStore(depths_out, texel + ivec2(0, parameters.span.x * size.y), vec4(is_surface(depth) ? depth : 2.0 * FARTHEST));
}
