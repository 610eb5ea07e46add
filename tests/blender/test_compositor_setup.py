# SPDX-License-Identifier: GPL-3.0-or-later
"""Ticking the box, unticking it, and everything that people do to a file in between. Nothing is rendered."""

import bpy
import pytest

from scenes import (
    TREES,
    box,
    compositor,
    differences,
    layered_tree,
    layers_node,
    nested_tree,
    read_rgb,
    render,
    simple_tree,
    written_down,
)


@pytest.fixture
def scene(fresh):
    return box(fresh)


def helpers():
    return [scene for scene in bpy.data.scenes if scene.render.engine == "AFTERLIGHT"]


def ours(tree):
    return [node for node in tree.nodes if "afterlight" in node]


@pytest.mark.parametrize("kind", TREES)
@pytest.mark.parametrize("compositing", [True, False])
def test_unticking_leaves_the_file_as_it_was(scene, addon, kind, compositing):
    TREES[kind](scene)
    scene.render.use_compositing = compositing
    scene.view_layers[0].use_pass_normal = True
    before = written_down()
    scene.afterlight.enabled = True
    assert not addon.compositor.faults.find(scene)
    assert written_down() != before
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


@pytest.mark.parametrize("kind", TREES)
def test_connecting_twice_changes_nothing(scene, addon, kind):
    TREES[kind](scene)
    scene.afterlight.enabled = True
    once = written_down()
    addon.compositor.setup.connect(scene)
    scene.afterlight.enabled = True
    assert not differences(once, written_down())


def test_a_tree_that_was_switched_off_stays_off(scene):
    tree = simple_tree(scene)
    scene.render.use_compositing = False
    scene.afterlight.enabled = True
    assert scene.render.use_compositing and scene.compositing_node_group != tree
    assert not ours(tree)


def test_muted_links_stay_muted(scene):
    tree = simple_tree(scene)
    link = next(link for link in tree.links if link.to_node.bl_idname == "CompositorNodeViewer")
    link.is_muted = True
    before = written_down()
    scene.afterlight.enabled = True
    assert [link.is_muted for link in tree.links if link.to_node.bl_idname == "CompositorNodeViewer"] == [True]
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


def test_other_scenes_are_left_alone(scene):
    other = bpy.data.scenes.new("Other")
    tree = compositor(scene)
    tree.links.new(layers_node(tree, other).outputs["Image"], tree.nodes.new("NodeGroupOutput").inputs[0])
    scene.afterlight.enabled = True
    assert not ours(tree) and len(tree.links) == 1


def test_what_the_user_builds_on_our_tree_is_kept(scene):
    scene.afterlight.enabled = True
    tree = scene.compositing_node_group
    blur = tree.nodes.new("CompositorNodeBlur")
    output = next(node for node in tree.nodes if node.bl_idname == "NodeGroupOutput")
    lit = output.inputs[0].links[0].from_socket
    tree.links.new(lit, blur.inputs[0])
    tree.links.new(blur.outputs[0], output.inputs[0])
    scene.afterlight.enabled = False
    assert scene.compositing_node_group == tree and not ours(tree)
    assert blur.inputs[0].links[0].from_node.bl_idname == "CompositorNodeRLayers"


