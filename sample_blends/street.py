# SPDX-License-Identifier: GPL-3.0-or-later
"""A street under sun and sky: one row of houses in the sun lights the other, which is in its own shade."""

import numpy as np

from parts import aim, box, camera, diffuse, light_data, place, render_settings, sky

LENGTH, ROAD, PAVEMENT = 44.0, 6.0, 2.2  # along y from 0; across x around 0
FRONT = ROAD / 2 + PAVEMENT  # houses stand from |x| = FRONT on
WALLS = [
    (0.72, 0.52, 0.30),
    (0.66, 0.30, 0.20),
    (0.74, 0.70, 0.60),
    (0.45, 0.55, 0.48),
    (0.70, 0.62, 0.38),
    (0.56, 0.22, 0.16),
]


def build(scene):
    render_settings(scene)
    sky(scene, (0.42, 0.62, 1.0), 0.55)
    _ground()
    for side in (-1, 1):
        _row(side, np.random.default_rng(3 + side))
    _things()
    sun = light_data("SUN", "Sun", (1, 0.90, 0.74), 9, angle=0.0093)
    place("Sun", sun, None, (0, 0, 20), aim((0, 0, 0), (1, 0.45, -1.15)))
    camera(scene, (-1.4, 1.5, 1.7), (0.9, 20, 3.4), 24)


def _ground():
    box("Road", diffuse("Asphalt", (0.16, 0.16, 0.17)), (-ROAD / 2, -6, -0.3), (ROAD / 2, LENGTH + 8, 0))
    paving = diffuse("Paving", (0.46, 0.43, 0.39))
    for side in (-1, 1):
        low, high = sorted((side * ROAD / 2, side * FRONT))
        box("Pavement", paving, (low, -6, -0.3), (high, LENGTH + 8, 0.14))
    box("Ground", diffuse("Ground", (0.34, 0.32, 0.28)), (-70, -70, -0.6), (70, 110, -0.2))
    line = diffuse("Line", (0.75, 0.75, 0.72))
    for number in range(12):
        box("Line", line, (-0.07, 4.0 * number, 0), (0.07, 4.0 * number + 2, 0.004))


def _row(side, chance):
    """Houses of one side, from the camera's end on, and one across the far end."""
    glass = diffuse(f"Panes {side}", (0.05, 0.06, 0.07))
    frame = diffuse(f"Window frames {side}", (0.74, 0.73, 0.70))
    y, number = -6.0, 0
    while y < LENGTH:
        wide, floors = float(chance.uniform(6, 9)), int(chance.integers(2, 5))
        tall = 3.2 * floors + 0.8
        color = WALLS[(number + 3 * (side > 0)) % len(WALLS)]
        _house(side, y, wide, tall, diffuse(f"House {side}.{number}", color), frame)
        for floor in range(floors):
            for column in range(int(wide // 2)):
                _window(side, y + 0.7 + 1.95 * column, 3.2 * floor + 1.0, glass, frame, door=floor == 0 and column == 1)
        y, number = y + wide, number + 1
    if side > 0:
        box(
            "Far house",
            diffuse("Far house", (0.70, 0.46, 0.28)),
            (-FRONT - 6, LENGTH + 8, -0.3),
            (FRONT + 6, LENGTH + 14, 13),
        )


def _house(side, y, wide, tall, wall, trim):
    low, high = sorted((side * FRONT, side * (FRONT + 8)))
    box("House", wall, (low, y, -0.3), (high, y + wide, tall))
    low, high = sorted((side * (FRONT - 0.35), side * FRONT))
    box("Cornice", trim, (low, y, tall - 0.35), (high, y + wide, tall - 0.1))


def _window(side, y, z, glass, frame, door=False):
    bottom, top = (0.14, 2.4) if door else (z, z + 1.5)
    face, out = side * FRONT, -side
    low, high = sorted((face, face + out * 0.03))
    box("Pane", glass, (low, y, bottom), (high, y + 1.05, top))
    low, high = sorted((face, face + out * 0.10))
    for left in (y - 0.09, y + 1.05):
        box("Frame", frame, (low, left, bottom), (high, left + 0.09, top))
    box("Frame", frame, (low, y - 0.09, top), (high, y + 1.14, top + 0.1))
    if not door:
        low, high = sorted((face, face + out * 0.18))
        box("Sill", frame, (low, y - 0.14, bottom - 0.08), (high, y + 1.19, bottom))


def _things():
    _car((-2.0, 9.0), (0.55, 0.06, 0.05))
    _car((-2.0, 17.5), (0.70, 0.70, 0.68))
    _car((2.0, 13.0), (0.08, 0.18, 0.42))
    stripe = diffuse("Awning", (0.72, 0.16, 0.10))
    for y in (6.0, 22.0):
        awning = box("Awning", stripe, (FRONT - 1.3, y, 2.75), (FRONT, y + 3.2, 2.80))
        awning.rotation_euler[1] = 0.28
    iron = diffuse("Iron", (0.10, 0.10, 0.11))
    for y in (5.0, 16.0, 27.0, 38.0):
        box("Lamp post", iron, (ROAD / 2 + 0.25, y, 0.14), (ROAD / 2 + 0.35, y + 0.1, 4.6))
        box("Lamp head", iron, (ROAD / 2 - 0.35, y - 0.05, 4.6), (ROAD / 2 + 0.4, y + 0.15, 4.75))
    bark, leaves = diffuse("Bark", (0.16, 0.10, 0.06)), diffuse("Leaves", (0.10, 0.26, 0.06))
    chance = np.random.default_rng(11)
    for y in (11.0, 20.5, 31.0):
        x = -ROAD / 2 - 0.6
        box("Trunk", bark, (x - 0.12, y - 0.12, 0.14), (x + 0.12, y + 0.12, 2.6))
        for _ in range(26):
            at, half = np.array((x, y, 3.8)) + chance.normal(0, (0.55, 0.55, 0.6)), chance.uniform(0.25, 0.45)
            box("Foliage", leaves, at - half, at + half, turn=float(chance.uniform(0, 90)))


def _car(at, color):
    x, y = at
    paint, dark = diffuse("Car paint", color), diffuse("Car dark", (0.04, 0.04, 0.05))
    box("Car body", paint, (x - 0.85, y - 2.1, 0.35), (x + 0.85, y + 2.1, 0.85), bevel=0.12)
    box("Car cabin", paint, (x - 0.72, y - 1.2, 0.85), (x + 0.72, y + 1.3, 1.42), bevel=0.15)
    box("Car windows", dark, (x - 0.74, y - 1.0, 0.92), (x + 0.74, y + 1.1, 1.28))
    for wheel in ((-0.8, -1.35), (0.6, -1.35), (-0.8, 1.15), (0.6, 1.15)):
        box("Wheel", dark, (x + wheel[0], y + wheel[1], 0), (x + wheel[0] + 0.2, y + wheel[1] + 0.62, 0.62), bevel=0.08)
