// SPDX-License-Identifier: GPL-3.0-or-later
// Shrink: the means of a picture, times a colour, over the cells of a grid. Pixels whose brightest channel then exceeds
// a limit are scaled down to it first.

void main()
{
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(cell, options.size)) {
    return;
  }
  ivec2 size = textureSize(picture, 0);
  ivec2 first = cell * size / options.size;
  ivec2 end = (cell + 1) * size / options.size;
  float limit = options.limit;
  vec4 total = vec4(0.0);
  for (int y = first.y; y < end.y; y++) {
    for (int x = first.x; x < end.x; x++) {
      vec4 pixel = texelFetch(picture, ivec2(x, y), 0);
      pixel.rgb *= options.color;
      vec3 magnitude = abs(pixel.rgb);
      float brightest = max(magnitude.r, max(magnitude.g, magnitude.b));
      total += vec4(limit > 0.0 && brightest > limit ? pixel.rgb * (limit / brightest) : pixel.rgb, pixel.a);
    }
  }
  imageStore(shrunk_out, cell, total / float((end.x - first.x) * (end.y - first.y)));
}
