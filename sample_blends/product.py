# SPDX-License-Identifier: GPL-3.0-or-later
"""A product shot under an environment picture: a coated toy car, a bottle of perfume, a chrome kettle.

Hard, because what one sees is mostly not diffuse: coat over paint, refraction through two walls of glass, chrome that
is nothing but what it mirrors. Bounced light must leave all that alone, and still lay the car's red on the table."""

from math import cos, pi, sin

import bpy
import numpy as np

import textures
from parts import aim, ball, box, camera, glossy, light_data, mesh, place, render_settings, sky, turned


def build(scene):
    render_settings(scene, exposure=0.0)
    scene.eevee.taa_render_samples = 16
    _environment(scene)
    _set()
    _car((-0.36, 0.02, 0.0), -28)
    _bottle((0.42, -0.10, 0.0))
    _kettle((0.34, 0.62, 0.0))
    key = light_data("AREA", "Softbox", (1, 0.95, 0.88), 22, shape="RECTANGLE", size=0.9, size_y=0.6)
    place("Softbox", key, None, (-1.3, -0.9, 1.7), aim((-1.3, -0.9, 1.7), (0, 0.2, 0.1)))
    camera(scene, (0.05, -2.15, 0.72), (0.0, 0.15, 0.19), 55)
    textures.unwrap(scene)


def _environment(scene):
    """A photographer's room as an equirectangular picture of floats: two softboxes, a strip, a warm floor."""
    high, wide = 128, 256
    up, around = np.mgrid[0:high, 0:wide]
    up, around = (up + 0.5) / high * 180 - 90, (around + 0.5) / wide * 360 - 180  # degrees
    tone = np.where(up < 0, 0.16, 0.10 + 0.25 * np.clip(up / 90, 0, 1))[..., None]
    picture = tone * np.where(up[..., None] < 0, (1.0, 0.80, 0.62), (0.72, 0.85, 1.0))

    def panel(middle, half, color, strength, soft=3.0):
        far = np.maximum(np.abs((around - middle[0] + 180) % 360 - 180) - half[0], np.abs(up - middle[1]) - half[1])
        return np.clip(-far / soft + 0.5, 0, 1)[..., None] * np.asarray(color) * strength

    picture = picture + panel((-70, 42), (28, 16), (1, 0.96, 0.90), 9.0)
    picture = picture + panel((75, 30), (10, 26), (0.75, 0.88, 1), 7.0)
    picture = picture + panel((165, 55), (40, 6), (1, 0.9, 0.75), 5.0)
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    node = nodes.new("ShaderNodeTexEnvironment")
    node.image = textures.packed("Studio", picture, kind="OPEN_EXR")
    links.new(node.outputs["Color"], sky(scene, (1, 1, 1), 0.8).inputs["Color"])


def _set():
    """A table that rises to a backdrop in one sweep, and a green card at the right."""
    sweep = [(-1.5, 0.0), (0.9, 0.0)]
    sweep += [(0.9 + 0.5 * sin(t), 0.5 - 0.5 * cos(t)) for t in np.linspace(0, pi / 2, 12)[1:]] + [(1.4, 2.2)]
    points = [(x, y, z) for y, z in sweep for x in (-2.4, 2.4)]
    faces = [(2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2) for k in range(len(sweep) - 1)]
    place("Backdrop", mesh("Backdrop", points, faces, smooth=True), glossy("Paper", (0.72, 0.66, 0.58), 0.6))
    card = glossy("Card", (0.05, 0.42, 0.28), 0.5)
    box("Card", card, (0.80, -0.3, 0), (0.82, 0.9, 0.6), turn=-14)
    wood = textures.planks(512, 4, 6, (0.52, 0.33, 0.18), 0.2)
    board = textures.material("Board", wood, 0.5, depth=0.001)
    box("Board", board, (0.16, -0.32, 0), (0.70, 0.10, 0.025), bevel=0.006)


def _paint(name, color):
    material = glossy(name, color, 0.45)
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Coat Weight"].default_value, inputs["Coat Roughness"].default_value = 1.0, 0.03
    return material


def _glass(name, color, ior=1.5):
    material = glossy(name, color, 0.0)
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Transmission Weight"].default_value, inputs["IOR"].default_value = 1.0, ior
    material.use_raytrace_refraction = True
    return material


