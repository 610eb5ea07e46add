// SPDX-License-Identifier: GPL-3.0-or-later
// Normals from depth, for pixels whose material wrote none (pure emission writes 0, 0, 0). A file of its own because a
// software GPU runs both sides of every branch: passes are compiled with it only for frames that have such pixels.

#define GEOMETRIC_NORMALS

// Depth of a pixel, or something beyond every surface where there is none.
float surface_depth(ivec2 pixel)
{
  if (!is_inside(pixel, frame.size)) {
    return 2.0 * FARTHEST;
  }
  float depth = texelFetch(depth_pass, pass_texel(pixel.x >> 2, pixel.y), 0)[pixel.x & 3];
  return is_surface(depth) ? depth : 2.0 * FARTHEST;
}

// Step along the surface from a pixel in the direction of +axis, by the neighbour whose depth is closer; zero where
// neither neighbour is a surface.
vec3 surface_step(ivec2 pixel, float depth, ivec2 axis)
{
  float ahead = surface_depth(pixel + axis);
  float behind = surface_depth(pixel - axis);
  float side = abs(ahead - depth) <= abs(behind - depth) ? 1.0 : -1.0;
  float neighbour = side > 0.0 ? ahead : behind;
  vec2 centre = vec2(pixel) + 0.5;
  return neighbour > FARTHEST ?
             vec3(0.0) :
             side * (view_position(centre + side * vec2(axis), neighbour) - view_position(centre, depth));
}

vec3 geometric_normal(ivec2 pixel, float depth)
{
  vec3 outgoing = is_orthographic() ? vec3(0.0, 0.0, 1.0) : -direction(view_position(vec2(pixel) + 0.5, depth));
  vec3 across = cross(surface_step(pixel, depth, ivec2(1, 0)), surface_step(pixel, depth, ivec2(0, 1)));
  if (dot(across, across) == 0.0) {
    return outgoing;
  }
  return direction(dot(across, outgoing) < 0.0 ? -across : across);
}
