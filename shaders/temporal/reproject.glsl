// SPDX-License-Identifier: GPL-3.0-or-later
// Reproject: what the frame before knew of the light on the surfaces that this one shows.
//
//   rgb  irradiance; a  how many gathers it is the mean of: 0 where that frame did not show the surface, -1 where there is none
//
// Where the surface was in that frame's picture is told by its place in the world, and of what moves by itself by EEVEE's Vector
// pass. The four texels around it that show the same surface count, as they do in bilinear interpolation.

#define MOVES 0.5             // texels: so far from where a thing at rest would have been lies one that moves
#define SAME_HEIGHT 1.0       // sides of a texel above the surface, of things at rest
#define SAME_DEPTH 0.1        // of the depth, of things that move: by so much they may come nearer in a frame
#define SAME_COSINE 0.9       // of both normals
#define MOVED_COSINE 0.5

vec3 to_past(vec3 place, float w)
{
  vec4 p = vec4(place, w);
  return vec3(dot(views.past[0], p), dot(views.past[1], p), dot(views.past[2], p));
}

// Of a place in the past view's space.
vec2 past_texel(vec3 seen)
{
  vec2 ray = is_orthographic() ? seen.xy : seen.xy / max(-seen.z, NEAREST);
  return (ray - views.past[3].zw) / views.past[3].xy;
}

vec2 own_texel(vec3 place)
{
  vec2 ray = is_orthographic() ? place.xy : place.xy / max(-place.z, NEAREST);
  return (ray - parameters.projection.zw) / texel_step(0);
}

void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (!is_inside(at, level_size(0))) {
    return;
  }
  Surfel receiver = unpack_surfel(texelFetch(surfels, at, 0), at, 0);
  vec4 known = vec4(0.0, 0.0, 0.0, receiver.area > 0.0 ? 0.0 : -1.0);
  vec3 seen = to_past(to_world(0, receiver.place) + views.eye[0].xyz, 1.0);
  if (receiver.area > 0.0 && (is_orthographic() || -seen.z > NEAREST)) {
    vec3 normal = to_past(to_world(0, direction(receiver.vector_area)), 0.0);
    vec2 spot = past_texel(seen);
    bool moves = false;
    if (parameters.span.x != 0) {
      vec2 told = own_texel(receiver.place) + texelFetch(motion, at, 0).xy;
      moves = distance(told, spot) > MOVES;
      spot = moves ? told : spot;
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
      Surfel surfel = unpack_surfel_of(texelFetch(past_surfels, tap, 0), views.past[3].zw + views.past[3].xy * vec2(tap),
                                       views.past[3].xy);
      if (surfel.area <= 0.0) {
        continue;
      }
      float cosine = dot(normal, direction(surfel.vector_area));
      float height = abs(dot(normal, surfel.place - seen)), deeper = abs(surfel.place.z - seen.z);
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
      known = sum / weights;
    }
  }
  imageStore(known_out, at, known);
}
