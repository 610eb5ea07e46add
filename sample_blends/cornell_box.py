# SPDX-License-Identifier: GPL-3.0-or-later
"""The Cornell box: red and green walls, two white blocks, one light in the ceiling.

Widened from the classic's square to 16:9, so that all of every wall that bounces light is in the frame."""

from parts import aim, box, camera, diffuse, glowing, light_data, place, quad, render_settings

WIDTH, DEPTH, HEIGHT = 4.9, 3.0, 2.75


def build(scene):
    render_settings(scene, transform="Standard", look="None")
    white = diffuse("White", (0.73, 0.73, 0.70))
    red = diffuse("Red", (0.63, 0.05, 0.04))
    green = diffuse("Green", (0.12, 0.45, 0.09))

    x, y, z = WIDTH / 2, DEPTH, HEIGHT
    quad("Floor", white, [(-x, 0, 0), (x, 0, 0), (x, y, 0), (-x, y, 0)])
    quad("Ceiling", white, [(-x, 0, z), (-x, y, z), (x, y, z), (x, 0, z)])
    quad("Back wall", white, [(-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z)])
    quad("Red wall", red, [(-x, 0, 0), (-x, y, 0), (-x, y, z), (-x, 0, z)])
    quad("Green wall", green, [(x, 0, 0), (x, 0, z), (x, y, z), (x, y, 0)])
    box("Tall block", white, (-1.62, 1.45, 0), (-0.77, 2.3, 1.65), turn=-24)
    box("Short block", white, (0.72, 0.75, 0), (1.57, 1.6, 0.85), turn=22)

    lamp = light_data("AREA", "Ceiling light", (1, 0.85, 0.65), 52, shape="RECTANGLE", size=1.2, size_y=0.9)
    place("Ceiling light", lamp, None, (0, 1.5, z - 0.012), aim((0, 0, 1), (0, 0, 0)))
    # Area lights do not show in EEVEE; this panel is what the eye sees of it, far dimmer than the light itself.
    panel = [(-0.6, 1.05, z - 0.01), (-0.6, 1.95, z - 0.01), (0.6, 1.95, z - 0.01), (0.6, 1.05, z - 0.01)]
    quad("Light panel", glowing("Light panel", (1, 0.85, 0.65), 3), panel)

    camera(scene, (0, -3.27, HEIGHT / 2), (0, DEPTH, HEIGHT / 2), 24)
