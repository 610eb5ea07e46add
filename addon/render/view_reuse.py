# SPDX-License-Identifier: GPL-3.0-or-later
"""Views that need not be rendered in every frame of an animation, because nothing that they see has changed.

They are used again within one render job, since between two anything may be edited.
"""

import os

from ..scene import frame_store


class ViewReuse:
    """The views of one render job. holder: by which frame_store.py knows who holds their files."""

    def __init__(self, holder):
        self._holder = holder
        self._rendered = {}  # {view_cameras.View: (what view_cameras.view_state() gave, SavedView)}
        self._again = {}  # of those, the SavedView that the frame at hand uses again

    def begin_frame(self):
        """No view is used again as yet."""
        self._again.clear()

    def recall(self, view, shown):
        """Whether a view of a scene that holds still need not be rendered in this frame. shown: all that decides what
        it sees of it."""
        before, saved = self._rendered.get(view, (None, None))
        if before != shown or not os.path.exists(saved.path):
            return False
        self._again[view] = saved
        return True

    def recalled(self, view):
        """SavedView of a view that this frame uses again, or None."""
        return self._again.get(view)

    def remember(self, view, shown, saved):
        """The view was rendered."""
        self._rendered[view] = shown, saved

    def end_frame(self, used):
        """Hold the files of the views in `used`, [SavedView] of the frame at hand, and forget all others."""
        self._rendered = {view: (shown, saved) for view, (shown, saved) in self._rendered.items() if saved in used}
        frame_store.hold(self._holder, [saved.path for _, saved in self._rendered.values()])
