# SPDX-License-Identifier: GPL-3.0-or-later
"""What belongs to the user stays: whatever a file claims, a script remaps, or somebody copies or links. Nothing is
rendered."""

from pathlib import Path

import bpy
import pytest

from scenes import box, compositor, differences, layers_node, written_down

OF_0_3_0 = Path(__file__).parents[1] / "data" / "afterlight_0_3_0.blend"


@pytest.fixture
def scene(fresh):
    return box(fresh)


@pytest.fixture
def with_views(scene):
    """A lit scene with two automatic views: three helper scenes."""
    scene.afterlight.method, scene.afterlight.view_count = "RADIOSITY", 2
    scene.afterlight.enabled = True
    assert len(ours()) == 3
    return scene


def ours():
    return [scene for scene in bpy.data.scenes if scene.afterlight.role]


def settle():
    """Evaluate the scene, as Blender does after an edit."""
    bpy.context.view_layer.update()
    bpy.context.evaluated_depsgraph_get()


def precious():
    """A scene of the user's with an object of its own."""
    made = bpy.data.scenes.new("Precious")
    made.collection.objects.link(bpy.data.objects.new("Treasure", bpy.data.cameras.new("Treasure")))
    made.camera = bpy.data.objects["Treasure"]
    return made


def test_a_script_that_ticks_every_scene(with_views):
    """Helper scenes used to get helpers of their own, without end."""
    before = [scene.name for scene in bpy.data.scenes]
    for _ in range(3):
        for scene in bpy.data.scenes:
            scene.afterlight.enabled = True
        settle()
    assert [scene.name for scene in bpy.data.scenes] == before
    assert [scene for scene in bpy.data.scenes if scene.afterlight.enabled] == [with_views]


@pytest.mark.parametrize("how", ["NEW", "EMPTY", "LINK_COPY", "FULL_COPY"])
@pytest.mark.parametrize("kind", ["HELPER", "SCOUT", "VIEW"])
def test_a_copied_helper_scene_is_the_users(with_views, addon, how, kind):
    """The copy used to be deleted while Blender was still using it."""
    bpy.context.window.scene = next(scene for scene in ours() if scene.afterlight.role == kind)
    bpy.ops.scene.new(type=how)
    copy = bpy.context.scene
    for _ in range(2):
        settle()
    assert copy.name in bpy.data.scenes and not addon.compositor.faults.find(with_views)
    assert not copy.afterlight.role or "You can delete it" in addon.diagnosis.checks.findings(copy)[0].text
    with_views.afterlight.enabled = False
    settle()
    assert [scene.name for scene in bpy.data.scenes if scene not in (copy, with_views)] == []


def test_a_copy_outlives_the_lit_scene(with_views, tmp_path):
    bpy.context.window.scene = with_views.afterlight.helper
    bpy.ops.scene.new(type="FULL_COPY")
    copy = bpy.context.scene
    bpy.data.scenes.remove(with_views)
    settle()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    assert [scene for scene in bpy.data.scenes if scene != copy and scene.afterlight.role] == []


@pytest.mark.parametrize("what", ["object", "data"])
@pytest.mark.parametrize("kind", ["HELPER", "VIEW"])
def test_the_users_camera_in_a_helper_scene(with_views, what, kind):
    """It used to be deleted with the scene."""
    camera = with_views.camera
    helper = next(scene for scene in ours() if scene.afterlight.role == kind)
    if what == "object":
        helper.collection.objects.link(camera)
        helper.camera = camera
    else:
        helper.camera.data = camera.data
    settle()
    lens = camera.data.lens, camera.matrix_world.copy()
    with_views.afterlight.enabled = False
    settle()
    assert with_views.camera == camera and camera.name in with_views.objects
    assert (camera.data.lens, camera.matrix_world) == lens
    assert not ours() and len(bpy.data.scenes) == 1


def test_an_object_that_is_nowhere_else_keeps_its_scene(with_views):
    thing = bpy.data.objects.new("Thing", bpy.data.meshes.new("Thing"))
    with_views.afterlight.helper.collection.objects.link(thing)
    with_views.afterlight.enabled = False
    (kept,) = thing.users_scene
    assert not kept.afterlight.role and not kept.name.startswith(".") and kept.render.engine == "BLENDER_EEVEE"
    with_views.afterlight.enabled = True
    assert thing.users_scene == (kept,) and len(ours()) == 3


