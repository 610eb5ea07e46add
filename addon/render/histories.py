# SPDX-License-Identifier: GPL-3.0-or-later
"""Which earlier frame's light a frame of an animation may reuse.

A history lives within one render job, from one frame to the next that the scene's frame step comes to. Whatever else
comes between makes a new one, and a frame without a history is gathered as often as makes up for it
(gather/temporal.py): so a farm's machines, each with frames of its own, render what one machine would.
"""

import sys
from dataclasses import dataclass, replace

import bpy

from .. import gather
from ..scene import cameras, needs

ANIMATION_FLAGS = {"-a", "--render-anim", "-f", "--render-frame"}  # of Blender's command line


@dataclass(frozen=True, eq=False)
class Left:
    """The light that a frame left. alike: all that must be the same for the next frame to reuse it."""

    frame: int
    alike: tuple
    light: gather.History


class Histories:
    """Those of one render job. first: the frame that it begins with, which may be of a single picture."""

    def __init__(self, first):
        self._left = {}  # Left, by the lit scene's session_uid and the view layer's name
        self._first = first  # None as soon as it surely is an animation

    def look_for_animation(self):
        """Ask Blender whether an animation is rendered. On the main thread, whose windows tell."""
        if _asked_for_animation():
            self._first = None

    def averages(self, scene):
        """Whether the light of the frame at hand is averaged with that of others: it is of an animation, and the
        settings say so."""
        if scene.frame_current != self._first:
            self._first = None
        return self._first is None and needs.averages_frames(scene.afterlight)

    def before(self, scene, layer, settings):
        """gather.History for a frame of a view layer: that of the frame before, or an empty one. settings:
        gather.RadiositySettings."""
        found = self._left.pop((scene.session_uid, layer), None)
        if found and found.frame == scene.frame_current - scene.frame_step and found.alike == _alike(scene, settings):
            return found.light
        return gather.History()

    def keep(self, scene, layer, settings, light):
        """The frame is lit, and has left its gather.History."""
        self._left[scene.session_uid, layer] = Left(scene.frame_current, _alike(scene, settings), light)


def _asked_for_animation():
    """Whether Blender was asked for an animation, which it does not tell an engine of the compositor's scenes. A script
    that asks for one that begins at the current frame goes unseen: its first frame then counts as a single one."""
    if bpy.app.background:
        flags = sys.argv[: sys.argv.index("--")] if "--" in sys.argv else sys.argv
        return not ANIMATION_FLAGS.isdisjoint(flags)
    return any(
        operator.bl_idname == "RENDER_OT_render" and operator.properties.animation
        for window in bpy.context.window_manager.windows
        for operator in window.modal_operators
    )


def _alike(scene, settings):
    """Strength may change from frame to frame, since it is no part of what is kept; another camera is a cut."""
    return (
        cameras.window(scene),
        scene.camera.session_uid,
        replace(settings, seed=0, strength=1.0),
        scene.frame_step,
        scene.frame_subframe,
    )
