# SPDX-License-Identifier: GPL-3.0-or-later
"""Glossy Light, end to end: roughness of materials, its pass and nodes, the image, and removal."""

import bpy
import numpy as np
import pytest

from scenes import TREES, box, differences, put, read_rgb, render, simple_tree, wall, written_down


@pytest.fixture
def scene(fresh):
    """The test room, with a shiny back wall."""
    scene = box(fresh, samples=2)
    scene.afterlight.method, scene.afterlight.views, scene.afterlight.bounces = "RADIOSITY", "CAMERA", 2
    shiny = metal("Shiny", 0.3)
    back = next(thing for thing in scene.objects if thing.type == "MESH" and thing.location.y > 1)
    back.data.materials[0] = shiny
    return scene


def metal(name, rough):
    material = bpy.data.materials.new(name)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.8, 0.8, 0.8, 1)
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1, rough
    return material


def of_kind(tree, kind):
    return [node for node in tree.nodes if node.get("afterlight") == kind]


# Roughness

NAMES = {
    "M1": 0xC490A865,
    "Mé5": 0x7EF4AA7A,
    "Plastic.r1": 0xBF0FBC80,
    "Plastic r5": 0x3F344463,
}  # EEVEE's own manifest


def test_numbers_of_materials(addon):
    for name, number in NAMES.items():
        assert addon.scene.roughness.cryptomatte_id(name) == number
    for number in range(3000):  # about six of them would be infinite, NaN or denormal
        bits = addon.scene.roughness.cryptomatte_id(f"Material.{number}")
        assert np.isfinite(np.uint32(bits).view(np.float32)) and bits >> 23 & 0xFF


def principled(tree, **inputs):
    node = tree.nodes.new("ShaderNodeBsdfPrincipled")
    for name, value in inputs.items():
        node.inputs[name].default_value = value
    return node.outputs["BSDF"]


def textured(tree, colour, space="Non-Color"):
    image = bpy.data.images.new("Rough", 4, 2, is_data=space == "Non-Color")
    image.colorspace_settings.name = space
    image.pixels = [*(colour, colour, colour, 1.0) * 4, *(0.0, 0.0, 0.0, 1.0) * 4]
    texture, shader = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeBsdfPrincipled")
    reroute = tree.nodes.new("NodeReroute")
    texture.image = image
    tree.links.new(texture.outputs["Color"], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], shader.inputs["Roughness"])
    return shader.outputs["BSDF"]


def mixed(tree, kind="ShaderNodeMixShader"):
    mix = tree.nodes.new(kind)
    shaders = [socket for socket in mix.inputs if socket.type == "SHADER"]
    if kind == "ShaderNodeMixShader":
        mix.inputs[0].default_value = 0.25
    tree.links.new(principled(tree, Roughness=0.2), shaders[0])
    tree.links.new(principled(tree, Roughness=0.6), shaders[1])
    return mix.outputs[0]


def of_noise(tree):
    shader, noise = tree.nodes.new("ShaderNodeBsdfPrincipled"), tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs[0], shader.inputs["Roughness"])
    return shader.outputs["BSDF"]


MATERIALS = {
    "principled": (lambda tree: principled(tree, Roughness=0.35), 0.35),
    "texture": (lambda tree: textured(tree, 0.5), 0.25),
    "texture of colours": (lambda tree: textured(tree, 0.5, "sRGB"), 0.107),  # ((0.5 + 0.055) / 1.055)^2.4 / 2
    "mixture": (mixed, 0.3),
    "sum": (lambda tree: mixed(tree, "ShaderNodeAddShader"), 0.4),
    "matt": (lambda tree: tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], 0.5),
    "noise": (of_noise, 0.5),
    "glossy": (lambda tree: tree.nodes.new("ShaderNodeBsdfAnisotropic").outputs[0], 0.5),
}


@pytest.mark.parametrize("kind", MATERIALS)
def test_roughness_is_read_off_nodes(fresh, addon, kind):
    make, expected = MATERIALS[kind]
    material = bpy.data.materials.new(kind)
    tree = material.node_tree
    tree.links.new(make(tree), tree.get_output_node("EEVEE").inputs["Surface"])
    assert addon.scene.materials.roughness(material, 0.5) == pytest.approx(expected, abs=0.003)


