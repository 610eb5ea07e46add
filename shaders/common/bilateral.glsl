// SPDX-License-Identifier: GPL-3.0-or-later
// Bilateral weights of four receivers for a texel near them.

#define FLATNESS_SHARPNESS 16.0
#define MIN_WEIGHT 1e-3       // where all taps are poor the best still counts; a good one outweighs it a thousand times

// A tap weighs more the closer it lies to the receiver's plane (height above it, relative to the size of the tap, so
// that the scale of the scene does not matter) and the more its normal agrees.
vec4 bilateral_weight(vec4 height, vec4 cosine, float area)
{
  vec4 flatness = 1.0 / (1.0 + FLATNESS_SHARPNESS * height * height / area);
  vec4 likeness = max(cosine, vec4(0.0));
  likeness *= likeness;
  likeness *= likeness;
  likeness *= likeness;  // cosine to the 8th
  return flatness * likeness + MIN_WEIGHT;
}
