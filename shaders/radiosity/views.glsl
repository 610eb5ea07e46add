// SPDX-License-Identifier: GPL-3.0-or-later
// Views: the cameras whose pictures send light, the main one first, and the projection of any position into them. World
// space has Blender's axes and the main camera's position as its origin. All depth maps have the same resolution.

#define NEAREST 1e-4          // m; anything nearer counts as behind the camera

struct Receiver {
  vec3 position;     // world, m
  vec3 normal;
  bool is_surface;
};

// A bit for each. Loops go over these bits: drivers unroll a loop over the indices of an array, and compile its body
// ten times.
uint all_views()
{
  return (1u << uint(views.count)) - 1u;
}

vec3 to_view(int view, vec3 position)
{
  vec4 p = vec4(position, 1.0);
  return vec3(dot(views.cameras[view].rotation[0], p), dot(views.cameras[view].rotation[1], p),
              dot(views.cameras[view].rotation[2], p));
}

// Of a direction: without the translation.
vec3 turn_to_view(int view, vec3 direction)
{
  return vec3(dot(views.cameras[view].rotation[0].xyz, direction), dot(views.cameras[view].rotation[1].xyz, direction),
              dot(views.cameras[view].rotation[2].xyz, direction));
}

vec3 to_world(int view, vec3 direction)
{
  return direction.x * views.cameras[view].rotation[0].xyz + direction.y * views.cameras[view].rotation[1].xyz +
         direction.z * views.cameras[view].rotation[2].xyz;
}

bool is_orthographic(int view)
{
  return views.cameras[view].is_orthographic != 0;
}

// Towards the camera; of length 1 in orthographic views, to the camera itself in others.
vec3 to_camera(int view, vec3 position)
{
  return is_orthographic(view) ? views.cameras[view].rotation[2].xyz : views.cameras[view].position - position;
}

// Linear in the position. x, y in texels of the view's depth map, times w; planar depth; w.
vec4 projection_of(int view, vec3 position)
{
  vec3 seen = to_view(view, position);
  float w = is_orthographic(view) ? 1.0 : -seen.z;
  return vec4((seen.xy - views.cameras[view].offset * w) / views.cameras[view].scale, -seen.z, w);
}

// (x, y) in texels of the view's depth map, and planar depth.
vec3 project(int view, vec3 position)
{
  vec4 projected = projection_of(view, position);
  return vec3(projected.xy / max(projected.w, NEAREST), projected.z);
}

// The cell of a view's grid of emitters that a position falls in; far outside of the grid where it is behind the
// camera.
ivec2 grid_cell(int view, vec3 position)
{
  vec3 projected = project(view, position);
  float blocks = float(views.depth_step) / float(views.cameras[view].emitters.side);
  return projected.z > NEAREST ? ivec2(floor(clamp(projected.xy * blocks, -1e6, 1e6))) : ivec2(-1000000);
}

// Area, m^2, that a texel of the view's depth map shows of a surface through this position.
float shown_area(int view, vec3 position, vec3 normal, float depth)
{
  float footprint = abs(views.cameras[view].scale.x * views.cameras[view].scale.y);
  vec3 outgoing = to_camera(view, position);
  float cosine = max(abs(dot(normal, direction(outgoing))), COSINE_FLOOR);
  return is_orthographic(view) ?
             footprint / cosine :
             depth * depth * footprint * depth * inversesqrt(max(dot(outgoing, outgoing), 1e-37)) / cosine;
}

// What emitters are sampled by, beside their area.
float power_of(vec3 radiance)
{
  return abs(radiance.r) + abs(radiance.g) + abs(radiance.b);
}

// EEVEE's world light on a white surface, as radiance: spherical harmonics up to the first order, unoccluded.
vec3 world_light(vec3 normal)
{
  return views.world[0].rgb + normal.x * views.world[1].rgb + normal.y * views.world[2].rgb +
         normal.z * views.world[3].rgb;
}

// The radiance from a direction that makes this light: a cosine lobe damps the first order to 2/3.
vec3 world_radiance(vec3 towards)
{
  return world_light(1.5 * towards);
}

// The texel of a part of a record, an emitter or a receiver, by its number.
ivec2 record_texel(int number, int part, int parts)
{
  return ivec2((number % RECORDS_WIDTH) * parts + part, number / RECORDS_WIDTH);
}

// The view that an emitter belongs to.
int view_of(int number)
{
  int view = views.count - 1;
  while (view > 0 && number < views.cameras[view].emitters.first) {
    view--;
  }
  return view;
}
