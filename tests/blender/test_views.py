# SPDX-License-Identifier: GPL-3.0-or-later
"""The further views: their scenes appear and go with the settings, and EEVEE's passes of them are where their cameras
say. test_placement.py tests where they are placed."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from scenes import TREES, box, differences, layers_node, matt, put, render, simple_tree, wall, written_down


@pytest.fixture
def scene(fresh):
    scene = box(fresh)
    scene.afterlight.method, scene.afterlight.views = "RADIOSITY", "CAMERA"
    return scene


@pytest.fixture
def views(afterlight):
    return afterlight.addon.compositor.view_scenes


@pytest.fixture
def seen(afterlight, monkeypatch):
    """[(gather.Passes, gather.Camera, Position pass)] of the views, as the engine passes them to the gather."""

    class Seen(list):
        def clear(self):
            super().clear()
            paths.clear()

    saved_view, exr = afterlight.addon.render.frames.SavedView, afterlight.addon.scene.exr
    found, load, paths = Seen(), saved_view.load, set()

    def spy(saved):
        loaded = load(saved)
        if saved.path in paths:  # each is loaded twice in a frame
            return loaded
        paths.add(saved.path)
        cut = exr.read(saved.path, saved.window)
        found.append((loaded, saved.camera, np.stack([cut(f"{saved.layer}.Position.{axis}") for axis in "XYZ"], -1)))
        return loaded

    monkeypatch.setattr(saved_view, "load", spy)
    return found


def by_hand(scene, *cameras):
    for camera in cameras:
        scene.afterlight.view_cameras.add().camera = camera
    scene.afterlight.views = "MANUAL"


def side_camera(location=(1.5, 1.5, 1), rotation=(60, 0, 140), **lens):
    camera = put(bpy.data.cameras.new("Side"), location, rotation)
    for name, value in lens.items():
        setattr(camera.data, name, value)
    return camera


def positions(passes, camera):
    """(H, W, 3) world positions, top row first, of depth seen through a gather.Camera."""
    height, width = passes.depth.shape
    i, j = np.meshgrid(np.arange(width) + 0.5, height - np.arange(height) - 0.5)
    ray = camera.offset + camera.scale * np.stack([i, j], -1)
    depth = passes.depth[..., None]
    place = np.concatenate([ray * (1 if camera.orthographic else depth), -depth], -1)
    return place @ camera.rotation + camera.position  # the rotation's transpose, from the left


def test_manual_views_are_where_their_cameras_say(scene, views, seen, tmp_path):
    scene.afterlight.enabled = True
    by_hand(scene, side_camera(shift_x=0.1, lens=30), side_camera((0, 0, 1.3), (0, 0, 30), type="ORTHO", ortho_scale=3))
    views.view_scene(scene).view_layers[0].use_pass_position = True
    render(scene, tmp_path / "lit.exr")
    assert scene.afterlight.report == "" and len(seen) == 2
    for passes, camera, place in seen:
        assert passes.size == (64, 36)
        hit = passes.depth < 1e9
        assert hit.mean() > 0.5
        assert np.abs(positions(passes, camera) - place)[hit].max() < 1e-3


@pytest.mark.parametrize("crop", [False, True])
def test_a_render_border_leaves_views_whole(scene, views, seen, tmp_path, crop):
    scene.afterlight.enabled = True
    camera = side_camera()
    camera.data.angle = np.radians(90)
    by_hand(scene, camera)
    views.view_scene(scene).view_layers[0].use_pass_position = True
    scene.render.use_border, scene.render.use_crop_to_border = True, crop
    scene.render.border_min_x, scene.render.border_max_x = 0.5, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.25, 1
    scene.render.pixel_aspect_x = 1.5
    render(scene, tmp_path / "lit.exr")
    assert scene.afterlight.report == ""
    ((passes, camera, place),) = seen
    assert passes.size == (16, 27)
    hit = passes.depth < 1e9
    assert np.abs(positions(passes, camera) - place)[hit].max() < 1e-3
    width, height = passes.size
    corners = camera.offset, camera.offset + camera.scale * (width, height)
    assert np.allclose(corners, [(-1, -1), (1, 1)], atol=1e-5)  # 90 degrees along either side


# Scenes and nodes that follow the settings


def kinds(scene):
    """The roles of our nodes at the top level, in the order in which Blender renders their scenes."""
    return [
        node.scene.afterlight.role.lower()
        for node in scene.compositing_node_group.nodes
        if node.get("afterlight") in {"view", "light"}
    ]


@pytest.mark.parametrize("kind", TREES)
def test_unticking_with_views_leaves_the_file_as_it_was(scene, addon, kind):
    TREES[kind](scene)
    scene.afterlight.views, scene.afterlight.view_count = "AUTOMATIC", 3
    before = written_down()
    scene.afterlight.enabled = True
    assert not addon.compositor.faults.find(scene)
    assert kinds(scene)[:2] == ["scout", "view"] and set(kinds(scene)[2:]) == {"helper"}
    once = written_down()
    addon.compositor.setup.connect(scene)
    addon.compositor.setup.follow(scene)
    assert not differences(once, written_down())
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


@pytest.mark.parametrize("kind", TREES)
def test_views_that_come_later_are_rendered_before_the_light(scene, addon, kind):
    TREES[kind](scene)
    scene.afterlight.enabled = True
    tree = scene.compositing_node_group
    light = next(node for node in tree.nodes if node.get("afterlight") == "light")
    light.location, light.label, name = (7, 8), "Mine", light.name
    users = sorted(
        (link.from_socket.name, link.to_node.name, link.to_socket.identifier) for link in light.outputs[0].links
    )
    before = written_down()
    scene.afterlight.views = "AUTOMATIC"
    assert not addon.compositor.faults.find(scene)
    made = tree.nodes[name]
    assert (tuple(made.location), made.label) == ((7, 8), "Mine")
    assert (
        sorted((link.from_socket.name, link.to_node.name, link.to_socket.identifier) for link in made.outputs[0].links)
        == users
    )
    order = kinds(scene)
    assert order[:2] == ["scout", "view"] and set(order[2:]) == {"helper"}
    scene.afterlight.views = "CAMERA"
    after = written_down()
    for state in (before, after):  # nodes come in another order
        for each in state["node_groups"].values():
            each["nodes"].sort(key=lambda node: node["name"])
    assert not differences(before, after)


def test_the_number_of_views_is_followed(scene, addon, views):
    scene.afterlight.enabled = True
    scene.afterlight.views = "AUTOMATIC"
    for count in (2, 9, 1):
        scene.afterlight.view_count = count
        assert len(views.views(scene)) == count and kinds(scene).count("view") == 1
        assert len([each for each in bpy.data.objects if each.name.startswith(".Afterlight Views")]) == count
        assert not addon.compositor.faults.find(scene)
    by_hand(scene, side_camera(), side_camera())
    assert len(views.views(scene)) == 2
    scene.name = "Shot 7"
    addon.compositor.setup.follow(scene)
    assert views.view_scene(scene).name == ".Afterlight Views (Shot 7)"
    assert views.placement_scene(scene).name == ".Afterlight Placement (Shot 7)"


@pytest.mark.parametrize("how", ["LINK_COPY", "FULL_COPY"])
@pytest.mark.parametrize("kind", ["none", "layered"])
def test_a_copied_scene_gets_views_of_its_own(scene, addon, views, how, kind):
    TREES[kind](scene)
    scene.afterlight.view_count = 2
    scene.afterlight.views = "AUTOMATIC"
    scene.afterlight.enabled = True
    bpy.ops.scene.new(type=how)
    copy = bpy.context.scene
    addon.compositor.setup.follow(copy)
    assert not addon.compositor.faults.find(scene) and not addon.compositor.faults.find(copy)
    assert len(views.views(copy)) == 2 and not set(views.views(copy)) & set(views.views(scene))
    assert views.view_scene(copy).background_set == copy
    copy.afterlight.enabled = False
    assert not addon.compositor.faults.find(scene)
    scene.afterlight.enabled = False
    assert not [each for each in bpy.data.scenes if each.afterlight.role]
    assert not [each for each in bpy.data.cameras if each.name.startswith(".Afterlight")]


def nodes_show(node, view):
    return node.bl_idname == "CompositorNodeRLayers" and node.scene == view


def delete_scene(views, scene):
    bpy.data.scenes.remove(views.view_scene(scene))


def delete_node(views, scene):
    tree = scene.compositing_node_group
    tree.nodes.remove(next(node for node in tree.nodes if nodes_show(node, views.view_scene(scene))))


def delete_camera(views, scene):
    bpy.data.objects.remove(views.views(scene)[2].camera)


def rename_camera(views, scene):
    views.views(scene)[2].camera.name = "Mine"


def remove_render_view(views, scene):
    render_views = views.view_scene(scene).render.views
    render_views.remove(render_views["Afterlight 2"])


@pytest.mark.parametrize("harm", [delete_scene, delete_node, delete_camera, rename_camera, remove_render_view])
def test_what_is_gone_of_the_views_is_noticed_and_repaired(scene, addon, views, harm):
    scene.afterlight.enabled = True
    scene.afterlight.views = "AUTOMATIC"
    harm(views, scene)
    addon.compositor.setup.follow(scene)
    assert addon.compositor.faults.find(scene)
    bpy.ops.afterlight.repair()
    assert not addon.compositor.faults.find(scene) and len(views.views(scene)) == 7


def test_deleting_the_scene_takes_its_views_along(scene, tmp_path):
    bpy.data.scenes.new("Other")
    scene.afterlight.views, scene.afterlight.enabled = "AUTOMATIC", True
    bpy.data.scenes.remove(scene)
    bpy.context.view_layer.update()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    assert [each.name for each in bpy.data.scenes] == ["Other"]


@pytest.fixture
def placement(afterlight):
    return afterlight.addon.views.placement


# In renders


def corner(scene):
    """The box, seen from so close that most of it is outside the image."""
    scene.camera.location, scene.camera.rotation_euler = (-0.5, 0, 0), np.radians((90, 0, 90))
    scene.afterlight.view_count = 5
    scene.afterlight.views, scene.afterlight.enabled = "AUTOMATIC", True
    return scene


def poses(scene, views):
    return [np.array(view.camera.matrix_basis) for view in views.views(scene)]


def test_automatic_views_end_to_end(scene, views, afterlight, seen, tmp_path):
    corner(scene)
    report = afterlight.addon.host.report
    views.view_scene(scene).view_layers[0].use_pass_position = True
    render(scene, tmp_path / "lit.exr")
    assert scene.afterlight.report == "" and not report.warnings(scene)
    shares, _ = report.coverage(scene)
    assert shares[0] < 0.5 and shares[-1] > 0.95 and len(shares) == len(seen) + 1
    stages = report.stages(scene)
    assert (
        list(stages)[:3] == ["place views", "EEVEE, views", "write passes"]
        and stages["EEVEE, views"] > stages["hand back"]
    )
    for passes, camera, place in seen:
        hit = passes.depth < 1e9
        found = positions(passes, camera)[hit]
        assert np.abs(found - place[hit]).max() < 1e-3
        assert np.abs(np.abs(found) - (2, 2, 1.5)).min(1).max() < 1e-3, "on a wall of the room"
        assert all(np.isfinite(axis[hit]).all() for axis in passes.diffuse_direct)
    used, first = len(seen), poses(scene, views)
    assert used < 5, "views that are not needed are not rendered"
    assert not any(view.is_used for view in views.views(scene)), "at rest no view is rendered"
    assert not views.view_scene(scene).view_layers[0].use

    seen.clear()  # nothing changed: the views stay
    render(scene, tmp_path / "lit.exr")
    assert len(seen) == used and np.array_equal(poses(scene, views), first)
    scene.camera.location.y += 0.2  # little changed
    render(scene, tmp_path / "lit.exr")
    assert np.array_equal(poses(scene, views), first)

    seen.clear()  # lit again: the kept views are used, and EEVEE does not render them
    assert bpy.ops.afterlight.update() == {"FINISHED"}
    assert len(seen) == used and not report.warnings(scene) and "EEVEE, views" not in report.stages(scene)
    scene.afterlight.view_count += 1  # fewer were asked for when it was rendered
    assert bpy.ops.afterlight.update() == {"FINISHED"}
    (said,) = report.warnings(scene)
    assert "Press F12" in said and scene.afterlight.report == ""
    scene.afterlight.view_count -= 1

    for view in views.views(scene)[1:used]:  # far from where they should be
        view.camera.location = (100, 0, 0)
    stored = views.stored_placement(scene)
    views.store_placement(scene, type(stored)([np.eye(4)], stored.coverage, stored.clearance))
    render(scene, tmp_path / "lit.exr")
    shares, _ = report.coverage(scene)
    assert shares[-1] > 0.95, "coverage had fallen, so the views moved"

    stored = views.stored_placement(scene)
    assert bpy.ops.afterlight.place_views() == {"FINISHED"} and scene.afterlight.views == "MANUAL"
    depsgraph = bpy.context.evaluated_depsgraph_get()
    view_cameras = afterlight.addon.scene.view_cameras
    kept = [each.camera.evaluated_get(depsgraph) for each in scene.afterlight.view_cameras]
    assert np.allclose([camera.matrix_world for camera in kept], stored.poses, atol=1e-5)
    for camera in kept:
        assert np.allclose(
            view_cameras.lens_of(camera, depsgraph, scene).pixel, view_cameras.wide_lens(scene, 0, 0).pixel, rtol=1e-5
        )


def pane(kind):
    """An object a metre across in the path of a ray along y."""
    if kind == "hair":
        hair = bpy.data.hair_curves.new("Hair")
        hair.add_curves([2] * 50)
        hair.position_data.foreach_set("vector", np.random.default_rng(0).uniform(-0.5, 0.5, 300))
        return put(hair, (0, 1, 0))
    material = matt("Pane", (0.8, 0.8, 0.8))
    tree = material.node_tree
    if kind in {"glass", "transparent"}:
        shader = tree.nodes.new("ShaderNodeBsdfGlass" if kind == "glass" else "ShaderNodeBsdfTransparent")
        tree.links.new(shader.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    elif kind == "alpha":
        tree.nodes["Principled BSDF"].inputs["Alpha"].default_value = 0.1
    elif kind == "volume":
        tree.links.clear()
    return wall(material, (0, 1, 0), (90, 0, 0))


@pytest.mark.parametrize(
    "kind, stops",
    [("wall", True), ("glass", True), ("transparent", False), ("alpha", False), ("volume", False), ("hair", False)],
)
def test_what_stands_in_the_way_of_a_view(scene, afterlight, kind, stops):
    """Materials that EEVEE sees through don't hide the wall behind them, two metres from the middle."""
    pane(kind)
    bpy.context.view_layer.update()
    geometry = afterlight.addon.views.ray_cast.Geometry(bpy.context.evaluated_depsgraph_get())
    distance, _, _ = geometry.cast(np.zeros((1, 3)), np.array([(0.0, 1, 0)]), np.array([np.inf]))
    assert abs(distance[0] - (1 if stops else 2)) < 1e-4


