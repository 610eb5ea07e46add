# SPDX-License-Identifier: GPL-3.0-or-later
"""A salon of three million polygons: carved panels, a coffered ceiling, busts, quilted chairs, a chandelier.

Hard by its weight, and by relief: all of it is made when it renders, by Subdivision and Displace modifiers and by
instances of collections, so that the file is small and the viewport light."""

from contextlib import contextmanager
from math import cos, pi, sin

import bpy

import textures
from furniture import window
from parts import aim, ball, box, camera, glossy, glowing, light_data, mesh, place, render_settings, turned, wall
from procedural import plastered, sky_for_the_camera, sky_panel, wooden

WIDTH, DEPTH, HEIGHT = 6.6, 6.0, 3.4  # x and y from 0


def build(scene):
    render_settings(scene, exposure=0.5)
    scene.eevee.taa_render_samples = 16
    sky_for_the_camera(scene, (0.62, 0.78, 1), 2.5)
    _room()
    _panels()
    _busts()
    _chairs()
    _chandelier()
    _things()
    sun = light_data("SUN", "Sun", (1, 0.85, 0.66), 20, angle=0.015)
    place("Sun", sun, None, (-3, 1, 4), aim((0, 0, 0), (1, 0.30, -0.75)))
    for y in (1.5, 3.9):
        sky_panel("Skylight", (0.76, 0.87, 1), 45, (1.2, 2.2), (0.03, y, 1.6), aim((0, 0, 0), (1, 0, -0.05)))
    camera(scene, (6.1, 0.35, 1.5), (2.3, 4.3, 1.25), 21)
    textures.unwrap(scene)


@contextmanager
def _instanced(name):
    """A collection that is in the scene only by its instances: what is placed within goes into it."""
    scene = bpy.context.scene
    before, made = set(scene.collection.objects), bpy.data.collections.new(name)
    yield made
    for thing in set(scene.collection.objects) - before:
        made.objects.link(thing)
        scene.collection.objects.unlink(thing)


def _instance(collection, at, turn=0.0, size=1.0):
    thing = place(collection.name, None, None, at, (0, 0, turn))
    thing.instance_type, thing.instance_collection, thing.scale = "COLLECTION", collection, (size,) * 3
    thing.empty_display_size = 0.1


def _subdivide(thing, level, kind="CATMULL_CLARK", viewport=0):
    modifier = thing.modifiers.new("Subdivision", "SUBSURF")
    modifier.subdivision_type, modifier.levels, modifier.render_levels = kind, viewport, level
    return thing


def _displace(thing, texture, strength, middle=0.5):
    modifier = thing.modifiers.new("Displace", "DISPLACE")
    modifier.texture, modifier.strength, modifier.mid_level = texture, strength, middle
    modifier.texture_coords = "LOCAL"


def _grid(name, wide, tall, columns, rows, bulge=None):
    """An upright grid that looks to -y."""
    points = [
        (wide * (c / columns - 0.5), -(bulge(c / columns, r / rows) if bulge else 0.0), tall * (r / rows - 0.5))
        for r in range(rows + 1)
        for c in range(columns + 1)
    ]
    wide_row = columns + 1
    faces = [
        (r * wide_row + c, r * wide_row + c + 1, (r + 1) * wide_row + c + 1, (r + 1) * wide_row + c)
        for r in range(rows)
        for c in range(columns)
    ]
    return mesh(name, points, faces, smooth=True)


def _room():
    white, x, y, z = plastered("Cream", (0.78, 0.73, 0.64)), WIDTH, DEPTH, HEIGHT
    parquet = textures.material("Parquet", textures.planks(512, 4, 10, (0.50, 0.32, 0.18), 0.2), 1.2, depth=0.002)
    box("Floor", parquet, (-0.2, -0.2, -0.2), (x, y, 0))
    box("Back wall", plastered("Rose", (0.56, 0.24, 0.20)), (-0.2, y, 0), (x + 0.2, y + 0.2, z))
    box("Right wall", white, (x, -0.2, 0), (x + 0.2, y, z))
    box("Near wall", white, (-0.2, -0.4, 0), (x + 0.2, -0.2, z))
    wall("Window wall", white, (-0.1, -0.2), (-0.1, y), z, [(1.1, 2.3, 0.4, 2.8), (3.5, 4.7, 0.4, 2.8)], 0.2)
    for middle in (1.5, 3.9):
        window(white, None, (-0.12, middle, 1.6), 1.2, 2.4, 1, (2, 4))
    box("Ceiling", white, (-0.2, -0.2, z), (x + 0.2, y + 0.2, z + 0.2))
    frame = glossy("Gilt frame", (0.78, 0.56, 0.24), 0.3, 1.0)
    for low, high in (
        ((0, y - 0.05, z - 0.16), (x, y, z)),
        ((0, 0, z - 0.16), (0.05, y, z)),
        ((0, y - 0.03, 0), (x, y, 0.14)),
    ):
        box("Moulding", frame, low, high, bevel=0.02)


