# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of other versions: a real one that 0.1.0 saved (tests/data/make_0_1_0.py), and one from a version to come."""

import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest

import extension
from scenes import box, read_rgb, render

OLD = Path(__file__).parents[1] / "data" / "afterlight_0_1_0.blend"
KEPT = {"start": "HALF", "samples": 99, "radius": 9, "seed": 5, "use_animated_seed": True}
DEFAULTS = {"strength": 1.0, "start": "HALF", "samples": 256, "radius": 16, "seed": 0, "use_animated_seed": False}


@pytest.fixture
def addon(afterlight, fresh):
    return afterlight.addon


@pytest.fixture
def old(addon):
    bpy.ops.wm.open_mainfile(filepath=str(OLD))
    return bpy.data.scenes


def values(scene, names):
    return {name: getattr(scene.afterlight, name) for name in names}


def stored(scene, addon):
    names = {parameter.name for parameter in addon.parameters.PARAMETERS}
    return {name for name in names if scene.afterlight.is_property_set(name)}


def test_versions_agree(addon):
    version = extension.manifest()["version"]
    assert ".".join(map(str, addon.host.version.VERSION)) == version
    assert all(step <= addon.host.version.VERSION for step, _ in addon.migration.STEPS)


def test_the_old_file_is_what_it_says(addon, monkeypatch):
    """Without migration: no version in it, and nothing of settings that were at their defaults."""
    assert OLD.stat().st_size < 200_000
    monkeypatch.setattr(addon.migration, "migrate", lambda *_: None)
    bpy.ops.wm.open_mainfile(filepath=str(OLD))
    kept, untouched = bpy.data.scenes["Kept"], bpy.data.scenes["Untouched"]
    assert not kept.afterlight.is_property_set("version") and tuple(kept.afterlight.version) == (0, 1, 0)
    assert stored(kept, addon) == {*KEPT, "strength"} - {"start"} and stored(untouched, addon) == set()


def test_settings_of_0_1_0_are_migrated(old, addon):
    names = {parameter.name for parameter in addon.parameters.PARAMETERS}
    for scene, expected in ((old["Kept"], KEPT), (old["Untouched"], DEFAULTS)):
        assert scene.afterlight.enabled and values(scene, expected) == expected
        assert tuple(scene.afterlight.version) == addon.host.version.VERSION and stored(scene, addon) == names
        assert not addon.diagnosis.checks.findings(scene)
    for frame, strength in ((1, 2.0), (6, 1.0), (11, 0.0)):
        old["Kept"].frame_set(frame)
        assert old["Kept"].afterlight.strength == pytest.approx(strength), "its keyframes"


