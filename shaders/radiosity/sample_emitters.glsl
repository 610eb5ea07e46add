// SPDX-License-Identifier: GPL-3.0-or-later
// Sample emitters: the irradiance of a receiver from the emitters of all views, W m^-2.
//
// Resampled importance sampling (Talbot et al. 2005): a shadow ray costs as much as weighing dozens of candidates. So
// candidates come in groups, one of each group is chosen in proportion to its unoccluded irradiance and stands for all
// of them, and only it gets a shadow ray. Unbiased for any number of groups and candidates.
//
// Candidates come from two strategies: a table that holds each emitter in proportion to its power and area, and the
// neighbourhood of the receiver in the views that show it, since near emitters count most and a table for all receivers
// can't know them. The pdf of a candidate is that of both together (the balance heuristic).
//
// EEVEE lights all surfaces by the whole world. An emitter covers its part of the world and takes that light away: its
// radiance is less by the world's from there. In a closed room nothing of the world is left.

#define NEAR_RINGS 32         // of emitters around the receiver; the pdf of ring k is proportional to log(1 + 1 / k)
#define NEAR_SHARE 4          // of 16 candidates come from them

// Pdf of each of the 8 k emitters on the square ring k.
float ring_pdf(int k)
{
  return k < 1 || k > NEAR_RINGS ? 0.0 : log(1.0 + 1.0 / float(k)) / log(float(NEAR_RINGS + 1)) / float(8 * k);
}

ivec2 sample_ring(float ring, float along)
{
  int k = clamp(int(exp(ring * log(float(NEAR_RINGS + 1)))), 1, NEAR_RINGS);
  int step = min(int(along * float(8 * k)), 8 * k - 1), side = step / (2 * k), offset = step % (2 * k) - k;
  return side == 0 ? ivec2(offset, -k) :
         side == 1 ? ivec2(k, offset) :
         side == 2 ? ivec2(-offset, k) :
                     ivec2(-k, -offset);
}

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(options.first_column, options.first_row);
  Receiver receiver = receiver_at(at);
  vec3 position = receiver.position, normal = receiver.normal, sum = vec3(0.0);
  if (receiver.is_surface) {
    int groups = options.groups, candidates = options.candidates, entries = options.entries;
    uint state = pcg_hash(uint(at.x) + pcg_hash(uint(at.y) + pcg_hash(options.seed)));
    // The views that show the receiver's neighbourhood.
    uint near_views = 0u;
    int near_count = 0;
    for (uint left = all_views(); left != 0u; left &= left - 1u) {
      int view = findLSB(left);
      if (is_inside(grid_cell(view, position), views.cameras[view].emitters.size)) {
        near_views |= 1u << view;
        near_count++;
      }
    }
    int near_candidates = near_count > 0 ? candidates * NEAR_SHARE / 16 : 0;
    int table_candidates = candidates - near_candidates;
    vec2 pdfs = texelFetch(starts, ivec2(0), 0).ba;
    for (int group = 0; group < groups; group++) {
      float total = 0.0, weight = 0.0;
      vec3 light = vec3(0.0), from = vec3(0.0);
      for (int k = 0; k < candidates; k++) {
        int number, view;
        state = pcg_next(state);
        float random = unit(pcg_output(state));
        if (k < table_candidates) {
          float stratum = (float(k * groups + group) + random) / float(groups * table_candidates);
          int entry = min(int(stratum * float(entries)), entries - 1);
          number = int(texelFetch(table, ivec2(entry % EMITTER_TABLE_WIDTH, entry / EMITTER_TABLE_WIDTH), 0).r);
          view = view_of(number);
        } else {
          int chosen = min(int(random * float(near_count)), near_count - 1);
          float ring = fract(random * float(near_count));
          uint left = near_views;
          for (int skipped = 0; skipped < chosen; skipped++) {
            left &= left - 1u;
          }
          view = findLSB(left);
          state = pcg_next(state);
          ivec2 block = grid_cell(view, position) + sample_ring(ring, unit(pcg_output(state)));
          Grid grid = views.cameras[view].emitters;
          if (!is_inside(block, grid.size)) {
            continue;
          }
          number = grid.first + block.y * grid.size.x + block.x;
        }
        vec4 first = texelFetch(emitters, record_texel(number, 0, 4), 0);
        vec4 second = texelFetch(emitters, record_texel(number, 1, 4), 0);
        vec4 sent = texelFetch(radiance, record_texel(number, 0, 1), 0);
        float form = form_factor(position, normal, first.xyz, second.a, second.xyz, first.a);
        vec3 more = sent.rgb - world_radiance(direction(first.xyz - position));
        float power = power_of(more);
        if (form <= 0.0 || power == 0.0) {
          continue;
        }
        float pdf = float(table_candidates) *
                    dot(pdfs, vec2(power_of(sent.rgb) + options.world_power, 1.0)) * first.a;
        if (near_candidates > 0 && (near_views >> view & 1u) != 0u) {
          Grid grid = views.cameras[view].emitters;
          int within = number - grid.first;
          ivec2 apart = abs(ivec2(within % grid.size.x, within / grid.size.x) - grid_cell(view, position));
          pdf += float(near_candidates) / float(near_count) * ring_pdf(max(apart.x, apart.y));
        }
        float own = power * form / pdf;
        total += own;
        state = pcg_next(state);
        if (unit(pcg_output(state)) * total <= own) {
          weight = own;
          light = more * form / pdf;
          from = first.xyz;
        }
      }
      state = pcg_next(state);
      if (weight > 0.0 && !is_blocked(position, from, unit(pcg_output(state)), options.shadow_steps)) {
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
