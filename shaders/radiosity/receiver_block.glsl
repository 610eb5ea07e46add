// SPDX-License-Identifier: GPL-3.0-or-later
// What receives: a block of any view's pixels, for the light that it will send on.

Receiver receiver_at(ivec2 at)
{
  ivec4 last = views.receivers[views.depths.w - 1];
  int number = at.y * RECORDS_WIDTH + at.x;
  vec4 first = texelFetch(receivers, record_texel(number, 0, 4), 0);
  Receiver receiver;
  receiver.place = first.xyz;
  receiver.normal = direction(texelFetch(receivers, record_texel(number, 1, 4), 0).xyz);
  receiver.is_surface = at.x < RECORDS_WIDTH && number < last.x + last.y * last.z && first.a > 0.0;
  return receiver;
}
