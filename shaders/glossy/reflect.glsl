// SPDX-License-Identifier: GPL-3.0-or-later
// Reflect: what each texel of the base sees in its own gloss: pi times the mean radiance over its lobe, as if all of it came
// back; EEVEE's Glossy Color says how much does. The fourth channel is the mean of 1 / distance of what was met.
//
// EEVEE has the whole world in its reflections. What a ray meets stands before its part of the world, and takes that away. A
// ray that meets nothing adds nothing; one that is lost from sight, or meets a side that no
// view shows, counts as the mean of the others.

#define LEAST_ALPHA 1e-3      // a mirror, as far as texels can tell
#define LEAST_COSINE 0.02     // of the eye to a normal that leans away from it, as smooth shading and bumps have them
#define CLEARANCE 0.1         // lengths of a texel of the base: where rays begin

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) + parameters.band.zx;
  Receiver receiver = receiver_at(at);
  vec4 surface = texelFetch(gloss, min(at, level_size(0) - 1), 0);  // roughness, whether there is gloss
  vec4 sum = vec4(0.0);
  if (receiver.is_surface && surface.g > 0.0) {
    float alpha = max(surface.r * surface.r, LEAST_ALPHA);
    vec3 eye = direction(to_eye(0, receiver.place));
    float lean = max(LEAST_COSINE - dot(receiver.normal, eye), 0.0);
    vec3 normal = direction(receiver.normal + lean * eye), x = beside(normal), y = cross(normal, x);
    vec3 seen = vec3(dot(eye, x), dot(eye, y), dot(eye, normal));
    Surfel surfel = unpack_surfel(texelFetch(surfels, at, 0), at, 0);
    float least = CLEARANCE * sqrt(surfel.area / max(seen.z, COSINE_FLOOR)), weights = 0.0;
    uint state = pcg_hash(uint(at.x) + pcg_hash(uint(at.y) + pcg_hash(uint(parameters.band.y))));
    vec3 shift;
    for (int k = 0; k < 3; k++) {
      state = pcg_next(state);
      shift[k] = unit(pcg_output(state));
    }
    for (int k = 0; k < views.draws.x; k++) {
      // The sequence R3 of M. Roberts, shifted for each texel.
      vec3 random = fract(shift + float(k) * vec3(0.8191725134, 0.6710436067, 0.5497004779));
      vec3 facet = visible_normal(seen, alpha, random.xy);
      vec3 away = 2.0 * dot(seen, facet) * facet - seen;
      float weight = lobe_weight(seen.z, away.z, alpha);
      if (weight <= 0.0) {
        continue;
      }
      vec3 towards = direction(away.x * x + away.y * y + away.z * normal);
      float far = first_hit(receiver.place, normal, towards, least, random.z);
      if (far > 0.0) {
        vec4 found = radiance_at(receiver.place + far * towards, towards);
        weight *= found.a;
        sum += weight * vec4(found.rgb - world_radiance(towards), 1.0 / far);
      }
      weights += far == LOST ? 0.0 : weight;
    }
    sum = weights > 0.0 ? sum * vec4(vec3(PI), 1.0) / weights : vec4(0.0);
  }
  if (is_inside(at, imageSize(irradiance_out))) {
    imageStore(irradiance_out, at, sum);
  }
}
