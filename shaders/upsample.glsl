// SPDX-License-Identifier: GPL-3.0-or-later
// Upsample: a level's total is what it gathered itself plus the coarser levels' total, upsampled.

void main()
{
  ivec2 texel = this_texel();
  if (!is_inside(texel, imageSize(total))) {
    return;
  }
  vec4 receiver = texelFetch(place, texel, 0);
  vec4 sum = texelFetch(own, texel, 0);
  if (receiver.w > 0.0) {
    vec3 normal = direction(texelFetch(vector_areas, texel, 0).xyz);
    sum += bilateral((vec2(texel) + 0.5) / 2.0, receiver.xyz, normal);
  }
  imageStore(total, texel, sum);
}
