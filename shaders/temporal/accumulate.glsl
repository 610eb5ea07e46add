// SPDX-License-Identifier: GPL-3.0-or-later
// Accumulate: the mean of a texel's history and its new irradiance. a: number of gathers that it is the mean of, -1
// where there is no surface.
//
// Light that changes must not lag behind. One texel can't tell change from noise, but its neighbourhood can: there all
// texels differ from their history by the same drift, each with noise of its own. A drift of the texels on the same
// surface that exceeds the noise is added to the history before the mean is taken. And where much of the light around
// has changed, on any surface, the history's weight is reduced, down to 0: texels do not change alike then.

#define DRIFT_RADIUS 2        // taps to each side
#define DRIFT_STRIDE 2        // texels between taps
#define DRIFT_START_SIGMA 2.0 // standard deviations of the noise: below, a drift is ignored
#define DRIFT_END_SIGMA 3.0   // from here on it is followed in full, and the history's weight falls
#define RESET_SIGMA 6.0       // from here on the history has no weight
#define SHARED_NOISE 0.03     // of the irradiance: the noise of the bounces before, which all texels share
#define SAME_SURFACE 0.5      // least bilateral weight of a tap on the same surface
#define MIN_TAPS 8.0          // fewer give no answer
#define RESET_START_SHARE 0.1 // of the light: a change from which on the history's weight falls
#define RESET_END_SHARE 0.5   // and one from which on it has none

// Sums over taps.
struct Changes {
  float count;
  vec3 change, squares, now, past;
};

Changes no_changes()
{
  Changes none;
  none.count = 0.0;
  none.change = none.squares = none.now = none.past = vec3(0.0);
  return none;
}

void tally(inout Changes changes, vec3 now, vec3 past)
{
  changes.count += 1.0;
  changes.change += now - past;
  changes.squares += (now - past) * (now - past);
  changes.now += now;
  changes.past += past;
}

// The mean change, in standard deviations of the noise; 0 where there are fewer than MIN_TAPS.
vec3 deviations(Changes changes)
{
  float few = max(changes.count, MIN_TAPS);
  vec3 mean = changes.change / few, alike = SHARED_NOISE * changes.now / few;
  vec3 deviation = sqrt(max(changes.squares / few - mean * mean, vec3(0.0)) / (few - 1.0) + alike * alike);
  return changes.count < MIN_TAPS ? vec3(0.0) : abs(mean) / max(deviation, vec3(1e-37));
}

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(at, level_size(0))) {
    return;
  }
  float gathers = options.gathers, most = options.earlier_gathers;
  vec4 past = texelFetch(history, at, 0), now = texelFetch(irradiance, at, 0);
  bool may_change = options.allows_drift != 0;
  float weight = may_change ? clamp(past.a, 0.0, most) : most;
  if (may_change && weight > 0.0) {
    Surfel receiver = unpack_surfel(texelFetch(surfels, at, 0), at, 0);
    vec3 normal = direction(receiver.vector_area);
    Changes here = no_changes(), around = no_changes();
    for (int y = -DRIFT_RADIUS; y <= DRIFT_RADIUS; y++) {
      for (int x = -DRIFT_RADIUS; x <= DRIFT_RADIUS; x++) {
        ivec2 tap = at + DRIFT_STRIDE * ivec2(x, y);
        vec4 before = is_inside(tap, level_size(0)) ? texelFetch(history, tap, 0) : vec4(0.0);
        if (before.a <= 0.0) {
          continue;
        }
        vec3 after = texelFetch(irradiance, tap, 0).rgb;
        tally(around, after, before.rgb);
        Surfel surfel = unpack_surfel(texelFetch(surfels, tap, 0), tap, 0);
        float height = dot(normal, surfel.position - receiver.position);
        float cosine = dot(normal, direction(surfel.vector_area));
        if (bilateral_weight(vec4(height), vec4(cosine), surfel.area).x > SAME_SURFACE) {
          tally(here, after, before.rgb);
        }
      }
    }
    past.rgb += here.change / max(here.count, 1.0) *
                clamp((deviations(here) - DRIFT_START_SIGMA) / (DRIFT_END_SIGMA - DRIFT_START_SIGMA), 0.0, 1.0);
    vec3 share = abs(around.change) / max(max(abs(around.now), abs(around.past)), vec3(1e-37));
    vec3 lost = clamp((deviations(around) - DRIFT_END_SIGMA) / (RESET_SIGMA - DRIFT_END_SIGMA), 0.0, 1.0) *
                clamp((share - RESET_START_SHARE) / (RESET_END_SHARE - RESET_START_SHARE), 0.0, 1.0);
    weight *= 1.0 - max(max(lost.r, lost.g), lost.b);
  }
  float all = weight + gathers;
  imageStore(light_out, at, vec4((past.rgb * weight + now.rgb * gathers) / all, past.a < 0.0 ? -1.0 : all));
}
