# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes as artists build them: small files that open without a word, and hold what they are there for."""

import sys

import bpy
import numpy as np
import pytest

import extension

FOLDER = extension.ROOT / "sample_blends"
sys.path.insert(0, str(FOLDER))

import make_samples


@pytest.fixture
def opened(afterlight, capfd):
    """Open a sample; its scene, once nothing was said that a user would have to care about."""

    def open_one(name):
        capfd.readouterr()
        bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "artists" / f"{name}.blend"), load_ui=False)
        printed = "".join(capfd.readouterr()).lower()
        assert not [word for word in ("warn", "error", "missing", "traceback", "not available") if word in printed], (
            printed
        )
        return bpy.data.scenes[name]

    return open_one


def polygons_at_render(scene):
    """How many polygons a render has, instances counted: the Subdivision modifiers at their levels of a render."""
    for modifier in (each for thing in bpy.data.objects for each in thing.modifiers):
        if modifier.type == "SUBSURF":
            modifier.levels = modifier.render_levels
    graph = scene.view_layers[0].depsgraph
    scene.view_layers[0].update()
    return sum(len(each.object.data.polygons) for each in graph.object_instances if each.object.type == "MESH")


def kinds_of_nodes(material):
    return {node.bl_idname.removeprefix("ShaderNode") for node in material.node_tree.nodes}


def shaders(socket):
    """Names of materials whose Principled BSDF has more than nothing at an input."""
    found = set()
    for material in bpy.data.materials:
        for node in material.node_tree.nodes:
            if node.bl_idname == "ShaderNodeBsdfPrincipled" and node.inputs[socket].default_value > 0:
                found.add(material.name)
    return found


def test_every_scene_has_its_file():
    assert sorted(path.stem for path in (FOLDER / "artists").iterdir()) == sorted(make_samples.ARTISTS)


@pytest.mark.parametrize("name", make_samples.ARTISTS)
def test_the_file_is_small_whole_and_ticked(opened, name):
    assert (FOLDER / "artists" / f"{name}.blend").stat().st_size < 3_000_000
    scene = opened(name)
    assert scene.afterlight.enabled and scene.afterlight.method == "RADIOSITY" and scene.camera is not None
    assert scene.render.engine == "BLENDER_EEVEE" and not scene.eevee.use_raytracing and scene.eevee.use_shadows
    assert (scene.render.resolution_x, scene.render.resolution_y, scene.eevee.taa_render_samples) == (1280, 720, 16)
    assert scene.view_settings.view_transform == "AgX"
    assert not bpy.data.libraries
    for image in bpy.data.images:
        assert image.source != "FILE" or image.packed_file, f"{image.name} is not in the file"
        assert image.size[0] > 0 or image.source == "VIEWER", f"{image.name} can't be read"


def test_loft_has_pictures_of_color_roughness_and_normals(opened):
    opened("loft")
    for name in ("Brick", "Boards", "Plaster"):
        nodes = bpy.data.materials[name].node_tree.nodes
        suffixes = {node.image.name.split()[-1] for node in nodes if node.bl_idname == "ShaderNodeTexImage"}
        assert suffixes == {"color", "roughness", "normal"} and "NormalMap" in kinds_of_nodes(bpy.data.materials[name])


@pytest.mark.parametrize("name", ["sky_room", "courtyard"])
def test_the_sky_is_a_sky_texture_with_its_sun(opened, name):
    scene = opened(name)
    (sky,) = (node for node in scene.world.node_tree.nodes if node.bl_idname == "ShaderNodeTexSky")
    turn = scene.objects["Sun"].matrix_world.to_3x3()
    up, around = sky.sun_elevation, sky.sun_rotation
    to_sun = np.array([np.cos(up) * np.sin(around), np.cos(up) * np.cos(around), np.sin(up)])
    assert np.allclose(np.array(turn.col[2]), to_sun, atol=1e-3)


def test_courtyard_has_a_tree_of_thousands_of_leaf_cards(opened):
    scene = opened("courtyard")
    graph = scene.view_layers[0].depsgraph
    scene.view_layers[0].update()
    assert sum(each.is_instance and each.object.name == "Leaf card" for each in graph.object_instances) > 4000
    assert {"TexImage", "BsdfTransparent", "BsdfTranslucent"} <= kinds_of_nodes(bpy.data.materials["Leaf"])
    assert bpy.data.images["Leaf"].channels == 4


def test_product_has_glass_coat_and_chrome_under_a_picture(opened):
    scene = opened("product")
    assert "ShaderNodeTexEnvironment" in {node.bl_idname for node in scene.world.node_tree.nodes}
    assert bpy.data.images["Studio"].is_float
    assert (
        len(shaders("Transmission Weight")) > 2 and len(shaders("Coat Weight")) > 1 and "Chrome" in shaders("Metallic")
    )


def test_bust_has_skin_hair_curves_and_fur(opened):
    scene = opened("bust")
    assert {"Skin", "Lips"} <= shaders("Subsurface Weight")
    graph = scene.view_layers[0].depsgraph
    scene.view_layers[0].update()
    hair = scene.objects["Hair"].evaluated_get(graph).data
    assert scene.objects["Hair"].type == "CURVES" and len(hair.curves) > 20_000
    (fur,) = scene.objects["Collar"].particle_systems
    assert fur.settings.type == "HAIR" and fur.settings.count * fur.settings.rendered_child_count > 10_000


def test_night_lamp_is_lit_by_emission_through_a_translucent_shade(opened):
    scene = opened("night_lamp")
    assert {thing.data.type for thing in scene.objects if thing.type == "LIGHT"} == {"SUN"}  # a faint moon
    assert "BsdfTranslucent" in kinds_of_nodes(bpy.data.materials["Shade"])
    glow = bpy.data.materials["Bulb"].node_tree.nodes["Principled BSDF"].inputs["Emission Strength"].default_value
    assert glow > 100


def test_fog_has_a_volume_and_a_spot(opened):
    scene = opened("fog")
    assert bpy.data.materials["Fog"].node_tree.nodes["Material Output"].inputs["Volume"].is_linked
    assert "SPOT" in {thing.data.type for thing in scene.objects if thing.type == "LIGHT"}


def test_bazaar_has_500_objects_and_30_pictures_of_2048(opened):
    scene = opened("bazaar")
    assert len(scene.objects) > 500
    assert sum(tuple(image.size) == (2048, 2048) for image in bpy.data.images) == 30


def test_heavy_room_has_three_million_polygons_and_a_light_viewport(opened):
    scene = opened("heavy_room")
    assert all(m.levels <= 1 for thing in bpy.data.objects for m in thing.modifiers if m.type == "SUBSURF")
    assert polygons_at_render(scene) > 3_000_000
