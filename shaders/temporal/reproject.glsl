// SPDX-License-Identifier: GPL-3.0-or-later
// Reproject: the history of the surfaces that this frame shows, from the frame before.
//
//   rgb  irradiance
//   a    number of gathers that it is the mean of: 0 where that frame did not show the surface, -1 where there is none
//
// A surface's texel in the frame before follows from its position in the world or, if the object moves, from EEVEE's
// Vector pass. The history is interpolated bilinearly between those of the four texels around that show the same
// surface.

#define MIN_MOTION 0.5        // texels; more than this is object motion, not camera motion
#define SAME_HEIGHT 1.0       // sides of a texel above the surface, for objects at rest
#define SAME_DEPTH 0.1        // of the depth, for objects that move: they may come nearer by this in a frame
#define SAME_COSINE 0.9       // between both normals
#define MOVED_COSINE 0.5      // the same, for objects that move

vec3 to_past(vec3 position, float w)
{
  vec4 p = vec4(position, w);
  return vec3(dot(options.past_rotation[0], p), dot(options.past_rotation[1], p), dot(options.past_rotation[2], p));
}

// seen: a position in the view space of the frame before.
vec2 past_texel(vec3 seen)
{
  vec2 ray = is_orthographic() ? seen.xy : seen.xy / max(-seen.z, NEAREST);
  return (ray - options.past_offset) / options.past_scale;
}

vec2 own_texel(vec3 position)
{
  vec2 ray = is_orthographic() ? position.xy : position.xy / max(-position.z, NEAREST);
  return (ray - frame.offset) / texel_step(0);
}

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(at, level_size(0))) {
    return;
  }
  Surfel receiver = unpack_surfel(texelFetch(surfels, at, 0), at, 0);
  vec4 history = vec4(0.0, 0.0, 0.0, receiver.area > 0.0 ? 0.0 : -1.0);
  vec3 seen = to_past(to_world(0, receiver.position) + views.cameras[0].position, 1.0);
  if (receiver.area > 0.0 && (is_orthographic() || -seen.z > NEAREST)) {
    vec3 normal = to_past(to_world(0, direction(receiver.vector_area)), 0.0);
    vec2 spot = past_texel(seen);
    bool moves = false;
    if (options.has_motion != 0) {
      vec2 by_motion = own_texel(receiver.position) + texelFetch(motion, at, 0).xy;
      moves = distance(by_motion, spot) > MIN_MOTION;
      spot = moves ? by_motion : spot;
    }
    ivec2 corner = ivec2(floor(clamp(spot, -1e6, 1e6) - 0.5));
    vec2 blend = spot - 0.5 - vec2(corner);
    float weights = 0.0;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; k++) {
      ivec2 side = ivec2(k & 1, k >> 1), tap = corner + side;
      if (!is_inside(tap, level_size(0))) {
        continue;
      }
      Surfel surfel = unpack_surfel_of(texelFetch(past_surfels, tap, 0),
                                       options.past_offset + options.past_scale * vec2(tap), options.past_scale);
      if (surfel.area <= 0.0) {
        continue;
      }
      float cosine = dot(normal, direction(surfel.vector_area));
      float height = abs(dot(normal, surfel.position - seen)), deeper = abs(surfel.position.z - seen.z);
      bool same = moves ? cosine > MOVED_COSINE && deeper < SAME_DEPTH * -seen.z :
                          cosine > SAME_COSINE && height < SAME_HEIGHT * sqrt(surfel.area);
      if (same) {
        vec2 linear = mix(1.0 - blend, blend, vec2(side));
        float weight = linear.x * linear.y;
        sum += weight * texelFetch(past_light, tap, 0);
        weights += weight;
      }
    }
    if (weights > 1e-3) {
      history = sum / weights;
    }
  }
  imageStore(history_out, at, history);
}
