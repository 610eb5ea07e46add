// SPDX-License-Identifier: GPL-3.0-or-later
// Form factor: the cosine-weighted solid angle of an emitter over pi.

// Facing disks of area A at distance r have the form factor A / (pi r^2 + A) of each other, never more than 1. own *
// facing is the emitter's vector area A n'. It may be shorter than A: for a texel that is not flat, or one that only
// counts in part.
float form_factor(vec3 receiver, vec3 normal, vec3 position, float area, vec3 facing, float own)
{
  vec3 path = position - receiver;
  float square = dot(path, path);
  float cosines = max(dot(normal, path), 0.0) * max(-dot(facing, path), 0.0);
  return own * cosines / max(square * (PI * square + area), 1e-37);
}
