// SPDX-License-Identifier: GPL-3.0-or-later
// Shrink: the means of a picture over the cells of a grid, times a colour. What is then brighter than a limit, in any
// channel, is made as bright as that first.

void main()
{
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(cell, parameters.frame.xy)) {
    return;
  }
  ivec2 size = textureSize(picture, 0);
  ivec2 first = cell * size / parameters.frame.xy;
  ivec2 end = (cell + 1) * size / parameters.frame.xy;
  float limit = parameters.output_scale.w;
  vec4 total = vec4(0.0);
  for (int y = first.y; y < end.y; y++) {
    for (int x = first.x; x < end.x; x++) {
      vec4 found = texelFetch(picture, ivec2(x, y), 0);
      found.rgb *= parameters.output_scale.rgb;
      vec3 size_of = abs(found.rgb);
      float brightest = max(size_of.r, max(size_of.g, size_of.b));
      total += vec4(limit > 0.0 && brightest > limit ? found.rgb * (limit / brightest) : found.rgb, found.a);
    }
  }
  imageStore(shrunk_out, cell, total / float((end.x - first.x) * (end.y - first.y)));
}
