# SPDX-License-Identifier: GPL-3.0-or-later
"""The shaders in float64 numpy, function by function under the same names, and the sums that they estimate."""
