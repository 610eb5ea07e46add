# SPDX-License-Identifier: GPL-3.0-or-later
"""A plaster knot on a plinth in a coloured courtyard, lit by an environment map computed here and packed in the
file."""

from math import pi

import bpy
import numpy as np

from parts import box, camera, diffuse, mesh, place, render_settings, sky

SUN = np.array([0.85, 0.22, 0.78])  # towards the sun
SUN_RADIUS = 0.045  # radians; ten times the real one, so that a small map can hold it


def build(scene):
    render_settings(scene)
    _environment(scene)
    _courtyard()
    plaster = diffuse("Plaster", (0.80, 0.79, 0.76))
    knot = place("Knot", _knot(), plaster, (0, 0, 1.82), (0, 0, 20))
    knot.modifiers.new("Subdivision", "SUBSURF").render_levels = 1
    camera(scene, (0.85, -4.9, 2.15), (-0.10, 0, 1.30), 34)


def _knot(along=200, around=20):
    """A (2, 3) torus knot whose oval section turns and swells on its way round; about 1.5 m across."""
    t = np.linspace(0, 2 * pi, along, endpoint=False)

    def path(t):
        ring = 0.50 + 0.22 * np.cos(3 * t)
        return np.stack([ring * np.cos(2 * t), 0.30 * np.sin(3 * t), ring * np.sin(2 * t)], axis=1)

    centre, step = path(t), 1e-4
    tangent = path(t + step) - path(t - step)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    # The direction away from the torus's core never runs along the path, so it makes a frame without a twist to mend.
    core = np.stack([0.50 * np.cos(2 * t), np.zeros(along), 0.50 * np.sin(2 * t)], axis=1)
    side = centre - core
    side -= tangent * (side * tangent).sum(1, keepdims=True)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    other = np.cross(tangent, side)

    phi = np.linspace(0, 2 * pi, around, endpoint=False)
    width = 0.125 + 0.030 * np.cos(3 * t + 0.6)
    oval = np.stack([1.35 * np.cos(phi), 0.70 * np.sin(phi)])
    a = width[:, None] * (np.cos(2 * t)[:, None] * oval[0] - np.sin(2 * t)[:, None] * oval[1])
    b = width[:, None] * (np.sin(2 * t)[:, None] * oval[0] + np.cos(2 * t)[:, None] * oval[1])
    points = centre[:, None, :] + a[..., None] * side[:, None, :] + b[..., None] * other[:, None, :]
    index = np.arange(along * around).reshape(along, around)
    ahead, beside = np.roll(index, -1, 0), np.roll(index, -1, 1)
    faces = np.stack([index, beside, np.roll(ahead, -1, 1), ahead], axis=-1).reshape(-1, 4)
    return mesh("Knot", points.reshape(-1, 3), faces.tolist(), smooth=True)


def _courtyard():
    stone = diffuse("Plinth stone", (0.66, 0.63, 0.58))
    box("Plinth foot", stone, (-0.52, -0.52, 0), (0.52, 0.52, 0.12), bevel=0.015)
    box("Plinth", stone, (-0.42, -0.42, 0.12), (0.42, 0.42, 0.86), bevel=0.01)
    box("Plinth top", stone, (-0.48, -0.48, 0.86), (0.48, 0.48, 0.96), bevel=0.015)
    terracotta = diffuse("Terracotta", (0.66, 0.19, 0.07))
    box("Floor", terracotta, (-3.2, -7, -0.2), (6, 2.4, 0))
    box("Back wall", diffuse("White wall", (0.72, 0.70, 0.66)), (-3.4, 2.2, 0), (6, 2.5, 3.1))
    box("Left wall", diffuse("Blue wall", (0.07, 0.32, 0.58)), (-2.0, -7, 0), (-1.7, 2.2, 3.1))


def _environment(scene):
    height, width = 128, 256
    image = bpy.data.images.new("Afternoon sky", width, height, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    image.pixels.foreach_set(_afternoon(width, height).ravel())
    image.update()
    image.pack()
    background = sky(scene, (1, 1, 1), 1)
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    texture.location = (-300, 300)
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    # EEVEE takes what is brighter than this out of the map and makes a sun of it, with a shadow.
    scene.world.sun_threshold = 8
    scene.world.use_sun_shadow = True
    scene.world.sun_angle = 2 * SUN_RADIUS


def _afternoon(width, height):
    """Equirectangular radiance, (height, width, 4) float32 from the bottom row: blue zenith, warm horizon, one sun."""
    polar = (np.arange(height) + 0.5) / height * pi - pi / 2
    around = pi - (np.arange(width) + 0.5) / width * 2 * pi
    polar, around = np.meshgrid(polar, around, indexing="ij")
    # Blender's map: the middle of the image looks along -y... and u runs clockwise seen from above.
    way = np.stack([np.cos(polar) * np.cos(around), np.cos(polar) * np.sin(around), np.sin(polar)], axis=-1)
    up = way[..., 2:3]
    zenith, horizon, ground = (np.array(c) for c in ((0.16, 0.30, 0.62), (0.62, 0.60, 0.56), (0.16, 0.11, 0.08)))
    haze = np.exp(-4 * np.clip(up, 0, 1))
    color = np.where(up > 0, zenith * (1 - haze) + horizon * haze, ground)
    toward = way @ (SUN / np.linalg.norm(SUN))
    color = color + np.array([1.0, 0.8, 0.5]) * 0.6 * np.exp((toward[..., None] - 1) * 30)
    color = np.where(
        np.arccos(np.clip(toward, -1, 1))[..., None] < SUN_RADIUS, np.array([1.0, 0.90, 0.74]) * 3600, color
    )
    return np.concatenate([color * 0.28, np.ones((height, width, 1))], axis=-1).astype(np.float32)
