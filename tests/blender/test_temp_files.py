# SPDX-License-Identifier: GPL-3.0-or-later
"""Temporary files: an unguessable folder, removing what a killed Blender left, and never anybody else's file."""

import os
import stat
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest

from scenes import read_rgb, render

TESTS = Path(__file__).resolve().parents[1]
FILES = "afterlight_*/passes_*.exr"

RENDERED = """
import os, sys, time
import bpy, scenes
bpy.ops.preferences.addon_enable(module=sys.argv[1])
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
scene = scenes.box(bpy.context.scene, samples=2)
scene.afterlight.enabled = True
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[2])
engine = sys.modules[sys.argv[1]].addon.render.engine

def stay(self, stage, fraction):
    if stage == "gather":
        os.write(1, f"\\ngathering in {bpy.app.tempdir}\\n".encode())
        time.sleep(600)

engine.AfterlightEngine._progress = stay
scene.render.filepath = sys.argv[3]
bpy.ops.render.render(write_still=True)
"""


@pytest.fixture
def temp_files(afterlight):
    return afterlight.addon.host.temp_files


@pytest.fixture(params=["by descriptor", "by path"])
def elsewhere(temp_files, monkeypatch, tmp_path, request):
    """Pretend that Blender's temporary folder is in tmp_path; with and without POSIX features."""
    if request.param == "by path":
        monkeypatch.setattr(temp_files, "BY_DESCRIPTOR", False)
    base = tmp_path / "base"
    (base / "blender_own").mkdir(parents=True)
    move(temp_files, monkeypatch, base / "blender_own")
    monkeypatch.setattr(temp_files, "_folders", [])
    monkeypatch.setattr(temp_files, "MAX_SEARCH_SECONDS", 10)
    yield base
    temp_files.release()


def move(temp_files, monkeypatch, folder):
    monkeypatch.setattr(temp_files, "bpy", SimpleNamespace(app=SimpleNamespace(tempdir=f"{folder}{os.sep}")))


def folder_of_a_dead_blender(base, name="blender_dead/afterlight_dead", files=("passes_1.exr",), lock=True):
    folder = base / name
    folder.mkdir(parents=True)
    for file in files:
        (folder / file).write_bytes(b"passes")
    if lock:
        (folder / ".lock").touch()
    return folder


def restart(afterlight):
    """Do what a start of Blender does to the extension."""
    bpy.ops.preferences.addon_disable(module=afterlight.__name__)
    bpy.ops.preferences.addon_enable(module=afterlight.__name__)


def test_blender_killed_in_the_gather(fresh, afterlight, tmp_path):
    blend = tmp_path / "ticked.blend"
    command = [sys.executable, "-c", RENDERED, afterlight.__name__, str(blend), str(tmp_path / "cut.exr")]
    killed = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(TESTS)})
    try:
        line = next((line for line in killed.stdout if line.startswith("gathering in ")), "")
        folder = Path(line.strip().removeprefix("gathering in "))
        assert line and list(folder.glob(FILES))
        restart(afterlight)
        assert list(folder.glob(FILES)), "its Blender still runs"
    finally:
        killed.kill()
        killed.communicate()
    assert list(folder.glob(FILES)), "nobody has cleared it yet"
    restart(afterlight)
    assert not list(folder.glob("*afterlight*"))
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    scene = bpy.context.scene
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert scene.afterlight.enabled and scene.afterlight.report == ""
    scene.afterlight.enabled = False
    assert (lit - read_rgb(render(scene, tmp_path / "plain.exr"))).mean() > 0


# A folder of our own


def test_the_folder_is_ours_alone_and_has_no_name_to_guess(temp_files, elsewhere):
    first = Path(temp_files.new(7))
    assert first.parent.parent == elsewhere / "blender_own" and Path(temp_files.new(8)).parent == first.parent
    assert stat.S_IMODE(first.parent.stat().st_mode) == 0o700 and len(first.parent.name) >= len("afterlight_") + 8
    temp_files.release()
    assert not first.parent.exists() and Path(temp_files.new(7)).parent.name != first.parent.name


def test_what_stands_in_the_place_of_a_file_goes_and_is_not_followed(temp_files, elsewhere, tmp_path):
    precious = tmp_path / "precious.exr"
    precious.write_bytes(b"precious")
    path = Path(temp_files.new(7))
    path.symlink_to(precious)
    assert temp_files.new(7) == str(path) and not path.is_symlink() and precious.read_bytes() == b"precious"
    path.mkdir()
    with pytest.raises(OSError):
        temp_files.new(7)


def test_only_files_of_ours_are_removed(temp_files, elsewhere, tmp_path):
    path = Path(temp_files.new(7))
    others = [tmp_path / "passes_7.exr", path.parent / "quit.blend", path.parent / "passes_7.exr.txt"]
    for each in (path, *others):
        each.touch()
        temp_files.remove(str(each))
    assert not path.exists() and all(each.exists() for each in others)
    temp_files.remove(str(path))  # no error where it is gone
    path.mkdir()
    path.with_name("passes_8.exr").symlink_to(others[0])
    temp_files.release()
    assert all(each.exists() for each in others) and path.is_dir(), "a folder with others' files stays"
    assert not (path.parent / ".lock").exists()


