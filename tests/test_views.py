# SPDX-License-Identifier: GPL-3.0-or-later
"""Further views: their scenes come and go with the settings, and what EEVEE saw through them is where it says it is."""

import bpy
import numpy as np
import pytest
from scenes import TREES, box, differences, put, read_rgb, render, simple_tree, written_down


@pytest.fixture
def scene(fresh):
    return box(fresh)


@pytest.fixture
def views(afterlight):
    return afterlight.addon.pipeline.views


@pytest.fixture
def wiring(afterlight):
    return afterlight.addon.pipeline.wiring


@pytest.fixture
def seen(views, monkeypatch):
    """[(light.Passes, light.Camera, Position pass)] of the views, as the engine of the light gets them."""
    found, load = [], views.Saved.load

    def spy(saved):
        loaded = load(saved)
        cut = views.passes.read(saved.path, saved.window)
        found.append((loaded, saved.camera, np.stack([cut(f"{saved.layer}.Position.{axis}") for axis in "XYZ"], -1)))
        return loaded

    monkeypatch.setattr(views.Saved, "load", spy)
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
    """(H, W, 3) world positions, rows top first, of depth seen through a light.Camera."""
    height, width = passes.depth.shape
    i, j = np.meshgrid(np.arange(width) + 0.5, height - np.arange(height) - 0.5)
    ray = camera.offset + camera.scale * np.stack([i, j], -1)
    depth = passes.depth[..., None]
    place = np.concatenate([ray * (1 if camera.orthographic else depth), -depth], -1)
    return place @ camera.rotation + camera.position  # the rotation's transpose, from the left


def test_manual_views_are_where_their_cameras_say(scene, views, seen, tmp_path):
    scene.afterlight.enabled = True
    by_hand(scene, side_camera(shift_x=0.1, lens=30), side_camera((0, 0, 1.3), (0, 0, 30), type="ORTHO", ortho_scale=3))
    for view in views.scenes(scene):
        view.view_layers[0].use_pass_position = True
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
    views.scenes(scene)[0].view_layers[0].use_pass_position = True
    scene.render.use_border, scene.render.use_crop_to_border = True, crop
    scene.render.border_min_x, scene.render.border_max_x = 0.5, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.25, 1
    scene.render.pixel_aspect_x = 1.5
    render(scene, tmp_path / "lit.exr")
    assert scene.afterlight.report == ""
    (passes, camera, place), = seen
    assert passes.size == (16, 27)
    hit = passes.depth < 1e9
    assert np.abs(positions(passes, camera) - place)[hit].max() < 1e-3
    width, height = passes.size
    corners = camera.offset, camera.offset + camera.scale * (width, height)
    assert np.allclose(corners, [(-16 / 27, -1), (16 / 27, 1)], atol=1e-5)  # 90 degrees along the longer side
