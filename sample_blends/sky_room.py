# SPDX-License-Identifier: GPL-3.0-or-later
"""A dining room lit by a Sky Texture alone: its sun and its sky come in through real windows and thin curtains.

Hard, because EEVEE lets the whole sky into the room: the walls must take it away again, and the patch of sun on the
floor is what lights the rest."""

import parts
import textures
from furniture import books, chair, plant, table, vase, window
from parts import box, camera, glossy, mesh, place, render_settings, turned, wall
from procedural import plastered, sky_texture, translucent, wooden

WIDTH, DEPTH, HEIGHT = 5.6, 4.6, 2.7  # x and y from 0; the windows are in the wall at x = 0


def build(scene):
    render_settings(scene, exposure=-1.2)
    scene.eevee.taa_render_samples = 16
    sky_texture(scene, elevation=24, rotation=-75)
    _room()
    _things()
    camera(scene, (5.2, 0.35, 1.45), (1.5, 3.1, 1.0), 20)
    textures.unwrap(scene)


def _room():
    white = plastered("Paint", (0.80, 0.78, 0.73))
    boards = wooden("Parquet", (0.36, 0.21, 0.11), (0.52, 0.33, 0.18), 0.3)
    x, y, z = WIDTH, DEPTH, HEIGHT
    box("Floor", boards, (-0.3, -0.2, -0.2), (x, y, 0))
    box("Ceiling", white, (-0.3, -0.2, z), (x + 0.2, y + 0.2, z + 0.2))
    box("Back wall", plastered("Sage", (0.42, 0.52, 0.42)), (-0.3, y, -0.2), (x + 0.2, y + 0.2, z + 0.2))
    box("Right wall", white, (x, -0.2, -0.2), (x + 0.2, y, z + 0.2))
    box("Near wall", white, (-0.3, -0.4, -0.2), (x + 0.2, -0.2, z + 0.2))
    windows = [(0.7, 1.9, 0.15, 2.35), (2.5, 3.7, 0.15, 2.35)]
    wall(
        "Window wall", white, (-0.15, -0.2), (-0.15, y), z, [(a + 0.2, b + 0.2, *rest) for a, b, *rest in windows], 0.3
    )
    frame = glossy("Frame", (0.80, 0.79, 0.76), 0.35)
    for near, far, sill, lintel in windows:
        window(frame, None, (-0.2, (near + far) / 2, (sill + lintel) / 2), far - near, lintel - sill, 1, (2, 3))
        for start in (near - 0.22, far - 0.12):
            _curtain(start, 0.34)
        rod = turned("Rod", glossy("Rod", (0.1, 0.09, 0.08), 0.4), [(0.012, -1.0), (0.012, 1.0)], around=12)
        rod.location, rod.rotation_euler = (0.1, (near + far) / 2, 2.5), (1.5708, 0, 0)
    box("Garden", plastered("Lawn", (0.16, 0.24, 0.08)), (-40, -40, -0.6), (-0.3, 40, -0.4))
    box("Hedge", plastered("Hedge", (0.05, 0.12, 0.03)), (-16, -40, -0.5), (-15, 40, 1.1))


def _curtain(start, wide):
    """A gathered curtain of thin cloth along y, of one mesh that a Subdivision modifier smooths."""
    from math import sin

    steps, points, faces = 14, [], []
    for step in range(steps + 1):
        fold = 0.05 * sin(step * 2.2)
        points += [(0.1 + fold, start + wide * step / steps, height) for height in (0.05, 2.48)]
    for step in range(steps):
        faces.append((2 * step, 2 * step + 2, 2 * step + 3, 2 * step + 1))
    thing = place("Curtain", mesh("Curtain", points, faces, smooth=True), _voile())
    smooth = thing.modifiers.new("Subdivision", "SUBSURF")
    smooth.levels, smooth.render_levels = 1, 2


def _voile():
    """Thin cloth: half of the light that it takes goes through."""
    import bpy

    return bpy.data.materials.get("Voile") or translucent("Voile", (0.85, 0.82, 0.75), 0.5)


def _things():
    oak = wooden("Oak", (0.42, 0.27, 0.14), (0.56, 0.38, 0.21), 0.35)
    dark = wooden("Walnut", (0.14, 0.08, 0.05), (0.24, 0.14, 0.08), 0.3)
    cloth = glossy("Seat", (0.62, 0.22, 0.08), 0.8)
    table(oak, (1.5, 1.5, 0), (1.7, 0.9, 0.75), leg=0.07)
    for at, turn in (
        ((1.95, 2.55), 5),
        ((2.75, 2.6), -8),
        ((1.95, 1.35), 176),
        ((2.8, 1.15), 200),
        ((1.2, 1.95), 92),
    ):
        chair(dark, cloth, (*at, 0), turn)
    box("Rug", glossy("Rug", (0.45, 0.10, 0.08), 0.95), (0.8, 0.9, 0), (3.9, 3.1, 0.012))
    vase(glossy("Blue china", (0.04, 0.12, 0.42), 0.1), (2.3, 2.0, 0.75), 0.26, 0.08)
    bowl = [(0.001, 0), (0.06, 0), (0.15, 0.08), (0.14, 0.08), (0.055, 0.012), (0.001, 0.012)]
    turned("Bowl", glossy("China", (0.80, 0.78, 0.72), 0.15), bowl, (2.8, 1.9, 0.75))
    for number, (x, y) in enumerate(((2.76, 1.88), (2.84, 1.90), (2.80, 1.95), (2.80, 1.91))):
        parts.ball("Orange", glossy("Orange", (0.85, 0.28, 0.02), 0.4), (x, y, 0.80 + 0.05 * (number == 3)), 0.04, 24)
    box("Sideboard", oak, (2.4, DEPTH - 0.45, 0.12), (4.4, DEPTH - 0.02, 0.82), bevel=0.008)
    for number in range(4):
        left = 2.42 + 0.49 * number
        box("Drawer", oak, (left, DEPTH - 0.462, 0.16), (left + 0.47, DEPTH - 0.44, 0.78), bevel=0.004)
        box("Handle", dark, (left + 0.2, DEPTH - 0.48, 0.60), (left + 0.27, DEPTH - 0.46, 0.62))
    books((3.5, DEPTH - 0.3, 0.82), 14, 6)
    vase(glossy("Green glaze", (0.10, 0.30, 0.16), 0.2), (2.75, DEPTH - 0.24, 0.82), 0.34, 0.10)
    box("Frame", dark, (2.9, DEPTH - 0.03, 1.35), (4.0, DEPTH, 2.15), bevel=0.006)
    box("Print", glossy("Print", (0.72, 0.52, 0.20), 0.5), (2.96, DEPTH - 0.034, 1.41), (3.94, DEPTH - 0.02, 2.09))
    leaf = glossy("Leaf", (0.05, 0.20, 0.05), 0.35)
    plant(glossy("Pot", (0.70, 0.66, 0.60), 0.5), leaf, (0.55, 4.1, 0), 30, 1.0, 2)
    shade = glossy("Pendant", (0.03, 0.10, 0.10), 0.3)
    turned("Pendant", shade, [(0.26, 1.62), (0.20, 1.78), (0.05, 1.86), (0.001, 1.86)], (2.35, 1.95, 0))
    turned("Cord", shade, [(0.006, 1.86), (0.006, HEIGHT)], (2.35, 1.95, 0), 8)
