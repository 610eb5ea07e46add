# SPDX-License-Identifier: GPL-3.0-or-later
"""A vaulted bazaar of carpets and pots: over 500 objects and 30 pictures of 2048 x 2048, in shafts of sun.

Hard by its size: every view draws hundreds of objects, and colours change from one carpet to the next. The pictures
are flat patterns, kept as PNG: they are 500 MB in memory and some hundred kilobytes in the file."""

from math import cos, pi, sin

import bpy
import numpy as np

import textures
from parts import aim, box, camera, glossy, glowing, light_data, mesh, place, render_settings, turned
from procedural import sky_for_the_camera, sky_panel

SIZE, PICTURES = 2048, 30
HALF, DEPTH, HEIGHT = 4.2, 19.0, 5.0  # the hall lies from y = 0, x about 0
DYES = np.array(
    [
        (0.55, 0.08, 0.07),
        (0.10, 0.16, 0.38),
        (0.86, 0.76, 0.58),
        (0.76, 0.44, 0.12),
        (0.10, 0.32, 0.28),
        (0.26, 0.12, 0.10),
        (0.48, 0.56, 0.62),
        (0.68, 0.26, 0.30),
    ]
)


def build(scene):
    render_settings(scene, exposure=0.9)
    scene.eevee.taa_render_samples = 16
    cloths = [textures.material(f"Carpet {n + 1}", _kilim(n), 1.0, maps=False, kind="PNG") for n in range(PICTURES - 4)]
    tiles = [textures.material(f"Tiles {n + 1}", _zellige(n), 1.6, maps=False, kind="PNG") for n in range(4)]
    for shader in (tile.node_tree.nodes["Principled BSDF"] for tile in tiles):
        shader.inputs["Roughness"].default_value = 0.3
    chance = np.random.default_rng(5)
    sky_for_the_camera(scene, (0.55, 0.74, 1), 3)
    _hall(tiles)
    _hangings(cloths)
    _stacks(cloths, chance)
    _pots(chance)
    _lanterns()
    sun = light_data("SUN", "Sun", (1, 0.85, 0.64), 30, angle=0.01)
    place("Sun", sun, None, (0, 0, 20), aim((0, 0, 0), (-0.30, 0.34, -1)))
    for y in (5.0, 9.8, 14.6):
        sky_panel("Skylight", (0.72, 0.85, 1), 130, (1.6, 1.2), (0, y, HEIGHT + 0.6))
    camera(scene, (0.7, 0.6, 1.65), (-0.25, 9, 1.75), 22)
    textures.unwrap(scene)
    _shift(chance)