def test_a_pass_the_user_has_come_to_use_stays_on(scene):
    tree = simple_tree(scene)
    scene.afterlight.enabled = True
    picture = next(node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers" and node.scene == scene)
    viewer = next(node for node in tree.nodes if node.bl_idname == "CompositorNodeViewer")
    tree.links.new(picture.outputs["Depth"], viewer.inputs["Image"])
    scene.afterlight.enabled = False
    layer = scene.view_layers[0]
    assert layer.use_pass_z and not layer.use_pass_normal
    assert viewer.inputs["Image"].links[0].from_socket.name == "Depth"


def test_a_picture_in_a_group_is_lit_when_the_cure_is_pressed(scene, addon, afterlight, tmp_path):
    """The fix used to report that a node "was deleted", and the image stayed plain."""
    tree = nested_tree(scene)
    for node in [node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers"]:
        tree.nodes.remove(node)
    scene.eevee.taa_render_samples = 1
    scene.afterlight.enabled = True
    (finding,) = afterlight.addon.diagnosis.checks.findings(scene)
    assert finding.fix == "RENDER_LAYERS" and "inside node groups" in finding.text
    bpy.ops.afterlight.mend(cure=finding.fix)
    assert not addon.compositor.faults.find(scene)
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert scene.afterlight.report == ""
    scene.afterlight.enabled = False
    assert len(tree.nodes) == 4 and not ours(tree), "viewer, group, output, and the node that was asked for"
    plain = read_rgb(render(scene, tmp_path / "plain.exr"))
    assert lit.mean() > 1.1 * plain.mean()


def test_a_compositor_that_uses_passes_only(scene, addon):
    """It used to be reported that a node was deleted."""
    tree = compositor(scene)
    picture = layers_node(tree, scene)
    scene.view_layers[0].use_pass_z = True
    tree.links.new(picture.outputs["Depth"], tree.nodes.new("NodeGroupOutput").inputs[0])
    scene.afterlight.enabled = True
    (fault,) = addon.compositor.faults.find(scene)
    assert "does not use the Image of any Render Layers node" in fault
    light = next(node for node in ours(tree))
    tree.links.new(light.outputs["Indirect"], tree.nodes["Group Output"].inputs[0])
    assert not addon.compositor.faults.find(scene), "the light alone is a use of it"


@pytest.mark.parametrize("kind", ["none", "simple", "layered"])
def test_the_link_of_the_image_is_missed_and_put_back(scene, addon, afterlight, kind):
    """A missing link used to give a black image without any message."""
    TREES[kind](scene)
    scene.afterlight.enabled = True
    tree = scene.compositing_node_group
    for link in [
        link
        for link in tree.links
        if link.to_node.name.startswith("Afterlight") and link.to_socket.identifier == "A_Color"
    ]:
        tree.links.remove(link)
    (finding,) = afterlight.addon.diagnosis.checks.findings(scene)
    assert "no longer linked" in finding.text and finding.fix == "REPAIR"
    bpy.ops.afterlight.repair()
    assert not addon.compositor.faults.find(scene)


@pytest.mark.parametrize("kind", ["none", "simple"])
@pytest.mark.parametrize("doomed", ["add", "light", "both"])
def test_deleting_our_nodes_is_noticed_and_repaired(scene, addon, afterlight, kind, doomed):
    TREES[kind](scene)
    scene.afterlight.enabled = True
    tree = scene.compositing_node_group
    picture = next(node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers" and node.scene == scene)
    users = [link.to_socket for link in tree.nodes["Afterlight"].outputs[2].links]
    for node in ours(tree):
        if node["afterlight"] != "plain" and doomed in (node["afterlight"], "both"):
            tree.nodes.remove(node)
    found = afterlight.addon.diagnosis.checks.findings(scene)
    only_the_user_knows = (kind, doomed) == ("simple", "add")  # Blender forgets the links of a deleted node
    assert found and {finding.fix for finding in found} == {"" if only_the_user_knows else "REPAIR"}
    addon.compositor.setup.follow(scene)
    assert addon.compositor.faults.find(scene), "nodes that a user deletes must not come back by themselves"
    if kind == "simple" and doomed != "light":  # as the message asks
        for user in users:
            tree.links.new(picture.outputs["Image"], user)
    assert bpy.ops.afterlight.repair() == {"FINISHED"}
    assert not addon.compositor.faults.find(scene)
    assert len([node for node in ours(tree) if node["afterlight"] != "plain"]) == 2
    scene.afterlight.enabled = False
    assert kind == "none" or not ours(tree)


def test_deleting_the_helper_scene_is_noticed_and_repaired(scene, addon):
    before = written_down()
    scene.afterlight.enabled = True
    bpy.data.scenes.remove(helpers()[0])
    assert addon.compositor.faults.find(scene)
    bpy.ops.afterlight.repair()
    assert not addon.compositor.faults.find(scene)
    scene.afterlight.enabled = False
    after = written_down()
    # The user deleted the scene without its camera, which stays; nothing else may be left.
    for kind in ("objects", "cameras"):
        after[kind] = {name: value for name, value in after[kind].items() if not name.startswith(".Afterlight")}
    assert not differences(before, after)


@pytest.mark.parametrize("built_on", [False, True])
def test_a_tree_of_ours_that_the_user_has_taken_out_of_use(scene, addon, built_on):
    scene.afterlight.enabled = True
    tree = scene.compositing_node_group
    if built_on:
        tree.nodes.new("CompositorNodeBlur")
    scene.compositing_node_group = None
    addon.compositor.setup.connect(scene)
    assert (scene.compositing_node_group == tree) != built_on and not addon.compositor.faults.find(scene)
    scene.afterlight.enabled = False
    assert len(bpy.data.node_groups) == int(built_on) and not built_on or not tree.keys() and not ours(tree)


@pytest.mark.parametrize("helper_deleted", [False, True])
@pytest.mark.parametrize("kind", TREES)
def test_a_tree_that_the_user_has_taken_out_of_use_is_cleared_too(scene, kind, helper_deleted):
    tree = TREES[kind](scene)
    if tree:
        tree.use_fake_user = True
    scene.afterlight.enabled = True
    scene.compositing_node_group = None
    if helper_deleted:
        bpy.data.cameras.remove(scene.afterlight.helper.camera.data)
        bpy.data.scenes.remove(scene.afterlight.helper)
    scene.afterlight.enabled = False
    assert not [node for each in bpy.data.node_groups for node in ours(each)]
    assert tree is None or tree.links


@pytest.mark.parametrize("other_ticked", [False, True])
def test_deleting_the_scene_takes_its_helper_along(scene, tmp_path, other_ticked):
    """At the latest when the file is saved: deleting it while Blender evaluates another scene would crash."""
    other = bpy.data.scenes.new("Other")
    scene.afterlight.enabled = True
    other.afterlight.enabled = other_ticked
    bpy.data.scenes.remove(scene)
    bpy.context.view_layer.update()
    other.afterlight.enabled = False
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    assert not helpers() and not [each for each in bpy.data.cameras if each.name.startswith(".Afterlight")]
    assert not [each for each in bpy.data.node_groups if ours(each) or each.keys()]


def test_view_layers_added_removed_and_renamed(scene, addon):
    tree = layered_tree(scene)
    scene.afterlight.enabled = True
    helper = helpers()[0]
    scene.view_layers[1].name = "Renamed"
    scene.view_layers.new("Third")
    addon.compositor.setup.follow(scene)
    assert [layer.name for layer in helper.view_layers] == [layer.name for layer in scene.view_layers]
    assert not addon.compositor.faults.find(scene)
    assert {node.layer for node in ours(tree) if node["afterlight"] == "light"} == {"ViewLayer", "Renamed"}
    assert [layer.use for layer in helper.view_layers] == [True, True, False], "an unused layer costs nothing"
    scene.view_layers.remove(scene.view_layers["Third"])
    addon.compositor.setup.follow(scene)
    assert not addon.compositor.faults.find(scene)


def test_edits_are_followed_by_themselves(scene, addon):
    layered_tree(scene)
    scene.afterlight.enabled = True
    scene.name = "Shot 7"
    scene.view_layers[1].name = "Hero"
    bpy.context.view_layer.update()
    assert [helper.name for helper in helpers()] == [".Afterlight (Shot 7)"]
    assert [layer.name for layer in helpers()[0].view_layers] == ["ViewLayer", "Hero"]


@pytest.mark.parametrize("how", ["LINK_COPY", "FULL_COPY", "EMPTY", "NEW"])
@pytest.mark.parametrize("kind", ["none", "layered"])
def test_a_copied_scene_gets_a_helper_of_its_own(scene, addon, how, kind):
    TREES[kind](scene)
    scene.afterlight.enabled = True
    bpy.ops.scene.new(type=how)
    copy = next(each for each in bpy.data.scenes if each not in helpers() and each != scene)
    addon.compositor.setup.follow(copy)
    assert copy.afterlight.enabled == (how != "NEW")
    assert addon.host.roles.lit_scene(scene.afterlight.helper) == scene and not addon.compositor.faults.find(scene)
    if copy.afterlight.enabled:
        assert addon.host.roles.lit_scene(copy.afterlight.helper) == copy and not addon.compositor.faults.find(copy)
        copy.afterlight.enabled = False
        assert not copy.compositing_node_group or not ours(copy.compositing_node_group)
    assert not addon.compositor.faults.find(scene)
    assert len(helpers()) == 1


def test_saved_and_loaded(scene, addon, tmp_path):
    simple_tree(scene)
    scene.afterlight.samples = 200
    before = written_down()
    scene.afterlight.enabled = True
    path = str(tmp_path / "ticked.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    scene = bpy.context.scene
    assert scene.afterlight.enabled and scene.afterlight.samples == 200 and not addon.compositor.faults.find(scene)
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


def test_undo_and_redo(scene, addon):
    simple_tree(scene)
    bpy.ops.ed.undo_push(message="before")
    before = written_down()
    scene.afterlight.enabled = True
    bpy.ops.ed.undo_push(message="ticked")
    bpy.ops.ed.undo()
    scene = bpy.context.scene
    assert not scene.afterlight.enabled and not differences(before, written_down())
    bpy.ops.ed.redo()
    scene = bpy.context.scene
    assert scene.afterlight.enabled and not addon.compositor.faults.find(scene)
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


def test_the_button_turns_off_ray_tracing(scene, afterlight):
    findings = afterlight.addon.diagnosis.checks.findings
    scene.eevee.use_raytracing = True
    scene.afterlight.enabled = True
    (found,) = findings(scene)
    assert found.fatal and found.fix == "RAY_TRACING"
    assert bpy.ops.afterlight.mend(cure=found.fix) == {"FINISHED"}
    assert not findings(scene) and not scene.eevee.use_raytracing


def test_presets_set_quality_and_nothing_else(scene, afterlight):
    settings = scene.afterlight
    settings.strength, settings.seed = 0.5, 7
    folder = bpy.utils.preset_paths("afterlight")
    assert folder
    seen = set()
    for name in ("draft", "paper", "production", "reference"):
        path = bpy.utils.preset_find(name, "afterlight")
        assert path, name
        bpy.ops.script.execute_preset(filepath=path, menu_idname="AFTERLIGHT_PT_presets")
        seen.add((settings.method, settings.start, settings.draws, settings.bounces, settings.views))
    assert len(seen) == 4 and (settings.strength, settings.seed) == (0.5, 7)
