# SPDX-License-Identifier: GPL-3.0-or-later
"""Views that need not be rendered in every frame of an animation, because nothing that they see has changed.

They are used again within one render job, since between two anything may be edited; and only without a window, where
a file may be edited during a render: the dependency graph does not tell an edit from what a render itself sets off.
"""

import os

import bpy

from ..scene import animation, frame_store


class ViewReuse:
    """The views of one render job. holder: by which frame_store.py knows who holds their files."""

    def __init__(self, holder):
        self._holder = holder
        self._moving = {}  # what animation.find_motion() gave, by the session_uid of the lit scene
        self._rendered = {}  # (what view_cameras.view_state() gave, SavedView) by the session_uid of the view
        self._again = {}  # of those, the SavedView that the frame at hand uses again

    def begin_frame(self):
        """No view is used again as yet."""
        self._again.clear()

    def recall(self, scene, depsgraph, view, shown):
        """Whether `view` of `scene` need not be rendered in this frame. shown: all that decides what it sees of a scene
        that holds still. depsgraph: one in which all that the view sees is evaluated."""
        if not bpy.app.background:
            return False
        before, saved = self._rendered.get(view.session_uid, (None, None))
        if before != shown or not os.path.exists(saved.path) or self._is_moving(scene, depsgraph):
            return False
        self._again[view.session_uid] = saved
        return True

    def recalled(self, view):
        """SavedView of a view that this frame uses again, or None."""
        return self._again.get(view.session_uid)

    def remember(self, view, shown, saved):
        """The view was rendered."""
        self._rendered[view.session_uid] = shown, saved

    def end_frame(self, used):
        """Hold the files of the views in `used`, [SavedView] of the frame at hand, and forget all others."""
        self._rendered = {uid: (shown, saved) for uid, (shown, saved) in self._rendered.items() if saved in used}
        frame_store.hold(self._holder, [saved.path for _, saved in self._rendered.values()])

    def _is_moving(self, scene, depsgraph):
        """Asked once in a render: whatever changes within it is of a kind that find_motion() finds."""
        if scene.session_uid not in self._moving:
            self._moving[scene.session_uid] = bool(animation.find_motion(scene, depsgraph))
        return self._moving[scene.session_uid]
