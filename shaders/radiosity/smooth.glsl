// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth: reduces the noise of the base's irradiance, by means over the texels around on the same surface, in steps
// that take texels farther and farther apart (the wavelet transform "a trous"; H. Dammertz et al., HPG 2010). A
// firefly, one texel much brighter than all around it, is clamped to FIREFLY_RATIO times their mean. Noise may not take
// away more of the world's light than there is.

#define FIREFLY_RATIO 4.0     // of the mean of the others

float brightness(vec3 light)
{
  return abs(light.r) + abs(light.g) + abs(light.b);
}

// Cubic B-spline at whole numbers, relative to its maximum.
float spline(int offset)
{
  return offset == 0 ? 1.0 : abs(offset) == 1 ? 2.0 / 3.0 : 1.0 / 6.0;
}

void main()
{
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(texel, level_size(0))) {
    return;
  }
  int step = options.step;
  bool is_last = options.is_last != 0;
  Surfel receiver = unpack_surfel(texelFetch(surfels, texel, 0), texel, 0);
  vec3 sum = texelFetch(irradiance, texel, 0).rgb, brightest = sum;
  float weights = 1.0, brightest_weight = 1.0;
  vec3 normal = direction(receiver.vector_area);
  for (int y = -2; y <= 2; y++) {
    for (int x = -2; x <= 2; x++) {
      ivec2 tap = texel + step * ivec2(x, y);
      if ((x == 0 && y == 0) || receiver.area <= 0.0 || !is_inside(tap, level_size(0))) {
        continue;
      }
      Surfel surfel = unpack_surfel(texelFetch(surfels, tap, 0), tap, 0);
      if (surfel.area <= 0.0) {
        continue;
      }
      float height = dot(normal, surfel.position - receiver.position);
      float cosine = dot(normal, direction(surfel.vector_area));
      float weight = spline(x) * spline(y) * (bilateral_weight(vec4(height), vec4(cosine), surfel.area).x - MIN_WEIGHT);
      vec3 light = texelFetch(irradiance, tap, 0).rgb;
      sum += weight * light;
      weights += weight;
      if (brightness(light) > brightness(brightest) && weight > 0.0) {
        brightest = light;
        brightest_weight = weight;
      }
    }
  }
  float others = weights - brightest_weight;
  if (step == 1 && others > 1.0) {
    float most = FIREFLY_RATIO * brightness(sum - brightest_weight * brightest) / others;
    sum -= brightest_weight * brightest * (1.0 - min(most / max(brightness(brightest), 1e-37), 1.0));
  }
  sum /= weights;
  if (is_last && options.has_world != 0) {
    vec3 world = PI * world_light(to_world(0, normal)) / max(options.strength, 1.0);
    sum = max(sum, -max(world, vec3(0.0)));
  }
  imageStore(total_out, texel, vec4(sum, 0.0));
}
