// SPDX-License-Identifier: GPL-3.0-or-later
// Show: one triangle that covers the region.

void main()
{
  gl_Position = vec4(corner, 0.0, 1.0);
}
