# SPDX-License-Identifier: GPL-3.0-or-later
"""A street corner at night under a shining sign. EEVEE takes no light from emission: all the sign gives is the
bounce."""

import bpy

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
    # Paving stones of one mesh, dark as if wet.
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
    red = glowing("Red glass", (1, 0.012, 0.02), 9)
    teal = glowing("Teal glass", (0.03, 0.55, 0.75), 7)
    dark = diffuse("Sign frame", (0.05, 0.05, 0.06))
    _light_box("Sign", red, dark, (-2.15, 2.30), (2.75, 3.18), 3.70, 3.99)
    _letters("AFTERLIGHT", 0.80, glowing("Letters", (1, 0.75, 0.45), 6), (0.3, 3.73, 2.74))
    _light_box("Strip", teal, dark, (-2.15, 1.99), (2.75, 2.10), 3.70, 3.99)
    # Juts out over the door, so that its front lights the wall it hangs on.
    _light_box("Door sign", teal, dark, (-2.82, 2.42), (-2.02, 3.10), 2.70, 2.86)
    _letters("OPEN", 0.27, dark, (-2.42, 2.73, 2.76))
    box("Door sign arm", dark, (-3, 2.75, 2.74), (-2.82, 2.81, 2.80))


def _light_box(name, glass, frame, low, high, front, back, rim=0.09):
    """A box that faces -y with shining glass inside a dark rim; low and high are (x, z) of the glass."""
    (left, bottom), (right, top) = low, high
    box(f"{name} glass", glass, (left, front + 0.04, bottom), (right, back - 0.02, top))
    box(f"{name} back", frame, (left - rim, back - 0.02, bottom - rim), (right + rim, back, top + rim))
    for edge, (x0, x1, z0, z1) in {
        "left": (left - rim, left, bottom - rim, top + rim),
        "right": (right, right + rim, bottom - rim, top + rim),
        "bottom": (left, right, bottom - rim, bottom),
        "top": (left, right, top, top + rim),
    }.items():
        box(f"{name} rim, {edge}", frame, (x0, front, z0), (x1, back - 0.02, z1))


def _letters(body, size, material, location):
    text = bpy.data.curves.new(body.title(), "FONT")
    text.body, text.size, text.extrude = body, size, 0.005
    text.align_x, text.align_y, text.space_character = "CENTER", "CENTER", 1.06
    place(text.name, text, material, location, (90, 0, 0))


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
