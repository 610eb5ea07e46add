# SPDX-License-Identifier: GPL-3.0-or-later
"""Furniture for the rooms of the sample scenes, at real sizes; a place is where it stands on the floor, in metres."""

from math import cos, pi, sin

import numpy as np

from parts import box, glossy, light_data, mesh, place, turned


def _at(origin, low, high):
    return [a + b for a, b in zip(origin, low)], [a + b for a, b in zip(origin, high)]


def sofa(cloth, feet, origin, wide=2.1, cushions=3, side=1):
    """A sofa along x from `origin` on; its front looks to -y, with `side` -1 to +y."""

    def part(name, low, high, bevel):
        (x, y, z), (right, deep, top) = low, high
        y, deep = sorted((side * y, side * deep))
        return box(name, cloth, *_at(origin, (x, y, z), (right, deep, top)), bevel=bevel)

    part("Sofa base", (0.12, 0.05, 0.12), (wide - 0.12, 0.86, 0.30), 0.02)
    part("Sofa back", (0.05, 0.70, 0.14), (wide - 0.05, 0.92, 0.74), 0.06)
    for left in (0, wide - 0.2):
        part("Sofa arm", (left, 0, 0.12), (left + 0.2, 0.90, 0.60), 0.06)
    step = (wide - 0.4) / cushions
    for number in range(cushions):
        left = 0.2 + step * number
        part("Sofa seat", (left + 0.005, 0.0, 0.29), (left + step - 0.005, 0.74, 0.46), 0.06)
        thing = part("Sofa cushion", (left + 0.02, 0.56, 0.45), (left + step - 0.02, 0.74, 0.84), 0.08)
        thing.rotation_euler[0] = -0.14 * side
    for x in (0.1, wide - 0.15):
        for y in (0.08, 0.8):
            y = side * y
            box("Sofa foot", feet, *_at(origin, (x, y, 0), (x + 0.05, y + 0.05, 0.13)))


def table(wood, origin, size=(1.2, 0.7, 0.42), thick=0.04, leg=0.05):
    """A table from corner `origin` on."""
    x, y, z = size
    box("Table top", wood, *_at(origin, (0, 0, z - thick), (x, y, z)), bevel=0.006)
    for left in (0.04, x - 0.04 - leg):
        for front in (0.04, y - 0.04 - leg):
            box("Table leg", wood, *_at(origin, (left, front, 0), (left + leg, front + leg, z - thick)), bevel=0.004)


def chair(wood, seat, origin, turn=0.0):
    """A chair, its back to +y before it is turned by `turn` degrees about `origin`, the middle of its seat."""
    angle = turn * pi / 180
    for name, material, low, high in (
        ("Chair seat", seat, (-0.22, -0.22, 0.43), (0.22, 0.22, 0.48)),
        ("Chair back", wood, (-0.22, 0.19, 0.66), (0.22, 0.22, 0.90)),
        ("Chair leg", wood, (-0.21, -0.21, 0), (-0.175, -0.175, 0.44)),
        ("Chair leg", wood, (0.175, -0.21, 0), (0.21, -0.175, 0.44)),
        ("Chair leg", wood, (-0.21, 0.185, 0), (-0.175, 0.22, 0.90)),
        ("Chair leg", wood, (0.175, 0.185, 0), (0.21, 0.22, 0.90)),
    ):
        thing = box(name, material, low, high, turn, bevel=0.008)
        x, y, z = thing.location
        thing.location = (
            origin[0] + x * cos(angle) - y * sin(angle),
            origin[1] + x * sin(angle) + y * cos(angle),
            origin[2] + z,
        )


def books(at, count, seed, axis=0):
    """A row of standing books from a place on along x, or along y; sizes and colours from the seed."""
    chance = np.random.default_rng(seed)
    covers = [
        glossy(f"Cover {seed}.{number}", tuple(chance.choice([0.04, 0.12, 0.25, 0.45, 0.6], 3)), 0.45)
        for number in range(5)
    ]
    x, y, z = at
    for number in range(count):
        thick, tall, deep = (float(chance.uniform(*span)) for span in ((0.02, 0.05), (0.18, 0.27), (0.13, 0.18)))
        across, along = ((thick, deep), (deep, thick))[axis]
        box("Book", covers[int(chance.integers(5))], (x, y, z), (x + across, y + along, z + tall))
        x, y = (x + thick + 0.002, y) if axis == 0 else (x, y + thick + 0.002)


def window(frame, pane, center, wide, tall, axis=0, bars=(2, 3), thick=0.05):
    """A window's frame and bars about `center`, along x or along y; `pane`: material of its glass, or None."""
    x, y, z = center

    def bar(low, high, name="Window bar"):
        (a, b), (c, d) = low, high  # along and up
        first, second = ((a, -thick / 2), (c, thick / 2)) if axis == 0 else ((-thick / 2, a), (thick / 2, c))
        return box(name, frame, (x + first[0], y + first[1], z + b), (x + second[0], y + second[1], z + d))

    w, t, half = wide / 2, tall / 2, 0.03
    for left in (-w, w - 2 * half):
        bar((left, -t), (left + 2 * half, t), "Window frame")
    for bottom in (-t, t - 2 * half):
        bar((-w, bottom), (w, bottom + 2 * half), "Window frame")
    for number in range(1, bars[0]):
        at = -w + wide * number / bars[0]
        bar((at - 0.015, -t), (at + 0.015, t))
    for number in range(1, bars[1]):
        at = -t + tall * number / bars[1]
        bar((-w, at - 0.015), (w, at + 0.015))
    if pane is not None:
        corners = [(-w, -t), (w, -t), (w, t), (-w, t)]
        points = [(a, 0, b) if axis == 0 else (0, a, b) for a, b in corners]
        place("Pane", mesh("Pane", points, [(0, 1, 2, 3)]), pane, center)


def vase(material, at, height=0.3, wide=0.08, around=32):
    """A bellied vase with a wall of some thickness."""
    outer = [(wide * (0.55 + 0.45 * sin(pi * (0.15 + 0.75 * t))), height * t) for t in np.linspace(0, 1, 12)]
    outer = [(0.001, 0), *outer]
    inner = [(max(0.004, r - 0.006), max(0.01, z)) for r, z in reversed(outer[1:])]
    return turned("Vase", material, outer + [*inner, (0.001, 0.01)], at, around)


def plant(pot, leaf, at, leaves=40, tall=0.7, seed=1):
    """A pot with long arching leaves; one leaf's mesh serves them all."""
    turned("Pot", pot, [(0.001, 0), (0.13, 0), (0.17, 0.3), (0.15, 0.3), (0.14, 0.26), (0.001, 0.26)], at)
    points, faces = [], []
    for step in range(7):
        t = step / 6
        half = 0.045 * sin(pi * (0.08 + 0.9 * t))
        out, up = 0.55 * tall * t**1.4, tall * (t - 0.45 * t**3)
        points += [(-half, out, up), (half, out, up)]
    for step in range(6):
        faces.append((2 * step, 2 * step + 1, 2 * step + 3, 2 * step + 2))
    blade = mesh("Blade", points, faces, smooth=True)
    chance = np.random.default_rng(seed)
    for number in range(leaves):
        size = float(chance.uniform(0.6, 1.1))
        x, y, z = at
        thing = place("Blade", blade, leaf, (x, y, z + 0.25), (float(chance.uniform(-25, 10)), 0, 137.5 * number))
        thing.scale = (size, size, size)


def lamp_data(name, color, energy, radius=0.05):
    """A bulb."""
    return light_data("POINT", name, color, energy, shadow_soft_size=radius)
