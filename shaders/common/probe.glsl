// SPDX-License-Identifier: GPL-3.0-or-later
// Probe: copies one texel of a texture. Reading the copy back waits for all passes that write the texture.

void main()
{
  imageStore(probed_out, ivec2(0), vec4(texelFetch(SOURCE, ivec2(0), 0)));
}
