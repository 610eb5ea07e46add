// SPDX-License-Identifier: GPL-3.0-or-later
// Composite: from the base's irradiance to full resolution, times the reflectance: albedo / pi.

void main()
{
  ivec2 pixel = this_texel();
  if (!is_inside(pixel, imageSize(indirect))) {
    return;
  }
  vec4 surface = texelFetch(guide, pixel, 0);
  if (surface.w <= 0.0) {
    imageStore(indirect, pixel, vec4(0.0));
    return;
  }
  vec2 centre = vec2(pixel) + 0.5;
  vec4 received = bilateral(centre / float(parameters.frame.z), view_place(centre, surface.w), surface.xyz);
  // Without visibility, surfaces behind one another can cover the hemisphere more than once (F > 1). Dividing by F
  // then keeps the white furnace: no point receives more than pi L.
  vec3 irradiance = received.rgb / max(received.a, 1.0);
  vec3 albedo = FETCH_PASS(color_r, color_g, color_b, pass_texel(pixel));
  imageStore(indirect, pixel, vec4(parameters.output_scale.x * albedo * irradiance / PI, 1.0));
}
