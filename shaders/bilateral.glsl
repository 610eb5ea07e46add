// SPDX-License-Identifier: GPL-3.0-or-later
// Bilateral upsampling: what a receiver takes from the four coarse texels around it.
// coarse: irradiance and form factor sums; coarse_place, coarse_vector_area: the surface they were gathered on.

#define FLATNESS_SHARPNESS 16.0
#define LEAST_WEIGHT 1e-3     // the best of four poor taps still counts; a good one outweighs it a thousand times

// position: the receiver in coarse texels. A tap counts the more, the better it lies in the receiver's plane (in units
// of the tap's own size, so scenes of any scale look alike) and the more it faces the same way.
vec4 bilateral(vec2 position, vec3 receiver, vec3 normal)
{
  vec2 corner = floor(position - 0.5);
  vec2 blend = position - 0.5 - corner;
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int k = 0; k < 4; k++) {
    ivec2 side = ivec2(k & 1, k >> 1);
    ivec2 tap = ivec2(corner) + side;
    if (!is_inside(tap, textureSize(coarse, 0))) {
      continue;
    }
    vec4 tap_place = texelFetch(coarse_place, tap, 0);
    vec3 tap_normal = direction(texelFetch(coarse_vector_area, tap, 0).xyz);
    vec2 linear = mix(1.0 - blend, blend, vec2(side));
    if (tap_place.w > 0.0 && linear.x * linear.y > 0.0) {
      float height = dot(normal, tap_place.xyz - receiver);
      float flatness = 1.0 / (1.0 + FLATNESS_SHARPNESS * height * height / tap_place.w);
      float likeness = max(dot(normal, tap_normal), 0.0);
      likeness *= likeness;
      likeness *= likeness;
      likeness *= likeness;  // cosine to the 8th
      float weight = linear.x * linear.y * (flatness * likeness + LEAST_WEIGHT);
      sum += weight * texelFetch(coarse, tap, 0);
      weights += weight;
    }
  }
  return weights > 0.0 ? sum / weights : vec4(0.0);
}
