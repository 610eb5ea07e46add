// SPDX-License-Identifier: GPL-3.0-or-later
// The PCG generator of M. O'Neill (HMC-CS-2014-0905), the variant RXS-M-XS with 32 bits of state.

uint pcg_next(uint state)
{
  return state * 747796405u + 2891336453u;
}

uint pcg_output(uint state)
{
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

uint pcg_hash(uint value)
{
  return pcg_output(pcg_next(value));
}

// Uniform in [0, 1).
float unit(uint random)
{
  return float(random >> 8u) / 16777216.0;
}
