# SPDX-License-Identifier: GPL-3.0-or-later
"""A store room full of fog: a spot through it, daylight through a broken roof, and crates that stand in between.

Hard, because the fog's own light is in the picture but on no surface: it must neither be gathered as if it lay on the
walls behind it, nor hide them."""

import bpy
import numpy as np

import textures
from parts import aim, box, camera, glossy, light_data, place, render_settings, turned, wall
from procedural import plastered, sky_panel

WIDTH, DEPTH, HEIGHT = 7.0, 11.0, 4.2  # x and y from 0


def build(scene):
    render_settings(scene, exposure=1.0)
    scene.eevee.taa_render_samples = 16
    scene.eevee.volumetric_end, scene.eevee.volumetric_tile_size = 20, "4"
    scene.eevee.use_volumetric_shadows = True
    _room()
    _goods()
    _fog()
    _lamps()
    camera(scene, (3.0, 0.4, 1.5), (3.7, 8, 1.55), 22)
    textures.unwrap(scene)


def _room():
    brick = textures.material("Old brick", textures.bricks(512, 3, 12, 4, (0.50, 0.26, 0.17)), 1.2, depth=0.02)
    slab = textures.material("Concrete", textures.plaster(512, 6, (0.55, 0.53, 0.50), 0.35), 2.4, depth=0.01)
    steel = glossy("Steel", (0.10, 0.11, 0.11), 0.45, 0.0)
    x, y, z = WIDTH, DEPTH, HEIGHT
    box("Floor", slab, (-0.3, -0.3, -0.2), (x + 0.3, y + 0.3, 0))
    wall("Left wall", brick, (-0.15, -0.3), (-0.15, y), z, [(3.3, 4.5, 1.9, 3.5), (6.3, 7.5, 1.9, 3.5)], 0.3)
    box("Right wall", brick, (x, -0.3, 0), (x + 0.3, y, z))
    wall("End wall", brick, (-0.3, y + 0.15), (x + 0.3, y + 0.15), z, [(2.7, 4.5, 0, 2.5)], 0.3)
    box("Near wall", brick, (-0.3, -0.6, 0), (x + 0.3, -0.3, z))
    roof = plastered("Roof boards", (0.24, 0.17, 0.11), 0.5, 14)
    for low, high in (
        ((-0.3, -0.6), (x + 0.3, 5.2)),
        ((-0.3, 6.1), (x + 0.3, y + 0.3)),
        ((-0.3, 5.2), (4.4, 6.1)),
        ((5.4, 5.2), (x + 0.3, 6.1)),
    ):
        box("Roof", roof, (*low, z), (*high, z + 0.1))
    for at in (1.2, 3.6, 6.6, 9.0):
        box("Girder", steel, (0, at, z - 0.3), (x, at + 0.14, z))
        for side in (0.05, x - 0.19):
            box("Column", steel, (side, at, 0), (side + 0.14, at + 0.14, z))
    box("Door", glossy("Green door", (0.07, 0.22, 0.14), 0.45), (2.45, y + 0.2, 0), (4.2, y + 0.26, 2.5))


def _goods():
    pine = textures.material("Pine", textures.planks(512, 5, 6, (0.62, 0.46, 0.28), 0.5), 0.8, depth=0.006)
    chance = np.random.default_rng(7)
    for x, y, count in (
        (0.5, 4.3, 2),
        (1.6, 5.6, 1),
        (0.6, 7.6, 3),
        (5.5, 4.6, 2),
        (4.6, 7.3, 1),
        (5.6, 8.3, 3),
        (1.9, 8.9, 2),
    ):
        z = 0.0
        for number in range(count):
            side = float(chance.uniform(0.75, 1.0)) * (1 - 0.12 * number)
            turn = float(chance.uniform(-14, 14))
            box("Crate", pine, (x, y, z), (x + side, y + side, z + side * 0.8), turn=turn, bevel=0.012)
            z += side * 0.8
    colors = ((0.60, 0.10, 0.05), (0.08, 0.22, 0.45), (0.70, 0.42, 0.05))
    drum = [(0.001, 0), (0.29, 0), (0.30, 0.02), (0.30, 0.28), (0.315, 0.30), (0.30, 0.32), (0.30, 0.56)]
    drum += [(0.315, 0.58), (0.30, 0.60), (0.30, 0.86), (0.29, 0.88), (0.27, 0.86), (0.001, 0.86)]
    for number, at in enumerate(((2.2, 3.5), (4.9, 5.9), (5.6, 3.2), (3.0, 9.8), (6.3, 6.4))):
        paint = bpy.data.materials.get(f"Drum {number % 3}") or glossy(f"Drum {number % 3}", colors[number % 3], 0.35)
        turned("Drum", paint, drum, (*at, 0))
    place("Rope", _rope(), glossy("Hemp", (0.42, 0.32, 0.18), 0.9), (4.3, 4.3, 0.03))


def _rope():
    """A coil of rope, and its end that lies on the floor."""
    line = bpy.data.curves.new("Rope", "CURVE")
    line.dimensions, line.bevel_depth = "3D", 0.025
    angles = np.linspace(0, 11 * np.pi, 90)
    spline = line.splines.new("POLY")
    spline.points.add(len(angles) - 1)
    for point, angle in zip(spline.points, angles):
        radius = 0.34 - 0.003 * angle
        point.co = (radius * np.cos(angle), radius * np.sin(angle), 0.006 * angle, 1)
    return line


def _fog():
    """A box of fog that fills the room."""
    material = bpy.data.materials.new("Fog")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.remove(nodes["Principled BSDF"])
    volume = nodes.new("ShaderNodeVolumePrincipled")
    volume.inputs["Color"].default_value = (0.85, 0.90, 1, 1)
    volume.inputs["Density"].default_value, volume.inputs["Anisotropy"].default_value = 0.03, 0.35
    links.new(volume.outputs["Volume"], nodes["Material Output"].inputs["Volume"])
    box("Fog", material, (0.0, -0.25, 0.0), (WIDTH, DEPTH, HEIGHT))


def _lamps():
    head, target = (5.9, 10.2, 3.7), (2.6, 4.6, 0.4)
    spot = light_data(
        "SPOT", "Work light", (1, 0.72, 0.42), 1700, spot_size=0.75, spot_blend=0.3, shadow_soft_size=0.06
    )
    place("Work light", spot, None, head, aim(head, target))
    steel = glossy("Lamp housing", (0.04, 0.04, 0.045), 0.4)
    housing = turned("Lamp housing", steel, [(0.001, 0.22), (0.10, 0.22), (0.16, -0.02)], head)
    housing.rotation_euler = [angle * 0.0174533 for angle in aim(head, target)]
    sky_panel("Skylight", (0.70, 0.84, 1), 60, (0.9, 0.8), (4.9, 5.65, HEIGHT + 0.15))
    for y in (3.9, 6.9):
        sky_panel("Window light", (0.70, 0.84, 1), 14, (1.1, 1.5), (0.05, y, 2.7), aim((0, 0, 0), (1, 0, -0.35)))
    sun = light_data("SUN", "Sun", (0.80, 0.90, 1), 18, angle=0.012)
    place("Sun", sun, None, (-4, 6, 8), aim((0, 0, 0), (0.62, -0.22, -0.80)))
