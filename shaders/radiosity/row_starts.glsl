// SPDX-License-Identifier: GPL-3.0-or-later
// Row starts, for the table of emitters: the entry at which those of a row of records begin, whole (r) and fraction (g)
// apart, since a float of 32 bits can't hold both; and power_pdf (b) and area_pdf (a), alike for all rows: an emitter is
// sampled with the pdf area * (power_pdf * power + area_pdf).

void main()
{
  int row = int(gl_GlobalInvocationID.x), rows = textureSize(sums, 0).y;
  if (row >= rows) {
    return;
  }
  vec2 all = vec2(0.0);
  for (int each = 0; each < rows; each++) {
    all += texelFetch(sums, ivec2(RECORDS_WIDTH - 1, each), 0).rg;
  }
  float by_area = all.r > 0.0 ? options.by_area : 1.0;
  vec2 pdf = vec2(all.r > 0.0 ? (1.0 - by_area) / all.r : 0.0, all.g > 0.0 ? by_area / all.g : 0.0);
  float whole = 0.0, fraction = 0.0;
  for (int each = 0; each < row; each++) {
    fraction += dot(pdf, texelFetch(sums, ivec2(RECORDS_WIDTH - 1, each), 0).rg) * float(options.entries);
    whole += floor(fraction);
    fraction = fract(fraction);
  }
  imageStore(starts_out, ivec2(row, 0), vec4(whole, fraction, pdf));
}
