# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways to remove noise from the light: smoothing, Blender's Denoise node, or none."""

import bpy
import numpy as np
import pytest

from scenes import TREES, box, differences, read_rgb, render, simple_tree, written_down


@pytest.fixture
def scene(fresh):
    scene = box(fresh, samples=1)
    settings = scene.afterlight
    settings.method, settings.views, settings.start, settings.draws, settings.bounces = (
        "RADIOSITY",
        "CAMERA",
        "FULL",
        2,
        1,
    )
    return scene


def of_kind(scene, kind):
    trees = [
        scene.compositing_node_group,
        *(group for group in bpy.data.node_groups if group != scene.compositing_node_group),
    ]
    return [node for tree in trees for node in tree.nodes if node.get("afterlight") == kind]


def rough(picture):
    """Mean square of each pixel's difference from its four neighbours: mostly noise."""
    return np.mean(
        (picture[1:-1, 1:-1] - (picture[2:, 1:-1] + picture[:-2, 1:-1] + picture[1:-1, 2:] + picture[1:-1, :-2]) / 4)
        ** 2
    )


def test_each_way_takes_noise_out_and_no_light(scene, tmp_path):
    scene.afterlight.enabled = True
    found = {}
    for way in ("NONE", "SMOOTH", "NODE"):
        scene.afterlight.denoise = way
        render(scene, tmp_path / f"{way}.exr")
        found[way] = read_rgb(tmp_path / f"{way}.exr")
        assert scene.afterlight.report == "" and len(of_kind(scene, "denoise")) == (way == "NODE")
    assert rough(found["SMOOTH"]) < rough(found["NONE"]) / 3 and rough(found["NODE"]) < rough(found["NONE"]) / 3
    assert found["SMOOTH"].mean() == pytest.approx(found["NONE"].mean(), rel=0.01)
    assert found["NODE"].mean() == pytest.approx(found["NONE"].mean(), rel=0.02)


@pytest.mark.parametrize("kind", TREES)
@pytest.mark.parametrize("glossy", [False, True])
def test_the_node_comes_and_goes(scene, kind, glossy):
    """In every kind of compositor, with the glossy light and without, whichever is enabled first."""
    TREES[kind](scene)
    before = written_down()
    settings = scene.afterlight
    settings.use_glossy, settings.enabled = glossy, True
    plain = written_down()
    settings.denoise = "NODE"
    for node in of_kind(scene, "denoise"):
        assert [link.from_node.get("afterlight") for link in node.inputs["Image"].links] == ["light"]
        assert node.inputs["Albedo"].links[0].from_socket.name == "Diffuse Color"
        assert node.inputs["Normal"].links[0].from_socket.name == "Normal"
        assert [link.to_node.get("afterlight") for link in node.outputs["Image"].links] == [
            "gloss" if glossy else "add"
        ]
    assert len(of_kind(scene, "denoise")) == len(of_kind(scene, "add")) > 0
    settings.use_glossy = not glossy
    assert len(of_kind(scene, "denoise")) == len(of_kind(scene, "add")) and len(of_kind(scene, "gloss")) == (
        0 if glossy else len(of_kind(scene, "add"))
    )
    settings.use_glossy, settings.denoise = glossy, "SMOOTH"
    assert not differences(plain, written_down())
    settings.denoise = "NODE"
    settings.enabled = settings.use_glossy = False
    settings.denoise = "SMOOTH"
    for name in ("denoise", "use_glossy"):
        settings.property_unset(name)
    left = differences(before, written_down())
    assert all("afterlight" in line for line in left), left


def test_a_deleted_node_is_missed_and_repaired(scene, afterlight):
    tree = simple_tree(scene)
    scene.afterlight.denoise, scene.afterlight.enabled = "NODE", True
    (add,) = of_kind(scene, "add")
    (denoise,) = of_kind(scene, "denoise")
    light = denoise.inputs["Image"].links[0].from_socket
    tree.nodes.remove(denoise)
    faults = afterlight.addon.compositor.faults.find
    assert [cure for cure in faults(scene).values()] == ["REPAIR"]
    bpy.ops.afterlight.repair()
    assert not faults(scene) and len(of_kind(scene, "denoise")) == len(of_kind(scene, "light")) == 1
    tree.links.new(light, next(each for each in add.inputs if each.identifier == "B_Color"))  # bypasses the node
    assert any("Denoise node" in text for text in faults(scene))