@pytest.mark.parametrize("is_elsewhere", [True, False])
def test_a_collection_in_a_helper_scene(with_views, is_elsewhere):
    """If the lit scene contains it as well, nothing is lost with the helper, which goes; otherwise the helper scene
    stays."""
    collection, thing = bpy.data.collections.new("Mine"), bpy.data.objects.new("Thing", None)
    collection.objects.link(thing)
    with_views.afterlight.helper.collection.children.link(collection)
    if is_elsewhere:
        with_views.collection.children.link(collection)
    with_views.afterlight.enabled = False
    assert thing.users_collection == (collection,) and thing.users_scene
    assert len(bpy.data.scenes) == (1 if is_elsewhere else 2)


CLAIMS = {
    "a helper": lambda lit, other: setattr(lit.afterlight, "helper", other),
    "a view": lambda lit, other: setattr(lit.afterlight.view_scenes.add(), "scene", other),
    "the mark of 0.3.0": lambda lit, other: other.__setitem__("afterlight", "helper"),
    "the mark of 0.3.0, both ways": lambda lit, other: (
        other.__setitem__("afterlight", "helper"),
        setattr(lit.afterlight, "helper", other),
    ),
    "a role": lambda lit, other: (
        setattr(other.afterlight, "role", "HELPER"),
        setattr(other.afterlight, "serves", lit),
    ),
    "a role, both ways": lambda lit, other: (
        setattr(other.afterlight, "role", "HELPER"),
        setattr(other.afterlight, "serves", lit),
        setattr(lit.afterlight, "helper", other),
        setattr(other.afterlight, "own_camera", other.camera),
    ),
}


@pytest.mark.parametrize("claim", CLAIMS)
@pytest.mark.parametrize("ticked", [False, True], ids=["unticked", "ticked"])
def test_what_a_file_claims(scene, tmp_path, claim, ticked):
    """A pointer or a custom property used to make any scene ours, and it was deleted."""
    path = str(tmp_path / "crafted.blend")

    def save_and_load():
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        return bpy.data.scenes["Scene"]

    precious()
    scene = save_and_load()
    before = written_down()["scenes"]["Precious"]
    scene.afterlight.enabled = ticked
    CLAIMS[claim](scene, bpy.data.scenes["Precious"])
    save_and_load()
    settle()
    scene = bpy.data.scenes["Scene"]
    scene.afterlight.enabled = True
    settle()
    scene.name = "Renamed"
    settle()
    scene.afterlight.enabled = False
    settle()
    after = written_down()["scenes"]["Precious"]
    assert not [line for line in differences(before, after) if "afterlight" not in line]
    assert "Treasure" in bpy.data.scenes["Precious"].objects and bpy.data.objects["Treasure"].data.name == "Treasure"
    assert {each.name for each in bpy.data.scenes} == {"Renamed", "Precious"}


def test_a_helper_that_is_remapped(with_views, addon):
    other = precious()
    with_views.afterlight.helper.user_remap(other)
    settle()
    addon.compositor.setup.connect(with_views)
    assert not addon.compositor.faults.find(with_views) and len(ours()) == 3
    with_views.afterlight.enabled = False
    assert other.name == "Precious" and other.camera.name == "Treasure" and not ours()


def test_records_that_a_script_clears_multiply_nothing(with_views, addon):
    for _ in range(3):
        with_views.afterlight.helper = None
        with_views.afterlight.view_scenes.clear()
        settle()
        addon.compositor.setup.connect(with_views)
        assert len(ours()) == 3 and not addon.compositor.faults.find(with_views)
    with_views.afterlight.helper = None
    with_views.afterlight.view_scenes.clear()
    with_views.afterlight.enabled = False
    assert len(bpy.data.scenes) == 1


@pytest.mark.parametrize("value", [1, "text", ["use_pass_z", "x"], [1.5], {"a": 1}, ["use_pass_combined"]])
def test_a_view_layers_property_of_our_name(scene, value):
    """It used to raise TypeErrors."""
    scene.view_layers[0]["afterlight"] = value
    before = written_down()
    scene.afterlight.enabled = True
    assert scene.view_layers[0].use_pass_z
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


@pytest.mark.parametrize("kind", ["add", "light", "view", "plain", "gloss", 7])
def test_nodes_of_the_user_with_a_property_of_our_name(scene, addon, kind):
    tree = compositor(scene)
    picture, blur, output = (
        layers_node(tree, scene),
        tree.nodes.new("CompositorNodeBlur"),
        tree.nodes.new("NodeGroupOutput"),
    )
    tree.links.new(picture.outputs["Image"], blur.inputs["Image"])
    tree.links.new(blur.outputs["Image"], output.inputs[0])
    for node in (picture, blur):
        node["afterlight"] = kind
    before = written_down()
    scene.afterlight.enabled = True
    assert not addon.compositor.faults.find(scene) and [
        node for node in tree.nodes if addon.compositor.nodes.role(node) == "add"
    ]
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


