// SPDX-License-Identifier: GPL-3.0-or-later
// The camera: where a pixel lies in view space, and how much surface it stands for. Four pixels at a time, which are
// neighbours in a row. Pixel coordinates count from the lower left corner of the frame; a pixel's centre is at +0.5.

#define COSINE_FLOOR 0.05     // a texel seen more edge-on than this would stand for an unbounded area

struct Quad {
  vec4 x, y, z;
};

Quad quad_of(vec4 x, vec4 y, vec4 z)
{
  Quad quad;  // Metal has no constructors of structs
  quad.x = x;
  quad.y = y;
  quad.z = z;
  return quad;
}

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

Quad view_place(vec4 column, float row, vec4 depth)
{
  vec4 x = parameters.projection.z + parameters.projection.x * column;
  vec4 y = vec4(parameters.projection.w + parameters.projection.y * row);
  return is_orthographic() ? quad_of(x, y, -depth) : quad_of(x * depth, y * depth, -depth);
}

Quad view_normal(Quad world)
{
  vec4 x = parameters.rotation[0].x * world.x + parameters.rotation[0].y * world.y + parameters.rotation[0].z * world.z;
  vec4 y = parameters.rotation[1].x * world.x + parameters.rotation[1].y * world.y + parameters.rotation[1].z * world.z;
  vec4 z = parameters.rotation[2].x * world.x + parameters.rotation[2].y * world.y + parameters.rotation[2].z * world.z;
  vec4 share = inversesqrt(max(x * x + y * y + z * z, vec4(1e-37)));
  return quad_of(x * share, y * share, z * share);
}

// World area (m^2) behind each pixel: its footprint on the image plane, over the cosine to the surface.
// With p = depth * q this is depth^3 du dv / |n.p|, which is depth^2 du dv / |n.q|.
vec4 texel_area(vec4 column, float row, vec4 depth, Quad normal)
{
  float footprint = abs(parameters.projection.x * parameters.projection.y);
  if (is_orthographic()) {
    return footprint / max(abs(normal.z), vec4(COSINE_FLOOR));
  }
  vec4 x = parameters.projection.z + parameters.projection.x * column;
  float y = parameters.projection.w + parameters.projection.y * row;
  vec4 cosine = abs(normal.x * x + normal.y * y - normal.z);
  return depth * depth * footprint / max(cosine, COSINE_FLOOR * sqrt(x * x + y * y + 1.0));
}
