// SPDX-License-Identifier: GPL-3.0-or-later
// One dispatch for several levels: its work groups are the tiles of level `last`, then of the next finer one, down to
// `first`. The coarsest come first because their texels take longest.

// (x, y, level) of this thread's texel, from the number of its work group.
ivec3 tile_texel(int first, int last, int group)
{
  ivec2 tiles = ivec2(0);
  int level;
  for (level = last; level >= first; level--) {
    tiles = (level_size(level) + ivec2(gl_WorkGroupSize.xy) - 1) / ivec2(gl_WorkGroupSize.xy);
    if (group < tiles.x * tiles.y) {
      break;
    }
    group -= tiles.x * tiles.y;
  }
  ivec2 corner = ivec2(group % tiles.x, group / tiles.x) * ivec2(gl_WorkGroupSize.xy);
  return ivec3(corner + ivec2(gl_LocalInvocationID.xy), level);
}
