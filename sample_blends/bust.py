# SPDX-License-Identifier: GPL-3.0-or-later
"""A bust of wax and skin with hair of curves, in a painter's studio: subsurface scattering, and strands of a pixel.

Hard, because skin holds light that came in elsewhere, and because hair is thinner than a pixel: its normal, depth and
light are those of many strands at once."""

import bpy
import numpy as np

import nodes
import parts
import shapes
import textures
from parts import aim, box, camera, glossy, light_data, mesh, place, render_settings, turned
from procedural import plastered, wooden

GUIDES, POINTS, COPIES = 1500, 6, 14


def build(scene):
    render_settings(scene, exposure=0.15)
    scene.eevee.taa_render_samples = 16
    _studio()
    head = place("Bust", _bust(), _skin("Skin", (0.72, 0.42, 0.31), 0.42))
    _lips(head.data)
    smooth = head.modifiers.new("Subdivision", "SUBSURF")
    smooth.levels, smooth.render_levels = 0, 1
    _eyes(head.data.materials[0])
    _hair(head)
    _fur()
    for name, color, power, at, size in (
        ("Key", (1, 0.86, 0.70), 34, (-0.95, -1.05, 1.95), 0.5),
        ("Rim", (0.62, 0.78, 1), 22, (0.95, 0.75, 1.95), 0.4),
    ):
        data = light_data("AREA", name, color, power, shape="SQUARE", size=size)
        place(name, data, None, at, aim(at, (0, 0, 1.42))).visible_camera = False
    camera(scene, (0.42, -1.62, 1.47), (0.03, 0, 1.36), 50)
    textures.unwrap(scene)


def _studio():
    red, wall = plastered("Red wall", (0.58, 0.08, 0.05), 0.2), plastered("Studio wall", (0.58, 0.52, 0.44))
    box("Floor", wooden("Floor", (0.22, 0.13, 0.07), (0.36, 0.22, 0.12)), (-2, -2.4, -0.1), (2, 1.4, 0))
    box("Back wall", wall, (-2, 1.3, 0), (2, 1.4, 2.8))
    box("Red wall", red, (0.95, -1.2, 0), (1.0, 1.3, 2.8))
    box("Left wall", wall, (-2.1, -2.4, 0), (-2, 1.4, 2.8))
    box("Ceiling", wall, (-2, -2.4, 2.8), (2, 1.4, 2.9))
    box("Near wall", wall, (-2, -2.5, 0), (2, -2.4, 2.8))
    stone = textures.material("Marble", textures.plaster(256, 4, (0.80, 0.78, 0.74), 0.35), 0.5, depth=0.001)
    box("Plinth", stone, (-0.24, -0.2, 0), (0.24, 0.2, 1.02), bevel=0.012)
    foot = [(0.001, 0), (0.15, 0), (0.15, 0.025), (0.09, 0.05), (0.075, 0.09), (0.10, 0.11), (0.001, 0.11)]
    turned("Foot", glossy("Dark stone", (0.05, 0.045, 0.04), 0.2), foot, (0, 0, 1.02))
    box("Canvas", glossy("Canvas", (0.70, 0.62, 0.42), 0.8), (-1.35, 1.18, 0.9), (-0.55, 1.22, 1.95), bevel=0.004)
    box("Shelf", wooden("Shelf", (0.25, 0.15, 0.08), (0.4, 0.25, 0.13)), (0.15, 1.05, 1.25), (0.93, 1.3, 1.29))
    for number, (x, color) in enumerate(
        ((0.28, (0.05, 0.25, 0.45)), (0.46, (0.75, 0.50, 0.08)), (0.66, (0.1, 0.3, 0.2)))
    ):
        jar = [(0.001, 0), (0.06, 0), (0.07, 0.05), (0.05, 0.15 + 0.03 * number), (0.04, 0.15), (0.001, 0.02)]
        turned("Jar", glossy(f"Jar {number}", color, 0.15), jar, (x, 1.17, 1.29))


