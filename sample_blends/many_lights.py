# SPDX-License-Identifier: GPL-3.0-or-later
"""A hall of sixteen pillars, each wound with 16 small lanterns: 256 point lights, 16 light datablocks."""

from colorsys import hsv_to_rgb
from math import cos, pi, sin

import numpy as np

from parts import box, camera, diffuse, glowing, light_data, mesh, place, render_settings

PILLARS, LANTERNS = 16, 16
AISLE, SPACING = 1.9, 2.3  # pillars stand at x = -AISLE and +AISLE, SPACING apart along y
HALF_WIDTH, LENGTH, HEIGHT = 3.6, 19.5, 4.4
RADIUS, WINDING = 0.32, 0.45  # of a pillar, and of the lanterns around it


def build(scene):
    render_settings(scene, exposure=0.3)
    # So many dim lights add up to half of the light where each of them has ended for EEVEE's default of 0.01.
    scene.eevee.light_threshold = 0.0001
    _hall()
    pillar = _pillar_mesh()
    stone = diffuse("Pillar stone", (0.74, 0.72, 0.68))
    bulbs = _bulb_points()
    for number in range(PILLARS):
        side, row = 2 * (number % 2) - 1, number // 2
        foot = (side * AISLE, 1.2 + row * SPACING, 0)
        place("Pillar", pillar, stone, foot)
        box(
            "Pillar foot",
            stone,
            (foot[0] - 0.45, foot[1] - 0.45, 0),
            (foot[0] + 0.45, foot[1] + 0.45, 0.18),
            bevel=0.02,
        )
        box(
            "Pillar head",
            stone,
            (foot[0] - 0.45, foot[1] - 0.45, HEIGHT - 0.3),
            (foot[0] + 0.45, foot[1] + 0.45, HEIGHT),
            bevel=0.02,
        )
        _lanterns(number, side, row, foot, bulbs)
    _objects()
    camera(scene, (0.55, -2.6, 1.75), (-0.25, 8, 1.75), 24)


def _hall():
    wall = diffuse("Hall wall", (0.66, 0.64, 0.62))
    x, y, z = HALF_WIDTH, LENGTH, HEIGHT
    box("Floor", diffuse("Hall floor", (0.52, 0.50, 0.48)), (-x, -4, -0.2), (x, y, 0))
    box("Ceiling", wall, (-x, -4, z), (x, y, z + 0.2))
    box("Left wall", wall, (-x - 0.2, -4, 0), (-x, y, z))
    box("Right wall", wall, (x, -4, 0), (x + 0.2, y, z))
    box("End wall", wall, (-x, y, 0), (x, y + 0.2, z))


def _pillar_mesh(segments=32):
    """A round pillar that swells a little at its middle."""
    rings = [(z, RADIUS * (1 + 0.08 * sin(pi * z / HEIGHT))) for z in np.linspace(0, HEIGHT, 13)]
    turns = [2 * pi * k / segments for k in range(segments)]
    points = [(r * cos(a), r * sin(a), z) for z, r in rings for a in turns]
    return mesh("Pillar", points, _ring_faces(len(rings), segments), smooth=True)


def _ring_faces(rings, segments):
    return [
        (
            ring * segments + k,
            ring * segments + (k + 1) % segments,
            (ring + 1) * segments + (k + 1) % segments,
            (ring + 1) * segments + k,
        )
        for ring in range(rings - 1)
        for k in range(segments)
    ]


def _bulb_points():
    """Places of a pillar's lanterns: three turns of a helix."""
    steps = np.arange(LANTERNS) / LANTERNS
    angles = 2 * pi * (3 * steps + 0.13)
    return np.stack([WINDING * np.cos(angles), WINDING * np.sin(angles), 0.45 + 3.4 * steps], axis=1)


def _lanterns(number, side, row, foot, points):
    """The lights of one pillar share one datablock; warm colours go down the left row, cold ones down the right."""
    hue = (0.98 + 0.022 * row) % 1 if side < 0 else 0.48 + 0.04 * row
    color = hsv_to_rgb(hue, 0.85, 1)
    # Without shadows: 256 point lights are 1536 shadow maps, which no software GPU draws in reasonable time.
    light = light_data("POINT", f"Lantern {number + 1}", color, 5.2, shadow_soft_size=0.04, use_shadow=False)
    for point in points:
        place("Lantern", light, None, np.add(foot, point))
    place("Bulbs", _octahedra(f"Bulbs {number + 1}", points, 0.028), glowing(f"Bulb {number + 1}", color, 6), foot)


def _octahedra(name, centres, radius):
    corners = radius * np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
    sides = [(k, (k + 1) % 4, 4) for k in range(4)] + [((k + 1) % 4, k, 5) for k in range(4)]
    points = (centres[:, None, :] + corners).reshape(-1, 3)
    return mesh(name, points, [tuple(6 * i + k for k in face) for i in range(len(centres)) for face in sides])


def _objects():
    """Plinths between the pillars, with white shapes that take on the colours around them."""
    chalk = diffuse("Chalk", (0.80, 0.79, 0.77))
    ball = _ball(24)
    for row in range(4):
        for side in (-1, 1):
            x, y = side * 1.75, 1.2 + (2 * row + 0.5) * SPACING
            box("Plinth", chalk, (x - 0.3, y - 0.3, 0), (x + 0.3, y + 0.3, 0.8), turn=15 * row, bevel=0.02)
            if (row + (side > 0)) % 2:
                place("Ball", ball, chalk, (x, y, 1.1))
            else:
                box("Cube", chalk, (x - 0.22, y - 0.22, 0.8), (x + 0.22, y + 0.22, 1.24), turn=30, bevel=0.02)


def _ball(segments, radius=0.3):
    rings = segments // 2
    polar = [pi * (k + 0.02) / (rings - 0.96) - 0.002 for k in range(rings)]
    turns = [2 * pi * k / segments for k in range(segments)]
    points = [(radius * sin(p) * cos(a), radius * sin(p) * sin(a), -radius * cos(p)) for p in polar for a in turns]
    return mesh("Ball", points, _ring_faces(rings, segments), smooth=True)