def _car(at, turn):
    """A toy car about 0.5 m long: a cage of a few faces, smoothed by a Subdivision modifier."""
    root = bpy.data.objects.new("Car", None)
    bpy.context.scene.collection.objects.link(root)
    red, chrome = _paint("Coated red", (0.62, 0.02, 0.015)), glossy("Chrome", (0.85, 0.86, 0.88), 0.04, 1.0)
    rubber, dark = glossy("Rubber", (0.02, 0.02, 0.02), 0.6), glossy("Dark glass", (0.01, 0.012, 0.015), 0.05)
    cream = _paint("Coated cream", (0.78, 0.70, 0.52))
    body = [(-0.31, 0.07, 0.13), (-0.27, 0.06, 0.17), (-0.02, 0.055, 0.17), (0.16, 0.055, 0.16), (0.31, 0.07, 0.13)]

    def shell(name, material, sections):
        """sections: (x, half width, bottom, top)."""
        points, faces = [], []
        for x, half, low, high in sections:
            points += [(x, -half, low), (x, half, low), (x, half * 0.92, high), (x, -half * 0.92, high)]
        for k in range(0, 4 * (len(sections) - 1), 4):
            faces += [(k + i, k + 4 + i, k + 4 + (i + 1) % 4, k + (i + 1) % 4) for i in range(4)]
        faces += [(0, 1, 2, 3), tuple(range(len(points) - 4, len(points)))[::-1]]
        thing = place(name, mesh(name, points, faces, smooth=True), material)
        smooth = thing.modifiers.new("Subdivision", "SUBSURF")
        smooth.levels, smooth.render_levels = 2, 4
        thing.parent = root

    shell("Body", red, [(x, 0.125 - 0.02 * (abs(x) > 0.3), low - 0.01, high + 0.02) for x, low, high in body])
    shell("Fender", red, [(x, 0.135, 0.06, 0.115) for x in (-0.32, -0.30, 0.0, 0.30, 0.32)])
    shell(
        "Cabin",
        dark,
        [(-0.20, 0.09, 0.15, 0.20), (-0.15, 0.10, 0.15, 0.27), (0.05, 0.10, 0.15, 0.27), (0.15, 0.09, 0.15, 0.19)],
    )
    shell(
        "Roof",
        cream,
        [
            (-0.16, 0.08, 0.23, 0.255),
            (-0.12, 0.092, 0.235, 0.272),
            (0.03, 0.092, 0.235, 0.272),
            (0.06, 0.08, 0.23, 0.255),
        ],
    )
    for x in (-0.19, 0.20):
        for side in (-1, 1):
            for name, material, profile in (
                (
                    "Tyre",
                    rubber,
                    [(0.035, -0.022), (0.068, -0.022), (0.072, -0.012), (0.072, 0.012), (0.068, 0.022), (0.035, 0.022)],
                ),
                ("Hub", chrome, [(0.001, 0.030), (0.02, 0.029), (0.036, 0.020), (0.044, 0.022)][::-1]),
            ):
                wheel = turned(name, material, profile, around=32)
                wheel.location, wheel.parent = (x, side * 0.125, 0.072), root
                wheel.rotation_euler = (-side * pi / 2, 0, 0)
    for x, side in ((0.325, 1), (-0.325, -1)):
        bumper = box("Bumper", chrome, (x - 0.012, -0.13, 0.062), (x + 0.012, 0.13, 0.088), bevel=0.008)
        bumper.parent = root
        for y in (-0.08, 0.08):
            lamp = ball("Headlamp", chrome, (x - 0.02 * side, y, 0.125), 0.022, 24)
            lamp.parent = root
    root.location, root.rotation_euler = at, (0, 0, turn * pi / 180)


def _bottle(at):
    """A bottle with walls of its own thickness, amber in it, and a stopper of gold."""
    x, y, z = at[0], at[1], 0.025
    outer = [(0.001, 0), (0.075, 0), (0.085, 0.012), (0.085, 0.16), (0.06, 0.20), (0.026, 0.215), (0.026, 0.25)]
    inner = [(0.018, 0.25), (0.018, 0.212), (0.052, 0.192), (0.074, 0.155), (0.074, 0.022), (0.001, 0.018)]
    turned("Bottle", _glass("Glass", (1, 1, 1)), outer + inner, (x, y, z), 64)
    perfume = [(0.001, 0.019), (0.073, 0.023), (0.073, 0.115), (0.001, 0.115)]
    turned("Perfume", _glass("Perfume", (1.0, 0.62, 0.22), 1.36), perfume, (x, y, z), 64)
    gold = glossy("Gold", (0.95, 0.65, 0.28), 0.12, 1.0)
    turned("Collar", gold, [(0.028, 0.222), (0.031, 0.224), (0.031, 0.245), (0.028, 0.247)], (x, y, z))
    ball("Stopper", _glass("Crystal", (0.95, 0.98, 1.0)), (x, y, z + 0.285), 0.037)
    ball("Marble", _glass("Blue glass", (0.35, 0.60, 1.0)), (0.02, -0.42, 0.035), 0.035)


def _kettle(at):
    chrome = glossy("Polished steel", (0.80, 0.80, 0.80), 0.05, 1.0)
    profile = [(0.001, 0), (0.15, 0), (0.17, 0.02), (0.175, 0.07), (0.155, 0.16), (0.10, 0.23), (0.07, 0.245)]
    profile += [(0.07, 0.25), (0.03, 0.262), (0.001, 0.264)]
    turned("Kettle", chrome, profile, at, 64)
    black = glossy("Bakelite", (0.015, 0.013, 0.012), 0.15)
    ball("Knob", black, (at[0], at[1], 0.283), 0.022, 24)
    for name, material, radius, points in (
        (
            "Handle",
            black,
            0.013,
            [(-0.11, 0.22), (-0.11, 0.33), (-0.04, 0.38), (0.04, 0.38), (0.11, 0.33), (0.11, 0.22)],
        ),
        ("Spout", chrome, 0.022, [(-0.14, 0.10), (-0.22, 0.13), (-0.24, 0.20), (-0.28, 0.23)]),
    ):
        line = bpy.data.curves.new(name, "CURVE")
        line.dimensions, line.bevel_depth, line.use_fill_caps = "3D", radius, True
        spline = line.splines.new("NURBS")
        spline.points.add(len(points) - 1)
        spline.use_endpoint_u, spline.order_u = True, 3
        for point, (x, z) in zip(spline.points, points):
            point.co = (x, 0, z, 1)
        place(name, line, material, at)
