# SPDX-License-Identifier: GPL-3.0-or-later
"""The messages, timings and memory use of each scene's last render: for the panel, pop-ups and the exit code of
`blender -b`."""

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
    """The last render of one scene. stages: seconds by stage, in order. memory: bytes by name. coverage: (shares,
    seconds) of keep_coverage()."""

    message: str = ""
    warnings: list = field(default_factory=list)
    stages: dict = field(default_factory=dict)
    memory: dict = field(default_factory=dict)
    coverage: tuple | None = None


_reports = {}  # by the scene's session_uid; global, since the panel shows them after the render
_failed = False  # whether any render failed; global, since it decides the exit code of the process
wants_stages = False  # global, set by benchmarks: wait for the GPU after each stage, so that times are the stage's own


class Problem(Exception):
    """A fault of the user's scene or machine that keeps the scene from being lit. Its text names the fault and the
    remedy. args: the English text, then the values for its placeholders."""

    def __str__(self):
        text, *values = self.args
        return text.format(*values)


class Reporter:
    """Base of our render engines: remembers messages for the panel, and reports each to Blender when it is new."""

    @contextmanager
    def failures_of(self, scene, report_failure=None):
        """Context that turns any error into a message about `scene`, through _fail() or another report_failure(scene,
        text)."""
        report_failure = report_failure or self._fail
        try:
            yield
        except gather.Cancelled:
            pass
        except (Problem, gather.GpuUnavailable) as problem:
            report_failure(scene, say(*problem.args))
        except Exception as error:  # a bug of ours must not cost the image, nor look like success on a farm
            print_traceback()
            report_failure(
                scene,
                say("Internal error in Afterlight ({}). Please report it with the details in the terminal", error),
            )

    def _fail(self, scene, text):
        if fail(scene, text):
            self.report({"ERROR"}, f"Afterlight: {text}")

    def _warn(self, scene, text):
        if warn(scene, text):
            self.report({"WARNING"}, f"Afterlight: {text}")


def begin(scene):
    """Forget the messages of the previous render of `scene`."""
    report = _report_of(scene)
    report.message, report.warnings = "", []


def fail(scene, text):
    """Remember why `scene` was not lit. Returns whether the message is new, so that an animation reports it once."""
    global _failed
    _failed = True
    if message(scene) == text:
        return False
    _report_of(scene).message = text
    pop_up(text, say("Afterlight: the image has no indirect light"))
    return True


def warn(scene, text):
    """Remember what the last render of `scene` lacked although it was lit. Returns whether the message is new."""
    texts = _report_of(scene).warnings
    if text in texts:
        return False
    texts.append(text)
    return True


def keep_coverage(scene, shares, seconds):
    """Keep the result of the last placement of views: the share of the light that the main view sees, then with each
    further view added; and the seconds it took."""
    _report_of(scene).coverage = shares, seconds


def keep_stages(scene, stages):
    """Keep the seconds of each stage of the last render, in order."""
    _report_of(scene).stages = stages


def keep_memory(scene, memory):
    """Keep the peak memory of the last render: bytes by name."""
    _report_of(scene).memory = memory


def message(scene):
    """Why the last render of `scene` was not lit; empty if it was."""
    return _report_of(scene).message


def warnings(scene):
    """The texts of warn() since the last render of `scene` began."""
    return _report_of(scene).warnings


def coverage(scene):
    """(shares, seconds) given to keep_coverage(), or None."""
    return _report_of(scene).coverage


def stages(scene):
    """Seconds by stage of the last render of `scene`; empty if there was none."""
    return _report_of(scene).stages


def memory(scene):
    """Bytes by name of the last render of `scene`; empty if there was none."""
    return _report_of(scene).memory


def _report_of(scene):
    return _reports.setdefault(scene.session_uid, _Report())


def label(name):
    """The name of a stage, or of a use of memory, as a label: capitalised, with spaces."""
    return name[:1].upper() + name[1:].replace("_", " ")


def print_line(text, stream=None):
    """Print a line on the terminal or another stream. Characters that its encoding lacks are escaped; errors are
    ignored."""
    stream = stream or sys.stdout
    with suppress(Exception):  # scripts may have replaced the stream, and no render may fail for a line of text
        encoding = getattr(stream, "encoding", None) or "ascii"
        print(text.encode(encoding, "backslashreplace").decode(encoding), file=stream)


def print_traceback():
    """Print the traceback of the current exception, which is a bug of ours."""
    print_line(traceback.format_exc(), sys.stderr)


def pop_up(text, title):
    """Show a text in a pop-up as soon as possible, if there is a window."""

    def draw(menu, _context):
        menu.layout.label(text=text, translate=False)

    def show():
        bpy.context.window_manager.popup_menu(draw, title=title, icon="ERROR")

    if not bpy.app.background:
        main_thread.later(lambda: bpy.app.timers.register(show))


def _exit_code():
    """Make `blender -b` exit with code 1 after a render that could not be lit.

    Blender has no way for an engine to set its exit code: an error reported from a scene that the compositor asks for
    is printed and forgotten. So this ends the process at Python's own exit, which is nearly Blender's last act."""
    if not _failed:
        return
    print_line("Afterlight: exit code 1, because a render has no indirect light", sys.stderr)
    for stream in (sys.stdout, sys.stderr):
        with suppress(Exception):
            stream.flush()
    try:  # flush Blender's own output, which C buffers when it goes to a file
        ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)
    except OSError:
        pass
    temp_files.release_at_exit()
    os._exit(1)


def register():
    # If Blender is a Python module the process is somebody else's, and so is its exit code.
    if bpy.app.background and not bpy.app.module:
        atexit.register(_exit_code)


def unregister():
    # When Blender exits it unregisters extensions before Python ends: keep the handler if a render failed.
    if not _failed:
        atexit.unregister(_exit_code)
    _reports.clear()
