// SPDX-License-Identifier: GPL-3.0-or-later
// Table: emitters in proportion to their pdf. Each entry is sampled from its own part of the whole, so that the number
// of entries that an emitter has is off by less than two.

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(table_out);
  if (!is_inside(at, size)) {
    return;
  }
  int entry = at.y * size.x + at.x;
  float jitter = unit(pcg_hash(uint(entry) + pcg_hash(options.seed)));
  // The last row that starts at or before this place among the entries.
  int row = 0, last = textureSize(starts, 0).x - 1;
  while (row < last) {
    int middle = (row + last + 1) / 2;
    vec2 start = texelFetch(starts, ivec2(middle, 0), 0).rg;
    if ((float(entry) - start.r) + (jitter - start.g) >= 0.0) {
      row = middle;
    } else {
      last = middle - 1;
    }
  }
  vec4 start = texelFetch(starts, ivec2(row, 0), 0);
  float within = ((float(entry) - start.r) + (jitter - start.g)) / float(options.entries);
  int column = 0, end = RECORDS_WIDTH - 1;
  while (column < end) {
    int middle = (column + end) / 2;
    if (dot(start.ba, texelFetch(sums, ivec2(middle, row), 0).rg) > within) {
      end = middle;
    } else {
      column = middle + 1;
    }
  }
  imageStore(table_out, at, vec4(float(min(row * RECORDS_WIDTH + column, options.count - 1)), 0.0, 0.0, 0.0));
}
