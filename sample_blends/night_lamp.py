# SPDX-License-Identifier: GPL-3.0-or-later
"""A bedroom at night: a glowing bulb in a translucent shade, a paper lantern and a screen are all the light there is.

Hard, because EEVEE's emission lights nothing: the bed, the walls and the ceiling are as dark as the bounced light
leaves them. The glow also comes through the shade's cloth. A faint moon at the window is the only lamp."""

from math import cos, pi, sin

import textures
from furniture import books, plant, sofa, table, vase, window
from parts import aim, ball, box, camera, glossy, glowing, light_data, place, render_settings, turned, wall
from procedural import plastered, translucent, wooden

WIDTH, DEPTH, HEIGHT = 4.4, 4.0, 2.5  # x and y from 0
WARM = (1, 0.62, 0.30)


def build(scene):
    render_settings(scene, exposure=1.2)
    scene.eevee.taa_render_samples = 16
    _room()
    _bed()
    _lamps()
    _things()
    moon = light_data("SUN", "Moon", (0.45, 0.62, 1), 0.5, angle=0.01)
    place("Moon", moon, None, (-2, 2, 3), aim((0, 0, 0), (1, -0.25, -0.55)))
    camera(scene, (3.95, 0.3, 1.35), (1.45, 2.9, 0.75), 21)
    textures.unwrap(scene)


def _room():
    paint, x, y, z = plastered("Night blue", (0.30, 0.38, 0.50)), WIDTH, DEPTH, HEIGHT
    white = plastered("White", (0.78, 0.76, 0.72))
    box("Floor", wooden("Floor boards", (0.20, 0.11, 0.06), (0.34, 0.20, 0.11), 0.35), (-0.2, -0.2, -0.2), (x, y, 0))
    box("Ceiling", white, (-0.2, -0.2, z), (x + 0.2, y + 0.2, z + 0.2))
    box("Back wall", paint, (-0.2, y, -0.2), (x + 0.2, y + 0.2, z + 0.2))
    box("Right wall", white, (x, -0.2, -0.2), (x + 0.2, y, z + 0.2))
    box("Near wall", white, (-0.2, -0.4, -0.2), (x + 0.2, -0.2, z + 0.2))
    wall("Window wall", white, (-0.1, -0.2), (-0.1, y), z, [(1.0, 2.2, 0.8, 2.1)], 0.2)
    frame = glossy("Frame", (0.76, 0.75, 0.72), 0.4)
    window(frame, None, (-0.12, 1.4, 1.45), 1.2, 1.3, 1)
    box("Skirting", frame, (0, y - 0.02, 0), (x, y, 0.09))


def _bed():
    oak = wooden("Oak", (0.30, 0.18, 0.09), (0.44, 0.28, 0.15), 0.4)
    linen = textures.material("Linen", textures.weave(256, 5, 64, (0.86, 0.83, 0.78)), 0.08, depth=0.0006)
    wool = textures.weave(256, 6, 48, (0.70, 0.34, 0.20), (0.78, 0.62, 0.42))
    blanket = textures.material("Blanket", wool, 0.6, depth=0.004)
    y = DEPTH
    box("Bed frame", oak, (0.95, y - 2.15, 0.12), (2.75, y - 0.05, 0.32), bevel=0.015)
    box("Headboard", oak, (0.90, y - 0.07, 0.1), (2.80, y - 0.01, 1.05), bevel=0.02)
    box("Mattress", linen, (1.0, y - 2.1, 0.30), (2.7, y - 0.1, 0.55), bevel=0.07)
    box("Blanket", blanket, (0.96, y - 2.13, 0.34), (2.74, y - 0.85, 0.60), bevel=0.06)
    for left in (1.08, 1.90):
        pillow = box("Pillow", linen, (left, y - 0.55, 0.56), (left + 0.72, y - 0.12, 0.72), bevel=0.075)
        pillow.rotation_euler[0] = 0.45
    for x in (0.95, 2.67):
        for at in (y - 2.12, y - 0.15):
            box("Bed foot", oak, (x, at, 0), (x + 0.08, at + 0.08, 0.14))
    for left in (0.35, 2.92):
        box("Bedside table", oak, (left, y - 0.48, 0.10), (left + 0.48, y - 0.04, 0.52), bevel=0.01)
        box("Drawer", oak, (left + 0.03, y - 0.49, 0.30), (left + 0.45, y - 0.47, 0.48), bevel=0.005)


def _lamps():
    """The shade is open above and below; the bulb in it is a mesh that glows."""
    brass, cloth = glossy("Brass", (0.75, 0.50, 0.20), 0.25, 1.0), translucent("Shade", (0.90, 0.74, 0.50), 0.6)
    x, y, z = 3.16, DEPTH - 0.26, 0.52
    foot = [(0.001, 0), (0.09, 0), (0.09, 0.015), (0.03, 0.03), (0.05, 0.10), (0.015, 0.19), (0.012, 0.26)]
    turned("Lamp foot", brass, foot, (x, y, z))
    turned("Shade", cloth, [(0.19, 0.24), (0.12, 0.50)], (x, y, z))
    ball("Glowing bulb", glowing("Bulb", WARM, 220), (x, y, z + 0.34), 0.045, 24)
    lantern = glowing("Lantern", (1, 0.70, 0.42), 6.5)
    profile = [(0.17 * sin(pi * k / 24) * (1 + 0.03 * (k % 2)), -0.20 * cos(pi * k / 24)) for k in range(25)]
    turned("Paper lantern", lantern, profile, (0.55, 3.35, 1.55))
    turned("Cord", glossy("Cord", (0.03, 0.03, 0.03), 0.5), [(0.005, 1.74), (0.005, HEIGHT)], (0.55, 3.35, 0), 8)
    black = glossy("Black plastic", (0.015, 0.015, 0.016), 0.3)
    box("Screen back", black, (1.15, 2.25, 0.625), (1.53, 2.49, 0.637), turn=20)
    screen = box("Screen", glowing("Screen", (0.35, 0.60, 1), 5), (1.17, 2.51, 0.64), (1.51, 2.52, 0.86), turn=20)
    screen.rotation_euler[0] = -0.25


def _things():
    books((0.45, DEPTH - 0.30, 0.52), 6, 8)
    vase(glossy("China", (0.70, 0.68, 0.62), 0.15), (2.99, DEPTH - 0.36, 0.52), 0.14, 0.04)
    oak = wooden("Chest wood", (0.36, 0.22, 0.11), (0.50, 0.32, 0.17), 0.35)
    table(oak, (0.12, 0.55, 0), (0.5, 1.5, 0.72))
    leaf = glossy("Leaf", (0.06, 0.22, 0.07), 0.35)
    plant(glossy("Pot", (0.55, 0.50, 0.44), 0.5), leaf, (3.95, 3.45, 0), 26, 0.9, 4)
    box("Rug", glossy("Rug", (0.50, 0.14, 0.10), 0.95), (0.9, 0.6, 0), (3.3, 1.75, 0.014))
    sofa(glossy("Armchair", (0.10, 0.30, 0.26), 0.8), glossy("Feet", (0.05, 0.03, 0.02), 0.4), (0.15, 2.2, 0), 0.8, 1)
    box("Picture", glossy("Print", (0.75, 0.55, 0.22), 0.4), (1.35, DEPTH - 0.03, 1.3), (2.3, DEPTH, 1.9), bevel=0.005)
