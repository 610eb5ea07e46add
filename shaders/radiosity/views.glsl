// SPDX-License-Identifier: GPL-3.0-or-later
// Views: the cameras whose pictures send light, the main one first, and what their depth maps tell of any place. World
// space has Blender's axes and the main camera's place as its origin. All views have the same resolution.

#define NEAREST 1e-4          // m; what is nearer than this lies behind the camera

struct Receiver {
  vec3 place;        // world, m
  vec3 normal;
  bool is_surface;
};

// A bit for each. Loops go over these: drivers write a loop over an array's indices out, and translate its body ten times.
uint all_views()
{
  return (1u << uint(views.depths.w)) - 1u;
}

vec3 to_view(int view, vec3 place)
{
  vec4 p = vec4(place, 1.0);
  return vec3(dot(views.rotation[3 * view], p), dot(views.rotation[3 * view + 1], p), dot(views.rotation[3 * view + 2], p));
}

// Of a direction, which has no place.
vec3 turn_to_view(int view, vec3 direction)
{
  return vec3(dot(views.rotation[3 * view].xyz, direction), dot(views.rotation[3 * view + 1].xyz, direction),
              dot(views.rotation[3 * view + 2].xyz, direction));
}

vec3 to_world(int view, vec3 direction)
{
  return direction.x * views.rotation[3 * view].xyz + direction.y * views.rotation[3 * view + 1].xyz +
         direction.z * views.rotation[3 * view + 2].xyz;
}

bool is_parallel(int view)
{
  return views.eye[view].w != 0.0;
}

// Towards the camera, of any length in orthographic views.
vec3 to_eye(int view, vec3 place)
{
  return is_parallel(view) ? views.rotation[3 * view + 2].xyz : views.eye[view].xyz - place;
}

// Linear in the place: x, y in texels of the view's depth map, times w; planar depth; w.
vec4 projection_of(int view, vec3 place)
{
  vec3 seen = to_view(view, place);
  float w = is_parallel(view) ? 1.0 : -seen.z;
  return vec4((seen.xy - views.projection[view].zw * w) / views.projection[view].xy, -seen.z, w);
}

// (x, y) in texels of the view's depth map, and planar depth.
vec3 project(int view, vec3 place)
{
  vec4 projected = projection_of(view, place);
  return vec3(projected.xy / max(projected.w, NEAREST), projected.z);
}

// Where a view's emitters would have the receiver: a place in its grid; far outside of it where it is behind the camera.
ivec2 place_in_grid(int view, vec3 place)
{
  vec3 projected = project(view, place);
  float blocks = float(views.depths.z) / float(views.emitters[view].w);
  return projected.z > NEAREST ? ivec2(floor(clamp(projected.xy * blocks, -1e6, 1e6))) : ivec2(-1000000);
}

// World area, m^2, of what a texel of the view's depth map shows of a surface through this place.
float shown_area(int view, vec3 place, vec3 normal, float depth)
{
  float footprint = abs(views.projection[view].x * views.projection[view].y);
  vec3 eye = to_eye(view, place);
  float cosine = max(abs(dot(normal, direction(eye))), COSINE_FLOOR);
  return is_parallel(view) ? footprint / cosine :
                             depth * depth * footprint * depth * inversesqrt(max(dot(eye, eye), 1e-37)) / cosine;
}

// EEVEE's world light on a white surface, as radiance: the first order of spherical harmonics, and unoccluded.
vec3 world_light(vec3 normal)
{
  return views.world[0].rgb + normal.x * views.world[1].rgb + normal.y * views.world[2].rgb + normal.z * views.world[3].rgb;
}

// The radiance from that direction which makes this light: a cosine lobe damps the first order to 2/3.
vec3 world_radiance(vec3 towards)
{
  return world_light(1.5 * towards);
}

// Number of a record, an emitter or a receiver, to where it lies in a texture.
ivec2 record_texel(int number, int part, int parts)
{
  return ivec2((number % RECORDS_WIDTH) * parts + part, number / RECORDS_WIDTH);
}

// The view that an emitter is of.
int view_of(int number)
{
  int view = views.depths.w - 1;
  while (view > 0 && number < views.emitters[view].x) {
    view--;
  }
  return view;
}
