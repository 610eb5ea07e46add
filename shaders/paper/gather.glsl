// SPDX-License-Identifier: GPL-3.0-or-later
// Gather: the irradiance that each texel of every level receives from a region of its own level around it. Only the
// part of the table of offsets differs between levels: a disk at the finest, a ring elsewhere.

// Entry of the table for sample k: any of the k-th part of it, all alike. `part` is its length in 1 / 65536 entries.
// With as many samples as entries this is entry k itself, the exhaustive sum.
uint stratum(uint k, uint part, uint random)
{
  return (k * part + min(uint(unit(random) * float(part)), part - 1u)) >> 16u;
}

void main()
{
  ivec3 tile = tile_texel(0, parameters.span.y, int(gl_WorkGroupID.x) + parameters.band.x);
  ivec2 texel = tile.xy;
  int level = tile.z;
  ivec2 size = level_size(level), origin = level_origin(level);
  if (!is_inside(texel, size)) {
    return;
  }
  Surfel receiver = unpack_surfel(texelFetch(surfels, origin + texel, 0), texel, level);
  vec4 gathered = vec4(0.0);
  if (receiver.area > 0.0) {
    vec3 normal = direction(receiver.vector_area);
    uint samples = uint(parameters.regions[level].x);
    int first = parameters.regions[level].y;
    uint part = uint(parameters.regions[level].w);
    uint state = pcg_hash(uint(texel.x) + pcg_hash(uint(texel.y) + pcg_hash(uint(level) +
                 pcg_hash(uint(parameters.band.y)))));
    for (uint k = 0u; k < samples; k++) {
      state = pcg_next(state);
      int entry = first + int(stratum(k, part, pcg_output(state)));
      ivec2 other = texel + ivec2(texelFetch(offsets, ivec2(entry % OFFSETS_WIDTH, entry / OFFSETS_WIDTH), 0).xy);
      Surfel emitter = unpack_surfel(texelFetch(surfels, origin + other, 0), other, level);
      float form = form_factor(receiver.place, normal, emitter.place, emitter.area, emitter.vector_area, 1.0);
      // Not 0 times it: beside the level lies what was in the memory before, and that may be NaN.
      gathered += is_inside(other, size) ? form * vec4(emitter.radiance, 1.0) : vec4(0.0);
    }
    gathered *= vec4(PI, PI, PI, 1.0) * (float(parameters.regions[level].z) / float(samples));
  }
  imageStore(irradiance_out, origin + texel, gathered);
}
