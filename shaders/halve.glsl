// SPDX-License-Identifier: GPL-3.0-or-later
// Halve: one level of the pyramid from the next finer one, by exact sums over 2 x 2 texels.

void main()
{
  ivec2 texel = this_texel();
  if (!is_inside(texel, imageSize(coarse_radiance))) {
    return;
  }
  float area = 0.0;
  vec3 power = vec3(0.0);
  vec3 moment = vec3(0.0);
  vec3 vector_area = vec3(0.0);
  for (int k = 0; k < 4; k++) {
    ivec2 child = 2 * texel + ivec2(k & 1, k >> 1);
    if (!is_inside(child, textureSize(radiance, 0))) {
      continue;
    }
    vec4 child_place = texelFetch(place, child, 0);
    area += child_place.w;
    power += child_place.w * texelFetch(radiance, child, 0).rgb;
    moment += child_place.w * child_place.xyz;
    vector_area += texelFetch(vector_areas, child, 0).xyz;
  }
  float share = area > 0.0 ? 1.0 / area : 0.0;
  imageStore(coarse_radiance, texel, vec4(power * share, 0.0));
  imageStore(coarse_place, texel, vec4(moment * share, area));
  imageStore(coarse_vector_area, texel, vec4(vector_area, 0.0));
}
