# SPDX-License-Identifier: GPL-3.0-or-later
"""Update Indirect Light: the image of a fresh render with the new settings, without EEVEE, and nothing else changed."""

import os
from pathlib import Path

import bpy
import numpy as np
import pytest

from scenes import TREES, box, differences, read, read_rgb, render, set_format, written_down


@pytest.fixture
def scene(fresh):
    scene = box(fresh, samples=2)
    scene.afterlight.enabled = True
    return scene


@pytest.fixture
def relight(afterlight):
    return afterlight.addon.render.relight


def updated(scene, path):
    """The image after the operator, as a person would save it."""
    assert bpy.ops.afterlight.update() == {"FINISHED"}
    set_format(scene)
    bpy.data.images["Render Result"].save_render(str(path), scene=scene)
    return read_rgb(path)


@pytest.mark.parametrize("kind", TREES)
def test_an_update_is_a_fresh_render_without_eevee(scene, tmp_path, kind):
    TREES[kind](scene)
    scene.afterlight.enabled = False
    scene.afterlight.enabled = True
    first = read_rgb(render(scene, tmp_path / "first.exr"))
    scene.afterlight.start, scene.afterlight.samples, scene.afterlight.strength = "FULL", 64, 2
    expected = read_rgb(render(scene, tmp_path / "expected.exr"))
    scene.afterlight.start, scene.afterlight.samples, scene.afterlight.strength = "HALF", 256, 1
    lamp = bpy.data.objects["Lamp"]
    lamp.location.x -= 1  # EEVEE would render it
    before = written_down()
    assert np.array_equal(updated(scene, tmp_path / "again.exr"), first)
    scene.afterlight.start, scene.afterlight.samples, scene.afterlight.strength = "FULL", 64, 2
    assert np.array_equal(updated(scene, tmp_path / "updated.exr"), expected)
    assert not np.array_equal(first, expected) and scene.afterlight.report == ""
    scene.afterlight.start, scene.afterlight.samples, scene.afterlight.strength = "HALF", 256, 1
    after = written_down()
    for state in (before, after):
        state.pop("images")
    assert not differences(before, after)


def test_every_pass_comes_back(scene, tmp_path):
    """All passes that EEVEE can render, data passes and Cryptomatte included, bit for bit and in the same order."""
    layer = scene.view_layers[0]
    for prop in layer.bl_rna.properties:
        if prop.identifier.startswith("use_pass_") and prop.type == "BOOLEAN":
            setattr(layer, prop.identifier, True)
    layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
    aov = layer.aovs.add()
    aov.name, aov.type = "Mine", "VALUE"
    first = read(render(scene, tmp_path / "first.exr", "OPEN_EXR_MULTILAYER"))
    assert bpy.ops.afterlight.update() == {"FINISHED"}
    bpy.data.images["Render Result"].save_render(str(tmp_path / "again.exr"), scene=scene)
    again = read(tmp_path / "again.exr")
    assert first.keys() == again.keys() and len(first) > 40
    for name, pixels in first.items():
        np.testing.assert_array_equal(pixels, again[name], name)


def test_a_render_region_and_a_crop(scene, tmp_path):
    render_settings = scene.render
    render_settings.use_border = True
    render_settings.border_min_x, render_settings.border_max_y = 0.25, 0.75
    for crop in (False, True):
        render_settings.use_crop_to_border = crop
        first = read_rgb(render(scene, tmp_path / "first.exr"))
        assert np.array_equal(updated(scene, tmp_path / "again.exr"), first)


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda scene: setattr(scene.render, "resolution_x", 32), "resolution"),
        (
            lambda scene: setattr(scene.render, "use_border", True) or setattr(scene.render, "border_max_x", 0.5),
            "region",
        ),
        (lambda scene: scene.view_layers.new("Front"), "View layers"),
        (lambda scene: os.remove(files()[0]), "temporary folder"),
        (lambda scene: setattr(scene.render, "engine", "BLENDER_WORKBENCH"), "Set Render Engine to EEVEE"),
        (lambda scene: bpy.ops.afterlight.free_passes(), "Press F12"),
        (lambda scene: setattr(scene.afterlight, "enabled", False), "Enable Indirect Light"),
    ],
)
def test_what_stands_in_the_way_is_said(scene, tmp_path, change, words):
    render(scene, tmp_path / "first.exr")
    assert bpy.ops.afterlight.update.poll()
    change(scene)
    engine = scene.render.engine
    with pytest.raises(RuntimeError, match=words):
        bpy.ops.afterlight.update()
    assert scene.render.engine == engine


def files():
    return list(Path(bpy.app.tempdir).glob("afterlight_*/*.exr"))


def test_one_file_is_kept_and_freed(scene, relight, tmp_path):
    assert not files() and not bpy.ops.afterlight.free_passes.poll()
    for _ in range(2):
        render(scene, tmp_path / "first.exr")
        assert len(files()) == 1
    found = relight.frames.kept(scene)
    assert found.size == os.path.getsize(found.path) > 64 * 36 * 17 * 4
    bpy.ops.afterlight.free_passes()
    assert not files() and relight.frames.kept(scene) is None


