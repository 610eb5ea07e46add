# SPDX-License-Identifier: GPL-3.0-or-later
"""Views are reused from frame to frame if nothing that they see can change, and only then."""

import bpy
import numpy as np
import pytest

from scenes import box, put, read, set_format


@pytest.fixture
def scene(fresh):
    scene = box(fresh)
    scene.afterlight.method, scene.afterlight.view_count = "RADIOSITY", 2
    scene.frame_start, scene.frame_end = 1, 3
    return scene


@pytest.fixture
def scene_animation(afterlight):
    return afterlight.addon.scene.animation


def keyed(thing, path="location", index=0):
    """Make `thing` move in the three frames."""
    for frame in (1, 3):
        value = getattr(thing, path)
        if hasattr(value, "__len__"):
            value[index] += 0.1 * frame
        else:
            setattr(thing, path, value + 0.1 * frame)
        thing.keyframe_insert(path, frame=frame)
    return thing


def empty(*children):
    pivot = put(None)
    for child in children:
        child.parent = pivot
    return pivot


def geometry_nodes(node):
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    inner = bpy.data.node_groups.new("Inner", "GeometryNodeTree")
    inner.nodes.new(node)
    tree.nodes.new("GeometryNodeGroup").node_tree = inner
    bpy.data.objects["Wall"].modifiers.new("Nodes", "NODES").node_group = tree


def image(source):
    shader = bpy.data.materials["White"].node_tree
    node = shader.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("Image", 4, 4)
    node.image.source = source
    shader.links.new(node.outputs[0], shader.nodes["Principled BSDF"].inputs["Base Color"])


def track(thing, target):
    thing.constraints.new("TRACK_TO").target = target


KEEP = {
    "nothing": lambda scene: None,
    "camera": lambda scene: keyed(scene.camera),
    "lens": lambda scene: keyed(scene.camera.data, "lens"),
    "camera on a turntable": lambda scene: keyed(empty(empty(scene.camera)), "rotation_euler"),
    "camera that looks at an empty": lambda scene: track(scene.camera, keyed(put(None))),
    "static modifiers": lambda scene: bpy.data.objects["Wall"].modifiers.new("", "SUBSURF"),
    "static geometry nodes": lambda scene: geometry_nodes("GeometryNodeMeshCube"),
    "a picture": lambda scene: image("FILE"),
}
MOVE = {
    "lamp": lambda scene: keyed(bpy.data.objects["Lamp"]),
    "power": lambda scene: keyed(bpy.data.lights["Lamp"], "energy"),
    "wall": lambda scene: keyed(bpy.data.objects["Wall"]),
    "colour": lambda scene: keyed(
        bpy.data.materials["White"].node_tree.nodes["Principled BSDF"].inputs[0], "default_value"
    ),
    "driver": lambda scene: bpy.data.objects["Wall"].driver_add("location", 0),
    "visibility": lambda scene: bpy.data.objects["Wall"].keyframe_insert("hide_render"),
    "wall on an empty": lambda scene: keyed(empty(bpy.data.objects["Wall"])),
    "wall that follows an empty": lambda scene: track(bpy.data.objects["Wall"], keyed(put(None))),
    "wall that faces the camera": lambda scene: track(bpy.data.objects["Wall"], keyed(scene.camera)),
    "lamp on the camera": lambda scene: keyed(empty(scene.camera, bpy.data.objects["Lamp"])),
    "texture that follows an empty": lambda scene: setattr(
        bpy.data.materials["White"].node_tree.nodes.new("ShaderNodeTexCoord"), "object", keyed(put(None))
    ),
    "wave": lambda scene: bpy.data.objects["Wall"].modifiers.new("", "WAVE"),
    "particles": lambda scene: bpy.data.objects["Wall"].modifiers.new("", "PARTICLE_SYSTEM"),
    "scene time": lambda scene: geometry_nodes("GeometryNodeInputSceneTime"),
    "active camera": lambda scene: geometry_nodes("GeometryNodeInputActiveCamera"),
    "image sequence": lambda scene: image("SEQUENCE"),
    "settings": lambda scene: scene.eevee.keyframe_insert("taa_render_samples"),
}


@pytest.mark.parametrize("change", KEEP)
def test_what_keeps_still(scene, scene_animation, change):
    KEEP[change](scene)
    assert scene_animation.find_motion(scene, bpy.context.evaluated_depsgraph_get()) == ""


