# SPDX-License-Identifier: GPL-3.0-or-later
"""A muted Render Layers node or link brings no image, so it must bring no light either, and no grey in their place."""

import bpy
import numpy as np
import pytest

from scenes import box, compositor, layers_node, read_rgb, render


@pytest.fixture
def scene(fresh):
    scene = box(fresh, samples=1)
    scene.view_layers.new("Front")
    return scene


def both_layers(scene):
    """The sum of both layers' images; the Render Layers node of the second."""
    tree = compositor(scene)
    back, front = layers_node(tree, scene, "ViewLayer"), layers_node(tree, scene, "Front")
    mix, output = tree.nodes.new("ShaderNodeMix"), tree.nodes.new("NodeGroupOutput")
    mix.data_type, mix.blend_type = "RGBA", "ADD"
    mix.inputs[0].default_value = 1.0
    tree.links.new(back.outputs["Image"], mix.inputs[6])
    tree.links.new(front.outputs["Image"], mix.inputs[7])
    tree.links.new(mix.outputs[2], output.inputs[0])
    mix.inputs[7].default_value = 0.02, 0.04, 0.06, 1.0
    return front


@pytest.fixture(scope="module")
def one_layers_light(afterlight, tmp_path_factory):
    """The light that one layer adds to the box."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene, folder = box(bpy.context.scene, samples=1), tmp_path_factory.mktemp("one")
    plain = read_rgb(render(scene, folder / "plain.exr"))
    scene.afterlight.enabled = True
    return read_rgb(render(scene, folder / "lit.exr")) - plain


@pytest.mark.parametrize("what, when", [("node", "before"), ("link", "after")])
def test_a_muted_second_layer(scene, one_layers_light, tmp_path, what, when):
    """It used to add grey of one half, and the light of an image that was not there."""
    front = both_layers(scene)

    def mute():
        if what == "node":
            front.mute = True
        else:
            front.outputs["Image"].links[0].is_muted = True

    if when == "before":
        mute()
    scene.afterlight.enabled = True
    if when == "after":
        mute()
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert scene.afterlight.report == ""
    scene.afterlight.enabled = False
    assert front.mute == (what == "node") and front.outputs["Image"].links[0].is_muted == (what == "link")
    plain = read_rgb(render(scene, tmp_path / "plain.exr"))
    np.testing.assert_allclose(lit - plain, one_layers_light, atol=2e-3)


def test_unmuting_brings_the_light_back(scene, afterlight):
    front, addon = both_layers(scene), afterlight.addon
    scene.afterlight.enabled = True
    light = next(
        node
        for node in scene.compositing_node_group.nodes
        if addon.compositor.nodes.role(node) == "light" and node.layer == "Front"
    )
    for is_muted in (True, False, True):
        front.mute = is_muted
        addon.compositor.setup.follow(scene)
        assert light.mute == is_muted
    scene.afterlight.enabled = False
    assert front.mute


def test_a_light_node_that_the_user_muted_stays_muted(scene, afterlight):
    both_layers(scene)
    scene.afterlight.enabled = True
    nodes = afterlight.addon.compositor.nodes
    light = next(node for node in scene.compositing_node_group.nodes if nodes.role(node) == "light")
    light.mute = True
    bpy.context.view_layer.update()
    afterlight.addon.compositor.setup.follow(scene)
    assert light.mute


def test_the_only_picture_muted(scene, tmp_path):
    tree = compositor(scene)
    picture = layers_node(tree, scene)
    tree.links.new(picture.outputs["Image"], tree.nodes.new("NodeGroupOutput").inputs[0])
    picture.mute = True
    plain = read_rgb(render(scene, tmp_path / "plain.exr"))
    scene.afterlight.enabled = True
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    np.testing.assert_array_equal(lit, plain)
    assert "muted" in scene.afterlight.report and "Unmute" in scene.afterlight.report