def _kilim(number):
    """Stepped diamonds, mirrored both ways, within a border: what a loom does. Cells of 32 pixels, and threads."""
    chance, cells = np.random.default_rng(100 + number), 64
    dyes = DYES[chance.permutation(len(DYES))[:5]]
    x, y = np.meshgrid(*[np.abs(np.arange(cells) - cells / 2 + 0.5)] * 2)
    step, tilt = int(chance.integers(5, 12)), float(chance.choice([0.5, 1, 1, 2]))
    ring = np.floor((tilt * x + y) / step).astype(int)
    motif = ((np.floor(x) % step == step // 2) & (np.floor(y) % step >= step // 2)) | ((x + 2 * y) % (2 * step) < 2)
    index = np.where(motif, (ring + 2) % 5, ring % 4)
    edge = np.minimum(cells / 2 - x, cells / 2 - y)
    index = np.where(edge < 7, np.where((np.floor(x + y) % 6 < 3) & (edge > 2), 4, 0), index)
    color = dyes[index] * chance.uniform(0.9, 1.08, (cells, 1, 1))
    return _grown(color, 0.9)


def _zellige(number):
    """Tiles in eightfold stars, of two glazes."""
    cells = 64
    x, y = np.meshgrid(*[np.abs(np.arange(cells) % 16 - 7.5)] * 2)
    star = (np.maximum(x, y) < 4.6) | (x + y < 6.4)
    cross = (np.minimum(x, y) < 1.2) | (np.abs(x - y) < 1.1)
    index = np.where(star, number % 4, np.where(cross, 2, (number + 4) % 8))
    return _grown(DYES[index] * np.random.default_rng(number).uniform(0.9, 1.06, (cells, 1, 1)), 0.3)


def _grown(color, roughness):
    grow = SIZE // len(color)
    picture = np.repeat(np.repeat(np.clip(color, 0, 1), grow, 0), grow, 1)
    picture[::4] *= 0.86  # threads, or the joints of the glaze
    flat = np.full((2, 2), roughness)
    return picture, flat, flat


def _hall(tiles):
    plaster = textures.material("Limewash", textures.plaster(256, 3, (0.84, 0.74, 0.60), 0.3), 2.5, maps=False)
    stone = textures.material("Stone", textures.plaster(256, 5, (0.70, 0.62, 0.50), 0.3), 1.5, maps=False)
    x, z = HALF, HEIGHT
    box("Floor", tiles[0], (-x, -0.5, -0.2), (x, DEPTH, 0))
    box("Left wall", plaster, (-x - 0.3, -0.5, 0), (-x, DEPTH, z))
    box("Right wall", plaster, (x, -0.5, 0), (x + 0.3, DEPTH, z))
    box("End wall", tiles[1], (-x, DEPTH, 0), (x, DEPTH + 0.3, z + 1.5))
    box("Near wall", plaster, (-x, -0.8, 0), (x, -0.5, z + 1.5))
    for left, right in ((-x - 0.3, -0.8), (0.8, x + 0.3)):
        box("Roof", plaster, (left, -0.8, z), (right, DEPTH + 0.3, z + 0.25))
    for low, high in ((-0.8, 4.4), (5.6, 9.2), (10.4, 14.0), (15.2, DEPTH + 0.3)):
        box("Roof", plaster, (-0.8, low, z), (0.8, high, z + 0.25))
    shaft = [(0.16, 0.35), (0.16, 2.7), (0.26, 2.9), (0.26, 3.0)]
    for row in range(8):
        y = 1.6 + 2.4 * row
        for side in (-2.6, 2.6):
            turned("Column", stone, shaft, (side, y, 0), 24)
            box("Base", tiles[2], (side - 0.26, y - 0.26, 0), (side + 0.26, y + 0.26, 0.35), bevel=0.01)
            box("Capital", stone, (side - 0.3, y - 0.3, 3.0), (side + 0.3, y + 0.3, 3.2), bevel=0.01)
            low, high = sorted((side * 0.96, side * 1.62))
            place("Arch", _arch(2.4, 0.3, HEIGHT - 3.2), plaster, (side, y + 1.2, 3.2))
            box(
                "Ledge",
                tiles[3],
                (low if side < 0 else high - 1.3, y - 0.9, 0),
                (low + 1.3 if side < 0 else high, y + 0.9, 0.5),
            )


def _arch(wide, thick, tall, steps=14):
    """A wall along y above a round arch, between two columns."""
    name = "Arch"
    if found := bpy.data.meshes.get(name):
        return found
    points, faces, radius = [], [], wide / 2 - 0.25
    for step in range(steps + 1):
        angle = pi * step / steps
        y, z = -radius * cos(angle), min(radius * sin(angle), tall - 0.1)
        points += [
            (side * thick / 2, at, up)
            for at, up in ((y, z), (y if 0 < step < steps else y * 1.27, tall))
            for side in (-1, 1)
        ]
    for step in range(steps):
        a = 4 * step
        faces += [(a, a + 2, a + 6, a + 4), (a + 1, a + 5, a + 7, a + 3), (a, a + 4, a + 5, a + 1)]
    return mesh(name, points, faces)


def _hangings(cloths):
    """Carpets on the walls, and over ropes between the columns."""
    for row in range(8):
        y = 0.5 + 2.3 * row
        for side in (-1, 1):
            cloth = cloths[(5 * row + 3 * (side > 0)) % len(cloths)]
            x = side * (HALF - 0.03)
            box("Carpet", cloth, (min(x, x - 0.02 * side), y, 0.9), (max(x, x - 0.02 * side), y + 1.6, 3.3))
        for side in (-2.6, 2.6):
            cloth = cloths[(7 * row + 2 * (side > 0) + 1) % len(cloths)]
            box("Runner", cloth, (side - 0.02, y + 1.9, 2.0), (side + 0.02, y + 2.7, 3.15))
    for number, (x, y, turn) in enumerate(((-0.5, 2.6, 8), (0.5, 6.4, -6), (-0.3, 10.5, 4), (0.2, 14.5, -3))):
        box(
            "Carpet on the floor",
            cloths[(9 * number + 4) % len(cloths)],
            (x - 0.8, y - 1.2, 0),
            (x + 0.8, y + 1.2, 0.015),
            turn,
        )


def _stacks(cloths, chance):
    """Folded carpets on the ledges, and rolls that stand beside them."""
    for row in range(8):
        for side in (-1, 1):
            y, z = 1.6 + 2.4 * row, 0.5
            for layer in range(int(chance.integers(6, 11))):
                tall = float(chance.uniform(0.05, 0.09))
                x = side * 3.5 + float(chance.uniform(-0.06, 0.06))
                cloth = cloths[int(chance.integers(len(cloths)))]
                box(
                    "Folded carpet",
                    cloth,
                    (x - 0.42, y - 0.55, z),
                    (x + 0.42, y + 0.15, z + tall),
                    float(chance.uniform(-8, 8)),
                    0.02,
                )
                z += tall
            for number in range(5):
                at = (side * (3.25 + 0.19 * number), y + 0.62 + 0.1 * (number % 2), 0.5)
                roll = [(0.001, 0), (0.085, 0), (0.085, 1.1 + 0.12 * (number % 3)), (0.001, 1.1 + 0.12 * (number % 3))]
                turned("Roll", cloths[int(chance.integers(len(cloths)))], roll, at, 16)


def _pots(chance):
    """Pots and bowls of few shapes in many glazes, along the middle."""
    shapes = (
        [(0.001, 0), (0.10, 0), (0.20, 0.18), (0.17, 0.36), (0.08, 0.44), (0.11, 0.50), (0.09, 0.49), (0.001, 0.40)],
        [(0.001, 0), (0.08, 0), (0.12, 0.30), (0.07, 0.52), (0.09, 0.60), (0.07, 0.59), (0.001, 0.50)],
        [(0.001, 0), (0.09, 0), (0.22, 0.16), (0.21, 0.17), (0.08, 0.02), (0.001, 0.02)],
    )
    colors = ((0.50, 0.20, 0.09), (0.05, 0.22, 0.40), (0.10, 0.34, 0.28), (0.75, 0.62, 0.42), (0.60, 0.36, 0.08))
    glazes = [glossy(f"Glaze {n + 1}", color, 0.15 + 0.1 * n) for n, color in enumerate(colors)]
    kinds = []
    for shape in shapes:
        for glaze in glazes:
            first = turned("Pot", glaze, shape, around=28)
            kinds.append(first.data)
            bpy.data.objects.remove(first)
    for number in range(190):
        side = -1 if number % 2 else 1
        at = (side * float(chance.uniform(1.55, 2.45)), float(chance.uniform(1.8, DEPTH - 0.5)), 0)
        pot = place("Pot", kinds[int(chance.integers(len(kinds)))], None, at)
        pot.scale = [float(chance.uniform(0.6, 1.15))] * 3


def _lanterns():
    brass, glow = glossy("Brass", (0.75, 0.50, 0.20), 0.25, 1.0), glowing("Lantern glass", (1, 0.60, 0.26), 12)
    for number in range(14):
        at = (1.5 * (-1) ** number, 1.9 + 1.25 * number, 2.9 + 0.25 * (number % 3))
        turned("Lantern", brass, [(0.10, 0.11), (0.03, 0.20), (0.006, 0.22), (0.006, HEIGHT - at[2])], at, 16)
        turned("Lantern glass", glow, [(0.001, -0.12), (0.07, -0.10), (0.10, 0.10)], at, 16)
        bulb = light_data("POINT", "Lantern", (1, 0.62, 0.30), 11, shadow_soft_size=0.1)
        place("Lantern light", bulb, None, (at[0], at[1], at[2] - 0.26))


def _shift(chance):
    """Each carpet shows another part of its picture."""
    for thing in bpy.context.scene.objects:
        if thing.name.startswith(("Folded", "Roll")):
            u, v = chance.uniform(0, 1, 2)
            for each in thing.data.uv_layers[0].data:
                each.uv = (each.uv[0] + u, each.uv[1] + v)
