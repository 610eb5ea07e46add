// SPDX-License-Identifier: GPL-3.0-or-later
// Gather: the irradiance of each texel of every level from a region of its own level around it: a disk at the finest
// level, a ring at the others. The offsets of both are in one table.

// Stratified sampling: the entry of the table for sample k, uniform in the k-th part of the table. part: its length in
// 1 / 65536 entries. With as many samples as entries it is entry k, the exhaustive sum.
uint stratum(uint k, uint part, uint random)
{
  return (k * part + min(uint(unit(random) * float(part)), part - 1u)) >> 16u;
}

void main()
{
  ivec3 tile = tile_texel(0, options.last_level, int(gl_WorkGroupID.x) + options.first_group);
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
    uint samples = uint(options.regions[level].samples);
    int first = options.regions[level].first;
    uint part = options.regions[level].part;
    uint state = pcg_hash(uint(texel.x) + pcg_hash(uint(texel.y) + pcg_hash(uint(level) +
                 pcg_hash(options.seed))));
    for (uint k = 0u; k < samples; k++) {
      state = pcg_next(state);
      int entry = first + int(stratum(k, part, pcg_output(state)));
      ivec2 other = texel + ivec2(texelFetch(offsets, ivec2(entry % OFFSETS_WIDTH, entry / OFFSETS_WIDTH), 0).xy);
      Surfel emitter = unpack_surfel(texelFetch(surfels, origin + other, 0), other, level);
      float form = form_factor(receiver.position, normal, emitter.position, emitter.area, emitter.vector_area, 1.0);
      // Not multiplied by 0: memory beside the level is uninitialised and may hold NaN.
      gathered += is_inside(other, size) ? form * vec4(emitter.radiance, 1.0) : vec4(0.0);
    }
    gathered *= vec4(PI, PI, PI, 1.0) * (float(options.regions[level].entries) / float(samples));
  }
  imageStore(irradiance_out, origin + texel, gathered);
}
