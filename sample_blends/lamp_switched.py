# SPDX-License-Identifier: GPL-3.0-or-later
"""A moving shot in which nothing moves: at frame 13 the bright lamp of a bedroom goes out, the dim one stays."""

from parts import aim, animate, box, camera, diffuse, light_data, place, shot

WIDTH, DEPTH, HEIGHT = 4.4, 4.0, 2.6  # x and y from 0
SWITCHED = 13  # the first frame without the bright lamp


def build(scene):
    shot(scene, exposure=1.0)
    _room()
    bright = light_data(
        "SPOT", "Reading lamp", (1, 0.80, 0.55), 320, spot_size=1.7, spot_blend=0.5, shadow_soft_size=0.1
    )
    place("Reading lamp", bright, None, (3.3, 1.9, 1.3), aim((3.3, 1.9, 1.3), (4.2, 2.9, 2.4)))
    animate(bright, "energy", {1: 320, SWITCHED: 0}, "CONSTANT")
    dim = light_data("AREA", "Window", (0.60, 0.76, 1), 18, shape="RECTANGLE", size=1.2, size_y=1.1)
    place("Window", dim, None, (0.06, 2.2, 1.5), aim((0, 0, 0), (1, 0, 0)))
    camera(scene, (0.5, 0.3, 1.5), (2.9, 3.4, 0.95), 20)


def _room():
    plaster = diffuse("Plaster", (0.78, 0.75, 0.70))
    x, y, z = WIDTH, DEPTH, HEIGHT
    box("Floor", diffuse("Carpet", (0.36, 0.40, 0.30)), (0, 0, -0.2), (x, y, 0))
    box("Ceiling", plaster, (0, 0, z), (x, y, z + 0.2))
    box("Back wall", plaster, (-0.2, y, -0.2), (x + 0.2, y + 0.2, z + 0.2))
    box("Near wall", plaster, (-0.2, -0.2, -0.2), (x + 0.2, 0, z + 0.2))
    box("Left wall", plaster, (-0.2, 0, -0.2), (0, y, z + 0.2))
    box("Right wall", diffuse("Rose wall", (0.72, 0.34, 0.32)), (x, 0, -0.2), (x + 0.2, y, z + 0.2))
    box("Bed", diffuse("Bed frame", (0.35, 0.22, 0.13)), (1.0, 2.2, 0), (2.6, 4.0, 0.3))
    box("Mattress", diffuse("Linen", (0.80, 0.79, 0.76)), (1.04, 2.24, 0.3), (2.56, 3.98, 0.52), bevel=0.06)
    box("Pillow", diffuse("Pillow", (0.25, 0.36, 0.62)), (1.2, 3.45, 0.52), (1.75, 3.85, 0.64), turn=8, bevel=0.05)
    oak = diffuse("Oak", (0.52, 0.33, 0.18))
    box("Table", oak, (2.9, 3.4, 0), (3.4, 3.95, 0.55), bevel=0.01)
    box("Wardrobe", diffuse("Wardrobe", (0.60, 0.55, 0.48)), (3.75, 0.2, 0), (4.4, 1.5, 2.0), bevel=0.01)
    box("Picture", diffuse("Picture", (0.12, 0.35, 0.30)), (1.3, 3.96, 1.25), (2.3, 4.0, 1.9))
