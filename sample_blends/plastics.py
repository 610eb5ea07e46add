# SPDX-License-Identifier: GPL-3.0-or-later
"""Balls and blocks of plastic and metal on a table before two walls, as smooth as roughness 0.1 and as dull as 0.8,
under a grey sky that the walls cover half of."""

from parts import aim, ball, box, camera, diffuse, glossy, light_data, place, render_settings, sky

COLORS = (0.60, 0.06, 0.05), (0.62, 0.38, 0.05), (0.08, 0.35, 0.10), (0.05, 0.18, 0.50), (0.35, 0.10, 0.40)
ROUGH = 0.1, 0.2, 0.35, 0.55, 0.8


def build(scene):
    render_settings(scene, exposure=0.2)
    sky(scene, (0.75, 0.85, 1.0), 0.25)
    box("Table", diffuse("Table", (0.62, 0.58, 0.52)), (-1.6, -0.9, -0.1), (1.6, 1.1, 0))
    box("Back wall", diffuse("Back wall", (0.72, 0.55, 0.35)), (-1.6, 1.1, -0.1), (1.6, 1.2, 1.7))
    box("Left wall", diffuse("Left wall", (0.25, 0.45, 0.65)), (-1.7, -0.9, -0.1), (-1.6, 1.2, 1.7))
    for index, (color, rough) in enumerate(zip(COLORS, ROUGH)):
        across = -1.05 + 0.52 * index
        ball(f"Ball {rough}", glossy(f"Plastic {rough}", color, rough), (across, 0.05, 0.2), 0.2)
        ball(
            f"Metal ball {rough}",
            glossy(f"Metal {rough}", (0.80, 0.77, 0.70), rough, metallic=1),
            (across + 0.2, 0.62, 0.22),
            0.22,
        )
        box(
            f"Block {rough}",
            glossy(f"Block {rough}", COLORS[index - 2], rough),
            (across - 0.12, -0.55, 0),
            (across + 0.12, -0.35, 0.16),
            turn=15 * index,
            bevel=0.02,
        )
    lamp = light_data("AREA", "Lamp", (1, 0.9, 0.76), 40, shape="DISK", size=0.5)
    place("Lamp", lamp, None, (0.9, -0.7, 1.9), aim((0.9, -0.7, 1.9), (0, 0.2, 0)))
    camera(scene, (0.45, -2.35, 1.05), (0.05, 0.25, 0.2), 34)
