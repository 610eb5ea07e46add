// SPDX-License-Identifier: GPL-3.0-or-later
// Gather: the irradiance that each texel of one level receives from a region of the same level around it.
// The same shader serves every level; only the table of offsets differs (a disk at the finest, a ring elsewhere).

// The PCG generator of M. O'Neill (HMC-CS-2014-0905), the variant RXS-M-XS with 32 bits of state.
uint pcg_next(uint state)
{
  return state * 747796405u + 2891336453u;
}

uint pcg_output(uint state)
{
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

uint pcg_hash(uint value)
{
  return pcg_output(pcg_next(value));
}

// Uniform integer in [0, count), count <= 65535: the upper word of the product random * count.
uint below(uint random, uint count)
{
  return ((random >> 16u) * count + (((random & 0xFFFFu) * count) >> 16u)) >> 16u;
}

// Cosine-weighted solid angle over pi: facing disks of area A at distance r see A / (pi r^2 + A) of each other,
// never more than 1. The vector area V stands for A n' and may be shorter than A: a texel that is not flat.
float form_factor(vec3 receiver, vec3 normal, vec4 emitter, vec3 vector_area)
{
  vec3 path = emitter.xyz - receiver;
  float square = dot(path, path);
  float cosines = max(dot(normal, path), 0.0) * max(-dot(vector_area, path), 0.0);
  return cosines > 0.0 ? cosines / square / (PI * square + emitter.w) : 0.0;
}

void main()
{
  ivec2 texel = this_texel();
  ivec2 size = imageSize(irradiance);
  if (!is_inside(texel, size)) {
    return;
  }
  vec4 receiver = texelFetch(place, texel, 0);
  vec4 gathered = vec4(0.0);
  if (receiver.w > 0.0) {
    vec3 normal = direction(texelFetch(vector_areas, texel, 0).xyz);
    uint samples = uint(parameters.sampling.x);
    uint count = uint(parameters.sampling.y);
    uint state = pcg_hash(uint(texel.x) + pcg_hash(uint(texel.y) + pcg_hash(uint(parameters.sampling.z) +
                 pcg_hash(uint(parameters.sampling.w)))));
    for (uint k = 0u; k < samples; k++) {
      // Stratified: sample k takes one of the k-th part of the table, every entry as likely as any other over all
      // samples. With samples == count this is entry k itself, the exhaustive sum.
      state = pcg_next(state);
      int entry = int((k * count + below(pcg_output(state), count)) / samples);
      ivec2 other = texel + ivec2(texelFetch(offsets, ivec2(entry % OFFSETS_WIDTH, entry / OFFSETS_WIDTH), 0).xy);
      if (!is_inside(other, size)) {
        continue;  // counted, adds nothing: the region has the same size for every receiver
      }
      float form = form_factor(receiver.xyz, normal, texelFetch(place, other, 0),
                               texelFetch(vector_areas, other, 0).xyz);
      if (form > 0.0) {
        gathered += form * vec4(PI * texelFetch(radiance, other, 0).rgb, 1.0);
      }
    }
    gathered *= float(count) / float(samples);
  }
  imageStore(irradiance, texel, gathered);
}