def test_a_folder_that_went_is_made_anew(temp_files, elsewhere, monkeypatch):
    """The system cleans the temporary folder, or another one is set in the preferences."""
    first = Path(temp_files.new(7))
    first.touch()
    (first.parent / ".lock").unlink()
    second = Path(temp_files.new(7))
    assert second.parent != first.parent and first.exists(), "it may still be read"
    move(temp_files, monkeypatch, elsewhere / "blender_other")
    third = Path(temp_files.new(7))
    assert third.parent.parent == elsewhere / "blender_other"
    for folder in (third.parent, third.parent.parent):
        for each in folder.iterdir():
            each.unlink()
        folder.rmdir()
    (elsewhere / "blender_other").mkdir()
    third.parent.symlink_to(first.parent)
    fourth = Path(temp_files.new(7))
    assert fourth.parent.is_dir() and fourth.parent != third.parent
    temp_files.release()
    assert not first.parent.exists() and not second.parent.exists() and not fourth.parent.exists()
    assert third.parent.is_symlink(), "not ours"


def test_no_place_for_the_folder(temp_files, elsewhere, monkeypatch):
    (elsewhere / "file").touch()
    move(temp_files, monkeypatch, elsewhere / "file")
    with pytest.raises(OSError):
        temp_files.new(7)


@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir, lambda path: os.symlink(__file__, path)])
def test_only_regular_files_are_read(afterlight, temp_files, elsewhere, make):
    path = temp_files.new(7)
    make(path)
    with pytest.raises(afterlight.addon.host.report.Problem, match="could not be read back"):
        afterlight.addon.scene.exr.read(path, (0, 0, 4, 4))


# Blender's own folder


def test_blenders_folder_goes_only_where_it_is_blenders_and_empty(temp_files, elsewhere, monkeypatch):
    session = elsewhere / "blender_own"
    (session / "quit.blend").touch()
    temp_files.new(7)
    temp_files.release_at_exit()
    assert [each.name for each in session.iterdir()] == ["quit.blend"]
    (session / "quit.blend").unlink()
    temp_files.release_at_exit()
    assert not session.exists()
    move(temp_files, monkeypatch, elsewhere)  # as if Blender could not make one
    Path(temp_files.new(7)).touch()
    temp_files.release_at_exit()
    assert elsewhere.exists() and not list(elsewhere.iterdir())


# What killed Blender processes left


@pytest.mark.parametrize("name", ["blender_dead/afterlight_dead", "afterlight_dead"])
@pytest.mark.parametrize("fallen_back", [False, True])
def test_the_files_of_the_dead_are_cleared(temp_files, elsewhere, monkeypatch, name, fallen_back):
    if fallen_back:
        move(temp_files, monkeypatch, elsewhere)
    folder_of_a_dead_blender(elsewhere, name, files=("passes_1.exr", "passes_22.exr"))
    temp_files.clear()
    assert [each.name for each in elsewhere.iterdir()] == ["blender_own"]


def test_files_of_others_stay(temp_files, elsewhere, tmp_path):
    theirs = ("quit.blend", "afterlight_1.exr", "passes_1.exr.txt", "passes_one.exr")
    folder = folder_of_a_dead_blender(elsewhere, files=("passes_1.exr", *theirs))
    (folder / "passes_3.exr").mkdir()
    (folder / "passes_4.exr").symlink_to(tmp_path)
    os.mkfifo(folder / "passes_5.exr")
    temp_files.clear()
    assert {each.name for each in folder.iterdir()} == {*theirs, *(f"passes_{number}.exr" for number in (3, 4, 5))}


def test_the_folder_of_a_session_with_other_files_stays(temp_files, elsewhere):
    folder = folder_of_a_dead_blender(elsewhere)
    (folder.parent / "quit.blend").touch()
    temp_files.clear()
    assert [each.name for each in folder.parent.iterdir()] == ["quit.blend"]


@pytest.mark.parametrize(
    "name, lock",
    [
        ("blender_dead/afterlight_unlocked", False),
        ("other/afterlight_dead", True),
        ("blender_dead/other", True),
        ("other", True),
    ],
)
def test_what_nobody_can_say_is_dead_stays(temp_files, elsewhere, name, lock):
    folder = folder_of_a_dead_blender(elsewhere, name, lock=lock)
    temp_files.clear()
    assert (folder / "passes_1.exr").exists()


def test_leftovers_of_version_0_3_0_stay(temp_files, elsewhere):
    files = ".afterlight.lock", "afterlight_1.exr"
    folder = folder_of_a_dead_blender(elsewhere, "blender_dead", files=files, lock=False)
    temp_files.clear()
    assert len(list(folder.iterdir())) == 2


