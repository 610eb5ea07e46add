# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender killed in the middle: the file opens and renders, and the next start clears the temporary folder."""

import os
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from scenes import read_rgb, render

TESTS = Path(__file__).resolve().parent

RENDERED = """
import os, sys, time
import bpy, scenes
bpy.ops.preferences.addon_enable(module=sys.argv[1])
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
scene = scenes.box(bpy.context.scene, samples=2)
scene.afterlight.enabled = True
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[2])
engine = sys.modules[sys.argv[1]].addon.pipeline.engine

def stay(self, stage, fraction):
    if stage == "gather":
        os.write(1, f"\\ngathering in {bpy.app.tempdir}\\n".encode())
        time.sleep(600)

engine.AfterlightEngine._progress = stay
scene.render.filepath = sys.argv[3]
bpy.ops.render.render(write_still=True)
"""


@pytest.fixture
def leftovers(afterlight):
    return afterlight.addon.pipeline.leftovers


@pytest.fixture
def elsewhere(leftovers, monkeypatch, tmp_path):
    """As if Blender's temporary folder lay in tmp_path."""
    own = tmp_path / "blender_own"
    own.mkdir()
    monkeypatch.setattr(leftovers, "bpy", SimpleNamespace(app=SimpleNamespace(tempdir=f"{own}{os.sep}")))
    monkeypatch.setattr(leftovers, "LONGEST", 10)
    return tmp_path


def folder_of_a_dead_blender(base, name="blender_dead", files=("afterlight_1.exr",), lock=True):
    folder = base / name
    folder.mkdir()
    for file in files:
        (folder / file).write_bytes(b"passes")
    if lock:
        (folder / ".afterlight.lock").touch()
    return folder


def restart(afterlight):
    """What a start of Blender does to the extension."""
    bpy.ops.preferences.addon_disable(module=afterlight.__name__)
    bpy.ops.preferences.addon_enable(module=afterlight.__name__)


def test_blender_killed_in_the_gather(fresh, afterlight, tmp_path):
    blend = tmp_path / "ticked.blend"
    command = [sys.executable, "-c", RENDERED, afterlight.__name__, str(blend), str(tmp_path / "cut.exr")]
    killed = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(TESTS)})
    try:
        line = next((line for line in killed.stdout if line.startswith("gathering in ")), "")
        folder = Path(line.strip().removeprefix("gathering in "))
        assert line and [file for file in folder.iterdir() if file.name.startswith("afterlight_")]
        restart(afterlight)
        assert [file for file in folder.iterdir() if file.name.startswith("afterlight_")], "its Blender still runs"
    finally:
        killed.kill()
        killed.communicate()
    assert [file for file in folder.iterdir() if file.name.startswith("afterlight_")], "nobody has cleared it yet"
    restart(afterlight)
    assert not folder.exists() or not list(folder.glob("*afterlight*"))
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    scene = bpy.context.scene
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert scene.afterlight.enabled and scene.afterlight.report == ""
    scene.afterlight.enabled = False
    assert (lit - read_rgb(render(scene, tmp_path / "plain.exr"))).mean() > 0


def test_the_files_of_the_dead_are_cleared(leftovers, elsewhere):
    folder = folder_of_a_dead_blender(elsewhere, files=("afterlight_1.exr", "afterlight_2.exr"))
    leftovers.clear()
    assert not folder.exists()


def test_files_of_others_stay(leftovers, elsewhere):
    folder = folder_of_a_dead_blender(elsewhere, files=("afterlight_1.exr", "quit.blend"))
    leftovers.clear()
    assert [file.name for file in folder.iterdir()] == ["quit.blend"]


@pytest.mark.parametrize("name, lock", [("blender_unlocked", False), ("something_else", True)])
def test_what_nobody_can_say_is_dead_stays(leftovers, elsewhere, name, lock):
    folder = folder_of_a_dead_blender(elsewhere, name, lock=lock)
    leftovers.clear()
    assert (folder / "afterlight_1.exr").exists()


