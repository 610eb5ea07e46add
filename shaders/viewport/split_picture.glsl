// SPDX-License-Identifier: GPL-3.0-or-later
// Split: one channel of a picture that EEVEE has drawn on the GPU, as EEVEE's finished passes are uploaded: four neighbouring pixels
// of a row to the texel, top row first. Rows are filled up with background.

#define NO_DEPTH 1e10         // what EEVEE has where there is no surface

void main()
{
  ivec2 quad = ivec2(gl_GlobalInvocationID.xy), size = parameters.frame.xy;
  if (4 * quad.x >= size.x || quad.y >= size.y) {
    return;
  }
  int channel = parameters.span.x;
  vec4 values = vec4(0.0);
  for (int k = 0; k < min(4, size.x - 4 * quad.x); k++) {
    vec4 drawn = texelFetch(picture, ivec2(4 * quad.x + k, size.y - 1 - quad.y), 0);
    // The picture of places is turned into depths. Where nothing is, it holds the world's origin.
    float depth = -dot(parameters.rotation[2], vec4(drawn.xyz, 1.0));
    values[k] = channel >= 0 ? drawn[channel] : drawn.xyz == vec3(0.0) ? NO_DEPTH : depth;
  }
  imageStore(channel_out, quad, values);
}
