// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth gloss: reduces the noise of the specular light, by a mean over the texels around on the same surface with the
// same roughness. Its width is a share of the lobe's footprint on the surface, so that reflections stay as sharp as the
// lobe shows them.

#define GLOSS_RADIUS 3        // texels at most
#define MAX_DEVIATION 0.7     // of GLOSS_RADIUS, at most; chosen by eye, not measured
#define LOBE_SHARE 0.5        // deviation of the mean, over alpha times the distance
#define ROUGHNESS_SCALE 0.1   // difference of roughness at which a texel weighs less by a factor e

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
  deviation = min(deviation, float(GLOSS_RADIUS) * MAX_DEVIATION);
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
      float height = dot(normal, surfel.position - receiver.position);
      float cosine = dot(normal, direction(surfel.vector_area));
      float near = exp(-0.5 * float(x * x + y * y) / (deviation * deviation) - abs(other.r - own.r) / ROUGHNESS_SCALE);
      float weight = near * (bilateral_weight(vec4(height), vec4(cosine), surfel.area).x - MIN_WEIGHT);
      sum += weight * texelFetch(irradiance, tap, 0);
      weights += weight;
    }
  }
  // a: no sum of form factors for composite to bound.
  imageStore(total_out, texel, vec4(sum.rgb / weights, 0.0));
}
