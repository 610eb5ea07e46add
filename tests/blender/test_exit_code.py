# SPDX-License-Identifier: GPL-3.0-or-later
"""The end of a process in which a render was not lit: exit code 1 of `blender -b`, but not of a host program that uses
Blender as a module; and no file of the user's is removed."""

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

HOST = """
import atexit, sys
import bpy
bpy.app.binary_path = "/usr/bin/blender"  # as the documentation of Blender's module has it
atexit.register(lambda: print("the host's own end"))
bpy.ops.preferences.addon_enable(module=sys.argv[1])
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
scene = bpy.context.scene
scene.render.engine = "BLENDER_WORKBENCH"
scene.render.resolution_x = scene.render.resolution_y = 8
scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
scene.collection.objects.link(scene.camera)
scene.afterlight.enabled = True
scene.render.filepath = sys.argv[2]
bpy.ops.render.render(write_still=True)
print("report:", scene.afterlight.report)
sys.exit(7)
"""


def test_a_host_of_blenders_module_ends_as_it_likes(afterlight, tmp_path):
    run = subprocess.run(
        [sys.executable, "-c", HOST, afterlight.__name__, str(tmp_path / "picture.png")],
        stdout=subprocess.PIPE,
        text=True,
        timeout=300,
    )
    assert "report: Indirect Light needs EEVEE" in run.stdout
    assert "the host's own end" in run.stdout and run.returncode == 7


@pytest.fixture
def scratch(tmp_path):
    """A shared temporary folder that contains files of the user."""
    for name in ("me/work.blend", "blender_notes/text", "passes_1.exr", "afterlight_mine/picture.exr"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    return tmp_path


def all_in(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def exit_code(afterlight, folder, failed=True):
    """The exit code of a child process that ends like `blender -b` after writing passes, and the files that were in its
    folder just before."""
    report, temp_files = (getattr(afterlight.addon.host, name, None) for name in ("report", "temp_files"))
    told, tell = os.pipe()
    child = os.fork()
    if child == 0:
        report.bpy = SimpleNamespace(app=SimpleNamespace(tempdir=f"{folder}{os.sep}"))
        if temp_files:
            temp_files.bpy = report.bpy
            temp_files._folders.clear()
            Path(temp_files.new(1)).touch()
        os.write(tell, "\n".join(all_in(folder)).encode())
        report._failed = failed
        report._exit_code()
        os._exit(7)
    os.close(tell)
    with os.fdopen(told) as answer:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), answer.read().split("\n")


def test_a_failed_render_in_the_background(afterlight, scratch):
    session = scratch / "blender_AbCdEf"
    session.mkdir()
    before = all_in(scratch)
    code, during = exit_code(afterlight, session)
    assert code == 1 and len(during) == 3  # the folder, the lock and the passes
    assert all_in(scratch) == [path for path in before if path != session.name], "Blender's folder is empty, and goes"


def test_what_else_lies_in_blenders_folder_stays(afterlight, scratch):
    session = scratch / "blender_AbCdEf"
    session.mkdir()
    (session / "quit.blend").touch()
    before = all_in(scratch)
    assert exit_code(afterlight, session)[0] == 1 and all_in(scratch) == before


def test_where_blender_could_not_make_a_folder(afterlight, scratch):
    """Blender then falls back to the shared temporary folder: because its own is unwritable, or the disk is full."""
    before = all_in(scratch)
    assert exit_code(afterlight, scratch)[0] == 1 and all_in(scratch) == before


def test_a_render_that_was_lit(afterlight, scratch):
    assert exit_code(afterlight, scratch, failed=False)[0] == 7
