# SPDX-License-Identifier: GPL-3.0-or-later
"""Five rooms of a flat, seen from one of them: light goes from room to room through the doors."""

from parts import aim, box, camera, diffuse, glowing, light_data, place, quad, render_settings, wall

HEIGHT, DOOR = 2.6, 2.05
WIDTH, DEPTH = 10.2, 8.2  # x and y from 0; the hall lies from x = 5.1 to 6.6
WARM, COLD, LAMP = (1, 0.72, 0.45), (0.80, 0.90, 1), (1, 0.84, 0.62)


def build(scene):
    render_settings(scene, exposure=0.8)
    _rooms()
    _living_room()
    _bedroom()
    _kitchen_and_bath()
    _lamps()
    camera(scene, (0.45, 0.35, 1.55), (4.6, 4.9, 1.15), 20)


def _rooms():
    white = diffuse("Wall", (0.78, 0.76, 0.72))
    boards = diffuse("Boards", (0.42, 0.27, 0.15))
    box("Floor", boards, (0, 0, -0.2), (WIDTH, DEPTH, 0))
    box("Ceiling", white, (0, 0, HEIGHT), (WIDTH, DEPTH, HEIGHT + 0.2))
    for name, start, end in (
        ("South wall", (0, 0), (WIDTH, 0)),
        ("North wall", (0, DEPTH), (WIDTH, DEPTH)),
        ("West wall", (0, 0), (0, DEPTH)),
        ("East wall", (WIDTH, 0), (WIDTH, DEPTH)),
    ):
        wall(name, white, start, end, HEIGHT, thick=0.2)
    wall("Living room wall", white, (5.1, 0), (5.1, DEPTH), HEIGHT, [(2.7, 4.0, 0, DOOR)])
    wall(
        "Bedroom wall", diffuse("Ochre wall", (0.74, 0.50, 0.22)), (0, 4.6), (5.05, 4.6), HEIGHT, [(2.4, 3.4, 0, DOOR)]
    )
    wall(
        "Hall wall",
        diffuse("Green wall", (0.36, 0.55, 0.36)),
        (6.6, 0),
        (6.6, DEPTH),
        HEIGHT,
        [(2.4, 3.3, 0, DOOR), (5.6, 6.5, 0, DOOR)],
    )
    wall("Bath wall", white, (6.65, 4.4), (WIDTH, 4.4), HEIGHT)
    leaf = diffuse("Door", (0.66, 0.63, 0.58))
    box("Bedroom door", leaf, (2.42, 4.65, 0.01), (2.46, 5.55, 2.03))
    box("Kitchen door", leaf, (6.68, 2.30, 0.01), (7.50, 2.34, 2.03), turn=8)


def _living_room():
    cloth = diffuse("Sofa", (0.10, 0.22, 0.45))
    oak = diffuse("Oak", (0.52, 0.33, 0.18))
    box("Sofa seat", cloth, (2.5, 0.35, 0.1), (4.6, 1.25, 0.45), bevel=0.05)
    box("Sofa back", cloth, (2.5, 0.2, 0.4), (4.6, 0.45, 0.85), bevel=0.05)
    box("Rug", diffuse("Rug", (0.62, 0.16, 0.10)), (1.6, 1.6, 0), (4.2, 3.4, 0.015))
    box("Table", oak, (2.5, 2.1, 0.36), (3.6, 2.8, 0.40), bevel=0.01)
    for leg in ((2.55, 2.15), (3.5, 2.15), (2.55, 2.7), (3.5, 2.7)):
        box("Table leg", oak, (*leg, 0), (leg[0] + 0.05, leg[1] + 0.05, 0.36))
    box("Sideboard", oak, (0.2, 4.1, 0.1), (2.0, 4.52, 0.75), bevel=0.01)
    for number, (left, tall) in enumerate(((0.3, 0.25), (0.55, 0.4), (1.5, 0.18))):
        box(
            "Vase",
            diffuse(f"Vase {number + 1}", ((0.7, 0.68, 0.6), (0.1, 0.3, 0.3), (0.65, 0.3, 0.1))[number]),
            (left, 4.2, 0.75),
            (left + 0.16, 4.36, 0.75 + tall),
            turn=20 * number,
            bevel=0.03,
        )
    box("Picture", diffuse("Picture", (0.5, 0.1, 0.12)), (0.4, 4.53, 1.25), (1.7, 4.56, 2.0))


