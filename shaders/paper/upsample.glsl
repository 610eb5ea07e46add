// SPDX-License-Identifier: GPL-3.0-or-later
// Upsample: the irradiance of each texel of the base from all levels: its own, and that of every coarser level,
// interpolated between the four texels of that level around it.

vec4 bilateral(ivec2 texel, Surfel receiver, vec3 normal, int level)
{
  vec2 position = (vec2(texel) + 0.5) / float(1 << level) - 0.5;
  ivec2 corner = ivec2(floor(position));
  vec2 blend = position - vec2(corner);
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int k = 0; k < 4; k++) {
    ivec2 side = ivec2(k & 1, k >> 1);
    ivec2 tap = corner + side;
    if (is_inside(tap, level_size(level))) {
      Surfel surfel = unpack_surfel(texelFetch(surfels, level_origin(level) + tap, 0), tap, level);
      if (surfel.area > 0.0) {
        vec2 linear = mix(1.0 - blend, blend, vec2(side));
        float height = dot(normal, surfel.position - receiver.position);
        float cosine = dot(normal, direction(surfel.vector_area));
        float weight = linear.x * linear.y * bilateral_weight(vec4(height), vec4(cosine), surfel.area).x;
        sum += weight * texelFetch(irradiance, level_origin(level) + tap, 0);
        weights += weight;
      }
    }
  }
  return weights > 0.0 ? sum / weights : vec4(0.0);
}

void main()
{
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(texel, level_size(0))) {
    return;
  }
  vec4 sum = texelFetch(irradiance, texel, 0);
  Surfel receiver = unpack_surfel(texelFetch(surfels, texel, 0), texel, 0);
  if (receiver.area > 0.0) {
    vec3 normal = direction(receiver.vector_area);
    for (int level = 1; level <= options.last_level; level++) {
      sum += bilateral(texel, receiver, normal, level);
    }
  }
  imageStore(total_out, texel, sum);
}
