// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth the noise out of what texels see in their gloss: a mean over those around on the same surface that are as rough. It
// reaches as far as leaves the picture of what is met as sharp as the lobe shows it: a part of the lobe's width there.

#define GLOSS_RADIUS 3        // texels at most
#define LOBE_SHARE 0.5        // of alpha times the distance: the deviation of the mean
#define ALIKE 0.1             // difference of roughness at which another surface counts less by e

void main()
{
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(texel, level_size(0))) {
    return;
  }
  Surfel receiver = unpack_surfel(texelFetch(surfels, texel, 0), texel, 0);
  vec4 sum = texelFetch(irradiance, texel, 0), own = texelFetch(gloss, texel, 0);
  float weights = 1.0;
  vec3 normal = direction(receiver.vector_area);
  float deviation = LOBE_SHARE * own.r * own.r / max(sum.a * sqrt(receiver.area), 1e-6);
  deviation = min(deviation, float(GLOSS_RADIUS) * 0.7);
  int reach = receiver.area > 0.0 && own.g > 0.0 ? int(min(ceil(2.0 * deviation), float(GLOSS_RADIUS))) : 0;
  for (int y = -reach; y <= reach; y++) {
    for (int x = -reach; x <= reach; x++) {
      ivec2 tap = texel + ivec2(x, y);
      if ((x == 0 && y == 0) || !is_inside(tap, level_size(0))) {
        continue;
      }
      Surfel surfel = unpack_surfel(texelFetch(surfels, tap, 0), tap, 0);
      vec4 other = texelFetch(gloss, tap, 0);
      if (surfel.area <= 0.0 || other.g <= 0.0) {
        continue;
      }
      float height = dot(normal, surfel.place - receiver.place);
      float cosine = dot(normal, direction(surfel.vector_area));
      float near = exp(-0.5 * float(x * x + y * y) / (deviation * deviation) - abs(other.r - own.r) / ALIKE);
      float weight = near * (bilateral_weight(vec4(height), vec4(cosine), surfel.area).x - LEAST_WEIGHT);
      sum += weight * texelFetch(irradiance, tap, 0);
      weights += weight;
    }
  }
  // No bound: the fourth channel is composite's share of the hemisphere.
  imageStore(total_out, texel, vec4(sum.rgb / weights, 0.0));
}
