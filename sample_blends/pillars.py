# SPDX-License-Identifier: GPL-3.0-or-later
"""A moving shot: the camera goes past the pillars of a sunlit hall, and what they hid comes into sight."""

from parts import aim, animate, box, camera, diffuse, light_data, place, shot, wall

LENGTH, WIDTH, HEIGHT = 11.0, 5.2, 3.4  # x and y from 0
ROWS = 2.0, 4.0  # of pillars, along y
STEP, THICK = 1.9, 0.34


def build(scene):
    shot(scene, exposure=1.4)
    _hall()
    white = diffuse("Pillar", (0.74, 0.71, 0.66))
    for row in ROWS:
        for number in range(6):
            x = 0.9 + STEP * number
            box("Pillar", white, (x, row - THICK / 2, 0), (x + THICK, row + THICK / 2, HEIGHT), bevel=0.03)
    box("Chest", diffuse("Chest", (0.16, 0.28, 0.52)), (4.6, 4.5, 0), (5.7, 5.1, 0.7))
    box("Bench", diffuse("Bench", (0.60, 0.38, 0.16)), (7.0, 4.6, 0), (8.6, 5.0, 0.45))
    sun = light_data("SUN", "Sun", (1, 0.92, 0.80), 16, angle=0.0093)
    place("Sun", sun, None, (5, -4, 6), aim((0, 0, 0), (0.30, 1, -0.72)))
    seen = camera(scene, (1.2, 0.4, 1.5), (5.6, 4.9, 1.2), 20)
    animate(seen, "location", {1: (1.2, 0.4, 1.5), 24: (2.9, 0.4, 1.5)})


def _hall():
    plaster = diffuse("Plaster", (0.78, 0.75, 0.70))
    windows = [(1.9 + 3.4 * number, 3.3 + 3.4 * number, 0.5, 2.9) for number in range(3)]
    box("Floor", diffuse("Floor", (0.62, 0.50, 0.36)), (-0.2, -0.2, -0.2), (LENGTH + 0.2, WIDTH + 0.2, 0))
    box("Ceiling", plaster, (-0.2, -0.2, HEIGHT), (LENGTH + 0.2, WIDTH + 0.2, HEIGHT + 0.2))
    wall("Window wall", plaster, (0, -0.1), (LENGTH, -0.1), HEIGHT, windows, thick=0.2)
    wall(
        "Red wall",
        diffuse("Red wall", (0.66, 0.16, 0.10)),
        (-0.2, WIDTH + 0.1),
        (LENGTH + 0.2, WIDTH + 0.1),
        HEIGHT,
        thick=0.2,
    )
    wall("West wall", plaster, (-0.1, -0.2), (-0.1, WIDTH), HEIGHT, thick=0.2)
    wall(
        "Green wall",
        diffuse("Green wall", (0.22, 0.48, 0.20)),
        (LENGTH + 0.1, -0.2),
        (LENGTH + 0.1, WIDTH),
        HEIGHT,
        thick=0.2,
    )
