// SPDX-License-Identifier: GPL-3.0-or-later
// Accumulate: the mean of what was known of a texel's light and what was gathered now. a: how many gathers it is of, -1 where
// there is no surface.
//
// Light that changes must not trail behind. One texel can't tell change from noise; the texels around it can: they all differ from
// what was known by the same drift, each with noise of its own. What those on the same surface drift by, if it is more than noise,
// is added to what was known before the mean is taken. And where much of the light around is another, on whatever surface, what
// was known counts less, or not at all: no two texels change quite alike then.

#define AROUND 2              // taps to each side,
#define STRIDE 2              // so many texels apart
#define MAYBE 2.0             // standard deviations that noise may make,
#define SURELY 3.0            // that it hardly ever makes,
#define NEVER 6.0             // and that it never makes
#define COMMON 0.03           // of the irradiance: the noise that all texels share, that of the bounces before
#define SAME_SURFACE 0.5      // least bilateral weight of a tap on the same surface
#define FEWEST 8.0            // taps that can tell
#define LITTLE 0.1            // of the light: a drift after which what was known still counts,
#define MUCH 0.5              // and one after which it does not

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

// The mean change in standard deviations of what noise would make; 0 where too few taps tell.
vec3 deviations(Changes changes)
{
  float few = max(changes.count, FEWEST);
  vec3 mean = changes.change / few, alike = COMMON * changes.now / few;
  vec3 deviation = sqrt(max(changes.squares / few - mean * mean, vec3(0.0)) / (few - 1.0) + alike * alike);
  return changes.count < FEWEST ? vec3(0.0) : abs(mean) / max(deviation, vec3(1e-37));
}

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(at, level_size(0))) {
    return;
  }
  float gathers = float(parameters.span.x), most = float(parameters.span.y);
  vec4 past = texelFetch(known, at, 0), now = texelFetch(irradiance, at, 0);
  bool may_change = parameters.span.z != 0;
  float weight = may_change ? clamp(past.a, 0.0, most) : most;
  if (may_change && weight > 0.0) {
    Surfel receiver = unpack_surfel(texelFetch(surfels, at, 0), at, 0);
    vec3 normal = direction(receiver.vector_area);
    Changes here = no_changes(), around = no_changes();
    for (int y = -AROUND; y <= AROUND; y++) {
      for (int x = -AROUND; x <= AROUND; x++) {
        ivec2 tap = at + STRIDE * ivec2(x, y);
        vec4 before = is_inside(tap, level_size(0)) ? texelFetch(known, tap, 0) : vec4(0.0);
        if (before.a <= 0.0) {
          continue;
        }
        vec3 after = texelFetch(irradiance, tap, 0).rgb;
        tally(around, after, before.rgb);
        Surfel surfel = unpack_surfel(texelFetch(surfels, tap, 0), tap, 0);
        float height = dot(normal, surfel.place - receiver.place), cosine = dot(normal, direction(surfel.vector_area));
        if (bilateral_weight(vec4(height), vec4(cosine), surfel.area).x > SAME_SURFACE) {
          tally(here, after, before.rgb);
        }
      }
    }
    past.rgb += here.change / max(here.count, 1.0) * clamp((deviations(here) - MAYBE) / (SURELY - MAYBE), 0.0, 1.0);
    vec3 share = abs(around.change) / max(max(abs(around.now), abs(around.past)), vec3(1e-37));
    vec3 lost = clamp((deviations(around) - SURELY) / (NEVER - SURELY), 0.0, 1.0) * clamp((share - LITTLE) / (MUCH - LITTLE), 0.0, 1.0);
    weight *= 1.0 - max(max(lost.r, lost.g), lost.b);
  }
  float all = weight + gathers;
  imageStore(light_out, at, vec4((past.rgb * weight + now.rgb * gathers) / all, past.a < 0.0 ? -1.0 : all));
}