def test_the_living_keep_their_files_until_they_end(leftovers, elsewhere):
    """Many at once, as on a farm; one that is over without a word is as dead as one that was killed."""
    folder = folder_of_a_dead_blender(elsewhere, "blender_living", lock=False)
    told, tell = os.pipe()
    child = os.fork()
    if child == 0:
        leftovers._lock = None  # what it has of ours is a copy
        leftovers.claim(f"{folder}{os.sep}")
        os.write(tell, b".")
        time.sleep(600)
        os._exit(0)
    os.read(told, 1)
    leftovers.clear()
    there = (folder / "afterlight_1.exr").exists()
    os.kill(child, 9)
    os.waitpid(child, 0)
    leftovers.clear()
    assert there and not folder.exists()


def test_a_claim_follows_the_folder(leftovers, elsewhere):
    """Another temporary folder is chosen in the preferences, or a cleaner of the system's empties it."""
    first, second = elsewhere / "blender_own", elsewhere / "blender_other"
    second.mkdir()
    for folder in (first, first, second):
        leftovers.claim(str(folder))
    assert not list(first.iterdir()) and [file.name for file in second.iterdir()] == [leftovers.LOCK]
    (second / leftovers.LOCK).unlink()
    leftovers.claim(str(second))
    (second / "afterlight_1.exr").touch()
    leftovers.clear()
    assert (second / "afterlight_1.exr").exists()
    leftovers.release()
    assert not (second / leftovers.LOCK).exists()


def test_without_locks_nothing_is_cleared(leftovers, elsewhere, monkeypatch):
    """Some network file systems have none."""
    def no_locks(_):
        raise OSError("No locks available")
    monkeypatch.setattr(leftovers, "_take", no_locks)
    leftovers.claim(str(elsewhere / "blender_own"))
    assert not list((elsewhere / "blender_own").iterdir())


def a_pipe(folder):
    os.mkfifo(folder / ".afterlight.lock")


def a_folder(folder):
    (folder / ".afterlight.lock").mkdir()


def a_link(folder):
    (folder / "target").touch()
    (folder / ".afterlight.lock").symlink_to(folder / "target")


@pytest.mark.parametrize("trap", [a_pipe, a_folder, a_link])
def test_traps_that_others_may_set(leftovers, elsewhere, trap):
    """Anybody may make a folder in /tmp."""
    folder = folder_of_a_dead_blender(elsewhere, lock=False)
    trap(folder)
    leftovers.clear()
    assert (folder / "afterlight_1.exr").exists()


@pytest.mark.parametrize("refused", ["open", "os.lstat", "os.listdir", "os.remove", "os.rmdir"])
def test_what_cannot_be_read_or_removed_is_left(leftovers, elsewhere, monkeypatch, refused):
    """Another user's folders. Tests may run as root, who is refused nothing."""
    folder_of_a_dead_blender(elsewhere)

    def refuse(*_, **__):
        raise PermissionError("Permission denied")
    if refused == "open":
        monkeypatch.setattr(leftovers, "open", refuse, raising=False)
    else:
        own = SimpleNamespace(**{name: getattr(os, name) for name in dir(os)})
        setattr(own, refused.removeprefix("os."), refuse)
        monkeypatch.setattr(leftovers, "os", own)
    leftovers.clear()


def test_a_temporary_folder_that_is_gone(leftovers, elsewhere, monkeypatch):
    monkeypatch.setattr(leftovers.bpy.app, "tempdir", str(elsewhere / "nowhere" / "blender_own"))
    leftovers.clear()


def test_it_is_quick_and_gets_everywhere(leftovers, elsewhere, monkeypatch):
    """With the folders of years of crashes."""
    monkeypatch.setattr(leftovers, "LONGEST", 0.005)
    for number in range(2000):
        folder_of_a_dead_blender(elsewhere, f"blender_{number}", files=(), lock=False)
    folder = folder_of_a_dead_blender(elsewhere)
    seconds = []
    while folder.exists() or len(seconds) < 20:
        start = time.perf_counter()
        leftovers.clear()
        seconds.append(time.perf_counter() - start)
        assert len(seconds) < 2000
    assert min(seconds) < 0.02
