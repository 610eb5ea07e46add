// SPDX-License-Identifier: GPL-3.0-or-later
// Probe: one texel of a texture, so that reading it back waits for whatever writes that texture.

void main()
{
  imageStore(probed_out, ivec2(0), vec4(texelFetch(SOURCE, ivec2(0), 0)));
}