def _panels():
    """Carved panels along the back wall, each of 65 thousand polygons; coffers in the ceiling."""
    carving = bpy.data.textures.new("Carving", "VORONOI")
    carving.noise_scale, carving.distance_metric = 0.16, "DISTANCE_SQUARED"
    gilt, lime = glossy("Gilt", (0.80, 0.58, 0.26), 0.32, 1.0), glossy("Carved lime", (0.70, 0.58, 0.42), 0.5)
    with _instanced("Panel") as panel:
        relief = place("Relief", _grid("Relief", 0.86, 1.5, 8, 8), lime)
        _displace(_subdivide(relief, 5, "SIMPLE"), carving, 0.055, 0.4)
        for low, high in (
            ((-0.48, -0.05, -0.80), (-0.42, 0.02, 0.80)),
            ((0.42, -0.05, -0.80), (0.48, 0.02, 0.80)),
            ((-0.48, -0.05, -0.80), (0.48, 0.02, -0.74)),
            ((-0.48, -0.05, 0.74), (0.48, 0.02, 0.80)),
        ):
            box("Frame", gilt, low, high, bevel=0.02)
    for number in range(6):
        _instance(panel, (0.62 + 1.07 * number, DEPTH - 0.05, 2.05))
    with _instanced("Coffer") as coffer:
        rose = turned("Rose", gilt, [(0.22, 0.0), (0.16, -0.06), (0.08, -0.02), (0.001, -0.07)], around=16)
        _subdivide(rose, 3)
        for turn in (0, 90, 180, 270):
            beam = box("Beam", lime, (-0.5, -0.5, -0.14), (0.5, -0.42, 0), bevel=0.015)
            angle = turn * pi / 180
            beam.location = (0.46 * sin(angle), -0.46 * cos(angle), -0.07)
            beam.rotation_euler = (0, 0, angle)
    for row in range(6):
        for column in range(6):
            _instance(coffer, (0.55 + 1.1 * column, 0.5 + 1.0 * row, HEIGHT))


def _busts():
    """Two monkeys of marble and one of bronze, half a million polygons each, on columns."""
    grain = bpy.data.textures.new("Chisel", "CLOUDS")
    grain.noise_scale = 0.05
    marble, bronze = glossy("Marble", (0.80, 0.78, 0.74), 0.25), glossy("Bronze", (0.42, 0.26, 0.12), 0.28, 1.0)
    bpy.ops.mesh.primitive_monkey_add()
    first = bpy.context.object
    data = first.data
    bpy.data.objects.remove(first)
    data.shade_smooth()
    with _instanced("Bust") as busts:
        bust = place("Suzanne", data, marble, (0, 0, 1.36))
        bust.scale = (0.26, 0.26, 0.26)
        _displace(_subdivide(bust, 5), grain, 0.02)
        column = [
            (0.001, 0),
            (0.22, 0),
            (0.22, 0.08),
            (0.15, 0.14),
            (0.13, 0.98),
            (0.2, 1.06),
            (0.2, 1.12),
            (0.001, 1.12),
        ]
        turned("Column", marble, column, around=40)
    _instance(busts, (1.0, 5.3, 0), 35)
    _instance(busts, (4.75, 5.35, 0), -8)
    other = place("Bronze Suzanne", data.copy(), None, (2.72, 3.05, 0.68), (-12, 0, 40))
    other.data.materials.clear()
    other.data.materials.append(bronze)
    other.scale = (0.17, 0.17, 0.17)
    _subdivide(other, 5)


