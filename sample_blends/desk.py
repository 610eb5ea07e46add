# SPDX-License-Identifier: GPL-3.0-or-later
"""A cluttered desk under its lamp: many small things close together, and the shelf above lit from below."""

from math import cos, pi, sin

import numpy as np

from parts import aim, box, camera, diffuse, light_data, mesh, place, render_settings

TOP = 0.74  # of the desk; it stands against y = 0.8, with x from -0.9 to 0.9


def build(scene):
    render_settings(scene, exposure=1.0)
    _room()
    _furniture()
    _clutter()
    _lamp()
    camera(scene, (-0.55, -1.15, 1.38), (0.08, 0.42, 0.86), 32)


def _room():
    paint = diffuse("Blue wall", (0.42, 0.52, 0.60))
    white = diffuse("White wall", (0.76, 0.75, 0.72))
    box("Floor", diffuse("Floor", (0.34, 0.20, 0.11)), (-2.2, -2.4, -0.1), (2.2, 0.8, 0))
    box("Ceiling", white, (-2.2, -2.4, 2.5), (2.2, 0.8, 2.6))
    box("Back wall", paint, (-2.3, 0.8, -0.1), (2.3, 0.9, 2.6))
    box("Left wall", white, (-2.3, -2.4, -0.1), (-2.2, 0.8, 2.6))
    box("Right wall", white, (2.2, -2.4, -0.1), (2.3, 0.8, 2.6))
    box("Front wall", white, (-2.3, -2.5, -0.1), (2.3, -2.4, 2.6))


def _furniture():
    oak = diffuse("Oak", (0.56, 0.37, 0.20))
    box("Desk top", oak, (-0.9, 0.0, TOP - 0.04), (0.9, 0.78, TOP), bevel=0.006)
    for x in (-0.86, 0.80):
        box("Desk side", oak, (x, 0.05, 0), (x + 0.06, 0.75, TOP - 0.04))
    box("Drawers", diffuse("Drawers", (0.66, 0.64, 0.60)), (0.40, 0.08, 0.10), (0.79, 0.75, TOP - 0.06), bevel=0.006)
    box("Shelf", oak, (-0.9, 0.56, 1.28), (0.9, 0.79, 1.31))
    _books((-0.86, 0.60, 1.31), 24, 3)


def _books(at, count, seed, lying=False):
    """A row of books from a place on, or a pile; thicknesses and colours from a fixed seed."""
    chance = np.random.default_rng(seed)
    x, y, z = at
    for number in range(count):
        thick, tall, deep = chance.uniform(0.015, 0.045), chance.uniform(0.17, 0.26), chance.uniform(0.12, 0.17)
        cover = diffuse(f"Cover {seed}.{number}", tuple(chance.choice([0.06, 0.15, 0.3, 0.5, 0.7], 3)))
        if lying:
            box("Book", cover, (x, y, z), (x + tall, y + deep, z + thick), turn=chance.uniform(-25, 25))
            z += thick
        else:
            box("Book", cover, (x, y, z), (x + thick, y + deep, z + tall))
            x += thick + 0.002