def test_the_living_keep_their_files_until_they_end(temp_files, elsewhere):
    """Many processes at once, as on a farm; one that exits silently counts the same as one that was killed."""
    told, tell = os.pipe()
    child = os.fork()
    if child == 0:
        path = temp_files.new(1)
        open(path, "w").close()
        os.write(tell, path.encode())
        time.sleep(600)
        os._exit(0)
    path = Path(os.read(told, 4096).decode())
    temp_files.clear()
    there = path.exists()
    os.kill(child, 9)
    os.waitpid(child, 0)
    temp_files.clear()
    assert there and not path.parent.exists()


def test_the_own_folder_is_not_cleared(temp_files, elsewhere):
    path = Path(temp_files.new(1))
    path.touch()
    temp_files.clear()
    assert path.exists() and (path.parent / ".lock").exists() and len(list(path.parent.iterdir())) == 2


def test_without_locks_nothing_is_cleared(temp_files, elsewhere, monkeypatch):
    """Some network file systems have no locks."""

    def no_locks(_):
        raise OSError("No locks available")

    monkeypatch.setattr(temp_files, "_acquire", no_locks)
    path, other = Path(temp_files.new(1)), folder_of_a_dead_blender(elsewhere)
    assert not list(path.parent.iterdir()) and temp_files.new(1) == str(path)
    temp_files.clear()
    assert (other / "passes_1.exr").exists()
    temp_files.release()
    assert not path.parent.exists()


def a_pipe(folder):
    os.mkfifo(folder / ".lock")


def a_folder(folder):
    (folder / ".lock").mkdir()


def a_link(folder):
    (folder / "target").touch()
    (folder / ".lock").symlink_to(folder / "target")


@pytest.mark.parametrize("trap", [a_pipe, a_folder, a_link])
def test_traps_in_the_place_of_a_lock(temp_files, elsewhere, trap):
    """Anybody may create a folder in /tmp."""
    folder = folder_of_a_dead_blender(elsewhere, lock=False)
    trap(folder)
    temp_files.clear()
    assert (folder / "passes_1.exr").exists()


@pytest.mark.parametrize("trap", [a_pipe, a_link])
def test_traps_that_are_set_after_the_look(temp_files, elsewhere, monkeypatch, trap):
    """Opening a pipe that nobody writes to would block Blender for ever."""
    is_file = temp_files._Folder.is_file
    monkeypatch.setattr(temp_files._Folder, "is_file", lambda folder, name: name == ".lock" or is_file(folder, name))
    test_traps_in_the_place_of_a_lock(temp_files, elsewhere, trap)


@pytest.mark.parametrize("name", ["afterlight_link", "blender_link", "blender_dead/afterlight_link"])
def test_links_to_folders_are_not_followed(temp_files, elsewhere, tmp_path, name):
    target = folder_of_a_dead_blender(tmp_path, "precious/afterlight_dead")
    link = elsewhere / name
    link.parent.mkdir(exist_ok=True)
    link.symlink_to(target.parent if name == "blender_link" else target)
    temp_files.clear()
    assert (target / "passes_1.exr").exists() and link.is_symlink()


@pytest.mark.skipif(os.name == "nt" or os.geteuid() != 0, reason="only root gives files away")
@pytest.mark.parametrize("owned", ["blender_dead", "blender_dead/afterlight_dead"])
def test_another_users_folder_stays(temp_files, elsewhere, owned):
    folder = folder_of_a_dead_blender(elsewhere)
    os.chown(elsewhere / owned, 65534, 65534)
    temp_files.clear()
    assert (folder / "passes_1.exr").exists()


@pytest.mark.parametrize("refused", ["open", "lstat", "listdir", "unlink", "rmdir"])
def test_what_cannot_be_read_or_removed_is_left(temp_files, elsewhere, monkeypatch, refused):
    """Another user's folders. Tests may run as root, who may do anything."""
    folder_of_a_dead_blender(elsewhere)

    def refuse(*_, **__):
        raise PermissionError("Permission denied")

    own = SimpleNamespace(**{name: getattr(os, name) for name in dir(os)})
    setattr(own, refused, refuse)
    monkeypatch.setattr(temp_files, "os", own)
    temp_files.clear()


def test_a_temporary_folder_that_is_gone(temp_files, elsewhere, monkeypatch):
    move(temp_files, monkeypatch, elsewhere / "nowhere" / "blender_own")
    temp_files.clear()


def test_it_is_quick_and_gets_everywhere(temp_files, elsewhere, monkeypatch):
    """With the folders of years of crashes."""
    monkeypatch.setattr(temp_files, "MAX_SEARCH_SECONDS", 0.005)
    for number in range(2000):
        folder_of_a_dead_blender(elsewhere, f"blender_{number}/afterlight_{number}", files=(), lock=False)
    folder = folder_of_a_dead_blender(elsewhere)
    seconds = []
    while folder.exists() or len(seconds) < 20:
        start = time.perf_counter()
        temp_files.clear()
        seconds.append(time.perf_counter() - start)
        assert len(seconds) < 2000
    assert min(seconds) < 0.02
