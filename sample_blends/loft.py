# SPDX-License-Identifier: GPL-3.0-or-later
"""A loft of brick, boards and plaster: every large surface has colour, roughness and normal pictures.

Hard, because bounced light must follow the bumps and the joints, and neither blur them nor take them for edges."""

import textures
from furniture import books, lamp_data, plant, sofa, table, vase, window
from parts import aim, box, camera, glossy, light_data, place, render_settings, turned, wall
from procedural import sky_for_the_camera, sky_panel

WIDTH, DEPTH, HEIGHT = 6.4, 5.2, 3.1  # x and y from 0


def build(scene):
    render_settings(scene, exposure=0.7)
    scene.eevee.taa_render_samples = 16
    sky_for_the_camera(scene, (0.62, 0.78, 1), 2.5)
    _room()
    _things()
    sun = light_data("SUN", "Sun", (1, 0.86, 0.66), 22, angle=0.02)
    place("Sun", sun, None, (-3, 1, 4), aim((0, 0, 0), (1, 0.42, -0.62)))
    for y in (1.35, 3.35):
        sky_panel("Skylight", (0.75, 0.87, 1), 55, (1.5, 1.9), (0.02, y, 1.65), aim((0, 0, 0), (1, 0, -0.05)))
    camera(scene, (5.9, 0.35, 1.45), (1.9, 3.9, 1.05), 22)
    textures.unwrap(scene)


def _room():
    brick = textures.material("Brick", textures.bricks(1024), 1.1, depth=0.02)
    boards = textures.material("Boards", textures.planks(1024), 1.6, depth=0.004)
    plaster = textures.material("Plaster", textures.plaster(512), 1.8, depth=0.012)
    x, y, z = WIDTH, DEPTH, HEIGHT
    box("Floor", boards, (0, 0, -0.2), (x, y, 0))
    box("Ceiling", plaster, (0, 0, z), (x, y, z + 0.2))
    box("Brick wall", brick, (-0.3, y, -0.2), (x + 0.3, y + 0.3, z + 0.2))
    box("Right wall", plaster, (x, -0.3, -0.2), (x + 0.3, y, z + 0.2))
    box("Near wall", plaster, (-0.3, -0.3, -0.2), (x, 0, z + 0.2))
    windows = [(0.6, 2.1, 0.7, 2.6), (2.6, 4.1, 0.7, 2.6)]
    wall("Window wall", brick, (-0.15, 0), (-0.15, y), z, windows, thick=0.3)
    iron = glossy("Iron", (0.03, 0.03, 0.035), 0.5)
    for near, far, sill, lintel in windows:
        window(iron, None, (-0.2, (near + far) / 2, (sill + lintel) / 2), far - near, lintel - sill, 1, (3, 4))
        box("Sill", boards, (-0.3, near - 0.05, sill - 0.05), (0.08, far + 0.05, sill))
    beam = textures.material("Beam", textures.planks(512, 7, 2, (0.34, 0.22, 0.13), 0.5), 0.8, depth=0.01)
    for at in (0.9, 2.5, 4.1):
        box("Beam", beam, (0, at, z - 0.24), (x, at + 0.2, z), bevel=0.01)
    box("Skirting", beam, (0, y - 0.02, 0), (x, y, 0.12))


def _things():
    cloth = textures.material("Sofa cloth", textures.weave(512, 5, 48, (0.22, 0.36, 0.38)), 0.16, depth=0.001)
    carpet = textures.weave(512, 6, 64, (0.62, 0.22, 0.16), (0.80, 0.70, 0.55))
    rug = textures.material("Rug", carpet, 1.2, depth=0.008)
    walnut = textures.material("Walnut", textures.planks(512, 8, 3, (0.40, 0.24, 0.14), 0.22), 0.9, depth=0.001)
    iron = glossy("Black steel", (0.04, 0.04, 0.045), 0.35)
    sofa(cloth, iron, (1.5, DEPTH - 1.05, 0), 2.2)
    box("Rug", rug, (1.1, 1.9, 0), (4.1, 3.9, 0.015))
    table(walnut, (2.0, 2.65, 0.015), (1.2, 0.65, 0.40))
    box("Sideboard", walnut, (4.5, DEPTH - 0.5, 0.15), (6.2, DEPTH - 0.05, 0.80), bevel=0.008)
    for left in (4.6, 6.05):
        box("Foot", iron, (left, DEPTH - 0.4, 0), (left + 0.05, DEPTH - 0.1, 0.15))
    for height in (1.35, 1.80):
        box("Shelf", walnut, (4.5, DEPTH - 0.26, height), (6.2, DEPTH, height + 0.035), bevel=0.004)
    books((4.55, DEPTH - 0.22, 1.385), 22, 3)
    books((4.9, DEPTH - 0.22, 1.835), 17, 4)
    books((2.15, 2.75, 0.415), 3, 9, axis=1)
    vase(glossy("Blue glaze", (0.05, 0.14, 0.35), 0.12), (2.75, 2.95, 0.415), 0.28, 0.09)
    vase(glossy("White glaze", (0.75, 0.72, 0.66), 0.2), (5.0, DEPTH - 0.26, 0.80), 0.36, 0.10)
    plant(
        glossy("Terracotta", (0.50, 0.20, 0.10), 0.7), glossy("Leaf", (0.06, 0.22, 0.05), 0.4), (0.6, 4.6, 0), 34, 1.0
    )
    _floor_lamp(iron)


def _floor_lamp(iron):
    at = (4.1, DEPTH - 0.55)
    turned("Lamp foot", iron, [(0.001, 0), (0.15, 0), (0.15, 0.02), (0.001, 0.02)], (*at, 0))
    turned("Lamp pole", iron, [(0.012, 0.02), (0.012, 1.40)], (*at, 0), 12)
    brass = glossy("Brass", (0.80, 0.55, 0.22), 0.25, 1.0)
    turned("Lamp head", brass, [(0.20, 1.38), (0.06, 1.62), (0.001, 1.63)], (*at, 0), 32)
    place("Bulb", lamp_data("Bulb", (1, 0.72, 0.42), 30, 0.04), None, (*at, 1.50))
