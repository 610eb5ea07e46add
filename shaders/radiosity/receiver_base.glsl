// SPDX-License-Identifier: GPL-3.0-or-later
// Receiver: a texel of the main view's base, for the picture.

Receiver receiver_at(ivec2 at)
{
  Surfel surfel = unpack_surfel(texelFetch(surfels, at, 0), at, 0);
  Receiver receiver;
  receiver.position = to_world(0, surfel.position) + views.cameras[0].position;
  receiver.normal = to_world(0, direction(surfel.vector_area));
  receiver.is_surface = is_inside(at, level_size(0)) && surfel.area > 0.0;
  return receiver;
}
