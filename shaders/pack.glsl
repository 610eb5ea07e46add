// SPDX-License-Identifier: GPL-3.0-or-later
// Pack: from EEVEE's passes to the pyramid's base, and the full-resolution guide for the last upsampling.
// One thread makes one base texel from its start x start pixels. The passes have their top row first, everything
// written here has its bottom row first.

ivec2 frame_size()
{
  return parameters.frame.xy;
}

bool is_surface(float depth)
{
  return is_finite(depth) && depth > 0.0 && depth < FARTHEST;
}

// Depth of a pixel, or something beyond every surface where there is none.
float surface_depth(ivec2 pixel)
{
  if (!is_inside(pixel, frame_size())) {
    return 2.0 * FARTHEST;
  }
  float depth = texelFetch(depth_pass, pass_texel(pixel), 0).r;
  return is_surface(depth) ? depth : 2.0 * FARTHEST;
}

// Step along the surface from a pixel towards +axis, taken to or from the neighbour that is nearer in depth; zero
// where neither neighbour is a surface.
vec3 surface_step(ivec2 pixel, float depth, ivec2 axis)
{
  float ahead = surface_depth(pixel + axis);
  float behind = surface_depth(pixel - axis);
  float side = abs(ahead - depth) <= abs(behind - depth) ? 1.0 : -1.0;
  float neighbour = side > 0.0 ? ahead : behind;
  vec2 centre = vec2(pixel) + 0.5;
  return neighbour > FARTHEST ?
             vec3(0.0) :
             side * (view_place(centre + side * vec2(axis), neighbour) - view_place(centre, depth));
}

// For pixels whose material wrote no normal (pure emission writes (0, 0, 0)).
vec3 geometric_normal(ivec2 pixel, float depth)
{
  vec3 to_camera = is_orthographic() ? vec3(0.0, 0.0, 1.0) : -direction(view_place(vec2(pixel) + 0.5, depth));
  vec3 across = cross(surface_step(pixel, depth, ivec2(1, 0)), surface_step(pixel, depth, ivec2(0, 1)));
  if (dot(across, across) == 0.0) {
    return to_camera;
  }
  return direction(dot(across, to_camera) < 0.0 ? -across : across);
}

// Shading normals that lean away from the camera are kept as they are: they say where the surface receives.
vec3 view_normal(ivec2 pixel, float depth, vec3 world)
{
  if (dot(world, world) < 1e-12) {
    return geometric_normal(pixel, depth);
  }
  return direction(vec3(dot(parameters.rotation[0].xyz, world),
                        dot(parameters.rotation[1].xyz, world),
                        dot(parameters.rotation[2].xyz, world)));
}

void main()
{
  ivec2 texel = this_texel();
  if (!is_inside(texel, imageSize(base_radiance))) {
    return;
  }
  float area = 0.0;
  vec3 power = vec3(0.0);        // sum of A L
  vec3 moment = vec3(0.0);       // sum of A p
  vec3 vector_area = vec3(0.0);  // sum of A n
  int start = parameters.frame.z;
  for (int k = 0; k < start * start; k++) {
    ivec2 pixel = texel * start + ivec2(k % start, k / start);
    if (!is_inside(pixel, frame_size())) {
      continue;
    }
    ivec2 source = pass_texel(pixel);
    float depth = texelFetch(depth_pass, source, 0).r;
    vec3 world = FETCH_PASS(normal_x, normal_y, normal_z, source);
    vec3 albedo = FETCH_PASS(color_r, color_g, color_b, source);
    vec3 direct = FETCH_PASS(direct_r, direct_g, direct_b, source);
    vec3 emission = FETCH_PASS(emission_r, emission_g, emission_b, source);
    vec3 radiance = direct * albedo + emission;
    bool sound = is_surface(depth) && is_finite(world) && is_finite(albedo) && is_finite(direct) &&
                 is_finite(emission) && is_finite(radiance);
    if (!sound) {
      imageStore(guide, pixel, vec4(0.0));
      continue;
    }
    vec3 normal = view_normal(pixel, depth, world);
    float pixel_area = texel_area(vec2(pixel) + 0.5, depth, normal);
    imageStore(guide, pixel, vec4(normal, depth));
    area += pixel_area;
    power += pixel_area * radiance;
    moment += pixel_area * view_place(vec2(pixel) + 0.5, depth);
    vector_area += pixel_area * normal;
  }
  float share = area > 0.0 ? 1.0 / area : 0.0;
  imageStore(base_radiance, texel, vec4(power * share, 0.0));
  imageStore(base_place, texel, vec4(moment * share, area));
  imageStore(base_vector_area, texel, vec4(vector_area, 0.0));
}
