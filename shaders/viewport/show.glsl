// SPDX-License-Identifier: GPL-3.0-or-later
// Show: a picture of any size over a region of `extent` pixels, interpolated between its texels. The blend mode adds it
// to the region.

void main()
{
  ivec2 size = textureSize(light, 0);
  vec2 position = gl_FragCoord.xy / extent * vec2(size) - 0.5;
  ivec2 corner = ivec2(floor(position));
  vec2 share = position - vec2(corner);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 4; k++) {
    ivec2 tap = ivec2(k & 1, k >> 1);
    vec2 weight = mix(1.0 - share, share, vec2(tap));
    sum += weight.x * weight.y * texelFetch(light, clamp(corner + tap, ivec2(0), size - 1), 0).rgb;
  }
  shown = vec4(strength * sum, 0.0);
}