def _skin(name, color, roughness):
    material = glossy(name, color, roughness)
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Subsurface Weight"].default_value, inputs["Subsurface Scale"].default_value = 1.0, 0.007
    inputs["Subsurface Radius"].default_value = (1.0, 0.35, 0.2)
    return material


def _bust():
    """A head, a neck and shoulders, blended from round parts; the face looks to -y. Its eyes are at z = 1.47."""
    z = 1.47
    add = [  # centre, radii, how softly it joins
        ((0, 0.02, z + 0.03), (0.078, 0.098, 0.100), 0.02),  # skull
        ((0, -0.030, z - 0.045), (0.056, 0.062, 0.078), 0.03),  # face
        ((0, -0.062, z - 0.108), (0.024, 0.022, 0.018), 0.025),  # chin
        ((0, -0.078, z + 0.020), (0.048, 0.014, 0.010), 0.022),  # brow
        ((0, -0.100, z - 0.022), (0.0085, 0.013, 0.030), 0.012),  # nose
        ((0, -0.113, z - 0.040), (0.010, 0.010, 0.009), 0.010),  # its tip
        ((0.012, -0.100, z - 0.043), (0.008, 0.010, 0.007), 0.008),
        ((-0.012, -0.100, z - 0.043), (0.008, 0.010, 0.007), 0.008),
        ((0.040, -0.060, z - 0.030), (0.018, 0.016, 0.014), 0.025),  # cheeks
        ((-0.040, -0.060, z - 0.030), (0.018, 0.016, 0.014), 0.025),
        ((0, -0.089, z - 0.0695), (0.021, 0.010, 0.0055), 0.005),  # lips
        ((0, -0.087, z - 0.082), (0.018, 0.010, 0.0065), 0.005),
        ((0.078, 0.012, z - 0.008), (0.009, 0.020, 0.032), 0.008),  # ears
        ((-0.078, 0.012, z - 0.008), (0.009, 0.020, 0.032), 0.008),
        ((0, 0.022, z - 0.13), (0.050, 0.052, 0.12), 0.03),  # neck
        ((0, 0.035, z - 0.275), (0.165, 0.075, 0.055), 0.06),  # shoulders
        ((0, 0.02, z - 0.32), (0.125, 0.080, 0.075), 0.05),  # chest
    ]
    cut = [
        ((0.031, -0.098, z), (0.019, 0.020, 0.012), 0.012),  # eye sockets
        ((-0.031, -0.098, z), (0.019, 0.020, 0.012), 0.012),
    ]
    field = shapes.blend(add, cut)
    points, faces = shapes.surface(field, (-0.20, -0.15, 1.10), (0.20, 0.15, 1.62), 0.0052)
    return mesh("Bust", points, faces, smooth=True)


def _eyes(skin):
    """Closed eyes: lids, and a line of lashes on each."""
    dark = glossy("Lashes", (0.03, 0.015, 0.01), 0.5)
    for side in (-1, 1):
        middle, radius = (0.031 * side, -0.0672, 1.4690), 0.0150
        parts.ball("Lid", skin, middle, radius, 32)
        line = bpy.data.curves.new("Lashes", "CURVE")
        line.dimensions, line.bevel_depth = "3D", 0.0007
        spline = line.splines.new("POLY")
        spline.points.add(12)
        for point, angle in zip(spline.points, np.linspace(-1.1, 1.1, 13)):
            down = -0.30 - 0.12 * np.cos(angle)
            flat = np.sqrt(1 - down**2)
            x, y, z = flat * np.sin(angle), -flat * np.cos(angle), down
            point.co = (*(m + 1.01 * radius * each for m, each in zip(middle, (x, y, z))), 1)
        place("Lashes", line, dark)


def _lips(data):
    """A second material on the faces of the mouth."""
    lips = _skin("Lips", (0.60, 0.20, 0.17), 0.3)
    data.materials.append(lips)
    for face in data.polygons:
        x, y, z = face.center
        if y < -0.086 and abs(x) < 0.022 and 1.384 < z < 1.4045:
            face.material_index = 1


