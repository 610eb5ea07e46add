// SPDX-License-Identifier: GPL-3.0-or-later
// Merge: coarser levels of the pyramid from a finer one, by sums over 2 x 2, 4 x 4 or 8 x 8 of its texels. Up to three
// levels at once: the third takes 64 reads a thread, which cost less than another dispatch.

void main()
{
  int finer = options.finer_level;
  ivec3 tile = tile_texel(finer + 1, options.last_level, int(gl_WorkGroupID.x));
  ivec2 texel = tile.xy;
  int level = tile.z;
  if (!is_inside(texel, level_size(level))) {
    return;
  }
  int side = 1 << (level - finer);
  Sums sums = sums_of(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
  for (int row = 0; row < side; row++) {
    for (int column = 0; column < side; column++) {
      ivec2 child = texel * side + ivec2(column, row);
      if (is_inside(child, level_size(finer))) {
        Surfel surfel = unpack_surfel(imageLoad(surfels_out, level_origin(finer) + child), child, finer);
        sums.area += surfel.area;
        sums.moment += surfel.area * surfel.position;
        sums.vector_area += surfel.vector_area;
        sums.power += surfel.area * surfel.radiance;
      }
    }
  }
  imageStore(surfels_out, level_origin(level) + texel, pack_surfel(sums, texel, level));
}
