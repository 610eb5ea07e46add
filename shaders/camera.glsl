// SPDX-License-Identifier: GPL-3.0-or-later
// The camera: where a pixel lies in view space, and how much surface it stands for.
// Pixel coordinates count from the lower left corner of the frame; a pixel's centre is at +0.5.

#define COSINE_FLOOR 0.05     // a texel seen more edge-on than this would stand for an unbounded area

bool is_orthographic()
{
  return parameters.frame.w != 0;
}

// (x, y) of the view ray at depth 1 in perspective, of the view ray itself in orthographic.
vec2 view_ray(vec2 pixel)
{
  return parameters.projection.zw + parameters.projection.xy * pixel;
}

vec3 view_place(vec2 pixel, float depth)
{
  vec2 ray = view_ray(pixel);
  return is_orthographic() ? vec3(ray, -depth) : vec3(ray * depth, -depth);
}

// World area (m^2) behind a pixel: its footprint on the image plane, over the cosine to the surface.
// With p = depth * q this is depth^3 du dv / |n.p|, which is depth^2 du dv / |n.q|.
float texel_area(vec2 pixel, float depth, vec3 normal)
{
  float footprint = abs(parameters.projection.x * parameters.projection.y);
  if (is_orthographic()) {
    return footprint / max(abs(normal.z), COSINE_FLOOR);
  }
  vec3 ray = vec3(view_ray(pixel), -1.0);
  return depth * depth * footprint / max(abs(dot(normal, ray)), COSINE_FLOOR * length(ray));
}