def _strands(name, roots, ways, length, material, radius, chance, *, fall, curl, copies, spread):
    """A hair curves object: guides from `roots` along `ways`, that fall and curl; nodes make many of each."""
    data = bpy.data.hair_curves.new(name)
    count = len(roots)
    data.add_curves([POINTS] * count)
    step = np.linspace(0, 1, POINTS)[None, :, None]
    lengths = length * chance.uniform(0.75, 1.1, (count, 1, 1))
    points = roots[:, None] + ways[:, None] * lengths * (step - 0.45 * step**2)
    points = points - np.array((0, 0, 1.0)) * fall * lengths * step**1.8
    phase = chance.uniform(0, 2 * np.pi, (count, 1))
    for axis, turn in ((0, 0.0), (1, 1.57)):
        points[..., axis] += curl * step[..., 0] * np.sin(5 * step[..., 0] + phase + turn)
    data.attributes["position"].data.foreach_set("vector", points.astype(np.float32).ravel())
    width = data.attributes.new("radius", "FLOAT", "POINT")
    width.data.foreach_set("value", np.tile(radius * np.linspace(1, 0.3, POINTS), count).astype(np.float32))
    thing = place(name, data, material)
    nodes.hair(thing, copies, spread, 3)
    return thing


def _hair(head):
    """Hair on the upper and rear part of the skull, combed back and down."""
    chance, skull = np.random.default_rng(21), np.array((0, 0.02, 1.50))
    points = np.array([vertex.co for vertex in head.data.vertices])
    way = (points - skull) / (0.078, 0.098, 0.100)
    on_skull = np.abs(np.linalg.norm(way, axis=1) - 1) < 0.12
    hairline = points[:, 2] - 1.47 - 0.055 + 0.95 * np.clip(points[:, 1] + 0.045, -1, 1) > 0
    not_ear = (np.abs(points[:, 0]) < 0.079) | (points[:, 2] > 1.50)
    roots = points[on_skull & (hairline | (points[:, 2] > 1.53)) & not_ear & (points[:, 2] > 1.40)]
    roots = roots[chance.integers(len(roots), size=GUIDES)] + chance.normal(0, 0.0016, (GUIDES, 3))
    ways = (roots - skull) / np.linalg.norm(roots - skull, axis=1, keepdims=True)
    ways = ways * 0.6 + np.sign(roots[:, :1]) * (0.25, 0, 0) + (0, 0.55, 0)
    material = glossy("Hair", (0.16, 0.065, 0.022), 0.35)
    _strands(
        "Hair", roots, ways, 0.13, material, 0.00022, chance, fall=0.55, curl=0.006, copies=COPIES, spread=0.005
    )  # fmt: skip


def _fur():
    """A collar of short pale fur around the shoulders, from a particle system."""
    collar = turned("Collar", glossy("Hide", (0.45, 0.40, 0.32), 0.9), _ring(0.105, 0.035), (0, 0.03, 1.262), 40)
    collar.scale = (1.32, 0.92, 1)
    collar.data.materials.append(glossy("Fur", (0.78, 0.72, 0.62), 0.5))
    system = collar.modifiers.new("Fur", "PARTICLE_SYSTEM").particle_system
    system.seed, settings = 4, system.settings
    settings.type, settings.count, settings.hair_step, settings.hair_length = "HAIR", 900, 4, 0.035
    settings.child_type, settings.rendered_child_count, settings.child_percent = "SIMPLE", 14, 2
    settings.child_radius, settings.roughness_2, settings.material = 0.008, 0.012, 2
    settings.root_radius, settings.tip_radius, settings.radius_scale = 0.03, 0.0, 0.01
    settings.brownian_factor = 0.012


def _ring(radius, thick, steps=12):
    angles = np.linspace(0, 2 * np.pi, steps + 1)
    return [(radius + thick * np.cos(angle), thick * np.sin(angle)) for angle in angles]
