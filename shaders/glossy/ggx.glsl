// SPDX-License-Identifier: GPL-3.0-or-later
// GGX: the isotropic specular lobe. alpha: the square of Blender's roughness. Directions are in the frame of the
// normal, which is z. Formulas: docs/method/glossy.md.

// Smith's Lambda of a direction with this cosine to the normal.
float smith(float cosine, float alpha)
{
  float square = cosine * cosine;
  return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - square) / max(square, 1e-12)) - 1.0);
}

// A sample of the distribution of visible normals (E. Heitz 2018, by the spherical cap of J. Dupuy and A. Benyoub
// 2023). outgoing: direction to the camera; random: two numbers in [0, 1).
vec3 visible_normal(vec3 outgoing, float alpha, vec2 random)
{
  vec3 stretched = direction(vec3(alpha * outgoing.xy, outgoing.z));
  float turn = 2.0 * PI * random.x;
  float z = (1.0 - random.y) * (1.0 + stretched.z) - stretched.z;
  float radius = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  vec3 facing = vec3(radius * cos(turn), radius * sin(turn), z) + stretched;
  return direction(vec3(alpha * facing.xy, facing.z));
}

// Weight of a direction sampled by reflection at a visible normal, from the cosines of both directions: G2 / G1 with
// height-correlated masking and shadowing, 0 below the surface. Its mean is the lobe's albedo for single scattering.
float lobe_weight(float outgoing, float towards, float alpha)
{
  float here = 1.0 + smith(outgoing, alpha);
  return towards > 0.0 ? here / (here + smith(towards, alpha)) : 0.0;
}

// A tangent (T. Duff et al. 2017).
vec3 tangent_of(vec3 normal)
{
  float side = normal.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (side + normal.z);
  return vec3(1.0 + side * normal.x * normal.x * a, side * normal.x * normal.y * a, -side * normal.x);
}
