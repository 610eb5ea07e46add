# SPDX-License-Identifier: GPL-3.0-or-later
"""All that lives as long as one render, in one object: made when the render begins, dropped when it ends or is
cancelled.

Whatever outlives a render is elsewhere, each in one place: the frames that are kept to be lit again (frames.py), what
the panel says of the last render (host/report.py), and whether the file may be changed (host/render_lock.py).
"""

import os
import time

from ..scene import frame_store
from . import evaluated, frames, histories, view_reuse


class Job:
    """The render of one scene: F12, an animation, or the light of a kept frame once more.

    scene: its session_uid. replayed: frames.Kept that is lit again instead of a new one, or None."""

    def __init__(self, scene, replayed=None):
        self.scene, self.replayed = scene.session_uid, replayed
        self.histories = histories.Histories(scene.frame_current)
        self.evaluated = evaluated.EvaluatedScene()
        self.reuse = view_reuse.ViewReuse(("views", id(self)))
        self.worlds = {}  # world_light.read()'s: pictures may change until the next render
        self.muted = []  # (tree, node) by their names: kept out of a render that can't be lit
        self.is_empty = False  # Blender renders nothing, for the sake of an image of the render (handlers.py)
        self._saved = {}  # (frame number, path of its passes), by the session_uid of a lit scene
        self._placed = {}  # (seconds, when) of views_placed(), by the same

    def renders(self, scene):
        """Whether it is `scene` that is rendered, and not another whose compositor shows it as well."""
        return scene.session_uid == self.scene

    def passes_file(self, scene):
        """Path of the passes of the frame of `scene` that EEVEE has just finished: saved when it is first asked for.
        Raises Problem and gather.Cancelled as frame_store.save() does."""
        number, path = self._saved.get(scene.session_uid, (None, ""))
        if number != scene.frame_current or not os.path.exists(path):
            frames.forget(scene.session_uid)  # it would lie in the same place
            path = frame_store.save(scene)
            self._saved[scene.session_uid] = scene.frame_current, path
            frame_store.hold(self._holder(scene.session_uid), [path])
        return path

    def hold_views(self, scene, path, views):
        """Need the files of [frames.SavedView] as well as that of the passes until the frame is done."""
        frame_store.hold(self._holder(scene.session_uid), [path, *(view.path for view in views)])

    def frame_done(self, uid):
        """The frame of the lit scene with this session_uid has its light, or goes without."""
        self._saved.pop(uid, None)
        frame_store.release(self._holder(uid))

    def views_placed(self, scene, seconds):
        """The views of `scene` are posed, which took so long; EEVEE renders them next."""
        self._placed[scene.session_uid] = seconds, time.perf_counter()

    def view_stages(self, scene):
        """Seconds by stage from the placing of the views until now; empty where `scene` has none. Once a frame."""
        if scene.session_uid not in self._placed:
            return {}
        seconds, since = self._placed.pop(scene.session_uid)
        return {"place views": seconds, "EEVEE, views": time.perf_counter() - since}

    def end(self):
        """Let go of all files that nobody has come to use."""
        for uid in list(self._saved):
            self.frame_done(uid)
        self.reuse.end_frame(())

    def _holder(self, uid):
        return "frame", id(self), uid


_jobs = []  # one within another's handlers comes last; global, since Blender's handlers and engines share nothing else


def begin(scene, replayed=None):
    """The render of `scene` begins."""
    _jobs.append(Job(scene, replayed))
    return _jobs[-1]


def current(scene):
    """The Job that goes on. One that is made up where Blender never said that a render of `scene` began: the extension
    was switched on in the midst of it."""
    return _jobs[-1] if _jobs else begin(scene)


def under_way():
    """The Job that goes on, or None."""
    return _jobs[-1] if _jobs else None


def end():
    """The render is over: returns its Job, ended, or None where Blender never said that one began."""
    job = _jobs.pop() if _jobs else None
    if job:
        job.end()
    return job


def end_all():
    """Another file is loaded, or the extension goes."""
    while end():
        pass


def is_empty_render():
    """Whether Blender renders only to have an image of the render."""
    return any(job.is_empty for job in _jobs)
