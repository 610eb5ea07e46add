// SPDX-License-Identifier: GPL-3.0-or-later
// Composite: the base's irradiance upsampled to full resolution, times the reflectance, albedo / pi. One thread makes
// four neighbouring pixels and writes r g b r g b ..., the layout of Blender's passes.

void main()
{
  int quad = int(gl_GlobalInvocationID.x);
  int row = int(gl_GlobalInvocationID.y);
  if (4 * quad >= frame.size.x || row >= frame.size.y) {
    return;
  }
  ivec2 source = pass_texel(quad, row);
  vec4 depth = texelFetch(depth_pass, source, 0);
  Quad world = quad_of(texelFetch(normal_x, source, 0), texelFetch(normal_y, source, 0),
                       texelFetch(normal_z, source, 0));
  Quad albedo = quad_of(texelFetch(color_r, source, 0), texelFetch(color_g, source, 0),
                        texelFetch(color_b, source, 0));
  vec4 columns = float(4 * quad) + vec4(0.5, 1.5, 2.5, 3.5);
  Quad position = view_position(columns, float(row) + 0.5, depth);
  Quad normal = view_normal(world);

  // Each pixel is interpolated between the four base texels around it; the loop covers those of all four pixels. With
  // one texel a pixel, each pixel lies on the centre of its own.
  float start = float(frame.start);
  ivec2 taps = frame.start == 4 ? ivec2(3, 2) : frame.start == 2 ? ivec2(4, 2) : ivec2(4, 1);
  vec4 across = columns / start - 0.5;
  float up = (float(row) + 0.5) / start - 0.5;
  ivec2 corner = ivec2(floor(vec2(across.x, up)));
  vec4 weights = vec4(0.0), bound = weights;
  Quad sum = quad_of(weights, weights, weights);
  for (int k = 0; k < taps.x * taps.y; k++) {
    ivec2 tap = corner + (k < taps.x ? ivec2(k, 0) : ivec2(k - taps.x, 1));
    vec4 linear = max(1.0 - abs(across - float(tap.x)), 0.0) * max(1.0 - abs(up - float(tap.y)), 0.0);
    if (!is_inside(tap, level_size(0)) || dot(linear, linear) == 0.0) {
      continue;
    }
    Surfel surfel = unpack_surfel(texelFetch(surfels, tap, 0), tap, 0);
    if (surfel.area <= 0.0) {
      continue;
    }
    vec3 facing = direction(surfel.vector_area);
    vec4 received = texelFetch(total, tap, 0);
    vec4 height = normal.x * (surfel.position.x - position.x) + normal.y * (surfel.position.y - position.y) +
                  normal.z * (surfel.position.z - position.z);
    vec4 cosine = normal.x * facing.x + normal.y * facing.y + normal.z * facing.z;
    vec4 weight = linear * bilateral_weight(height, cosine, surfel.area);
    weights += weight;
    sum.x += weight * received.r;
    sum.y += weight * received.g;
    sum.z += weight * received.b;
    bound += weight * received.a;
  }
  // Without visibility, surfaces behind one another can cover the hemisphere more than once (F > 1). Dividing by F
  // then keeps the white furnace: no point receives more than pi L.
  vec4 share = options.strength / PI / max(max(bound, weights), vec4(1e-37));
  vec4 red = share * sum.x * albedo.x, green = share * sum.y * albedo.y, blue = share * sum.z * albedo.z;
  for (int k = 0; k < 4; k++) {
    // Background, and pixels with NaN or infinity: no light.
    if (!is_surface(depth[k]) || !is_finite(red[k] + green[k] + blue[k])) {
      red[k] = green[k] = blue[k] = 0.0;
    }
  }
  imageStore(indirect_out, ivec2(3 * quad, row), vec4(red.x, green.x, blue.x, red.y));
  imageStore(indirect_out, ivec2(3 * quad + 1, row), vec4(green.y, blue.y, red.z, green.z));
  imageStore(indirect_out, ivec2(3 * quad + 2, row), vec4(blue.z, red.w, green.w, blue.w));
}