def _chairs():
    """Quilted armchairs; every button and fold is geometry."""
    velvet, oak = (
        glossy("Velvet", (0.06, 0.26, 0.24), 0.7),
        wooden("Carved oak", (0.20, 0.11, 0.05), (0.34, 0.20, 0.10)),
    )

    def quilt(u, v):
        return 0.05 * abs(sin(5 * pi * u) * sin(5 * pi * v)) ** 0.5 * (min(u, v, 1 - u, 1 - v) > 0)

    with _instanced("Armchair") as chair:
        back = place(
            "Quilted back", _grid("Quilted back", 0.66, 0.62, 20, 20, quilt), velvet, (0, 0.24, 0.80), (-10, 0, 0)
        )
        seat = place(
            "Quilted seat", _grid("Quilted seat", 0.66, 0.62, 20, 20, quilt), velvet, (0, -0.08, 0.46), (-90, 0, 0)
        )
        for part in (back, seat):
            _subdivide(part, 4)
        box("Back", velvet, (-0.36, 0.25, 0.35), (0.36, 0.36, 1.15), bevel=0.05)
        box("Seat", velvet, (-0.35, -0.40, 0.26), (0.35, 0.28, 0.45), bevel=0.04)
        for side in (-1, 1):
            low, high = sorted((side * 0.34, side * 0.46))
            _subdivide(box("Arm", velvet, (low, -0.38, 0.30), (high, 0.34, 0.68)), 4)
            for y in (-0.36, 0.26):
                leg = [(0.02, 0), (0.035, 0.04), (0.02, 0.12), (0.045, 0.2), (0.04, 0.27)]
                _subdivide(turned("Leg", oak, leg, (side * 0.30, y, 0), 12), 4)
    for at, turn in (((1.5, 2.5, 0), 112), ((2.2, 4.35, 0), 20), ((3.7, 4.35, 0), -15), ((4.5, 2.9, 0), -80)):
        _instance(chair, at, turn)


def _chandelier():
    """Twelve arms with drops of crystal, instances of one."""
    gold, crystal = glossy("Gold", (0.90, 0.64, 0.28), 0.2, 1.0), glossy("Crystal", (0.95, 0.97, 1.0), 0.0)
    crystal.node_tree.nodes["Principled BSDF"].inputs["Transmission Weight"].default_value = 1.0
    middle, wax = (3.1, 3.1, 2.45), glossy("Wax", (0.85, 0.80, 0.68), 0.5)
    with _instanced("Arm") as arm:
        line = bpy.data.curves.new("Arm", "CURVE")
        line.dimensions, line.bevel_depth, line.bevel_resolution, line.resolution_u = "3D", 0.012, 3, 24
        spline = line.splines.new("NURBS")
        points = [(0, 0), (0.10, -0.16), (0.32, -0.14), (0.42, 0.0), (0.50, 0.06)]
        spline.points.add(len(points) - 1)
        spline.use_endpoint_u, spline.order_u = True, 4
        for point, (x, z) in zip(spline.points, points):
            point.co = (x, 0, z, 1)
        place("Arm", line, gold)
        _subdivide(turned("Dish", gold, [(0.001, 0.06), (0.05, 0.07), (0.06, 0.09)], (0.50, 0, 0), 16), 4)
        turned("Candle", wax, [(0.018, 0.08), (0.018, 0.20), (0.001, 0.20)], (0.50, 0, 0), 12)
        ball("Flame", glowing("Flame", (1, 0.62, 0.28), 40), (0.50, 0, 0.225), 0.018, 12)
        for x, z in ((0.50, -0.02), (0.40, -0.08), (0.28, -0.22), (0.15, -0.22)):
            drop = ball("Drop", crystal, (x, 0, z), 0.018, 8)
            drop.scale[2] = 1.7
            _subdivide(drop, 2)
    for number in range(12):
        _instance(arm, middle, 30 * number)
    turned(
        "Stem", gold, [(0.001, -0.2), (0.06, -0.14), (0.03, 0), (0.05, 0.1), (0.012, 0.2), (0.012, 0.95)], middle, 24
    )
    for number in range(4):
        at = (middle[0] + 0.42 * cos(number * pi / 2), middle[1] + 0.42 * sin(number * pi / 2), middle[2] + 0.30)
        place("Candles", light_data("POINT", "Candles", (1, 0.62, 0.30), 9, shadow_soft_size=0.05), None, at)


def _things():
    rug = textures.material("Rug", textures.weave(256, 6, 64, (0.50, 0.10, 0.09), (0.72, 0.60, 0.40)), 1.6, depth=0.004)
    box("Rug", rug, (1.2, 1.5, 0), (4.6, 4.7, 0.015))
    oak = wooden("Table", (0.20, 0.11, 0.05), (0.34, 0.20, 0.10), 0.25)
    top = [(0.001, 0.46), (0.46, 0.46), (0.48, 0.48), (0.46, 0.50), (0.001, 0.50)]
    _subdivide(turned("Table", oak, top, (2.75, 3.0, 0), 32), 3)
    foot = [(0.001, 0), (0.26, 0), (0.24, 0.04), (0.06, 0.10), (0.09, 0.28), (0.05, 0.46)]
    _subdivide(turned("Table foot", oak, foot, (2.75, 3.0, 0), 24), 3)
