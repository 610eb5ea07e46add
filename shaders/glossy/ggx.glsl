// SPDX-License-Identifier: GPL-3.0-or-later
// The GGX lobe of a glossy surface, isotropic. alpha: the square of Blender's roughness. Directions are in the frame of the
// normal, which is z. Formulas: docs/method/glossy.md.

// Smith's Lambda of a direction with this cosine to the normal.
float smith(float cosine, float alpha)
{
  float square = cosine * cosine;
  return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - square) / max(square, 1e-12)) - 1.0);
}

// One of the microfacets that are seen from `eye`, as often as it shows (E. Heitz 2018, by the spherical cap of J. Dupuy and
// A. Benyoub 2023). random: two numbers in [0, 1).
vec3 visible_normal(vec3 eye, float alpha, vec2 random)
{
  vec3 stretched = direction(vec3(alpha * eye.xy, eye.z));
  float turn = 2.0 * PI * random.x;
  float z = (1.0 - random.y) * (1.0 + stretched.z) - stretched.z;
  float radius = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  vec3 facing = vec3(radius * cos(turn), radius * sin(turn), z) + stretched;
  return direction(vec3(alpha * facing.xy, facing.z));
}

// What a direction counts that comes by reflection at a visible microfacet: G2 / G1 of heights that go together, 0 below the
// surface. Its mean is the share of the light that leaves after one reflection.
float lobe_weight(float eye, float towards, float alpha)
{
  float here = 1.0 + smith(eye, alpha);
  return towards > 0.0 ? here / (here + smith(towards, alpha)) : 0.0;
}

// An axis beside the normal (T. Duff et al. 2017).
vec3 beside(vec3 normal)
{
  float side = normal.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (side + normal.z);
  return vec3(1.0 + side * normal.x * normal.x * a, side * normal.x * normal.y * a, -side * normal.x);
}
