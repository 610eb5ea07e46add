# SPDX-License-Identifier: GPL-3.0-or-later
"""A moving shot: a four-legged creature walks over a bright floor and bends its neck and back; every part deforms."""

from math import pi, sin

import figure
from parts import aim, animate, box, camera, diffuse, light_data, place, shot

WIDTH, DEPTH, HEIGHT = 4.4, 3.6, 2.4  # x and y from 0


def build(scene):
    shot(scene, exposure=-0.1)
    _room()
    lamp = light_data("AREA", "Ceiling lamp", (1, 0.88, 0.72), 75, shape="RECTANGLE", size=1.0, size_y=0.6)
    place("Ceiling lamp", lamp, None, (2.2, 1.7, HEIGHT - 0.05), aim((0, 0, 1), (0, 0, 0)))
    _creature()
    camera(scene, (2.2, 0.15, 1.15), (2.2, 2.4, 0.7), 20)


def _room():
    white = diffuse("Wall", (0.76, 0.74, 0.70))
    x, y, z = WIDTH, DEPTH, HEIGHT
    box("Floor", diffuse("Floor", (0.72, 0.66, 0.54)), (0, 0, -0.2), (x, y, 0))
    box("Ceiling", white, (0, 0, z), (x, y, z + 0.2))
    box("Back wall", white, (-0.2, y, -0.2), (x + 0.2, y + 0.2, z + 0.2))
    box("Near wall", white, (-0.2, -0.2, -0.2), (x + 0.2, 0, z + 0.2))
    box("Left wall", diffuse("Red wall", (0.68, 0.12, 0.08)), (-0.2, 0, -0.2), (0, y, z + 0.2))
    box("Right wall", diffuse("Blue wall", (0.14, 0.26, 0.60)), (x, 0, -0.2), (x + 0.2, y, z + 0.2))
    box("Block", diffuse("Block", (0.70, 0.52, 0.16)), (3.1, 2.5, 0), (3.8, 3.2, 0.8), turn=15)


def _creature():
    """Two thirds of a metre tall; it goes to the right by a length of its body."""
    z = 0.62
    bones = {
        "hip": ("", (-0.35, 0, z), (-0.05, 0, z + 0.05), 0.16, 0.19),
        "chest": ("hip", (-0.05, 0, z + 0.05), (0.32, 0, z + 0.02), 0.19, 0.15),
        "neck": ("chest", (0.32, 0, z + 0.02), (0.52, 0, z + 0.30), 0.10, 0.07),
        "head": ("neck", (0.52, 0, z + 0.30), (0.80, 0, z + 0.26), 0.10, 0.06),
        "tail": ("hip", (-0.42, 0, z + 0.04), (-0.68, 0, z + 0.20), 0.06, 0.045),
        "tail end": ("tail", (-0.68, 0, z + 0.20), (-0.88, 0, z + 0.42), 0.045, 0.02),
    }
    steps = {}
    for number, (end, x, parent) in enumerate((("fore", 0.26, "chest"), ("hind", -0.30, "hip"))):
        for side, y in (("left", 0.12), ("right", -0.12)):
            leg, shin = f"{end} leg {side}", f"{end} shin {side}"
            bones[leg] = (parent, (x, y, z - 0.04), (x, y, 0.32), 0.085, 0.06)
            bones[shin] = (leg, (x, y, 0.32), (x, y, 0.05), 0.06, 0.045)
            steps[leg] = pi * (number + (side == "left"))
    creature = figure.body("Creature", diffuse("Hide", (0.34, 0.56, 0.30)), bones)
    animate(creature, "location", {1: (1.45, 1.9, 0), 24: (2.55, 1.7, 0)})

    def swing(name, axis, reach, turn=0.0, rest=0.0):
        keys = {}
        for frame in range(1, 25):
            angles = [0.0, 0.0, 0.0]
            angles[axis] = rest + reach * sin(2 * pi * (frame - 1) / 16 + turn)
            keys[frame] = angles
        animate(creature.pose.bones[name], "rotation_euler", keys)

    for leg, turn in steps.items():
        swing(leg, 2, 0.45, turn)
        swing(leg.replace("leg", "shin"), 2, 0.3, turn + pi / 2, 0.2)
    swing("chest", 2, 0.18)
    swing("neck", 0, 0.35, 0.7)
    swing("head", 0, 0.25, 1.6)
    swing("tail", 2, 0.5, 1.0)
    swing("tail end", 2, 0.6, 0.3)
