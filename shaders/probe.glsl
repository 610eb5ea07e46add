// SPDX-License-Identifier: GPL-3.0-or-later
// Probe: one texel of a texture, so that reading it back waits for whatever writes that texture.

void main()
{
  imageStore(probed, ivec2(0), texelFetch(source, ivec2(0), 0));
}
