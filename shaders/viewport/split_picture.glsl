// SPDX-License-Identifier: GPL-3.0-or-later
// Split: one channel of a picture that EEVEE has drawn on the GPU, in the layout of uploaded passes: four neighbouring
// pixels of a row to the texel, top row first. Rows are padded with background.

#define NO_DEPTH 1e10         // EEVEE's depth where there is no surface

void main()
{
  ivec2 quad = ivec2(gl_GlobalInvocationID.xy), size = options.size;
  if (4 * quad.x >= size.x || quad.y >= size.y) {
    return;
  }
  int component = options.component;
  vec4 values = vec4(0.0);
  for (int k = 0; k < min(4, size.x - 4 * quad.x); k++) {
    vec4 drawn = texelFetch(picture, ivec2(4 * quad.x + k, size.y - 1 - quad.y), 0);
    // Positions become depths. A picture of positions holds the world's origin where there is no surface.
    float depth = -dot(options.depth_axis, vec4(drawn.xyz, 1.0));
    values[k] = component >= 0 ? drawn[component] : drawn.xyz == vec3(0.0) ? NO_DEPTH : depth;
  }
  imageStore(channel_out, quad, values);
}
