# SPDX-License-Identifier: GPL-3.0-or-later
"""Freestyle lines cover the light as they cover the plain image, and leave no trace in the file."""

import bpy
import numpy as np
import pytest

from scenes import TREES, box, differences, matt, read_rgb, render, simple_tree, wall, written_down


@pytest.fixture
def scene(fresh):
    """The room, with a box whose edges are drawn."""
    scene = box(fresh, samples=4)
    scene.render.use_freestyle = scene.view_layers[0].use_freestyle = True
    settings = scene.view_layers[0].freestyle_settings
    if not settings.linesets:
        settings.linesets.new("Lines")
    if settings.linesets[0].linestyle is None:
        settings.linesets[0].linestyle = bpy.data.linestyles.new("Lines")
    style(scene, 3.0)
    bpy.data.objects["Lamp"].data.use_shadow = False  # so that only lines are black
    panel = wall(matt("Panel", (0.8, 0.8, 0.8)), (0, 0.8, 0), (90, 0, 0))
    panel.scale = 0.4, 0.4, 0.4
    return scene


def style(scene, thickness, color=(0, 0, 0), alpha=1.0):
    lines = scene.view_layers[0].freestyle_settings.linesets[0].linestyle
    lines.thickness, lines.color, lines.alpha = thickness, color, alpha


def laid(tree):
    return [node for node in tree.nodes if node.get("afterlight") == "lines"]


@pytest.mark.parametrize("kind", TREES)
def test_unticking_leaves_the_file_as_it_was(scene, addon, kind):
    TREES[kind](scene)
    for layer in scene.view_layers:
        layer.use_freestyle = True
    before = written_down()
    scene.afterlight.enabled = True
    tree = scene.compositing_node_group
    assert not addon.compositor.faults.find(scene) and scene.view_layers[0].freestyle_settings.as_render_pass
    adding = [
        node for group in addon.compositor.nodes.trees(tree) for node in group.nodes if node.get("afterlight") == "add"
    ]
    assert len([node for group in addon.compositor.nodes.trees(tree) for node in laid(group)]) == len(adding) > 0
    once = written_down()
    addon.compositor.setup.connect(scene)
    assert not differences(once, written_down())
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


def test_lines_that_are_a_pass_already_stay_one(scene, addon):
    scene.view_layers[0].freestyle_settings.as_render_pass = True
    before = written_down()
    scene.afterlight.enabled = True
    assert not laid(scene.compositing_node_group) and not addon.compositor.faults.find(scene)
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


def test_lines_can_be_switched_while_ticked(scene, addon):
    simple_tree(scene)
    scene.render.use_freestyle = False
    scene.afterlight.enabled = True
    layer, tree = scene.view_layers[0], scene.compositing_node_group
    without = written_down()
    for wanted in (True, False):
        scene.render.use_freestyle = wanted
        addon.compositor.setup.follow(scene)
        assert bool(laid(tree)) == layer.freestyle_settings.as_render_pass == wanted
        assert not addon.compositor.faults.find(scene)
    assert not differences(without, written_down())


@pytest.mark.parametrize("kind", ["none", "simple"])
@pytest.mark.parametrize("doomed", [("lines",), ("add",), ("add", "lines"), ("light",)])
def test_deleted_nodes_are_noticed_and_repaired(scene, addon, kind, doomed):
    TREES[kind](scene)
    scene.afterlight.enabled = True
    tree = scene.compositing_node_group
    picture = next(node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers" and node.scene == scene)
    users = [link.to_socket for link in laid(tree)[0].outputs["Image"].links]
    lit = tree.nodes["Afterlight"].outputs[2]
    for node in [node for node in tree.nodes if node.get("afterlight") in doomed]:
        tree.nodes.remove(node)
    if doomed == ("lines",):  # Blender forgets the links of a deleted node
        for user in users:
            tree.links.new(lit, user)
    elif "add" in doomed and kind == "simple":
        assert addon.compositor.faults.find(scene)
        for user in users:
            tree.links.new(picture.outputs["Image"], user)
    assert addon.compositor.faults.find(scene)
    assert bpy.ops.afterlight.repair() == {"FINISHED"}
    assert not addon.compositor.faults.find(scene)
    assert [
        len([node for node in tree.nodes if node.get("afterlight") == name]) for name in ("add", "light", "lines")
    ] == [1, 1, 1]
    scene.afterlight.enabled = False
    assert not laid(tree) if kind == "simple" else scene.compositing_node_group is None


def test_lines_over_the_light(scene, addon, tmp_path, monkeypatch):
    """Black lines stay black. What half-transparent lines let through is lit, as they let the plain image through."""
    handed, engine = [], addon.render.engine.AfterlightEngine
    hand_back = engine._hand_back

    def spy(self, shot, pictures):
        handed.append(pictures["Indirect"][::-1].copy())
        hand_back(self, shot, pictures)

    monkeypatch.setattr(engine, "_hand_back", spy)

    def shown(enabled):
        scene.afterlight.enabled = enabled
        found = read_rgb(render(scene, tmp_path / "picture.exr"))
        assert scene.afterlight.report == ""
        return found

    plain, lit = shown(False), shown(True)
    black = plain.max(-1) < 1e-5
    assert black.sum() > 20 and lit[black].max() < 1e-3
    assert (lit - plain)[~black].mean() > 0.05
    color = np.array((0.2, 0.9, 0.1))
    style(scene, 3.0, color, 0.5)
    plain, lit, light = shown(False), shown(True), handed[-1]
    cut = addon.scene.exr.read(addon.render.frames.kept(scene).path, addon.scene.cameras.window(scene)[0])
    clear = np.stack([cut(f"{scene.view_layers[0].name}.Combined.{axis}") for axis in "RGB"], -1)
    seen = (color[1] - plain[..., 1]) / (
        color[1] - clear[..., 1]
    )  # share of the plain image that the lines let through
    assert ((seen > 0.2) & (seen < 0.8)).sum() > 50 and (seen > 0.999).sum() > 50
    off = np.abs(lit - plain - seen[..., None] * light)
    assert np.quantile(off, 0.99) < 2e-3 and off.max() < 0.03, "but for a few pixels where lines are drawn anew"
    scene.afterlight.strength = 0
    assert bpy.ops.afterlight.update() == {"FINISHED"}
    bpy.data.images["Render Result"].save_render(str(tmp_path / "none.exr"), scene=scene)
    np.testing.assert_allclose(read_rgb(tmp_path / "none.exr"), plain, atol=1e-3)


def test_an_update_keeps_the_lines(scene, tmp_path):
    scene.afterlight.enabled = True
    first = read_rgb(render(scene, tmp_path / "first.exr"))
    assert bpy.ops.afterlight.update() == {"FINISHED"}
    assert scene.render.use_freestyle and not set(scene.keys()) - {"afterlight"}
    bpy.data.images["Render Result"].save_render(str(tmp_path / "again.exr"), scene=scene)
    np.testing.assert_allclose(read_rgb(tmp_path / "again.exr"), first, atol=1e-4)
