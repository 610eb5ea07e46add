# SPDX-License-Identifier: GPL-3.0-or-later
"""A hall with a floor of polished stone: pillars, a bench and a glowing doorway stand on their reflections."""

from parts import aim, box, camera, diffuse, glossy, glowing, light_data, place, render_settings

WIDTH, DEPTH, HEIGHT = 7.0, 12.0, 3.4


def build(scene):
    render_settings(scene, exposure=0.6)
    stone = glossy("Polished stone", (0.10, 0.09, 0.085), 0.12)
    stone.node_tree.nodes["Principled BSDF"].inputs["IOR"].default_value = 1.9
    white, ochre = diffuse("Plaster", (0.76, 0.73, 0.67)), diffuse("Ochre", (0.68, 0.42, 0.15))
    x = WIDTH / 2
    box("Floor", stone, (-x, -1, -0.2), (x, DEPTH, 0))
    box("Ceiling", white, (-x, -1, HEIGHT), (x, DEPTH, HEIGHT + 0.2))
    box("Left wall", ochre, (-x - 0.2, -1, 0), (-x, DEPTH, HEIGHT))
    box("Right wall", white, (x, -1, 0), (x + 0.2, DEPTH, HEIGHT))
    box("End wall", white, (-x, DEPTH, 0), (x, DEPTH + 0.2, HEIGHT))
    box("Near wall", white, (-x, -1.2, 0), (x, -1, HEIGHT))
    teal = diffuse("Teal", (0.08, 0.36, 0.36))
    for row in range(3):
        for side in (-1, 1):
            box(
                "Pillar",
                teal if side < 0 else white,
                (side * 2.2 - 0.2, 3.2 + 3 * row, 0),
                (side * 2.2 + 0.2, 3.6 + 3 * row, HEIGHT),
            )
    box("Bench", glossy("Lacquer", (0.55, 0.05, 0.05), 0.25), (0.6, 4.2, 0.38), (1.9, 4.65, 0.44), bevel=0.01)
    for left in (0.7, 1.72):
        box("Bench leg", diffuse("Leg", (0.05, 0.05, 0.05)), (left, 4.28, 0), (left + 0.08, 4.58, 0.38))
    box("Doorway", glowing("Doorway", (0.65, 0.82, 1), 4), (-0.6, DEPTH - 0.05, 0.02), (0.6, DEPTH - 0.02, 2.2))
    for place_of in ((-0.6, 3.4), (0.6, 8.0)):
        lamp = light_data("AREA", "Ceiling light", (1, 0.84, 0.62), 110, shape="RECTANGLE", size=1.4, size_y=0.5)
        place("Ceiling light", lamp, None, (*place_of, HEIGHT - 0.02), aim((0, 0, 1), (0, 0, 0)))
    camera(scene, (-0.4, -0.6, 1.5), (0.2, 7, 0.7), 22)
