# SPDX-License-Identifier: GPL-3.0-or-later
"""A living room lit by the sun through one window: what the sun does not hit is lit by what it does hit."""

from parts import aim, box, camera, diffuse, glowing, light_data, place, quad, render_settings

WIDTH, DEPTH, HEIGHT = 5.2, 5.4, 2.7  # x from 0, y from 0, z from 0
SILL, LINTEL = 0.75, 2.35  # the window is in the left wall
WINDOW = (2.3, 4.2)  # from and to along y


def build(scene):
    render_settings(scene, exposure=1.2)
    _shell()
    _furniture()
    _sun_and_sky()
    camera(scene, (4.85, 0.35, 1.5), (1.75, 4.2, 0.95), 22)


def _shell():
    plaster = diffuse("Plaster", (0.78, 0.75, 0.70))
    wood = diffuse("Floor boards", (0.46, 0.25, 0.12))
    box("Floor", wood, (0, 0, -0.2), (WIDTH, DEPTH, 0))
    box("Ceiling", plaster, (-0.2, -0.2, HEIGHT), (WIDTH + 0.2, DEPTH + 0.2, HEIGHT + 0.2))
    box("Back wall", diffuse("Teal wall", (0.62, 0.70, 0.66)), (-0.2, DEPTH, -0.2), (WIDTH + 0.2, DEPTH + 0.2, HEIGHT))
    box("Front wall", plaster, (-0.2, -0.2, -0.2), (WIDTH + 0.2, 0, HEIGHT))
    box("Right wall", plaster, (WIDTH, 0, -0.2), (WIDTH + 0.2, DEPTH, HEIGHT))
    near, far = WINDOW
    box("Window wall, near", plaster, (-0.2, 0, -0.2), (0, near, HEIGHT))
    box("Window wall, far", plaster, (-0.2, far, -0.2), (0, DEPTH, HEIGHT))
    box("Window wall, below", plaster, (-0.2, near, -0.2), (0, far, SILL))
    box("Window wall, above", plaster, (-0.2, near, LINTEL), (0, far, HEIGHT))
    frame = diffuse("Window frame", (0.8, 0.8, 0.78))
    middle = (near + far) / 2
    box("Mullion", frame, (-0.14, middle - 0.03, SILL), (-0.08, middle + 0.03, LINTEL))
    box("Transom", frame, (-0.14, near, 1.75), (-0.08, far, 1.81))
    box("Sill", frame, (-0.2, near - 0.05, SILL - 0.04), (0.15, far + 0.05, SILL), bevel=0.01)
    box("Skirting", frame, (0, DEPTH - 0.02, 0), (WIDTH, DEPTH, 0.1))


def _furniture():
    oak = diffuse("Oak", (0.52, 0.33, 0.18))
    sofa = diffuse("Sofa", (0.75, 0.20, 0.05))
    x, y = 2.0, 4.35
    box("Sofa seat", sofa, (x, y, 0.12), (x + 2.1, y + 0.9, 0.45), bevel=0.05)
    box("Sofa back", sofa, (x, y + 0.68, 0.4), (x + 2.1, y + 0.92, 0.85), bevel=0.06)
    for name, left in (("Sofa arm, left", x - 0.2), ("Sofa arm, right", x + 2.08)):
        box(name, sofa, (left, y, 0.12), (left + 0.22, y + 0.92, 0.62), bevel=0.05)
    cushion = diffuse("Cushion", (0.80, 0.66, 0.30))
    box("Cushion", cushion, (x + 0.12, y + 0.44, 0.46), (x + 0.56, y + 0.62, 0.84), turn=-14, bevel=0.07)

    box("Rug", diffuse("Rug", (0.68, 0.38, 0.24)), (1.1, 2.3, 0), (3.9, 4.2, 0.015))
    box("Table top", oak, (1.9, 2.9, 0.38), (3.1, 3.55, 0.42), bevel=0.01)
    for leg in ((1.96, 2.96), (2.99, 2.96), (1.96, 3.44), (2.99, 3.44)):
        box("Table leg", oak, (*leg, 0.01), (leg[0] + 0.05, leg[1] + 0.05, 0.38))
    box("Book", diffuse("Blue book", (0.06, 0.16, 0.45)), (2.2, 3.1, 0.42), (2.42, 3.4, 0.46), turn=20)
    box("Bowl stand", diffuse("White china", (0.8, 0.8, 0.78)), (2.65, 3.15, 0.42), (2.85, 3.35, 0.55), bevel=0.04)

    # Shelf on the back wall, left of the sofa: its boards shade one another, its books are lit by the bounce alone.
    colors = [(0.55, 0.08, 0.06), (0.07, 0.22, 0.42), (0.75, 0.58, 0.16), (0.12, 0.34, 0.16), (0.7, 0.66, 0.58)]
    covers = [diffuse(f"Cover {i + 1}", color) for i, color in enumerate(colors)]
    for board in range(5):
        height = 0.12 + 0.42 * board
        box("Shelf board", oak, (0.35, DEPTH - 0.32, height), (1.35, DEPTH - 0.02, height + 0.03))
        left = 0.40
        for book in range(0 if board == 4 else 9 - 2 * (board % 2)):
            thick, tall = 0.04 + 0.013 * ((book * 7 + board * 3) % 5), 0.22 + 0.03 * ((book * 5 + board) % 4)
            box(
                "Book",
                covers[(book * 3 + board) % 5],
                (left, DEPTH - 0.27, height + 0.03),
                (left + thick, DEPTH - 0.05, height + 0.03 + tall),
            )
            left += thick + 0.008
    for side in (0.32, 1.35):
        box("Shelf side", oak, (side, DEPTH - 0.32, 0), (side + 0.03, DEPTH - 0.02, 1.85))
    picture = diffuse("Picture", (0.10, 0.30, 0.42))
    box("Picture frame", oak, (2.45, DEPTH - 0.03, 1.2), (3.75, DEPTH, 2.05))
    box("Picture", picture, (2.52, DEPTH - 0.04, 1.27), (3.68, DEPTH - 0.01, 1.98))


def _sun_and_sky():
    sun = light_data("SUN", "Sun", (1, 0.93, 0.82), 14, angle=0.0093)
    place("Sun", sun, None, (-3, 3, 4), aim((0, 0, 0), (1, 0.13, -0.74)))
    near, far = WINDOW
    # EEVEE's world light would come through the walls, so half of the sky is a light in the window
    # and half a shining plane behind it.
    sky = light_data(
        "AREA", "Sky in the window", (0.62, 0.80, 1), 14, shape="RECTANGLE", size=far - near, size_y=LINTEL - SILL
    )
    place("Sky in the window", sky, None, (-0.05, (near + far) / 2, (SILL + LINTEL) / 2), aim((0, 0, 0), (1, 0, 0)))
    plane = quad("Sky", glowing("Sky", (0.62, 0.80, 1), 1.5), [(-3, 0, -1), (-3, 9, -1), (-3, 9, 5), (-3, 0, 5)])
    plane.visible_shadow = False
