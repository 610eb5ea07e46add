# SPDX-License-Identifier: GPL-3.0-or-later
"""A street corner at night under a shining sign. EEVEE takes no light from emission: all the sign gives is the bounce."""

from math import cos, pi, sin

import bpy
import numpy as np

from parts import aim, box, camera, diffuse, glowing, light_data, place, render_settings, sky


def build(scene):
    render_settings(scene, transform="Standard", look="None", exposure=0.3)
    sky(scene, (0.010, 0.014, 0.030), 1)
    moon = light_data("SUN", "Moon", (0.55, 0.70, 1), 0.10, angle=0.02)
    place("Moon", moon, None, (4, -4, 6), aim((0, 0, 0), (-0.5, 0.75, -0.9)))
    _street()
    _signs()
    _things()
    camera(scene, (2.1, -4.9, 1.6), (-0.2, 2.0, 1.58), 27)


def _street():
    plaster = diffuse("Back wall", (0.52, 0.47, 0.42))
    brick = diffuse("Side wall", (0.50, 0.36, 0.28))
    pavement, joint = diffuse("Pavement", (0.36, 0.36, 0.37)), diffuse("Joints", (0.16, 0.16, 0.17))
    box("Back wall", plaster, (-3.4, 4, 0), (5.2, 4.3, 4.6))
    box("Side wall", brick, (-3.7, -3, 0), (-3, 4, 4.6))
    box("Right house", brick, (3.6, 1.4, 0), (6.5, 4.2, 4.6))
    box("Ledge", plaster, (-3, 3.86, 3.55), (3.6, 4, 3.68), bevel=0.02)
    # Paving stones of one mesh: what is wet-looking about them is only their colour.
    stones = box("Paving stone", pavement, (0, 0, -0.1), (0.88, 0.58, 0.02), bevel=0.012)
    stones.location.x, stones.location.y = -2.52, 0.0
    for axis, (count, offset) in enumerate(((7, 0.9), (8, 0.6))):
        array = stones.modifiers.new(f"Rows {axis + 1}", "ARRAY")
        array.use_relative_offset, array.use_constant_offset = False, True
        array.count, array.constant_offset_displace = count, (offset if axis == 0 else 0, offset if axis == 1 else 0, 0)
    stones.location.y = -0.5
    box("Ground", joint, (-3, -0.9, -0.3), (6.5, 4, 0))
    box("Kerb", diffuse("Kerb", (0.42, 0.42, 0.42)), (-3, -1.05, -0.3), (6.5, -0.85, 0.02), bevel=0.02)
    box("Road", diffuse("Road", (0.20, 0.20, 0.21)), (-3, -8, -0.3), (6.5, -1.05, -0.12))
    # Door and window in the side wall.
    wood = diffuse("Door", (0.10, 0.28, 0.30))
    box("Door frame", plaster, (-3.05, 1.3, 0), (-2.93, 2.5, 2.25), bevel=0.01)
    box("Door", wood, (-3, 1.4, 0.03), (-2.91, 2.4, 2.15), bevel=0.01)
    for low in (0.25, 1.2):
        box("Door panel", wood, (-3, 1.55, low), (-2.89, 2.25, low + 0.75), bevel=0.01)
    box("Step", pavement, (-3, 1.2, 0), (-2.6, 2.6, 0.14), bevel=0.015)


def _signs():
    text = bpy.data.curves.new("Sign", "FONT")
    text.body, text.size, text.extrude = "AFTERLIGHT", 0.80, 0.02
    text.align_x, text.align_y, text.space_character = "CENTER", "CENTER", 1.06
    place("Sign", text, glowing("Letters", (1, 0.75, 0.45), 6), (0.3, 3.72, 2.74), (90, 0, 0))
    box("Sign board", glowing("Sign board", (1, 0.012, 0.02), 9), (-2.15, 3.76, 2.30), (2.75, 3.9, 3.18))
    box("Sign frame", diffuse("Sign frame", (0.05, 0.05, 0.06)), (-2.21, 3.80, 2.24), (2.81, 3.99, 3.24), bevel=0.02)
    teal = glowing("Tubes", (0.04, 0.62, 0.85), 11)
    _tube("Line", teal, [(-2.15, 3.76, 2.08), (2.75, 3.76, 2.08)])
    # An arrow beside the door, on the side wall.
    turn = np.linspace(-0.5, 1.0, 13) * pi
    hook = [(-2.86, 2.95 + 0.35 * cos(a), 2.55 + 0.35 * sin(a)) for a in turn]
    _tube("Arrow", teal, hook + [(-2.86, 2.6, 1.9)])
    _tube("Arrow head", teal, [(-2.86, 2.78, 2.1), (-2.86, 2.6, 1.88), (-2.86, 2.42, 2.1)])


def _tube(name, material, points, radius=0.03):
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution, curve.use_fill_caps = "3D", radius, 3, True
    spline = curve.splines.new("POLY")
    spline.points.add(len(points) - 1)
    for point, place_ in zip(spline.points, points):
        point.co = (*place_, 1)
    return place(name, curve, material)


def _things():
    crate, paper = diffuse("Crate", (0.48, 0.34, 0.20)), diffuse("Paper", (0.75, 0.74, 0.70))
    box("Crate", crate, (-2.35, 3.05, 0.02), (-1.65, 3.75, 0.62), turn=8, bevel=0.015)
    box("Crate", crate, (-1.60, 3.20, 0.02), (-1.05, 3.75, 0.50), turn=-6, bevel=0.015)
    box("Crate", crate, (-2.15, 3.15, 0.62), (-1.65, 3.65, 1.05), turn=24, bevel=0.015)
    # A bench under the sign.
    for slat in range(4):
        box("Bench slat", paper, (0.1, 2.55 + 0.13 * slat, 0.44), (1.9, 2.65 + 0.13 * slat, 0.48), bevel=0.008)
    for slat in range(3):
        box("Bench back", paper, (0.1, 3.08, 0.58 + 0.13 * slat), (1.9, 3.11, 0.68 + 0.13 * slat), bevel=0.008)
    for x in (0.25, 1.65):
        box("Bench leg", paper, (x, 2.58, 0.02), (x + 0.08, 3.08, 0.44), bevel=0.008)
        box("Bench post", paper, (x, 3.06, 0.02), (x + 0.06, 3.12, 0.95), bevel=0.008)
    box("Letter box", diffuse("Letter box", (0.75, 0.62, 0.10)), (2.55, 3.3, 0.02), (3.1, 3.75, 1.25), bevel=0.06)
    for x in (-1.6, 0.4, 2.4):
        box("Bollard", paper, (x, -0.55, 0), (x + 0.16, -0.39, 0.85), bevel=0.05)
