// SPDX-License-Identifier: GPL-3.0-or-later
// Radiate: what each emitter sends once its view's receivers have gathered: its own radiance, and albedo / pi of the
// irradiance of the receiver that it belongs to. With the area in the fourth channel, for the table of draws.

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  int number = at.y * RECORDS_WIDTH + at.x, view = view_of(number);
  ivec4 grid = views.emitters[view], receivers = views.receivers[view];
  int within = number - grid.x;
  if (at.x >= RECORDS_WIDTH || within >= grid.y * grid.z) {
    return;
  }
  ivec2 block = ivec2(within % grid.y, within / grid.y);
  ivec2 receiver = min(block * grid.w / receivers.w, receivers.yz - 1);
  vec3 irradiance = texelFetch(irradiance, record_texel(receivers.x + receiver.y * receivers.y + receiver.x, 0, 1), 0).rgb;
  vec3 radiance = texelFetch(emitters, record_texel(number, 2, 4), 0).rgb +
                  texelFetch(emitters, record_texel(number, 3, 4), 0).rgb * irradiance / PI;
  // One pixel of absurd brightness must not cost the picture.
  if (!is_finite(abs(radiance.r) + abs(radiance.g) + abs(radiance.b))) {
    radiance = vec3(0.0);
  }
  imageStore(radiance_out, at, vec4(radiance, texelFetch(emitters, record_texel(number, 0, 4), 0).a));
}