def test_two_scenes_that_share_a_tree_do_not_render_each_others_views(scene, views, seen, tmp_path):
    tree, other = simple_tree(scene), bpy.data.scenes.new("Other")
    other.render.engine, other.camera, other.compositing_node_group = "BLENDER_EEVEE", scene.camera, tree
    for thing in scene.objects:
        other.collection.objects.link(thing)
    tree.links.new(layers_node(tree, other).outputs["Image"], tree.nodes.new("CompositorNodeViewer").inputs[0])
    corner(scene)
    other.afterlight.views, other.afterlight.enabled = "AUTOMATIC", True
    views.view_scene(scene).view_layers[0].use_pass_position = True
    render(scene, tmp_path / "lit.exr")
    assert seen and views.stored_placement(scene) is not None
    assert views.stored_placement(other) is None


def test_views_that_can_not_be_used_are_named_and_left_out(scene, views, afterlight, seen, tmp_path):
    report = afterlight.addon.host.report
    scene.afterlight.enabled = True
    panorama = side_camera(type="PANO")
    panorama.name, away = "Dome", side_camera((0, 0, 5), (180, 0, 0))
    away.name = "Away"
    by_hand(scene, None, bpy.data.objects["Lamp"], panorama, away, side_camera())
    views.view_scene(scene).view_layers[0].use_pass_position = True
    render(scene, tmp_path / "lit.exr")
    assert scene.afterlight.report == "" and len(seen) == 1
    text = " ".join(report.warnings(scene))
    for part in (
        "no camera. Choose one",
        '"Lamp" is not a camera object',
        '"Dome" is panoramic',
        '"Away" sees no surface',
    ):
        assert part in text, part
    assert len(report.warnings(scene)) == 4


