// SPDX-License-Identifier: GPL-3.0-or-later
// Span: the least and the greatest depth, along a camera's axis, of what a block of a picture of places shows.

#define BLOCK 16              // pixels along its side
#define NOTHING 1e10

void main()
{
  ivec2 block = ivec2(gl_GlobalInvocationID.xy), size = textureSize(picture, 0);
  vec2 found = vec2(NOTHING, -NOTHING);
  ivec2 end = min(block * BLOCK + BLOCK, size);
  for (int y = block.y * BLOCK; y < end.y; y++) {
    for (int x = block.x * BLOCK; x < end.x; x++) {
      vec3 place = texelFetch(picture, ivec2(x, y), 0).xyz;
      float depth = -dot(parameters.rotation[2].xyz, place) - parameters.rotation[2].w;
      if (place != vec3(0.0) && is_finite(depth)) {
        found = vec2(min(found.x, depth), max(found.y, depth));
      }
    }
  }
  if (is_inside(block, imageSize(span_out))) {
    imageStore(span_out, block, vec4(found, 0.0, 0.0));
  }
}
