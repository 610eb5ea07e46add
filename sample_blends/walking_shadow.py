# SPDX-License-Identifier: GPL-3.0-or-later
"""A moving shot: someone walks through the light of a lamp. The shadow crosses the bright wall, and its bounce
fails."""

from math import pi, sin

import figure
from parts import aim, animate, box, camera, diffuse, light_data, place, shot

WIDTH, DEPTH, HEIGHT = 5.0, 4.6, 2.7  # x and y from 0


def build(scene):
    shot(scene, exposure=1.2)
    _room()
    lamp = light_data("SPOT", "Lamp", (1, 0.86, 0.66), 520, spot_size=1.25, spot_blend=0.3, shadow_soft_size=0.08)
    place("Lamp", lamp, None, (4.75, 0.3, 1.1), aim((4.75, 0.3, 1.1), (1.3, 4.2, 1.35)))
    _walker()
    camera(scene, (0.45, 0.3, 1.55), (3.3, 4.2, 1.05), 20)


def _room():
    white = diffuse("Wall", (0.78, 0.76, 0.72))
    x, y, z = WIDTH, DEPTH, HEIGHT
    box("Floor", diffuse("Boards", (0.45, 0.30, 0.17)), (0, 0, -0.2), (x, y, 0))
    box("Ceiling", white, (0, 0, z), (x, y, z + 0.2))
    box("Back wall", white, (-0.2, y, -0.2), (x + 0.2, y + 0.2, z + 0.2))
    box("Near wall", white, (-0.2, -0.2, -0.2), (x + 0.2, 0, z + 0.2))
    box("Left wall", diffuse("Orange wall", (0.80, 0.42, 0.12)), (-0.2, 0, -0.2), (0, y, z + 0.2))
    box("Right wall", diffuse("Blue wall", (0.24, 0.36, 0.58)), (x, 0, -0.2), (x + 0.2, y, z + 0.2))
    box("Cupboard", diffuse("Cupboard", (0.66, 0.62, 0.54)), (3.9, 3.4, 0), (WIDTH, DEPTH, 1.3), bevel=0.01)
    box("Crate", diffuse("Crate", (0.55, 0.40, 0.25)), (2.9, 3.9, 0), (3.4, 4.4, 0.5), turn=20)


def _walker():
    """Two steps, from right to left through the middle of the light."""
    z = 0.88
    bones = {
        "spine": ("", (0, 0, z), (0, 0, 1.38), 0.14, 0.18),
        "head": ("spine", (0, 0, 1.46), (0, 0, 1.70), 0.09, 0.11),
    }
    for side, x in (("left", 0.1), ("right", -0.1)):
        bones[f"thigh {side}"] = ("spine", (x, 0, z), (x, 0.01, 0.46), 0.10, 0.07)
        bones[f"shin {side}"] = (f"thigh {side}", (x, 0.01, 0.46), (x, 0, 0.06), 0.07, 0.05)
        bones[f"arm {side}"] = ("spine", (2.1 * x, 0, 1.34), (2.6 * x, 0, 0.80), 0.055, 0.045)
    walker = figure.body("Walker", diffuse("Clothes", (0.30, 0.34, 0.30)), bones)
    walker.rotation_euler.z = -0.98
    animate(walker, "location", {1: (4.3, 2.5, 0), 24: (2.35, 1.2, 0)})
    for name, swing, turn in (
        ("thigh left", 0.5, 0),
        ("thigh right", 0.5, pi),
        ("arm left", 0.4, pi),
        ("arm right", 0.4, 0),
    ):
        animate(
            walker.pose.bones[name],
            "rotation_euler",
            {frame: (swing * sin(2 * pi * (frame - 1) / 12 + turn), 0, 0) for frame in range(1, 25)},
        )
    for name, turn in (("shin left", 0), ("shin right", pi)):
        animate(
            walker.pose.bones[name],
            "rotation_euler",
            {frame: (0.35 + 0.35 * sin(2 * pi * (frame - 1) / 12 + turn - pi / 2), 0, 0) for frame in range(1, 25)},
        )
