// SPDX-License-Identifier: GPL-3.0-or-later
// What every pass shares. The struct Parameters is declared by addon/gather/device.py, beside its numpy twin.

#define PI 3.14159265358979
#define FARTHEST 1e9          // a depth beyond this is EEVEE's background (1e10), not a surface

// A test of the bits: compilers may assume that NaN never happens and fold isnan() to false.
bool is_finite(float x)
{
  return (floatBitsToUint(x) & 0x7F800000u) != 0x7F800000u;
}

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

// Level of the pyramid: all levels lie side by side in one texture.
ivec2 level_origin(int level)
{
  return parameters.levels[level].xy;
}

ivec2 level_size(int level)
{
  return parameters.levels[level].zw;
}

// EEVEE's passes are one texture a channel, four neighbouring pixels of a row to the texel, top row first.
ivec2 pass_texel(int quad, int row)
{
  return ivec2(quad, parameters.frame.y - 1 - row);
}