def roughness_seen(scene, addon, tmp_path):
    """(H, W) roughness of the frame as the engine reads it."""
    scene.afterlight.use_glossy = scene.afterlight.enabled = True
    render(scene, tmp_path / "picture.exr")
    path = addon.scene.frame_store.save(scene)
    try:
        return addon.scene.roughness.load(
            path, scene.view_layers[0].name, addon.scene.cameras.window(scene)[0]
        ).roughness
    finally:
        addon.scene.frame_store.discard(path)


def test_pixels_have_the_roughness_of_their_material(scene, addon, tmp_path):
    names = ["Plain", "Zwölf", "With.number.001", "Shiny"]
    for index, (name, rough) in enumerate(zip(names, (0.1, 0.3, 0.6, 0.9))):
        material = bpy.data.materials.get(name) or metal(name, rough)
        material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = rough
        wall(material, (-1.5 + index, 0.5, 0), (90, 0, 0)).scale = 0.2, 0.2, 0.2
    rough = roughness_seen(scene, addon, tmp_path)
    for value in (0.1, 0.3, 0.6, 0.9):
        assert (np.abs(rough - value) < 1e-6).sum() > 20


def test_an_aov_of_that_name_is_taken_instead(scene, addon, tmp_path):
    aov = scene.view_layers[0].aovs.add()
    aov.name, aov.type = "Roughness", "VALUE"
    tree = bpy.data.materials["Shiny"].node_tree
    output = tree.nodes.new("ShaderNodeOutputAOV")
    output.aov_name = "Roughness"
    output.inputs["Value"].default_value = 0.77
    rough = roughness_seen(scene, addon, tmp_path)
    assert (np.abs(rough - 0.77) < 1e-3).sum() > 100
    assert not scene.view_layers[0].use_pass_cryptomatte_material


# Nodes


@pytest.mark.parametrize("kind", TREES)
def test_unticking_leaves_the_file_as_it_was(scene, addon, kind):
    TREES[kind](scene)
    scene.afterlight.use_glossy = True
    before = written_down()
    scene.afterlight.enabled = True
    assert not addon.compositor.faults.find(scene)
    tree = scene.compositing_node_group
    assert [node for group in addon.compositor.nodes.trees(tree) for node in of_kind(group, "gloss")]
    assert scene.view_layers[0].use_pass_glossy_color and scene.view_layers[0].use_pass_cryptomatte_material
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


@pytest.mark.parametrize("kind", TREES)
@pytest.mark.parametrize("how", ["setting", "method"])
def test_the_setting_can_be_switched_while_ticked(scene, addon, kind, how):
    TREES[kind](scene)
    scene.afterlight.use_glossy = how == "method"
    scene.afterlight.method = "PAPER" if how == "method" else "RADIOSITY"
    scene.afterlight.enabled = True
    before = written_down()
    for _ in range(2):
        scene.afterlight.use_glossy, scene.afterlight.method = True, "RADIOSITY"
        assert not addon.compositor.faults.find(scene)
        once = written_down()
        addon.compositor.setup.connect(scene)
        assert not differences(once, written_down())
        if how == "setting":
            scene.afterlight.use_glossy = False
        else:
            scene.afterlight.method = "PAPER"
        assert not addon.compositor.faults.find(scene)
        assert not scene.view_layers[0].use_pass_glossy_color
    assert not differences(before, written_down())