def test_a_view_that_fails_leaves_the_others(scene, views, afterlight, seen, tmp_path, monkeypatch):
    """A full disk ends a file before its end, and Blender says nothing of it for a scene with several views."""
    report = afterlight.addon.host.report
    scene.afterlight.enabled = True
    by_hand(scene, side_camera(), side_camera())
    views.view_scene(scene).view_layers[0].use_pass_position = True
    check = afterlight.addon.scene.frame_store.check

    def cut(path):
        if path.endswith("_2.exr"):
            Path(path).write_bytes(Path(path).read_bytes()[:-1000])
        check(path)

    monkeypatch.setattr(afterlight.addon.scene.frame_store, "check", cut)
    render(scene, tmp_path / "lit.exr")
    assert scene.afterlight.report == "" and len(seen) == 1
    (said,) = report.warnings(scene)
    assert said.startswith("A view could not be used: The passes could not be read back")


@pytest.mark.parametrize("covers", [True, False])
def test_what_covers_the_world_is_to_be_seen_as_well(scene, placement, monkeypatch, tmp_path, covers):
    """The box emits nothing: all weight of its surfaces beyond what they reflect is the world's light that they
    block."""
    sent, bounces = [], placement.trace

    def spy(places, normals, albedo, cast, radiance, rng, most):
        def and_keep(*hits):
            found = radiance(*hits)
            sent.append(found[2])
            return found

        return bounces(places, normals, albedo, cast, and_keep, rng, most)

    monkeypatch.setattr(placement, "trace", spy)
    scene.world = bpy.data.worlds.new("Bright")
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.6, 0.6, 0.6, 1)
    scene.afterlight.views, scene.afterlight.use_world_shadow, scene.afterlight.enabled = "AUTOMATIC", covers, True
    render(scene, tmp_path / "lit.exr")
    assert np.concatenate(sent) == pytest.approx(0.6 if covers else 0.0, abs=1e-6)


