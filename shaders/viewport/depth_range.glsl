// SPDX-License-Identifier: GPL-3.0-or-later
// Depth range: the least and the greatest depth, along a camera's axis, in each block of a picture of positions.

#define NOTHING 1e10

void main()
{
  ivec2 block = ivec2(gl_GlobalInvocationID.xy), size = textureSize(picture, 0);
  vec2 range = vec2(NOTHING, -NOTHING);
  ivec2 end = min(block * DEPTH_RANGE_BLOCK + DEPTH_RANGE_BLOCK, size);
  for (int y = block.y * DEPTH_RANGE_BLOCK; y < end.y; y++) {
    for (int x = block.x * DEPTH_RANGE_BLOCK; x < end.x; x++) {
      vec3 position = texelFetch(picture, ivec2(x, y), 0).xyz;
      float depth = -dot(options.depth_axis.xyz, position) - options.depth_axis.w;
      if (position != vec3(0.0) && is_finite(depth)) {
        range = vec2(min(range.x, depth), max(range.y, depth));
      }
    }
  }
  if (is_inside(block, imageSize(range_out))) {
    imageStore(range_out, block, vec4(range, 0.0, 0.0));
  }
}