def _clutter():
    dark = diffuse("Dark plastic", (0.06, 0.06, 0.07))
    grey = diffuse("Grey plastic", (0.30, 0.30, 0.32))
    box("Monitor", dark, (-0.28, 0.52, TOP + 0.10), (0.34, 0.55, TOP + 0.46), turn=-6, bevel=0.006)
    box("Monitor neck", grey, (0.0, 0.55, TOP), (0.06, 0.58, TOP + 0.30))
    box("Monitor foot", grey, (-0.10, 0.47, TOP), (0.16, 0.66, TOP + 0.012), bevel=0.004)
    box("Keyboard", grey, (-0.24, 0.18, TOP), (0.20, 0.31, TOP + 0.018), turn=4, bevel=0.004)
    key = diffuse("Key", (0.70, 0.70, 0.68))
    for row in range(4):
        for column in range(14):
            x, y = -0.228 + 0.030 * column, 0.192 + 0.028 * row
            box("Key", key, (x, y, TOP + 0.018), (x + 0.024, y + 0.022, TOP + 0.026))
    box("Mouse", dark, (0.28, 0.20, TOP), (0.34, 0.30, TOP + 0.03), turn=-12, bevel=0.012)
    _books((-0.76, 0.40, TOP), 6, 5, lying=True)
    _books((0.50, 0.52, TOP), 4, 8, lying=True)
    paper = diffuse("Paper", (0.80, 0.79, 0.76))
    for number in range(5):
        x, y = -0.62 + 0.05 * number, 0.06 + 0.02 * number
        box(
            "Sheet",
            paper,
            (x, y, TOP + 0.001 * number),
            (x + 0.21, y + 0.297, TOP + 0.001 * number + 0.0006),
            turn=23 * number - 40,
        )
    china = diffuse("China", (0.70, 0.12, 0.08))
    place("Mug", _cup(0.042, 0.10), china, (0.50, 0.34, TOP))
    place("Pen pot", _cup(0.038, 0.11), diffuse("Pen pot", (0.10, 0.35, 0.30)), (0.36, 0.42, TOP))
    for number in range(8):
        angle = 2 * pi * number / 8
        pen = diffuse(
            f"Pen {number + 1}", ((0.7, 0.6, 0.1), (0.1, 0.2, 0.6), (0.6, 0.1, 0.1), (0.1, 0.5, 0.2))[number % 4]
        )
        thing = box("Pen", pen, (-0.0035, -0.0035, 0), (0.0035, 0.0035, 0.17))
        thing.location = (0.36 + 0.02 * cos(angle), 0.42 + 0.02 * sin(angle), TOP + 0.10)
        thing.rotation_euler = (0.25 * sin(-angle), 0.25 * cos(angle), angle)
    place("Plant pot", _cup(0.07, 0.12), diffuse("Terracotta", (0.60, 0.26, 0.14)), (-0.74, 0.66, TOP))
    leaf = mesh("Leaf", [(0, 0, 0), (0.03, 0.06, 0.01), (0, 0.16, 0), (-0.03, 0.06, 0.01)], [(0, 1, 2, 3)])
    green = diffuse("Leaf", (0.12, 0.36, 0.09))
    for number in range(40):
        place(
            "Leaf",
            leaf,
            green,
            (-0.74, 0.66, TOP + 0.10 + 0.004 * number),
            (15 + (37 * number) % 60, 0, 137.5 * number),
        )


def _cup(radius, height, segments=32, thick=0.004):
    """An open cup with a wall of some thickness."""
    rings = [(radius, 0), (radius, height), (radius - thick, height), (radius - thick, thick)]
    points = [
        (r * cos(2 * pi * k / segments), r * sin(2 * pi * k / segments), z) for r, z in rings for k in range(segments)
    ]
    faces = [
        (
            ring * segments + k,
            ring * segments + (k + 1) % segments,
            (ring + 1) * segments + (k + 1) % segments,
            (ring + 1) * segments + k,
        )
        for ring in range(3)
        for k in range(segments)
    ]
    faces += [tuple(range(segments))[::-1], tuple(range(3 * segments, 4 * segments))]
    data = mesh("Cup", points, faces, smooth=True)
    data.set_sharp_from_angle(angle=0.5)
    return data


def _lamp():
    head, target = (0.62, 0.42, TOP + 0.52), (0.30, 0.30, TOP)
    data = light_data("SPOT", "Desk lamp", (1, 0.82, 0.58), 26, spot_size=2.0, spot_blend=0.5, shadow_soft_size=0.03)
    place("Desk lamp", data, None, head, aim(head, target))
    metal = diffuse("Lamp", (0.65, 0.55, 0.12))
    box("Lamp foot", metal, (0.66, 0.50, TOP), (0.82, 0.66, TOP + 0.02), bevel=0.005)
    box("Lamp pole", metal, (0.735, 0.57, TOP + 0.02), (0.745, 0.58, TOP + 0.58))
    box("Lamp arm", metal, (0.61, 0.42, TOP + 0.575), (0.745, 0.58, TOP + 0.585))
    window = light_data("AREA", "Window", (0.70, 0.84, 1), 22, shape="RECTANGLE", size=1.2, size_y=1.3)
    place("Window", window, None, (-2.15, -1.0, 1.5), aim((0, 0, 0), (1, 0, 0)))
