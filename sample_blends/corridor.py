# SPDX-License-Identifier: GPL-3.0-or-later
"""A dim corridor, lit through a side door from a room that the camera does not see."""

from parts import aim, box, camera, diffuse, light_data, place, render_settings, wall

LENGTH, WIDTH, HEIGHT = 12.0, 1.8, 2.6  # along y, across x, both from 0
DOOR = (6.6, 7.7)  # along y, in the right wall
ROOM = 4.4  # the lit room reaches from x = WIDTH to WIDTH + ROOM


def build(scene):
    render_settings(scene, exposure=2.6)
    _corridor()
    _lit_room()
    _things()
    camera(scene, (0.75, 0.5, 1.5), (0.95, 9, 1.15), 24)


def _corridor():
    paint = diffuse("Paint", (0.72, 0.70, 0.64))
    lino = diffuse("Linoleum", (0.30, 0.20, 0.14))
    box("Corridor floor", lino, (-0.2, -0.2, -0.2), (WIDTH, LENGTH + 0.2, 0))
    box("Corridor ceiling", paint, (-0.2, -0.2, HEIGHT), (WIDTH, LENGTH + 0.2, HEIGHT + 0.2))
    wall("Left wall", paint, (-0.1, -0.2), (-0.1, LENGTH + 0.2), HEIGHT, thick=0.2)
    wall("Near wall", paint, (0, -0.1), (WIDTH, -0.1), HEIGHT, thick=0.2)
    wall(
        "Far wall", diffuse("Far wall", (0.30, 0.45, 0.55)), (0, LENGTH + 0.1), (WIDTH, LENGTH + 0.1), HEIGHT, thick=0.2
    )
    wall(
        "Right wall",
        paint,
        (WIDTH + 0.06, -0.2),
        (WIDTH + 0.06, LENGTH + 0.2),
        HEIGHT,
        [(DOOR[0] + 0.2, DOOR[1] + 0.2, 0, 2.1)],
        thick=0.12,
    )
    rail = diffuse("Rail", (0.35, 0.20, 0.10))
    box("Rail, left", rail, (0, 0, 0.9), (0.02, LENGTH, 1.02))
    for name, low, high in (("Rail, near", 0, DOOR[0] - 0.1), ("Rail, far", DOOR[1] + 0.1, LENGTH)):
        box(name, rail, (WIDTH - 0.02, low, 0.9), (WIDTH, high, 1.02))
    leaf = diffuse("Closed door", (0.42, 0.34, 0.26))
    for y in (2.2, 9.6):
        box("Closed door", leaf, (0, y, 0), (0.04, y + 0.95, 2.08), bevel=0.005)
    box("Closed door", leaf, (WIDTH - 0.04, 2.6, 0), (WIDTH, 3.55, 2.08), bevel=0.005)


def _lit_room():
    left, near, far = WIDTH + 0.12, 5.0, 9.4
    right = left + ROOM
    plaster = diffuse("Warm plaster", (0.80, 0.68, 0.50))
    box("Room floor", diffuse("Carpet", (0.50, 0.14, 0.10)), (WIDTH, near - 0.2, -0.2), (right + 0.2, far + 0.2, 0))
    box("Room ceiling", plaster, (WIDTH, near - 0.2, HEIGHT), (right + 0.2, far + 0.2, HEIGHT + 0.2))
    wall("Room, near wall", plaster, (left, near - 0.1), (right + 0.2, near - 0.1), HEIGHT, thick=0.2)
    wall("Room, far wall", plaster, (left, far + 0.1), (right + 0.2, far + 0.1), HEIGHT, thick=0.2)
    wall("Room, right wall", plaster, (right + 0.1, near), (right + 0.1, far), HEIGHT, thick=0.2)
    box("Cupboard", diffuse("Cupboard", (0.40, 0.26, 0.15)), (right - 0.5, 5.4, 0), (right, 7.0, 1.9), bevel=0.01)
    box("Room table", diffuse("Room table", (0.62, 0.52, 0.40)), (3.4, 7.4, 0.72), (5.0, 8.4, 0.76))
    for leg in ((3.45, 7.45), (4.9, 7.45), (3.45, 8.3), (4.9, 8.3)):
        box("Room table leg", diffuse("Leg", (0.2, 0.2, 0.2)), (*leg, 0), (leg[0] + 0.05, leg[1] + 0.05, 0.72))
    lamp = light_data("AREA", "Room lamp", (1, 0.80, 0.55), 160, shape="RECTANGLE", size=1.4, size_y=0.5)
    place("Room lamp", lamp, None, (3.9, 6.6, HEIGHT - 0.1), aim((0, 0, 1), (0, 0, 0)))


def _things():
    box(
        "Open door",
        diffuse("Open door", (0.66, 0.60, 0.50)),
        (WIDTH + 0.14, DOOR[1] + 0.02, 0.01),
        (WIDTH + 1.1, DOOR[1] + 0.06, 2.07),
    )
    wood = diffuse("Bench wood", (0.50, 0.32, 0.18))
    box("Bench", wood, (0.02, 5.2, 0.40), (0.42, 6.7, 0.45), bevel=0.01)
    for y in (5.3, 6.5):
        box("Bench leg", wood, (0.08, y, 0), (0.36, y + 0.08, 0.40))
    box("Box", diffuse("Cardboard", (0.55, 0.40, 0.25)), (1.2, 4.3, 0), (1.65, 4.8, 0.4), turn=18)
    box("Small box", diffuse("Small box", (0.20, 0.35, 0.55)), (1.25, 4.35, 0.4), (1.5, 4.65, 0.58), turn=-12)
    pot = diffuse("Pot", (0.60, 0.25, 0.14))
    box("Pot", pot, (0.15, 8.4, 0), (0.5, 8.75, 0.4), bevel=0.05)
    leaves = diffuse("Leaves", (0.10, 0.32, 0.08))
    for number in range(9):
        box(
            "Leaf",
            leaves,
            (0.30, 8.45 + 0.02 * number, 0.42 + 0.06 * number),
            (0.34, 8.70, 0.50 + 0.09 * number),
            turn=40 * number,
        )
