// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth: the noise of the draws out of the base's irradiance, by means over the texels around that lie on the same surface, twice,
// the second time of texels two apart (the wavelet transform "a trous"; H. Dammertz and others, HPG 2010). One texel that outshines
// all others around is a draw that hardly ever happens: it counts as OUTSHINES times the others, not as a spot of light. No noise may
// take away more of the world's light than there is.

#define OUTSHINES 4.0         // times the mean of the others

float brightness(vec3 light)
{
  return abs(light.r) + abs(light.g) + abs(light.b);
}

// Of a cubic spline at whole numbers, over its greatest.
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
  int step = parameters.span.x;
  bool is_last = parameters.span.y != 0;
  Surfel receiver = unpack_surfel(texelFetch(surfels, texel, 0), texel, 0);
  vec3 sum = texelFetch(irradiance, texel, 0).rgb, brightest = sum;
  float weights = 1.0, its_weight = 1.0;
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
      float height = dot(normal, surfel.place - receiver.place);
      float cosine = dot(normal, direction(surfel.vector_area));
      float weight = spline(x) * spline(y) * (bilateral_weight(vec4(height), vec4(cosine), surfel.area).x - LEAST_WEIGHT);
      vec3 light = texelFetch(irradiance, tap, 0).rgb;
      sum += weight * light;
      weights += weight;
      if (brightness(light) > brightness(brightest) && weight > 0.0) {
        brightest = light;
        its_weight = weight;
      }
    }
  }
  float others = weights - its_weight;
  if (step == 1 && others > 1.0) {
    float most = OUTSHINES * brightness(sum - its_weight * brightest) / others;
    sum -= its_weight * brightest * (1.0 - min(most / max(brightness(brightest), 1e-37), 1.0));
  }
  sum /= weights;
  if (is_last && views.odds.z > 0.0) {
    vec3 world = PI * world_light(to_world(0, normal)) / max(parameters.output_scale.x, 1.0);
    sum = max(sum, -max(world, vec3(0.0)));
  }
  imageStore(total_out, texel, vec4(sum, 0.0));
}
