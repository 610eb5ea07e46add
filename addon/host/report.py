# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last render of each scene has to say to people: in the panel, in a pop-up, and as the exit code of -b."""

import atexit
import ctypes
import os
import sys
import time
import traceback
from contextlib import suppress

import bpy

from ..translations import say
from . import main_thread, temp_files

_messages = {}
_warnings = {}
_coverage = {}
_scouted = {}
_stages = {}
_memory = {}
_failed = False
wants_stages = False  # a benchmark sets it: the GPU is then waited for after each stage


class Problem(Exception):
    """Something in the user's scene or machine keeps the light out. Its text says what, and what to do. args: as
    gather.GpuUnavailable has them."""

    def __str__(self):
        text, *values = self.args
        return text.format(*values)


class Reporter:
    """What our render engines have in common: they remember what they have to say, and report what is news."""

    def _fail(self, scene, text):
        if fail(scene, text):
            self.report({"ERROR"}, f"Afterlight: {text}")

    def _warn(self, scene, text):
        if warn(scene, text):
            self.report({"WARNING"}, f"Afterlight: {text}")


def begin(scene):
    """Forget what the render before had to say."""
    _messages.pop(scene.session_uid, None)
    _warnings.pop(scene.session_uid, None)
    _scouted.pop(scene.session_uid, None)


def fail(scene, text):
    """Remember why `scene` was not lit. Returns whether that is news, so that an animation says it once."""
    global _failed
    _failed = True
    if message(scene) == text:
        return False
    _messages[scene.session_uid] = text
    pop_up(text, say("Afterlight: the image has no indirect light"))
    return True


def warn(scene, text):
    """Remember what the last render of `scene` had to do without, though it was lit. Returns whether that is news."""
    known = _warnings.setdefault(scene.session_uid, [])
    if text in known:
        return False
    known.append(text)
    return True


def warnings(scene):
    """What warn() has been told since the last render began."""
    return _warnings.get(scene.session_uid, [])


def covered(scene, shares, seconds):
    """Keep what the last placement of views gave: the share of the light that the main view sees, and with each
    view."""
    _coverage[scene.session_uid] = shares, seconds


def coverage(scene):
    """(shares, seconds) as covered() was told, or None."""
    return _coverage.get(scene.session_uid)


def scouted(scene, seconds):
    """The views of `scene` are posed, which took so long; EEVEE renders them next."""
    _scouted[scene.session_uid] = seconds, time.perf_counter()


def views_stages(scene):
    """Seconds by stage, from the scout's beginning until now, of the render that goes on; empty where it has no views.
    Once."""
    if scene.session_uid not in _scouted:
        return {}
    seconds, since = _scouted.pop(scene.session_uid)
    return {"place views": seconds, "EEVEE, views": time.perf_counter() - since}


def message(scene):
    """Why the last render of `scene` was not lit; an empty string where it was."""
    return _messages.get(scene.session_uid, "")


def timed(scene, stages):
    """Keep the seconds that each stage of the last render took, in order."""
    _stages[scene.session_uid] = stages


def stages(scene):
    """Seconds by stage of the last render of `scene`; empty where there was none."""
    return _stages.get(scene.session_uid, {})


def in_words(name):
    """The name of a stage or of what memory is for, as a label has it."""
    return name[:1].upper() + name[1:].replace("_", " ")


def took(scene, memory):
    """Keep the bytes that the last render took at most, by the name of what they are."""
    _memory[scene.session_uid] = memory


def memory(scene):
    """Bytes by name of the last render of `scene`; empty where there was none."""
    return _memory.get(scene.session_uid, {})


def tell(text, stream=None):
    """Print a line on the terminal, or to another stream: with escapes for what its encoding lacks, and nowhere if it
    is gone."""
    stream = stream or sys.stdout
    with suppress(Exception):  # other scripts put there what they like, and no render may fail for a line of text
        encoding = getattr(stream, "encoding", None) or "ascii"
        print(text.encode(encoding, "backslashreplace").decode(encoding), file=stream)


def tell_traceback():
    """Print the error that is being handled, which is a bug of ours."""
    tell(traceback.format_exc(), sys.stderr)


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
    tell("Afterlight: exit code 1, because a render has no indirect light", sys.stderr)
    for stream in (sys.stdout, sys.stderr):
        with suppress(Exception):
            stream.flush()
    try:  # Blender's own output waits in C's buffers when it goes to a file
        ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)
    except OSError:
        pass
    temp_files.leave()
    os._exit(1)


def register():
    # As a Python module Blender is a guest in somebody's process, whose exit is theirs.
    if bpy.app.background and not bpy.app.module:
        atexit.register(_exit_code)


def unregister():
    # At Blender's exit extensions are switched off before Python ends: a failure must outlive that.
    if not _failed:
        atexit.unregister(_exit_code)
    _messages.clear()
    _warnings.clear()
    _coverage.clear()
    _scouted.clear()
    _stages.clear()
    _memory.clear()