def _bedroom():
    linen = diffuse("Linen", (0.80, 0.79, 0.76))
    box("Bed", diffuse("Bed frame", (0.35, 0.22, 0.13)), (0.15, 6.1, 0), (2.2, 7.9, 0.3))
    box("Mattress", linen, (0.2, 6.15, 0.3), (2.15, 7.85, 0.52), bevel=0.06)
    box("Blanket", diffuse("Blanket", (0.20, 0.34, 0.55)), (0.9, 6.1, 0.42), (2.2, 7.9, 0.56), bevel=0.04)
    box("Wardrobe", diffuse("Wardrobe", (0.60, 0.55, 0.48)), (3.9, 7.4, 0), (5.0, 8.05, 2.1), bevel=0.01)
    box("Chest", diffuse("Chest", (0.48, 0.30, 0.17)), (2.7, 7.6, 0), (3.7, 8.05, 0.8), bevel=0.01)


def _kitchen_and_bath():
    front = diffuse("Kitchen front", (0.70, 0.24, 0.12))
    top = diffuse("Worktop", (0.30, 0.29, 0.27))
    box("Kitchen units", front, (9.5, 0.1, 0.1), (10.1, 4.2, 0.86), bevel=0.01)
    box("Worktop", top, (9.45, 0.1, 0.86), (10.1, 4.2, 0.90))
    box("Wall units", front, (9.75, 0.1, 1.45), (10.1, 4.2, 2.15), bevel=0.01)
    box("Kitchen table", diffuse("Kitchen table", (0.68, 0.62, 0.50)), (7.5, 0.6, 0.70), (8.6, 1.6, 0.74))
    box("Table foot", top, (7.95, 1.0, 0), (8.15, 1.2, 0.70))
    tiles = diffuse("Tiles", (0.45, 0.62, 0.66))
    box("Tiled wall", tiles, (WIDTH - 0.13, 4.45, 0), (WIDTH - 0.1, DEPTH - 0.1, 1.8))
    box("Bath tub", diffuse("Enamel", (0.82, 0.82, 0.80)), (8.2, 7.2, 0), (10.0, 8.05, 0.55), bevel=0.05)


def _lamps():
    down = aim((0, 0, 1), (0, 0, 0))
    for name, color, power, at, size in (
        ("Kitchen lamp", COLD, 70, (8.4, 2.2), 0.8),
        ("Bath lamp", COLD, 40, (8.4, 6.2), 0.5),
    ):
        data = light_data("AREA", name, color, power, shape="SQUARE", size=size)
        place(name, data, None, (*at, HEIGHT - 0.06), down)
        side, z = size / 2, HEIGHT - 0.05
        quad(
            f"{name} panel",
            glowing(f"{name} panel", color, 3),
            [
                (at[0] - side, at[1] - side, z),
                (at[0] - side, at[1] + side, z),
                (at[0] + side, at[1] + side, z),
                (at[0] + side, at[1] - side, z),
            ],
        )
    place("Floor lamp", light_data("POINT", "Floor lamp", LAMP, 45, shadow_soft_size=0.1), None, (4.6, 4.1, 1.5))
    shade = diffuse("Lamp foot", (0.12, 0.12, 0.12))
    box("Lamp pole", shade, (4.585, 4.085, 0), (4.615, 4.115, 1.3))
    place(
        "Bedside lamp", light_data("POINT", "Bedside lamp", WARM, 40, shadow_soft_size=0.08), None, (2.45, 7.75, 0.95)
    )
