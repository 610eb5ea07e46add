// SPDX-License-Identifier: GPL-3.0-or-later
// Row sums, for the table of emitters: the sums of power times area (r) and of area (g) over the emitters of a row of
// records, up to and including each.

void main()
{
  int row = int(gl_GlobalInvocationID.x);
  if (row >= imageSize(sums_out).y) {
    return;
  }
  vec2 sum = vec2(0.0);
  for (int column = 0; column < RECORDS_WIDTH; column++) {
    ivec2 at = ivec2(column, row);
    if (row * RECORDS_WIDTH + column < options.count) {
      vec4 sent = texelFetch(radiance, at, 0);
      sum += vec2(power_of(sent.rgb) + options.world_power, 1.0) * sent.a;
    }
    imageStore(sums_out, at, vec4(sum, 0.0, 0.0));
  }
}
