// SPDX-License-Identifier: GPL-3.0-or-later
// What every pass shares. The struct Parameters is declared by addon/light/device.py, beside its numpy twin.

#define PI 3.14159265358979
#define FARTHEST 1e9          // a depth beyond this is EEVEE's background (1e10), not a surface

// A test of the bits: compilers may assume that NaN never happens and fold isnan() to false.
bool is_finite(float x)
{
  return (floatBitsToUint(x) & 0x7F800000u) != 0x7F800000u;
}

bool is_finite(vec3 v)
{
  return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

// The texel of this thread. Long passes are dispatched in bands of rows, the first of which is parameters.band.x.
ivec2 this_texel()
{
  return ivec2(gl_GlobalInvocationID.xy) + ivec2(0, parameters.band.x);
}

bool is_inside(ivec2 texel, ivec2 size)
{
  return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
}

// Where a pixel lies in EEVEE's passes, which have their top row first.
ivec2 pass_texel(ivec2 pixel)
{
  return ivec2(pixel.x, parameters.frame.y - 1 - pixel.y);
}

// Three channels of a pass, each a texture of its own; a macro, because samplers cannot be handed on everywhere.
#define FETCH_PASS(first, second, third, texel) \
  vec3(texelFetch(first, texel, 0).r, texelFetch(second, texel, 0).r, texelFetch(third, texel, 0).r)

vec3 direction(vec3 v)
{
  return v / max(length(v), 1e-30);
}