def test_an_animation_keeps_its_last_frame(scene, relight, tmp_path):
    """It is lit again with the camera and the noise of that frame, wherever the playhead is."""
    scene.frame_end, scene.afterlight.use_animated_seed, scene.afterlight.samples = 2, True, 16
    for frame, place in ((1, 0), (2, 0.3)):
        scene.camera.location.x = place
        scene.camera.keyframe_insert("location", frame=frame)
    set_format(scene)
    scene.render.filepath = str(tmp_path / "frame#")
    bpy.ops.render.render(animation=True)
    assert len(files()) == 1 and relight.frames.kept(scene).number == 2
    scene.frame_set(1)
    assert np.array_equal(updated(scene, tmp_path / "again.exr"), read_rgb(tmp_path / "frame2.exr"))


def test_another_file_frees_the_passes(scene, tmp_path):
    render(scene, tmp_path / "first.exr")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    assert not files()


def test_a_deleted_scene_frees_its_passes(scene, relight, tmp_path):
    other = bpy.data.scenes.new("Other")
    render(scene, tmp_path / "first.exr")
    bpy.context.window.scene = other
    bpy.data.scenes.remove(scene)
    other.view_layers[0].update()
    relight.frames.forget_deleted()
    assert not files()


def test_a_failed_update_leaves_the_engine(scene, tmp_path, afterlight, monkeypatch):
    render(scene, tmp_path / "first.exr")

    def fails(*_, **__):
        raise afterlight.addon.gather.GpuUnavailable("No GPU today")

    monkeypatch.setattr(afterlight.addon.gather, "gather_indirect", fails)
    with pytest.raises(RuntimeError, match="No GPU today"):
        bpy.ops.afterlight.update()
    assert scene.render.engine == "BLENDER_EEVEE" and "No GPU today" in scene.afterlight.report
    monkeypatch.undo()
    bpy.ops.afterlight.update()
    assert scene.afterlight.report == ""


@pytest.mark.parametrize("others", [("A.Normal", "A.Normal.X"), ("A.B", "A.B.B")])
def test_view_layers_with_names_like_passes(scene, relight, tmp_path, capfd, others):
    """And a pass of the user's own that is named like the rest of such a name."""
    scene.view_layers[0].name = "A"
    for name in others:
        scene.view_layers.new(name)
    for layer in scene.view_layers:
        layer.use_pass_z = layer.use_pass_normal = True
        layer.aovs.add().name = "B"
    first = read(render(scene, tmp_path / "first.exr", "OPEN_EXR_MULTILAYER"))
    found = relight.frames.kept(scene).layers
    assert found.keys() == {"A", *others}
    assert all(dict(passes).keys() >= {"Combined", "Depth", "Normal", "B"} for passes in found.values())
    capfd.readouterr()
    assert bpy.ops.afterlight.update() == {"FINISHED"} and scene.afterlight.report == ""
    assert "Traceback" not in "".join(capfd.readouterr())
    bpy.data.images["Render Result"].save_render(str(tmp_path / "again.exr"), scene=scene)
    again = read(tmp_path / "again.exr")
    assert first.keys() == again.keys() and len(first) > 3 * 10
    for name, pixels in first.items():
        np.testing.assert_array_equal(pixels, again[name], name)


def gone(relight, monkeypatch):
    for path in files():
        path.unlink()


def cut_short(relight, monkeypatch):
    for path in files():
        path.write_bytes(path.read_bytes()[:1000])


def a_bug(relight, monkeypatch):
    def fails(*_):
        raise KeyError("no such pass")

    monkeypatch.setattr(relight.exr, "read", fails)


@pytest.mark.parametrize(
    "trouble, words", [(gone, "could not be read back"), (cut_short, "could not be read back"), (a_bug, "no such pass")]
)
def test_passes_that_cannot_be_handed_back(scene, relight, tmp_path, monkeypatch, capfd, trouble, words):
    """They are removed after the operator has checked that they exist."""
    render(scene, tmp_path / "first.exr")
    monkeypatch.setattr(relight, "obstacle", lambda scene: "")
    trouble(relight, monkeypatch)
    capfd.readouterr()
    with pytest.raises(RuntimeError, match=words):
        bpy.ops.afterlight.update()
    assert words in scene.afterlight.report and scene.render.engine == "BLENDER_EEVEE"
    assert trouble == a_bug or "Traceback" not in "".join(capfd.readouterr())
    monkeypatch.undo()
    render(scene, tmp_path / "again.exr")
    assert scene.afterlight.report == ""


def test_undo_into_the_moment_of_an_update_restores_the_engine(scene, relight):
    scene.render.engine = "AFTERLIGHT_REPLAY"
    relight.restore()
    assert scene.render.engine == "BLENDER_EEVEE" and scene.afterlight.helper.render.engine == "AFTERLIGHT"
