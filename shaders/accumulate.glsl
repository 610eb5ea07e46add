// SPDX-License-Identifier: GPL-3.0-or-later
// Accumulate: the mean of what was known of a texel's light and what was gathered now. a: how many gathers it is of.
//
// Light that changes must not trail behind. One texel can't tell change from noise; the texels around it on the same surface
// can: they all differ from what was known by the same drift, each with noise of its own. A drift that is more than noise is added
// to what was known before the mean is taken.

#define AROUND 2              // taps to each side,
#define STRIDE 2              // so many texels apart
#define MAYBE 2.0             // standard deviations that noise may make,
#define SURELY 3.0            // and that it hardly ever makes
#define COMMON 0.03           // of the irradiance: the noise that all texels share, that of the bounces before
#define SAME_SURFACE 0.5      // least bilateral weight of a tap
#define FEWEST 8.0            // taps that can tell

// What surely changed of the light around `at` since it was known, W m^-2.
vec3 drift(ivec2 at)
{
  Surfel receiver = unpack_surfel(texelFetch(surfels, at, 0), at, 0);
  vec3 normal = direction(receiver.vector_area), sum = vec3(0.0), squares = vec3(0.0), light = vec3(0.0);
  float count = 0.0;
  for (int y = -AROUND; y <= AROUND; y++) {
    for (int x = -AROUND; x <= AROUND; x++) {
      ivec2 tap = at + STRIDE * ivec2(x, y);
      if (!is_inside(tap, level_size(0))) {
        continue;
      }
      Surfel surfel = unpack_surfel(texelFetch(surfels, tap, 0), tap, 0);
      vec4 past = texelFetch(known, tap, 0);
      if (surfel.area <= 0.0 || past.a <= 0.0) {
        continue;
      }
      float height = dot(normal, surfel.place - receiver.place), cosine = dot(normal, direction(surfel.vector_area));
      if (bilateral_weight(vec4(height), vec4(cosine), surfel.area).x > SAME_SURFACE) {
        vec3 now = texelFetch(irradiance, tap, 0).rgb, change = now - past.rgb;
        sum += change;
        squares += change * change;
        light += now;
        count += 1.0;
      }
    }
  }
  if (count < FEWEST) {
    return vec3(0.0);
  }
  vec3 mean = sum / count, alike = COMMON * light / count;
  vec3 deviation = sqrt(max(squares / count - mean * mean, vec3(0.0)) / (count - 1.0) + alike * alike);
  return mean * clamp((abs(mean) / max(deviation, vec3(1e-37)) - MAYBE) / (SURELY - MAYBE), 0.0, 1.0);
}

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(at, level_size(0))) {
    return;
  }
  float gathers = float(parameters.span.x), most = float(parameters.span.y);
  bool may_drift = parameters.span.z != 0;
  vec4 past = texelFetch(known, at, 0), now = texelFetch(irradiance, at, 0);
  float weight = clamp(past.a, 0.0, most), all = weight + gathers;
  if (may_drift && weight > 0.0) {
    past.rgb += drift(at);
  }
  vec3 mean = weight > 0.0 ? (past.rgb * weight + now.rgb * gathers) / all : now.rgb;
  imageStore(light_out, at, vec4(mean, all));
}
