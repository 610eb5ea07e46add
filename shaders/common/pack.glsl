// SPDX-License-Identifier: GPL-3.0-or-later
// Pack: the pyramid's base from EEVEE's passes. One thread reads four neighbouring pixels of `start` rows and makes the
// 4 / start base texels that they cover.

vec4 keep(bvec4 which, vec4 values)
{
  return vec4(which.x ? values.x : 0.0, which.y ? values.y : 0.0, which.z ? values.z : 0.0, which.w ? values.w : 0.0);
}

void main()
{
  int start = frame.start;
  int quad = int(gl_GlobalInvocationID.x);
  int texel_row = int(gl_GlobalInvocationID.y);
  if (4 * quad >= frame.size.x || texel_row >= level_size(0).y) {
    return;
  }
  vec4 columns = float(4 * quad) + vec4(0.5, 1.5, 2.5, 3.5);
  // Sums over the rows, one for each column of pixels.
  vec4 area = vec4(0.0);
  Quad moment = quad_of(area, area, area), vector_area = moment, power = moment;
  for (int row = texel_row * start; row < min(texel_row * start + start, frame.size.y); row++) {
    ivec2 source = pass_texel(quad, row);
    vec4 depth = texelFetch(depth_pass, source, 0);
    Quad world = quad_of(texelFetch(normal_x, source, 0), texelFetch(normal_y, source, 0),
                         texelFetch(normal_z, source, 0));
    Quad radiance = quad_of(
        texelFetch(direct_r, source, 0) * texelFetch(color_r, source, 0) + texelFetch(emission_r, source, 0),
        texelFetch(direct_g, source, 0) * texelFetch(color_g, source, 0) + texelFetch(emission_g, source, 0),
        texelFetch(direct_b, source, 0) * texelFetch(color_b, source, 0) + texelFetch(emission_b, source, 0));
    Quad normal = view_normal(world);
    vec4 square = world.x * world.x + world.y * world.y + world.z * world.z;
    // NaN or infinity in any of them makes the sum NaN or infinite.
    vec4 all_of_it = square + radiance.x + radiance.y + radiance.z;
    bvec4 sound;
    for (int k = 0; k < 4; k++) {
      sound[k] = is_surface(depth[k]) && is_finite(all_of_it[k]);
    }
#ifdef GEOMETRIC_NORMALS
    for (int k = 0; k < 4; k++) {
      if (sound[k] && square[k] == 0.0) {
        vec3 own = geometric_normal(ivec2(4 * quad + k, row), depth[k]);
        normal.x[k] = own.x;
        normal.y[k] = own.y;
        normal.z[k] = own.z;
      }
    }
#endif
    vec4 pixel_area = texel_area(columns, float(row) + 0.5, depth, normal);
    Quad position = view_position(columns, float(row) + 0.5, depth);
    area += keep(sound, pixel_area);
    moment.x += keep(sound, pixel_area * position.x);
    moment.y += keep(sound, pixel_area * position.y);
    moment.z += keep(sound, pixel_area * position.z);
    vector_area.x += keep(sound, pixel_area * normal.x);
    vector_area.y += keep(sound, pixel_area * normal.y);
    vector_area.z += keep(sound, pixel_area * normal.z);
    power.x += keep(sound, pixel_area * radiance.x);
    power.y += keep(sound, pixel_area * radiance.y);
    power.z += keep(sound, pixel_area * radiance.z);
  }
  for (int k = 0; k < 4 / start; k++) {
    ivec2 texel = ivec2(quad * (4 / start) + k, texel_row);
    vec4 mine = vec4(equal(ivec4(0, 1, 2, 3) / start, ivec4(k)));
    Sums sums = sums_of(dot(area, mine), vec3(dot(moment.x, mine), dot(moment.y, mine), dot(moment.z, mine)),
                     vec3(dot(vector_area.x, mine), dot(vector_area.y, mine), dot(vector_area.z, mine)),
                     vec3(dot(power.x, mine), dot(power.y, mine), dot(power.z, mine)));
    if (texel.x < level_size(0).x) {
      imageStore(surfels_out, texel, pack_surfel(sums, texel, 0));
    }
  }
}