@pytest.mark.parametrize("kind", ["none", "simple"])
@pytest.mark.parametrize("doomed", [("gloss",), ("light",), ("gloss", "light"), ("add", "gloss")])
def test_deleted_nodes_are_noticed_and_repaired(scene, addon, kind, doomed):
    TREES[kind](scene)
    scene.afterlight.use_glossy = scene.afterlight.enabled = True
    tree = scene.compositing_node_group
    picture = next(node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers" and node.scene == scene)
    users = [link.to_socket for link in tree.nodes["Afterlight"].outputs[2].links]
    for name in doomed:
        for node in of_kind(tree, name):
            tree.nodes.remove(node)
    assert addon.compositor.faults.find(scene)
    if kind == "simple" and "add" in doomed:
        for user in users:
            tree.links.new(picture.outputs["Image"], user)
    assert bpy.ops.afterlight.repair() == {"FINISHED"}
    assert not addon.compositor.faults.find(scene)
    assert [len(of_kind(tree, name)) for name in ("add", "light", "gloss")] == [1, 1, 1]
    scene.afterlight.enabled = False
    assert kind == "none" or not [node for node in tree.nodes if "afterlight" in node]


def test_views_show_gloss_where_it_is_wanted(scene, addon):
    scene.afterlight.views, scene.afterlight.view_count, scene.afterlight.enabled = "AUTOMATIC", 2, True
    for wanted in (False, True, False):
        scene.afterlight.use_glossy = wanted
        layer = addon.compositor.view_scenes.view_scene(scene).view_layers[0]
        assert layer.use_pass_glossy_color == layer.use_pass_glossy_direct == wanted
        assert not layer.use_pass_cryptomatte_material


def test_a_pass_in_use_stays_on(scene):
    tree = simple_tree(scene)
    scene.afterlight.use_glossy = scene.afterlight.enabled = True
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source, node.scene = "RENDER", scene
    scene.afterlight.use_glossy = False
    layer = scene.view_layers[0]
    assert layer.use_pass_cryptomatte_material and not layer.use_pass_glossy_color
    scene.afterlight.enabled = False
    assert layer.use_pass_cryptomatte_material and not layer.use_pass_z


@pytest.fixture
def handed(addon, monkeypatch):
    """{pass: (H, W, 3), bottom row first}, what the engine last returned to Blender."""
    found, engine = {}, addon.render.engine.AfterlightEngine
    hand_back = engine._hand_back

    def spy(self, shot, pictures):
        found.clear()
        found.update(pictures)
        hand_back(self, shot, pictures)

    monkeypatch.setattr(engine, "_hand_back", spy)
    return found


def test_probes_leave_it_out(scene, addon, tmp_path, handed):
    scene.afterlight.use_glossy = scene.afterlight.enabled = True
    assert not addon.diagnosis.checks.findings(scene)
    probe = put(bpy.data.lightprobes.new("Probe", "SPHERE"))
    (found,) = addon.diagnosis.checks.findings(scene)
    assert "probe" in found.text and not found.fatal
    handed.clear()
    render(scene, tmp_path / "probe.exr")
    assert handed["Indirect"].any() and "Indirect Glossy" not in handed
    probe.hide_render = True
    assert not addon.diagnosis.checks.findings(scene)


# Light


def test_gloss_reflects_the_room_once(scene, addon, tmp_path, handed):
    """The image gains the pass Indirect Glossy over the diffuse light: on the shiny wall alone, times Strength."""
    scene.afterlight.enabled = True
    diffuse = read_rgb(render(scene, tmp_path / "diffuse.exr"))
    assert set(handed) == {"Indirect"}
    scene.afterlight.use_glossy = True
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert scene.afterlight.report == "" and set(handed) == {"Indirect", "Indirect Glossy"}
    gloss = handed["Indirect Glossy"][::-1]
    np.testing.assert_allclose(lit - diffuse, gloss, atol=2e-3)
    near_red, near_white = gloss[14:22, 17:22].mean((0, 1)), gloss[14:22, 42:47].mean((0, 1))
    assert near_white.mean() > 0.05 * diffuse.mean() and not gloss[14:22, :14].any()
    assert near_red[0] / near_red[1] > 2 * near_white[0] / near_white[1], "it reflects the red wall"
    scene.afterlight.strength = 2
    assert bpy.ops.afterlight.update() == {"FINISHED"}
    np.testing.assert_allclose(handed["Indirect Glossy"], 2 * gloss[::-1], rtol=1e-4, atol=1e-6)
    scene.afterlight.use_glossy = False
    assert bpy.ops.afterlight.update() == {"FINISHED"} and set(handed) == {"Indirect"}


def test_an_update_says_what_the_last_render_lacks(scene, addon, tmp_path, handed):
    scene.afterlight.enabled = True
    render(scene, tmp_path / "diffuse.exr")
    scene.afterlight.use_glossy = True
    assert bpy.ops.afterlight.update() == {"FINISHED"}
    assert set(handed) == {"Indirect"} and any("F12" in text for text in addon.host.report.warnings(scene))
