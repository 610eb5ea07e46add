# SPDX-License-Identifier: GPL-3.0-or-later
"""Which frame's light goes on into which: the histories of an animation that is being rendered.

A history lives within one render job, from one frame to the next that the scene's frame step comes to. Whatever else
comes between makes a new one, and a frame without a history is gathered as often as makes up for it
(gather/temporal.py): so a farm's machines, each with frames of its own, render what one machine would.
"""

import sys
from dataclasses import dataclass, replace

import bpy

from .. import gather
from ..scene import passes

ANIMATION_FLAGS = {"-a", "--render-anim", "-f", "--render-frame"}  # of Blender's command line

_known = {}  # Known, by the lit scene's session_uid and the view layer's name
_first = None  # the frame at which a render began that may be of a single frame; None where it surely is an animation


@dataclass(frozen=True, eq=False)
class Known:
    """What a frame left. alike: all that must be the same for its light to go on."""

    frame: int
    alike: tuple
    gather: gather.History


def begin(scene):
    """A render begins: nothing is known."""
    global _first
    _known.clear()
    _first = None if _asked_for_animation() else scene.frame_current


def end():
    """A render is over."""
    _known.clear()


def goes_on(scene):
    """Whether the light of the frame at hand is averaged with that of others: it is of an animation, and the settings
    say so."""
    global _first
    if scene.frame_current != _first:
        _first = None
    return _first is None and passes.averages_frames(scene.afterlight)


def _asked_for_animation():
    """Blender does not tell an engine of the compositor's scenes. A script that asks for an animation that begins at
    the current frame is the one case that goes unseen: its first frame then counts as a single one."""
    if bpy.app.background:
        flags = sys.argv[: sys.argv.index("--")] if "--" in sys.argv else sys.argv
        return not ANIMATION_FLAGS.isdisjoint(flags)
    return any(
        operator.bl_idname == "RENDER_OT_render" and operator.properties.animation
        for window in bpy.context.window_manager.windows
        for operator in window.modal_operators
    )


def before(scene, layer, settings):
    """gather.History for a frame of a view layer: that of the frame before, or an empty one. settings: gather.RadiositySettings."""
    found = _known.pop((scene.session_uid, layer), None)
    if found and found.frame == scene.frame_current - scene.frame_step and found.alike == _alike(scene, settings):
        return found.light
    return gather.History()


def keep(scene, layer, settings, found):
    """The frame is lit, and has left its gather.History."""
    _known[scene.session_uid, layer] = Known(scene.frame_current, _alike(scene, settings), found)


def _alike(scene, settings):
    """Strength may change from frame to frame, since it is no part of what is kept; another camera is a cut."""
    return (
        passes.window(scene),
        scene.camera.session_uid,
        replace(settings, seed=0, strength=1.0),
        scene.frame_step,
        scene.frame_subframe,
    )
