# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last render of each scene has to say to people: in the panel, in a pop-up, and as the exit code of -b."""

import atexit
import ctypes
import os
import sys
import traceback
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field

import bpy

from .. import gather
from ..translations import say
from . import main_thread, temp_files


@dataclass
class _Report:
    """The last render of one scene. stages: seconds by stage, in order. memory: bytes by name. coverage: as covered()
    was told."""

    message: str = ""
    warnings: list = field(default_factory=list)
    stages: dict = field(default_factory=dict)
    memory: dict = field(default_factory=dict)
    coverage: tuple | None = None


_reports = {}  # by the scene's session_uid; global, since the panel shows them when their render is over
_failed = False  # any render; global, since it decides the exit code of the process
wants_stages = False  # a benchmark sets it: the GPU is then waited for after each stage


class Problem(Exception):
    """Something in the user's scene or machine keeps the light out. Its text says what, and what to do. args: as
    gather.GpuUnavailable has them."""

    def __str__(self):
        text, *values = self.args
        return text.format(*values)


class Reporter:
    """What our render engines have in common: they remember what they have to say, and report what is news."""

    @contextmanager
    def failures_of(self, scene, print_line=None):
        """Whatever fails within becomes a message about `scene`, by _fail() or another way to tell."""
        print_line = print_line or self._fail
        try:
            yield
        except gather.Cancelled:
            pass
        except (Problem, gather.GpuUnavailable) as problem:
            print_line(scene, say(*problem.args))
        except Exception as error:  # a bug of ours must not cost a picture, nor pass for success on a farm
            print_traceback()
            print_line(
                scene,
                say("Afterlight met an error of its own ({}). The terminal has the details; please report them", error),
            )

    def _fail(self, scene, text):
        if fail(scene, text):
            self.report({"ERROR"}, f"Afterlight: {text}")

    def _warn(self, scene, text):
        if warn(scene, text):
            self.report({"WARNING"}, f"Afterlight: {text}")


def begin(scene):
    """Forget the messages of the render before."""
    found = _report_of(scene)
    found.message, found.warnings = "", []


def fail(scene, text):
    """Remember why `scene` was not lit. Returns whether that is news, so that an animation says it once."""
    global _failed
    _failed = True
    if message(scene) == text:
        return False
    _report_of(scene).message = text
    pop_up(text, say("Afterlight: the picture has no indirect light"))
    return True


def warn(scene, text):
    """Remember what the last render of `scene` had to do without, though it was lit. Returns whether that is news."""
    known = _report_of(scene).warnings
    if text in known:
        return False
    known.append(text)
    return True


def keep_coverage(scene, shares, seconds):
    """Keep what the last placement of views gave: the share of the light that the main view sees, and with each
    view."""
    _report_of(scene).coverage = shares, seconds


def keep_stages(scene, stages):
    """Keep the seconds that each stage of the last render took, in order."""
    _report_of(scene).stages = stages


def keep_memory(scene, memory):
    """Keep the bytes that the last render took at most, by the name of what they are."""
    _report_of(scene).memory = memory


def message(scene):
    """Why the last render of `scene` was not lit; an empty string where it was."""
    return _report_of(scene).message


def warnings(scene):
    """What warn() has been told since the last render began."""
    return _report_of(scene).warnings


def coverage(scene):
    """(shares, seconds) as covered() was told, or None."""
    return _report_of(scene).coverage


def stages(scene):
    """Seconds by stage of the last render of `scene`; empty where there was none."""
    return _report_of(scene).stages


def memory(scene):
    """Bytes by name of the last render of `scene`; empty where there was none."""
    return _report_of(scene).memory


def _report_of(scene):
    return _reports.setdefault(scene.session_uid, _Report())


def label(name):
    """The name of a stage or of what memory is for, as a label has it."""
    return name[:1].upper() + name[1:].replace("_", " ")


def print_line(text, stream=None):
    """Print a line on the terminal, or to another stream: with escapes for what its encoding lacks, and nowhere if it
    is gone."""
    stream = stream or sys.stdout
    with suppress(Exception):  # other scripts put there what they like, and no render may fail for a line of text
        encoding = getattr(stream, "encoding", None) or "ascii"
        print(text.encode(encoding, "backslashreplace").decode(encoding), file=stream)


def print_traceback():
    """Print the error that is being handled, which is a bug of ours."""
    print_line(traceback.format_exc(), sys.stderr)


def pop_up(text, title):
    """Show a text in the window as soon as that can be, if there is one."""

    def draw(menu, _context):
        menu.layout.label(text=text, translate=False)

    def show():
        bpy.context.window_manager.popup_menu(draw, title=title, icon="ERROR")

    if not bpy.app.background:
        main_thread.later(lambda: bpy.app.timers.register(show))


def _exit_code():
    """Make `blender -b` end with 1 after a render that could not be lit.

    Blender offers no way to set its exit code from an engine (an error reported from a scene that the compositor asks
    for is printed and forgotten), so this ends the process at Python's own exit, which is nearly Blender's last act.
    """
    if not _failed:
        return
    print_line("Afterlight: exit code 1, because a render was not lit", sys.stderr)
    for stream in (sys.stdout, sys.stderr):
        with suppress(Exception):
            stream.flush()
    try:  # Blender's own output waits in C's buffers when it goes to a file
        ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)
    except OSError:
        pass
    temp_files.release_at_exit()
    os._exit(1)


def register():
    # As a Python module Blender is a guest in somebody's process, whose exit is theirs.
    if bpy.app.background and not bpy.app.module:
        atexit.register(_exit_code)


def unregister():
    # At Blender's exit extensions are switched off before Python ends: a failure must outlive that.
    if not _failed:
        atexit.unregister(_exit_code)
    _reports.clear()
