# SPDX-License-Identifier: GPL-3.0-or-later
"""A courtyard under a Sky Texture with its sun, and in it a tree of thousands of leaf cards with an alpha picture.

Hard, because the shaded side lives on what the sunlit walls and the paving send back, and because a leaf is a card
that the light must treat as a leaf: thin, translucent, and not there where its picture is not."""

from math import cos, pi, sin

import bpy
import numpy as np

import nodes
import parts
import textures
from furniture import chair, plant, table, window
from parts import box, camera, glossy, mesh, place, render_settings, turned, wall
from procedural import plastered, sky_texture, translucent

HALF, TALL = 5.0, 6.4  # of the courtyard in x and y; height of the houses
LEAVES = 5200


def build(scene):
    render_settings(scene, exposure=-2.0)
    scene.eevee.taa_render_samples = 16
    sky_texture(scene, elevation=42, rotation=-128)
    _houses()
    _ground()
    _tree((-1.2, 1.4))
    _things()
    camera(scene, (2.9, -4.5, 1.6), (-0.9, 2.2, 1.95), 22)
    textures.unwrap(scene)


def _houses():
    ochre = textures.material("Ochre plaster", textures.plaster(512, 3, (0.86, 0.66, 0.42), 0.25), 2.6, depth=0.02)
    white = textures.material("Lime plaster", textures.plaster(512, 5, (0.90, 0.86, 0.78), 0.2), 2.6, depth=0.02)
    shutter, frame = glossy("Shutter", (0.06, 0.22, 0.20), 0.5), glossy("Window frame", (0.70, 0.66, 0.58), 0.5)
    glass = glossy("Panes", (0.03, 0.04, 0.05), 0.08)
    x, z = HALF, TALL
    door = [(4.2, 5.8, 0, 2.6)]
    wall("North wall", white, (-x, x + 0.2), (x, x + 0.2), z, door, 0.4)
    wall(
        "West wall",
        ochre,
        (-x - 0.2, -x),
        (-x - 0.2, x),
        z,
        [(1.0, 2.6, 0, 2.7), (3.4, 5.0, 0, 2.7), (5.8, 7.4, 0, 2.7)],
        0.4,
    )
    wall("East wall", ochre, (x + 0.2, -x), (x + 0.2, x), z - 2.4, (), 0.4)
    wall("South wall", white, (-x, -x - 0.2), (x, -x - 0.2), z - 3.0, (), 0.4)
    box("Gallery", white, (-x - 3, -x, -0.1), (-x - 2.6, x, z))
    box("Gallery roof", white, (-x - 3, -x, 2.9), (-x - 0.4, x, 3.1))
    box("Doorway", glossy("Door", (0.12, 0.06, 0.03), 0.45), (-0.8, x + 0.3, 0), (0.8, x + 0.35, 2.6))
    for column in (-3.4, -1.1, 1.1, 3.4):
        for height in (1.9, 4.6):
            if height < 3 and abs(column) < 2:
                continue
            window(frame, glass, (column, x - 0.02, height), 0.9, 1.4, 0, (2, 3), 0.06)
            for side in (-0.72, 0.72):
                low = column + side
                box("Shutter", shutter, (low - 0.24, x - 0.05, height - 0.72), (low + 0.24, x - 0.01, height + 0.72))
            box("Sill", frame, (column - 0.55, x - 0.14, height - 0.78), (column + 0.55, x, height - 0.70))
    for at in (-3.4, -0.8, 1.8, 4.2):
        window(frame, glass, (-x + 0.02, at, 4.6), 0.9, 1.4, 1, (2, 3), 0.06)
        for side in (-0.72, 0.72):
            low = at + side
            box("Shutter", shutter, (-x + 0.01, low - 0.24, 3.88), (-x + 0.05, low + 0.24, 5.32))
    roof = glossy("Roof tiles", (0.45, 0.16, 0.09), 0.7)
    box("Eaves", roof, (-x - 3.2, x - 0.35, z), (x + 0.6, x + 1.2, z + 0.12))
    box("Eaves", roof, (-x - 3.2, -x - 0.5, z), (-x + 0.35, x - 0.35, z + 0.12))


def _ground():
    stone = textures.tiles(1024, 4, 7, ((0.66, 0.60, 0.52), (0.60, 0.53, 0.44), (0.70, 0.65, 0.58)))
    paving = textures.material("Paving", stone, 3.2, depth=0.02)
    box("Paving", paving, (-HALF - 3, -HALF, -0.2), (HALF, HALF + 0.4, 0))
    turf = plastered("Earth", (0.10, 0.07, 0.04), 0.8, 12)
    edge = textures.material("Kerb", textures.plaster(256, 8, (0.62, 0.58, 0.52), 0.3), 1.0, depth=0.01)
    for low, high in (
        ((-2.3, 0.3), (-0.1, 0.5)),
        ((-2.3, 2.3), (-0.1, 2.5)),
        ((-2.3, 0.5), (-2.1, 2.3)),
        ((-0.3, 0.5), (-0.1, 2.3)),
    ):
        box("Kerb", edge, (*low, 0), (*high, 0.42), bevel=0.02)
    box("Earth", turf, (-2.1, 0.5, 0), (-0.3, 2.3, 0.36))