def test_a_default_that_changes_leaves_old_files_alone(addon, tmp_path, monkeypatch):
    """The defaults of 0.1.0 are what its files get, not this version's: here as if they were others."""
    monkeypatch.setitem(addon.migration.DEFAULTS_OF_0_1_0, "samples", 333)
    monkeypatch.setitem(addon.migration.DEFAULTS_OF_0_1_0, "start", "FULL")
    bpy.ops.wm.open_mainfile(filepath=str(OLD))
    kept, untouched = bpy.data.scenes["Kept"].afterlight, bpy.data.scenes["Untouched"].afterlight
    assert (untouched.samples, untouched.start) == (333, "FULL") and (kept.samples, kept.start) == (99, "FULL")
    path = str(tmp_path / "again.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    monkeypatch.undo()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.data.scenes["Untouched"].afterlight.samples == 333, "saved by this version, it holds every setting"


@pytest.mark.parametrize("name", ["Kept", "Untouched"])
def test_an_old_file_renders_lit(old, tmp_path, name):
    scene = old[name]
    bpy.context.window.scene = scene
    scene.frame_set(1)
    scene.eevee.taa_render_samples = 1
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert scene.afterlight.report == ""
    scene.afterlight.enabled = False
    plain = read_rgb(render(scene, tmp_path / "plain.exr"))
    assert (lit - plain).mean() > 0.05 * plain.mean()


def test_scenes_come_in_from_an_old_file(addon):
    """Appended: theirs are migrated, and what is in the file already is left as it is."""
    mine = bpy.context.scene
    mine.afterlight.samples = 64
    with bpy.data.libraries.load(str(OLD)) as (there, here):
        here.scenes = ["Untouched"]
    (came,) = here.scenes
    assert tuple(came.afterlight.version) == addon.host.version.VERSION and values(came, DEFAULTS) == DEFAULTS
    assert mine.afterlight.samples == 64 and tuple(mine.afterlight.version) == addon.host.version.VERSION


def test_files_get_the_version_when_they_are_saved(addon, tmp_path):
    path = str(tmp_path / "new.blend")
    ticked, touched = box(bpy.context.scene), bpy.data.scenes.new("Touched")
    bpy.data.scenes.new("Plain")
    ticked.afterlight.enabled = True
    touched.afterlight.samples = 77
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    for name in ("Scene", "Touched"):
        assert tuple(bpy.data.scenes[name].afterlight.version) == addon.host.version.VERSION
        assert len(stored(bpy.data.scenes[name], addon)) == len(addon.parameters.PARAMETERS)
    assert not addon.properties.is_stored(bpy.data.scenes["Plain"].afterlight), (
        "nobody touched it: nothing of ours in it"
    )


def test_a_file_of_a_newer_version_loses_nothing(addon, tmp_path, capfd):
    """Values that this version can't know: a later version's setting, and a Start Resolution it does not have."""
    path = str(tmp_path / "newer.blend")
    scene = box(bpy.context.scene, samples=1)
    scene.afterlight.enabled = True
    scene.afterlight.version = 9, 1, 0
    raw = scene.bl_system_properties_get()["afterlight"]
    raw["bounces"], raw["start"] = 3, 7
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    scene = bpy.context.scene
    (found,) = addon.diagnosis.checks.findings(scene)
    assert "9.1.0" in found.text and not found.fatal and not found.fix
    capfd.readouterr()
    render(scene, tmp_path / "lit.exr")
    printed = "".join(capfd.readouterr())
    assert scene.afterlight.report == "" and "Traceback" not in printed and "9.1.0" in printed
    scene.afterlight.samples = 100
    again = shutil.copy(path, tmp_path / "again.blend")
    bpy.ops.wm.save_as_mainfile(filepath=str(again))
    bpy.ops.wm.open_mainfile(filepath=str(again))
    raw = bpy.context.scene.bl_system_properties_get()["afterlight"]
    assert (raw["bounces"], raw["start"], raw["samples"], tuple(raw["version"])) == (3, 7, 100, (9, 1, 0))


def test_undo_after_loading_keeps_the_migrated_settings(old, addon):
    scene = old["Untouched"]
    bpy.context.window.scene = scene
    bpy.ops.ed.undo_push(message="loaded")
    scene.afterlight.samples = 17
    bpy.ops.ed.undo_push(message="changed")
    bpy.ops.ed.undo()
    scene = bpy.data.scenes["Untouched"]
    assert scene.afterlight.samples == 256 and tuple(scene.afterlight.version) == addon.host.version.VERSION


def test_enabling_the_extension_in_an_old_file(addon, afterlight, old):
    module = afterlight.__name__
    bpy.ops.preferences.addon_disable(module=module)
    bpy.ops.wm.open_mainfile(filepath=str(OLD))
    bpy.ops.preferences.addon_enable(module=module)
    migration = __import__("sys").modules[f"{module}.addon.migration"]
    assert bpy.app.timers.is_registered(migration._once), "Blender lets no add-on near the file while it is switched on"
    migration._once()
    assert tuple(bpy.data.scenes["Kept"].afterlight.version) == migration.properties.VERSION
    np.testing.assert_equal(values(bpy.data.scenes["Kept"], KEPT), KEPT)