@pytest.mark.parametrize("change", MOVE)
def test_what_may_move(scene, scene_animation, change):
    MOVE[change](scene)
    assert scene_animation.find_motion(scene, bpy.context.evaluated_depsgraph_get()) != ""


def test_scripts_between_frames_may_move_anything(scene, scene_animation):
    def script(*_):
        pass

    bpy.app.handlers.frame_change_pre.append(script)
    try:
        assert scene_animation.find_motion(scene, bpy.context.evaluated_depsgraph_get()) != ""
    finally:
        bpy.app.handlers.frame_change_pre.remove(script)


def animation(scene, folder):
    """[{channel: pixels}] of the three frames."""
    set_format(scene, "OPEN_EXR")
    scene.render.filepath = f"{folder}/"
    bpy.ops.render.render(animation=True)
    return [read(folder / f"{frame:04}.exr") for frame in (1, 2, 3)]


@pytest.fixture
def rendered(afterlight, monkeypatch):
    """The suffixes of the views whose passes were saved."""
    suffixes, save = [], afterlight.addon.scene.frame_store.save_views

    def spy(scene, wanted):
        suffixes.extend(wanted)
        return save(scene, wanted)

    monkeypatch.setattr(afterlight.addon.scene.frame_store, "save_views", spy)
    return suffixes


@pytest.fixture
def evaluations(afterlight):
    """The role of each scene whose geometry Blender has evaluated for a render, "" for the user's."""
    roles = []

    def on_evaluated(scene, depsgraph):
        if depsgraph.mode == "RENDER" and any(
            update.is_updated_geometry and getattr(update.id, "type", "") == "MESH" for update in depsgraph.updates
        ):
            roles.append(scene.afterlight.role)

    on_evaluated.__module__ = f"{afterlight.addon.__name__}.test"  # another's could move anything
    bpy.app.handlers.frame_change_post.append(on_evaluated)
    yield roles
    bpy.app.handlers.frame_change_post.remove(on_evaluated)


def test_views_are_rendered_once_while_only_the_camera_moves(scene, scene_animation, rendered, monkeypatch, tmp_path):
    scene.afterlight.enabled = True
    keyed(scene.camera)
    kept = animation(scene, tmp_path / "kept")
    assert rendered == ["_1", "_2"]
    rendered.clear()
    monkeypatch.setattr(scene_animation, "find_motion", lambda *_: "everything")
    anew = animation(scene, tmp_path / "anew")
    assert rendered == ["_1", "_2"] * 3
    for one, other in zip(kept, anew):
        assert all(np.array_equal(one[name], other[name]) for name in other)
    assert np.abs(kept[0]["R"] - kept[2]["R"]).max() > 0.01  # the camera did move


def test_views_are_rendered_in_every_frame_where_the_lamp_moves(scene, rendered, tmp_path):
    scene.afterlight.enabled = True
    keyed(bpy.data.objects["Lamp"])
    animation(scene, tmp_path)
    assert rendered == ["_1", "_2"] * 3


def test_between_two_renders_anything_may_have_changed(scene, rendered, tmp_path):
    scene.afterlight.enabled = True
    animation(scene, tmp_path / "first")
    lamp = bpy.data.lights["Lamp"]
    lamp.energy *= 2
    rendered.clear()
    animation(scene, tmp_path / "second")
    assert rendered == ["_1", "_2"]


def test_how_often_the_scene_is_evaluated(scene, afterlight, evaluations, tmp_path):
    """Once for the views, placed anew or not, however many. Where only the camera moves, never: but Blender keeps one
    evaluated scene at a time, and evaluates the lit one again since our helper scenes have come between."""
    scene.afterlight.view_count = 5
    scene.afterlight.views, scene.afterlight.enabled = "AUTOMATIC", True
    for _ in ("placed anew", "kept"):
        bpy.ops.render.render()
        assert scene.afterlight.report == "" and evaluations == ["", "VIEW"]
        evaluations.clear()
    keyed(scene.camera)
    animation(scene, tmp_path / "camera")
    assert evaluations == ["", "VIEW", "", ""]
    evaluations.clear()
    keyed(bpy.data.objects["Wall"])
    animation(scene, tmp_path / "wall")
    assert evaluations == ["", "VIEW"] * 3