def _branches(chance, start, way, length, radius, depth, found):
    """A branch as points with radii, and its own branches; the ends of the thin ones are where leaves are."""
    points, at = [(*start, radius)], np.array(start)
    for step in range(1, 5):
        way = way + chance.normal(0, 0.16, 3) + (0, 0, 0.05)
        way = way / np.linalg.norm(way)
        at = at + way * length / 4
        points.append((*at, radius * (1 - 0.12 * step)))
        if depth < 2:
            found["leaves"].append(at.copy())
        if depth and step > 1:
            for _ in range(2 if step == 4 else 1):
                side = chance.normal(0, 1, 3)
                side = side - way * (side @ way)
                turned_way = way * 0.75 + side / np.linalg.norm(side) * 0.75
                _branches(chance, at, turned_way, length * chance.uniform(0.62, 0.8), radius * 0.5, depth - 1, found)
    found["branches"].append(points)


def _tree(at):
    chance, found = np.random.default_rng(12), {"leaves": [], "branches": []}
    _branches(chance, np.array((*at, 0.3)), np.array((0.05, 0, 1.0)), 2.2, 0.14, 3, found)
    wood = bpy.data.curves.new("Branches", "CURVE")
    wood.dimensions, wood.bevel_depth, wood.bevel_resolution = "3D", 1.0, 1
    for points in found["branches"]:
        line = wood.splines.new("POLY")
        line.points.add(len(points) - 1)
        for point, (x, y, z, radius) in zip(line.points, points):
            point.co, point.radius = (x, y, z, 1), radius
    place("Tree", wood, plastered("Bark", (0.16, 0.11, 0.07), 1.0, 18))
    twigs = np.array(found["leaves"])
    points = twigs[chance.integers(len(twigs), size=LEAVES)] + chance.normal(0, 0.13, (LEAVES, 3))
    crown = place("Crown", mesh("Crown", points, []))
    nodes.instances(crown, _leaf(), scale=(0.6, 1.2), seed=5)


def _leaf():
    """One leaf card, bent along its middle, with its alpha picture; kept out of sight itself."""
    material = translucent("Leaf", (0.30, 0.42, 0.10), 0.35)
    tree = material.node_tree
    picture, clear, mix = (tree.nodes.new(f"ShaderNode{name}") for name in ("TexImage", "BsdfTransparent", "MixShader"))
    picture.image = textures.packed("Leaf", textures.leaf(), kind="PNG")
    output = tree.nodes["Material Output"].inputs["Surface"]
    leaf = output.links[0].from_socket
    for name, socket in (("Principled BSDF", "Base Color"), ("Translucent BSDF", "Color")):
        tree.links.new(picture.outputs["Color"], tree.nodes[name].inputs[socket])
    tree.links.new(picture.outputs["Alpha"], mix.inputs["Fac"])
    tree.links.new(clear.outputs["BSDF"], mix.inputs[1])
    tree.links.new(leaf, mix.inputs[2])
    tree.links.new(mix.outputs["Shader"], output)
    size = 0.15
    points = [(x * size, y * size, 0.18 * size * abs(x)) for y in (0, 1) for x in (-0.5, 0, 0.5)]
    data = mesh("Leaf card", points, [(0, 1, 4, 3), (1, 2, 5, 4)])
    layer = data.uv_layers.new(name="UVMap")
    for loop in data.loops:
        x, y, _ = data.vertices[loop.vertex_index].co
        layer.data[loop.index].uv = (x / size + 0.5, y / size)
    card = place("Leaf card", data, material)
    card.hide_render = card.hide_viewport = True
    return card


def _things():
    iron, seat = glossy("Garden iron", (0.05, 0.09, 0.08), 0.4), glossy("Seat", (0.55, 0.40, 0.24), 0.5)
    table(seat, (1.3, 1.2, 0), (1.2, 0.8, 0.74))
    for at, turn in (((1.5, 2.3), 8), ((2.3, 2.25), -12), ((1.95, 0.85), 182)):
        chair(iron, seat, (*at, 0), turn)
    pot, leaf = glossy("Terracotta", (0.55, 0.22, 0.11), 0.75), glossy("Blade", (0.07, 0.20, 0.05), 0.4)
    for number, at in enumerate(((-4.4, 0.9), (-1.4, 4.5), (1.4, 4.5), (3.6, 4.3), (-4.4, 4.3), (4.3, 1.5))):
        plant(pot, leaf, (*at, 0), 26, 0.9 + 0.2 * (number % 3), number)
    rim = [(0.001, 0), (0.34, 0), (0.42, 0.55), (0.38, 0.55), (0.34, 0.1), (0.001, 0.1)]
    turned(
        "Basin", textures.material("Basin", textures.plaster(256, 9, (0.7, 0.67, 0.6), 0.4), 0.8), rim, (3.3, 3.0, 0)
    )
    for number in range(7):
        angle = 2 * pi * number / 7
        stone = (3.3 + 0.62 * cos(angle), 3.0 + 0.62 * sin(angle), 0.05)
        parts.ball("Stone", glossy(f"Stone {number}", (0.3 + 0.03 * number,) * 3, 0.8), stone, 0.12, 16)
