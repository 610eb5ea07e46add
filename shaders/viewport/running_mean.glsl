// SPDX-License-Identifier: GPL-3.0-or-later
// Running mean: one more of the pictures that composite makes, into the mean of those before. A texel for each pixel,
// bottom row first.

void main()
{
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(pixel, options.size)) {
    return;
  }
  vec3 now;
  for (int k = 0; k < 3; k++) {
    int number = 3 * pixel.x + k;
    now[k] = texelFetch(indirect, ivec2(number / 4, pixel.y), 0)[number % 4];
  }
  vec3 before = texelFetch(mean, pixel, 0).rgb;
  int count = options.count;
  imageStore(mean_out, pixel, vec4(count > 1 ? before + (now - before) / float(count) : now, 0.0));
}
