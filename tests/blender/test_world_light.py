# SPDX-License-Identifier: GPL-3.0-or-later
"""What world_light.read() says of a world's light, compared with EEVEE's."""

import bpy
import numpy as np
import pytest
from mathutils import Vector

import scenes

NORMALS = ((0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))


@pytest.fixture
def scene(afterlight):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("World")
    return scene


@pytest.fixture
def world(afterlight):
    return afterlight.addon.scene.world_light


def tree_of(scene):
    tree = scene.world.node_tree
    return tree, next(node for node in tree.nodes if node.type == "BACKGROUND")


def picture(sun=0.0, as_bytes=False, height=64):
    """Equirectangular: brighter above, towards -y and, in red, towards +x; with a sun of that radiance."""
    image = bpy.data.images.new("Surroundings", 2 * height, height, float_buffer=not as_bytes)
    if not as_bytes:
        image.colorspace_settings.name = "Linear Rec.709"
    up = ((np.arange(height) + 0.5) / height - 0.5) * np.pi
    around = np.pi * (1 - (np.arange(2 * height) + 0.5) / height)
    up, around = np.meshgrid(up, around, indexing="ij")
    x, y, z = np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)
    pixels = np.stack([0.4 + 0.3 * x * (x > 0), 0.4 - 0.2 * y, 0.4 + 0.3 * z, np.ones_like(x)], -1)
    pixels[(x - 0.6) ** 2 + (y - 0.5) ** 2 + (z - 0.62) ** 2 < 0.03, :3] += sun
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    image.update()
    image.pack()
    return image


def surround(scene, image, strength=1.5, turn=None):
    tree, background = tree_of(scene)
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    background.inputs["Strength"].default_value = strength
    if turn:
        mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        mapping.inputs["Rotation"].default_value = turn
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    return texture


def lit_by_eevee(scene, addon):
    """(6, 3): Diffuse Direct of a cube's sides, seen from one corner and from the opposite one."""
    bpy.ops.mesh.primitive_cube_add(size=1)
    scene.render.engine = "BLENDER_EEVEE"
    scene.eevee.taa_render_samples, scene.eevee.use_raytracing = 4, False
    scene.render.resolution_x = scene.render.resolution_y = 32
    for _, switch, _, _ in addon.scene.passes.PASSES:
        setattr(scene.view_layers[0], switch, True)
    camera = scene.camera = scenes.put(bpy.data.cameras.new("Camera"))
    found = {}
    for corner in (1, -1):
        camera.location = Vector((2, 2.2, 1.8)) * corner
        camera.rotation_euler = (-camera.location).to_track_quat("-Z", "Y").to_euler()
        bpy.ops.render.render()
        shown, direct = read(scene, addon)
        for normal in NORMALS:
            facing = shown @ np.array(normal) > 0.99
            if facing.sum() > 20:
                found[normal] = np.median(direct[facing], 0)
    return np.array([found[normal] for normal in NORMALS])


def read(scene, addon):
    """(normals, light of white surfaces) of the finished render, (H, W, 3) each."""
    path = addon.scene.frame_store.save(scene)
    window, _ = addon.scene.cameras.window(scene)
    found = addon.scene.passes.load(path, scene.view_layers[0].name, window)
    addon.scene.frame_store.discard(path)
    return np.stack(found.normal, -1), np.stack(found.diffuse_direct, -1)


def said(world):
    """(6, 3): the same light as world_light.read() computes it."""
    found = world.read(bpy.context.evaluated_depsgraph_get(), {})
    return found[0] + np.array(NORMALS) @ found[1:]


KINDS = {
    "plain": lambda scene: tree_of(scene)[1].inputs["Color"].__setattr__("default_value", (0.2, 0.5, 0.8, 1)),
    "picture": lambda scene: surround(scene, picture()),
    "bytes": lambda scene: surround(scene, picture(as_bytes=True)),
    "turned": lambda scene: surround(scene, picture(), turn=(0.3, -0.5, 1.2)),
    "with a sun": lambda scene: surround(scene, picture(sun=200.0, height=256)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_light_is_eevees(scene, world, afterlight, kind):
    KINDS[kind](scene)
    scene.world.sun_threshold = 5 if kind == "with a sun" else 0
    if kind == "with a sun":  # EEVEE makes the sun a light of its own, so it is not part of the world's light
        true = lit_by_eevee_without_sun(scene, afterlight.addon)
    else:
        true = lit_by_eevee(scene, afterlight.addon)
    # EEVEE stores this light in floats with 6, 6 and 5 bits of mantissa.
    assert (np.abs(said(world) - true) < true * (1 / 64, 1 / 64, 1 / 32) + 0.01 * true.mean()).all()


def lit_by_eevee_without_sun(scene, addon):
    """lit_by_eevee() in a shell that blocks only the sun, by its shadow."""
    bpy.ops.mesh.primitive_ico_sphere_add(radius=30, subdivisions=2)
    scene.world.use_sun_shadow = True
    return lit_by_eevee(scene, addon)


def test_a_picture_is_looked_at_once_a_render(scene, world, monkeypatch):
    texture = surround(scene, picture())
    known, calls = {}, []
    first = world.read(bpy.context.evaluated_depsgraph_get(), known)
    monkeypatch.setattr(world, "harmonics", lambda *arguments: calls.append(1))
    assert np.array_equal(world.read(bpy.context.evaluated_depsgraph_get(), known), first) and not calls
    said_anew = world.read(bpy.context.evaluated_depsgraph_get(), {})
    assert calls and said_anew is None
    assert texture.image.size[0] == 128


def strange(scene, kind):
    tree, background = tree_of(scene)
    texture = surround(scene, picture(), turn=(0, 0, 0.5))
    mapping = next(node for node in tree.nodes if node.type == "MAPPING")
    coordinates = next(node for node in tree.nodes if node.type == "TEX_COORD")
    if kind == "mirror ball":
        texture.projection = "MIRROR_BALL"
    elif kind == "no picture":
        texture.image = None
    elif kind == "a film":
        texture.image.source = "MOVIE"
    elif kind == "stretched":
        mapping.inputs["Scale"].default_value = (1, 2, 1)
    elif kind == "by the camera":
        tree.links.new(coordinates.outputs["Camera"], mapping.inputs["Vector"])
    elif kind == "strength by nodes":
        tree.links.new(texture.outputs["Color"], background.inputs["Strength"])
    elif kind == "sky":
        tree.links.new(tree.nodes.new("ShaderNodeTexSky").outputs["Color"], background.inputs["Color"])
    elif kind == "black":
        background.inputs["Strength"].default_value = 0
    elif kind == "no world":
        scene.world = None


@pytest.mark.parametrize(
    "kind",
    [
        "mirror ball",
        "no picture",
        "a film",
        "stretched",
        "by the camera",
        "strength by nodes",
        "sky",
        "black",
        "no world",
    ],
)
def test_what_is_not_known_is_left_alone(scene, world, kind):
    strange(scene, kind)
    assert world.read(bpy.context.evaluated_depsgraph_get(), {}) is None


def test_harmonics_of_a_known_sky(world):
    """L = 1 + z has the irradiance pi (1 + 2/3 n.z), up to the size of the pixels."""
    up = ((np.arange(200) + 0.5) / 200 - 0.5) * np.pi
    radiance = np.repeat(np.repeat((1 + np.sin(up))[:, None, None], 400, 1), 3, 2)
    assert np.allclose(world.harmonics(radiance), [[1] * 3, [0] * 3, [0] * 3, [2 / 3] * 3], atol=1e-3)
