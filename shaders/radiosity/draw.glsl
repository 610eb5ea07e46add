// SPDX-License-Identifier: GPL-3.0-or-later
// Draw: the irradiance of a receiver from the emitters of all views, W m^-2.
//
// Emitters are taken from a table that holds each as often as it has power and area, and from around where the views show
// the receiver: what lies near counts most, and a table for all can't know it. Looking along the way to one costs as
// much as weighing dozens, so they are drawn in groups: of a group's candidates one is chosen in proportion to what it would
// send if nothing stood in between, stands for all of them, and only it is looked at (resampled importance sampling;
// Talbot et al. 2005). Which of the two ways an emitter came by makes no difference: its chance is that of both together
// (the balance heuristic). Unbiased for any number of groups and candidates.
//
// EEVEE lights all surfaces by the whole world. An emitter stands before its part of the world, and takes that light away:
// what it sends is less by the world's radiance from there. In a closed room nothing of the world is left.

#define NEAR_RINGS 32         // of emitters around the receiver; those between two radii are drawn as often as those up to twice both
#define NEAR_SHARE 4          // of 16 candidates are drawn from there

float power_of(vec3 radiance)
{
  return abs(radiance.r) + abs(radiance.g) + abs(radiance.b);
}

// Chance of each of the 8 k emitters on the square ring k.
float ring_chance(int k)
{
  return k < 1 || k > NEAR_RINGS ? 0.0 : log(1.0 + 1.0 / float(k)) / log(float(NEAR_RINGS + 1)) / float(8 * k);
}

ivec2 draw_from_rings(float ring, float along)
{
  int k = clamp(int(exp(ring * log(float(NEAR_RINGS + 1)))), 1, NEAR_RINGS);
  int step = min(int(along * float(8 * k)), 8 * k - 1), side = step / (2 * k), offset = step % (2 * k) - k;
  return side == 0 ? ivec2(offset, -k) : side == 1 ? ivec2(k, offset) : side == 2 ? ivec2(-offset, k) : ivec2(-k, -offset);
}

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) + parameters.band.zx;
  Receiver receiver = receiver_at(at);
  vec3 place = receiver.place, normal = receiver.normal, sum = vec3(0.0);
  if (receiver.is_surface) {
    int groups = views.draws.x, candidates = views.draws.y, entries = views.draws.z;
    uint state = pcg_hash(uint(at.x) + pcg_hash(uint(at.y) + pcg_hash(uint(parameters.band.y))));
    // The views that show the receiver's surroundings.
    uint watchers = 0u;
    int watching = 0;
    for (uint left = all_views(); left != 0u; left &= left - 1u) {
      int view = findLSB(left);
      if (is_inside(place_in_grid(view, place), views.emitters[view].yz)) {
        watchers |= 1u << view;
        watching++;
      }
    }
    int nearby = watching > 0 ? candidates * NEAR_SHARE / 16 : 0, anywhere = candidates - nearby;
    for (int group = 0; group < groups; group++) {
      float total = 0.0, weight = 0.0;
      vec3 light = vec3(0.0), from = vec3(0.0);
      for (int k = 0; k < candidates; k++) {
        int number, view;
        state = pcg_next(state);
        float random = unit(pcg_output(state));
        if (k < anywhere) {
          float stratum = (float(k * groups + group) + random) / float(groups * anywhere);
          int entry = min(int(stratum * float(entries)), entries - 1);
          number = int(texelFetch(table, ivec2(entry % DRAWS_WIDTH, entry / DRAWS_WIDTH), 0).r);
          view = view_of(number);
        } else {
          int chosen = min(int(random * float(watching)), watching - 1);
          float ring = fract(random * float(watching));
          uint left = watchers;
          for (int skipped = 0; skipped < chosen; skipped++) {
            left &= left - 1u;
          }
          view = findLSB(left);
          state = pcg_next(state);
          ivec2 block = place_in_grid(view, place) + draw_from_rings(ring, unit(pcg_output(state)));
          ivec4 grid = views.emitters[view];
          if (!is_inside(block, grid.yz)) {
            continue;
          }
          number = grid.x + block.y * grid.y + block.x;
        }
        vec4 first = texelFetch(emitters, record_texel(number, 0, 4), 0);
        vec4 second = texelFetch(emitters, record_texel(number, 1, 4), 0);
        vec4 sent = texelFetch(radiance, record_texel(number, 0, 1), 0);
        float form = form_factor(place, normal, first.xyz, second.a, second.xyz, first.a);
        vec3 more = sent.rgb - world_radiance(direction(first.xyz - place));
        float power = power_of(more);
        if (form <= 0.0 || power == 0.0) {
          continue;
        }
        float chance = float(anywhere) * (views.odds.x * (power_of(sent.rgb) + views.odds.z) + views.odds.y) * first.a;
        if (nearby > 0 && (watchers >> view & 1u) != 0u) {
          ivec4 grid = views.emitters[view];
          int within = number - grid.x;
          ivec2 apart = abs(ivec2(within % grid.y, within / grid.y) - place_in_grid(view, place));
          chance += float(nearby) / float(watching) * ring_chance(max(apart.x, apart.y));
        }
        float own = power * form / chance;
        total += own;
        state = pcg_next(state);
        if (unit(pcg_output(state)) * total <= own) {
          weight = own;
          light = more * form / chance;
          from = first.xyz;
        }
      }
      state = pcg_next(state);
      if (weight > 0.0 && !is_blocked(place, from, unit(pcg_output(state)))) {
        sum += light * (total / weight);
      }
    }
    sum *= PI / float(groups);
  }
  ivec2 size = imageSize(irradiance_out);
  if (is_inside(at, size)) {
    imageStore(irradiance_out, at, vec4(sum, 0.0));
  }
}