def test_a_scene_with_nothing_to_hit_is_rendered_all_the_same(scene, afterlight, tmp_path):
    corner(scene)
    for thing in [thing for thing in scene.objects if thing.type == "MESH"]:
        bpy.data.objects.remove(thing)
    render(scene, tmp_path / "lit.exr")
    assert scene.afterlight.report == ""
    assert "No views were placed" in afterlight.addon.host.report.warnings(scene)[0]


def test_muted_views_are_not_used(scene, views, seen, tmp_path):
    scene.afterlight.enabled = True
    by_hand(scene, side_camera(), side_camera())
    tree = scene.compositing_node_group
    next(node for node in tree.nodes if nodes_show(node, views.view_scene(scene))).mute = True
    render(scene, tmp_path / "lit.exr")
    assert scene.afterlight.report == "" and not seen


def test_the_picture_is_written_once_a_frame(scene, afterlight, tmp_path, monkeypatch):
    """The placement engine and the light engine read the same file of this frame; only what is kept remains of it."""
    written, save = [], afterlight.addon.scene.frame_store.save
    monkeypatch.setattr(afterlight.addon.scene.frame_store, "save", lambda lit: written.append(lit) or save(lit))
    scene.afterlight.views, scene.afterlight.view_count, scene.afterlight.enabled = "AUTOMATIC", 1, True
    for _ in range(2):
        written.clear()
        render(scene, tmp_path / "lit.exr")
        assert written.count(scene) == 1 and scene.afterlight.report == ""
    job = afterlight.addon.render.job.begin(scene)
    path = job.passes_file(scene)
    assert job.passes_file(scene) == path and written.count(scene) == 2 and Path(path).exists()
    afterlight.addon.render.job.end()
    assert not Path(path).exists()


@pytest.mark.parametrize("kind", ["none", "one colour", "sky"])
def test_the_world_of_the_views(scene, views, addon, tmp_path, kind):
    """A world of one colour is copied for a frame, in the smallest resolution, and nothing of it stays."""
    scene.world = None
    if kind != "none":
        scene.world = bpy.data.worlds.new("Sky")
        tree = scene.world.node_tree
        tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.4, 0.6, 1)
        if kind == "sky":
            sky = tree.nodes.new("ShaderNodeTexSky")
            tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    scene.afterlight.views, scene.afterlight.enabled = "AUTOMATIC", True
    view_scene, worlds, seen = views.view_scene(scene), set(bpy.data.worlds), []

    def look(rendered, *_):
        if rendered == view_scene:
            seen.append((rendered.world == scene.world, rendered.world.probe_resolution))

    bpy.app.handlers.frame_change_post.append(look)
    try:
        render(scene, tmp_path / "lit.exr")
    finally:
        bpy.app.handlers.frame_change_post.remove(look)
    assert scene.afterlight.report == "" and seen == [(True, "1024") if kind == "sky" else (False, "128")]
    assert set(bpy.data.worlds) == worlds and view_scene.world is None
