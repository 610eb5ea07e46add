// SPDX-License-Identifier: GPL-3.0-or-later
// Reflect: the specular light of each texel of the base. rgb: pi times the mean radiance over the lobe of a white
// surface; EEVEE's Glossy Color has the albedo. a: the mean of 1 / distance of the hits.
//
// EEVEE has the whole world in its reflections. A hit covers its part of the world and takes that light away. A ray
// without a hit adds nothing; one that ends out of sight, or hits a side that no view shows, counts as the mean of the
// others.

#define MIN_ALPHA 1e-3        // a mirror, at the resolution of texels
#define MIN_COSINE 0.02       // between normal and camera: normals of smooth shading and bumps may lean away
#define CLEARANCE 0.1         // sides of a base texel: where rays begin

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) + ivec2(options.first_column, options.first_row);
  Receiver receiver = receiver_at(at);
  vec4 surface = texelFetch(gloss, min(at, level_size(0) - 1), 0);  // roughness; above 0 where there is gloss
  vec4 sum = vec4(0.0);
  if (receiver.is_surface && surface.g > 0.0) {
    float alpha = max(surface.r * surface.r, MIN_ALPHA);
    vec3 outgoing = direction(to_camera(0, receiver.position));
    float lean = max(MIN_COSINE - dot(receiver.normal, outgoing), 0.0);
    vec3 normal = direction(receiver.normal + lean * outgoing), x = tangent_of(normal), y = cross(normal, x);
    vec3 seen = vec3(dot(outgoing, x), dot(outgoing, y), dot(outgoing, normal));
    Surfel surfel = unpack_surfel(texelFetch(surfels, at, 0), at, 0);
    float least = CLEARANCE * sqrt(surfel.area / max(seen.z, COSINE_FLOOR)), weights = 0.0;
    uint state = pcg_hash(uint(at.x) + pcg_hash(uint(at.y) + pcg_hash(options.seed)));
    vec3 shift;
    for (int k = 0; k < 3; k++) {
      state = pcg_next(state);
      shift[k] = unit(pcg_output(state));
    }
    for (int k = 0; k < options.rays; k++) {
      // The sequence R3 of M. Roberts, shifted for each texel.
      vec3 random = fract(shift + float(k) * vec3(0.8191725134, 0.6710436067, 0.5497004779));
      vec3 facet = visible_normal(seen, alpha, random.xy);
      vec3 away = 2.0 * dot(seen, facet) * facet - seen;
      float weight = lobe_weight(seen.z, away.z, alpha);
      if (weight <= 0.0) {
        continue;
      }
      vec3 towards = direction(away.x * x + away.y * y + away.z * normal);
      float far = first_hit(receiver.position, normal, towards, least, random.z, options.reach);
      if (far > 0.0) {
        vec4 hit = radiance_at(receiver.position + far * towards, towards);
        weight *= hit.a;
        sum += weight * vec4(hit.rgb - world_radiance(towards), 1.0 / far);
      }
      weights += far == LOST ? 0.0 : weight;
    }
    sum = weights > 0.0 ? sum * vec4(vec3(PI), 1.0) / weights : vec4(0.0);
  }
  if (is_inside(at, imageSize(irradiance_out))) {
    imageStore(irradiance_out, at, sum);
  }
}
