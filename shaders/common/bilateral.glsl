// SPDX-License-Identifier: GPL-3.0-or-later
// Bilateral upsampling: how much each of four receivers takes from a coarse texel near it.

#define FLATNESS_SHARPNESS 16.0
#define LEAST_WEIGHT 1e-3     // the best of poor taps still counts; a good one outweighs it a thousand times

// A tap counts the more, the better it lies in the receiver's plane (height above it, in units of the tap's own size, so
// that scenes of any scale look alike) and the more it faces the same way.
vec4 bilateral_weight(vec4 height, vec4 cosine, float area)
{
  vec4 flatness = 1.0 / (1.0 + FLATNESS_SHARPNESS * height * height / area);
  vec4 likeness = max(cosine, vec4(0.0));
  likeness *= likeness;
  likeness *= likeness;
  likeness *= likeness;  // cosine to the 8th
  return flatness * likeness + LEAST_WEIGHT;
}
