# SPDX-License-Identifier: GPL-3.0-or-later
"""A bin of brushed metal in the corner of a coloured room, before a satin plate: what they show is light off the
walls."""

from parts import aim, box, camera, diffuse, glossy, light_data, place, quad, render_settings, turned

WIDTH, DEPTH, HEIGHT = 3.2, 3.0, 2.4


def build(scene):
    render_settings(scene, exposure=0.5)
    _room()
    brushed = glossy("Brushed steel", (0.62, 0.61, 0.59), 0.3, metallic=1)
    turned(
        "Bin", brushed, [(0, 0.03), (0.27, 0.03), (0.33, 0.78), (0.315, 0.78), (0.26, 0.05), (0, 0.05)], (-0.25, 1.7, 0)
    )
    turned(
        "Bin rim",
        glossy("Polished rim", (0.75, 0.74, 0.72), 0.15, metallic=1),
        [(0.305, 0.77), (0.345, 0.77), (0.345, 0.81), (0.305, 0.81), (0.305, 0.77)],
        (-0.25, 1.7, 0),
    )
    box(
        "Plate",
        glossy("Satin copper", (0.83, 0.48, 0.34), 0.2, metallic=1),
        (0.45, 2.0, 0),
        (1.25, 2.03, 1.1),
        turn=-18,
    )
    box(
        "Block",
        glossy("Cast iron", (0.45, 0.45, 0.47), 0.6, metallic=1),
        (0.55, 1.0, 0),
        (0.95, 1.4, 0.4),
        turn=25,
        bevel=0.02,
    )
    box("Crate", diffuse("Crate", (0.55, 0.36, 0.16)), (-1.35, 1.1, 0), (-0.85, 1.6, 0.5), turn=12, bevel=0.01)
    lamp = light_data("AREA", "Lamp", (1, 0.86, 0.68), 45, shape="RECTANGLE", size=0.8, size_y=0.5)
    place("Lamp", lamp, None, (0.2, 1.4, HEIGHT - 0.02), aim((0, 0, 1), (0, 0, 0)))
    camera(scene, (0, -1.35, 1.25), (0, 2.0, 0.55), 26)


def _room():
    x, y, z = WIDTH / 2, DEPTH, HEIGHT
    white, tiles = diffuse("White", (0.75, 0.74, 0.71)), diffuse("Tiles", (0.42, 0.40, 0.37))
    red, blue = diffuse("Red", (0.62, 0.10, 0.07)), diffuse("Blue", (0.10, 0.22, 0.52))
    front = -1.5
    quad("Floor", tiles, [(-x, front, 0), (x, front, 0), (x, y, 0), (-x, y, 0)])
    quad("Ceiling", white, [(-x, front, z), (-x, y, z), (x, y, z), (x, front, z)])
    quad("Back wall", white, [(-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z)])
    quad("Front wall", white, [(-x, front, 0), (-x, front, z), (x, front, z), (x, front, 0)])
    quad("Red wall", red, [(-x, front, 0), (-x, y, 0), (-x, y, z), (-x, front, z)])
    quad("Blue wall", blue, [(x, front, 0), (x, front, z), (x, y, z), (x, y, 0)])