@pytest.mark.parametrize("pointer", ["own_tree", "set_aside"])
@pytest.mark.parametrize("filled", [True, False])
def test_a_tree_that_the_file_calls_ours(scene, pointer, filled):
    tree = bpy.data.node_groups.new("Mine", "CompositorNodeTree")
    tree.use_fake_user = True
    if filled:
        layers_node(tree, scene)["afterlight"] = "plain"
    scene.afterlight.enabled = True
    scene.compositing_node_group = tree
    setattr(scene.afterlight, pointer, tree)
    scene.afterlight.enabled = False
    assert tree == bpy.data.node_groups["Mine"] and len(tree.nodes) == int(filled) and not tree.links


GARBAGE = {
    "a number": 3,
    "a text": "poses",
    "nothing": {},
    "no coverage": {"poses": [1.0] * 16},
    "odd length": {"poses": [1.0] * 7, "coverage": [1.0, 1.0], "clearance": 0.1},
    "texts": {"poses": "text", "coverage": "text", "clearance": "text"},
    "no turn": {"poses": [1.0] * 16, "coverage": [0.5, 0.9], "clearance": 0.1},
    "far away": {
        "poses": [1, 0, 0, 1e30, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.0],
        "coverage": [0.5, 0.9],
        "clearance": 0.1,
    },
    "not a number": {"poses": [float("nan")] * 16, "coverage": [0.5, 0.9], "clearance": 0.1},
    "no clearance": {
        "poses": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.0],
        "coverage": [0.5, 0.9],
        "clearance": -1.0,
    },
    "one number": {"poses": [], "coverage": -4.5e16, "clearance": 1.0},
    "no share": {"poses": [], "coverage": [7.0], "clearance": 1.0},
    "too many": {
        "poses": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.0] * 1000,
        "coverage": [0.5] * 1001,
        "clearance": 1.0,
    },
}


@pytest.mark.parametrize("kind", GARBAGE)
def test_a_placement_of_garbage_is_none(with_views, addon, kind):
    views = addon.compositor.view_scenes
    views.placement_scene(with_views)["placed"] = GARBAGE[kind]
    assert views.stored_placement(with_views) is None


def test_a_placement_is_read_as_it_was_kept(with_views, addon):
    import numpy as np

    pose = np.eye(4)
    pose[:3, 3] = 1, 2, 3
    addon.compositor.view_scenes.store_placement(with_views, addon.views.placement.Placement([pose], [0.5, 0.9], 0.25))
    found = addon.compositor.view_scenes.stored_placement(with_views)
    np.testing.assert_allclose(found.poses, [pose])
    assert (found.coverage, found.clearance) == ([0.5, 0.9], 0.25)


def test_a_file_of_0_3_0(afterlight, addon):
    """Its helper scenes become ours, a scene that only resembles one stays, and unticking leaves no trace in the
    file."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=str(OF_0_3_0))
    settle()
    views, paper, lookalike = (bpy.data.scenes[name] for name in ("Views", "Paper", "Precious"))
    assert len(bpy.data.scenes) == 7 and len(ours()) == 4 and not lookalike.afterlight.role
    for scene in (views, paper):
        assert scene.afterlight.enabled and not addon.diagnosis.checks.findings(scene)
    assert tuple(views.afterlight.version) == afterlight.addon.properties.VERSION
    for scene in (views, paper):
        scene.afterlight.enabled = False
    assert {scene.name for scene in bpy.data.scenes} == {"Views", "Paper", "Precious"}
    assert "Lamp" in lookalike.objects and lookalike["afterlight"] == "helper"
    assert [tree.name for tree in bpy.data.node_groups] == ["Compositing"]
    assert not [camera for camera in bpy.data.cameras if camera.name.startswith(".")]
    assert not any(
        layer.use_pass_normal or "afterlight" in layer for scene in bpy.data.scenes for layer in scene.view_layers
    )


def test_a_scene_that_is_linked_from_a_file_of_0_3_0(fresh, addon):
    with bpy.data.libraries.load(str(OF_0_3_0), link=True) as (_, linked):
        linked.scenes = ["Paper"]
    (scene,) = linked.scenes
    assert (
        scene.library
        and addon.host.roles.lit_scene(scene.afterlight.helper) == scene
        and not addon.diagnosis.checks.findings(scene)
    )
