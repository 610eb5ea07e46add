// SPDX-License-Identifier: GPL-3.0-or-later
// Radiate: the radiance of each emitter: its own, and albedo / pi times the irradiance of the receiver that it belongs
// to. a: its area, for the table of emitters.
//
// ADDS_DIFFUSE: the emitters hold specular light, in place of diffuse light. Their radiance is added to the diffuse
// one, which has the area.

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  int number = at.y * RECORDS_WIDTH + at.x, view = view_of(number);
  Grid grid = views.cameras[view].emitters, receivers = views.cameras[view].receivers;
  int within = number - grid.first;
  if (at.x >= RECORDS_WIDTH || within >= grid.size.x * grid.size.y) {
    return;
  }
  ivec2 block = ivec2(within % grid.size.x, within / grid.size.x);
  ivec2 receiver = min(block * grid.side / receivers.side, receivers.size - 1);
  int owner = receivers.first + receiver.y * receivers.size.x + receiver.x;
  vec3 received = texelFetch(irradiance, record_texel(owner, 0, 1), 0).rgb;
  vec3 radiance = texelFetch(emitters, record_texel(number, 2, 4), 0).rgb +
                  texelFetch(emitters, record_texel(number, 3, 4), 0).rgb * received / PI;
  // One pixel that overflows must not spoil the picture.
  if (!is_finite(abs(radiance.r) + abs(radiance.g) + abs(radiance.b))) {
    radiance = vec3(0.0);
  }
#ifdef ADDS_DIFFUSE
  vec4 diffuse = texelFetch(diffuse_radiance, at, 0);
  imageStore(radiance_out, at, vec4(diffuse.rgb + radiance, diffuse.a));
#else
  imageStore(radiance_out, at, vec4(radiance, texelFetch(emitters, record_texel(number, 0, 4), 0).a));
#endif
}
