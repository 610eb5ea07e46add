// SPDX-License-Identifier: GPL-3.0-or-later
// Receiver: a block of any view's pixels, for the light that its emitters send on.

Receiver receiver_at(ivec2 at)
{
  Grid last = views.cameras[views.count - 1].receivers;
  int number = at.y * RECORDS_WIDTH + at.x;
  vec4 first = texelFetch(receivers, record_texel(number, 0, 4), 0);
  Receiver receiver;
  receiver.position = first.xyz;
  receiver.normal = direction(texelFetch(receivers, record_texel(number, 1, 4), 0).xyz);
  receiver.is_surface = at.x < RECORDS_WIDTH && number < last.first + last.size.x * last.size.y && first.a > 0.0;
  return receiver;
}
