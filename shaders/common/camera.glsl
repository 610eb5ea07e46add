// SPDX-License-Identifier: GPL-3.0-or-later
// Camera: the position of a pixel in view space and the area of its surface, for four neighbouring pixels of a row at a
// time; and the texels of a frame's pyramid and passes. Pixel coordinates count from the lower left corner of the
// frame; a pixel's centre is at +0.5.

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
  return frame.is_orthographic != 0;
}

// Level of the pyramid: all levels lie side by side in one texture.
ivec2 level_origin(int level)
{
  return frame.levels[level].origin;
}

ivec2 level_size(int level)
{
  return frame.levels[level].size;
}

// EEVEE's passes are one texture a channel, four neighbouring pixels of a row to the texel, top row first.
ivec2 pass_texel(int quad, int row)
{
  return ivec2(quad, frame.size.y - 1 - row);
}

// (x, y) of the view ray at depth 1 in perspective, of the view ray itself in orthographic.
vec2 view_ray(vec2 pixel)
{
  return frame.offset + frame.scale * pixel;
}

vec3 view_position(vec2 pixel, float depth)
{
  vec2 ray = view_ray(pixel);
  return is_orthographic() ? vec3(ray, -depth) : vec3(ray * depth, -depth);
}

Quad view_position(vec4 column, float row, vec4 depth)
{
  vec4 x = frame.offset.x + frame.scale.x * column;
  vec4 y = vec4(frame.offset.y + frame.scale.y * row);
  return is_orthographic() ? quad_of(x, y, -depth) : quad_of(x * depth, y * depth, -depth);
}

Quad view_normal(Quad world)
{
  vec4 x = frame.rotation[0].x * world.x + frame.rotation[0].y * world.y + frame.rotation[0].z * world.z;
  vec4 y = frame.rotation[1].x * world.x + frame.rotation[1].y * world.y + frame.rotation[1].z * world.z;
  vec4 z = frame.rotation[2].x * world.x + frame.rotation[2].y * world.y + frame.rotation[2].z * world.z;
  vec4 share = inversesqrt(max(x * x + y * y + z * z, vec4(1e-37)));
  return quad_of(x * share, y * share, z * share);
}

// Surface area (m^2) that each pixel shows: its footprint on the image plane, over the cosine to the surface.
// With p = depth * q this is depth^3 du dv / |n.p|, which is depth^2 du dv / |n.q|.
vec4 texel_area(vec4 column, float row, vec4 depth, Quad normal)
{
  float footprint = abs(frame.scale.x * frame.scale.y);
  if (is_orthographic()) {
    return footprint / max(abs(normal.z), vec4(COSINE_FLOOR));
  }
  vec4 x = frame.offset.x + frame.scale.x * column;
  float y = frame.offset.y + frame.scale.y * row;
  vec4 cosine = abs(normal.x * x + normal.y * y - normal.z);
  return depth * depth * footprint / max(cosine, COSINE_FLOOR * sqrt(x * x + y * y + 1.0));
}
