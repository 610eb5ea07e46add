// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by all passes. The uniform blocks `frame`, `views` and `options`, and the constants FARTHEST, ..._WIDTH and
// ..._BLOCK, are declared in addon/gather/shader_interface.py.

#define PI 3.14159265358979
#define COSINE_FLOOR 0.05     // of a surface to the view ray: the area of a pixel is not bounded at grazing angles

// A test of the bits: compilers may assume that NaN never happens and fold isnan() to false.
bool is_finite(float x)
{
  return (floatBitsToUint(x) & 0x7F800000u) != 0x7F800000u;
}

// Beyond FARTHEST is EEVEE's background (1e10).
bool is_surface(float depth)
{
  return is_finite(depth) && depth > 0.0 && depth < FARTHEST;
}

bool is_inside(ivec2 texel, ivec2 size)
{
  return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
}

vec3 direction(vec3 v)
{
  return v * inversesqrt(max(dot(v, v), 1e-37));
}
