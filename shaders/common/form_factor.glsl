// SPDX-License-Identifier: GPL-3.0-or-later
// The form factor, for samples of the pyramid and for emitters of several views alike.

// Cosine-weighted solid angle over pi: facing disks of area A at distance r see A / (pi r^2 + A) of each other,
// never more than 1. own * facing is the vector area that sends: it stands for A n' and may be shorter than A, for a texel
// that is not flat, or of which a part alone counts.
float form_factor(vec3 receiver, vec3 normal, vec3 place, float area, vec3 facing, float own)
{
  vec3 path = place - receiver;
  float square = dot(path, path);
  float cosines = max(dot(normal, path), 0.0) * max(-dot(facing, path), 0.0);
  return own * cosines / max(square * (PI * square + area), 1e-37);
}
