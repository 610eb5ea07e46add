// SPDX-License-Identifier: GPL-3.0-or-later
// Surfel: the surfaces that one texel of the pyramid stands for, and their 128 bits in the texture.
//
//   x   depth, 22 bits of its float (14 of mantissa); exponent of the radiance, 8 bits
//   y   area relative to the texel's footprint at that depth, 5 bits of exponent and 13 of mantissa; position within
//       the texel, 7 bits an axis
//   z   vector area over area, 11, 11 and 10 bits
//   w   radiance over 2^exponent, 11, 11 and 10 bits; signed, since a lamp may have negative power
//
// docs/method/paper.md has the error that this quantisation makes.

struct Surfel {
  vec3 position;      // mean, view space, m
  float area;         // A, m^2; 0 where there is no surface
  vec3 vector_area;   // sum of A n, m^2
  vec3 radiance;      // mean over the area, W sr^-1 m^-2
};

// Sums over surfaces, from which a surfel is made.
struct Sums {
  float area;         // of A
  vec3 moment;        // of A p
  vec3 vector_area;   // of A n
  vec3 power;         // of A L
};

Sums sums_of(float area, vec3 moment, vec3 vector_area, vec3 power)
{
  Sums sums;
  sums.area = area;
  sums.moment = moment;
  sums.vector_area = vector_area;
  sums.power = power;
  return sums;
}

#define DIRECTION_STEPS vec3(1023.0, 1023.0, 511.0)   // 1 is the last step
#define RADIANCE_STEPS vec3(1024.0, 1024.0, 512.0)    // below 1; powers of two are whole numbers of steps
#define MIN_AREA 1.490116119384765625e-8  // 2^-26: one pixel's share of the coarsest texel of any frame

uint pack_signed(vec3 v, vec3 steps)
{
  uvec3 whole = uvec3(ivec3(min(round(v * steps), DIRECTION_STEPS) + steps));
  return whole.x | (whole.y << 11u) | (whole.z << 22u);
}

vec3 unpack_signed(uint bits, vec3 steps)
{
  vec3 whole = vec3(float(bits & 0x7FFu), float((bits >> 11u) & 0x7FFu), float(bits >> 22u));
  return whole * (1.0 / steps) - 1.0;
}

// Size of a texel on the image plane.
vec2 texel_step(int level)
{
  return frame.scale * float(frame.start << level);
}

// Area of a texel's footprint at a depth, m^2.
float footprint(float depth, int level)
{
  vec2 side = texel_step(level);
  return abs(side.x * side.y) * (is_orthographic() ? 1.0 : depth * depth);
}

uvec4 pack_surfel(Sums sums, ivec2 texel, int level)
{
  if (!(sums.area > 0.0)) {
    return uvec4(0u);
  }
  vec3 position = sums.moment / sums.area;
  vec3 radiance = sums.power / sums.area;
  vec2 ray = is_orthographic() ? position.xy : position.xy / -position.z;
  vec2 within = (ray - frame.offset) / texel_step(level) - vec2(texel);
  uvec2 offset = uvec2(clamp(round(within * 128.0), 0.0, 127.0));
  uint depth = (floatBitsToUint(-position.z) + 0x100u) >> 9u;

  float relative = clamp(sums.area / footprint(-position.z, level), MIN_AREA, 64.0);
  uint area = min((floatBitsToUint(relative) - floatBitsToUint(MIN_AREA) + 0x200u) >> 10u, 0x3FFFFu);

  // The exponent's power of two lies above the largest channel.
  float largest = max(max(abs(radiance.r), abs(radiance.g)), abs(radiance.b));
  uint exponent = min((floatBitsToUint(largest) >> 23u) + 1u, 254u);
  vec3 mantissa = exponent > 1u ? radiance / uintBitsToFloat(exponent << 23u) : vec3(0.0);
  return uvec4((depth << 10u) | exponent, (area << 14u) | (offset.y << 7u) | offset.x,
               pack_signed(sums.vector_area / sums.area, DIRECTION_STEPS), pack_signed(mantissa, RADIANCE_STEPS));
}

// corner: the texel's lower left corner on the image plane; size: of the texel there.
Surfel unpack_surfel_of(uvec4 bits, vec2 corner, vec2 size)
{
  Surfel surfel;
  float depth = uintBitsToFloat((bits.x >> 10u) << 9u);
  vec2 within = vec2(float(bits.y & 0x7Fu), float((bits.y >> 7u) & 0x7Fu)) * (1.0 / 128.0);
  vec2 ray = corner + size * within;
  surfel.position = vec3(is_orthographic() ? ray : ray * depth, -depth);
  float relative = uintBitsToFloat(((bits.y >> 14u) << 10u) + floatBitsToUint(MIN_AREA));
  surfel.area = depth > 0.0 ? relative * abs(size.x * size.y) * (is_orthographic() ? 1.0 : depth * depth) : 0.0;
  surfel.vector_area = surfel.area * unpack_signed(bits.z, DIRECTION_STEPS);
  surfel.radiance = uintBitsToFloat((bits.x & 0xFFu) << 23u) * unpack_signed(bits.w, RADIANCE_STEPS);
  return surfel;
}

Surfel unpack_surfel(uvec4 bits, ivec2 texel, int level)
{
  vec2 size = texel_step(level);
  return unpack_surfel_of(bits, frame.offset + size * vec2(texel), size);
}
