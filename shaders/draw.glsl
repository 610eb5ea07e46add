// SPDX-License-Identifier: GPL-3.0-or-later
// Draw: the irradiance of a receiver from the emitters of all views, W m^-2.
//
// Emitters are taken from a table that holds each as often as it has power and area. Looking along the way to one costs as
// much as weighing dozens, so they are drawn in groups: of a group's candidates one is chosen in proportion to what it would
// send if nothing stood in between, stands for all of them, and only it is looked at (resampled importance sampling;
// Talbot et al. 2005). Unbiased for any number of groups and candidates.

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, parameters.band.x);
  Receiver receiver = receiver_at(at);
  vec3 place = receiver.place, normal = receiver.normal, sum = vec3(0.0);
  if (receiver.is_surface) {
    int groups = views.draws.x, candidates = views.draws.y, entries = views.draws.z;
    uint state = pcg_hash(uint(at.x) + pcg_hash(uint(at.y) + pcg_hash(uint(parameters.band.y))));
    for (int group = 0; group < groups; group++) {
      float total = 0.0, weight = 0.0;
      vec3 light = vec3(0.0), from = vec3(0.0);
      for (int k = 0; k < candidates; k++) {
        state = pcg_next(state);
        float stratum = (float(k * groups + group) + unit(pcg_output(state))) / float(groups * candidates);
        int entry = min(int(stratum * float(entries)), entries - 1);
        int number = int(texelFetch(table, ivec2(entry % DRAWS_WIDTH, entry / DRAWS_WIDTH), 0).r);
        vec4 first = texelFetch(emitters, record_texel(number, 0, 4), 0);
        vec4 second = texelFetch(emitters, record_texel(number, 1, 4), 0);
        vec4 sent = texelFetch(radiance, record_texel(number, 0, 1), 0);
        float form = form_factor(place, normal, first.xyz, second.a, second.xyz, first.a);
        float power = abs(sent.r) + abs(sent.g) + abs(sent.b);
        float odds = (views.odds.x * power + views.odds.y) * first.a;
        if (form <= 0.0 || power == 0.0) {
          continue;
        }
        float own = power * form / odds;
        total += own;
        state = pcg_next(state);
        if (unit(pcg_output(state)) * total <= own) {
          weight = own;
          light = sent.rgb * form / odds;
          from = first.xyz;
        }
      }
      state = pcg_next(state);
      if (weight > 0.0 && !is_blocked(place, from, unit(pcg_output(state)))) {
        sum += light * (total / weight);
      }
    }
    sum *= PI / float(groups * candidates);
  }
  ivec2 size = imageSize(irradiance_out);
  if (is_inside(at, size)) {
    imageStore(irradiance_out, at, vec4(sum, 0.0));
  }
}
