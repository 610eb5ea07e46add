# SPDX-License-Identifier: GPL-3.0-or-later
"""The lit scene as EEVEE's own render has it evaluated: all that placing views asks of it, read while it is there.

Blender gives the evaluated scene of a render to its engine, and to handlers of frame_change_post, which it calls as
soon as the scene is evaluated. So the views can be placed, when the scene is rendered, without evaluating it again.
"""

import time

import bpy

from ..host import roles
from ..scene import animation, cameras, needs, view_cameras
from ..views import ray_cast


class EvaluatedScene:
    """A lit scene in one render job, frame by frame. camera: gather.Camera of its first view layer. geometry:
    ray_cast.Geometry. by_hand: [(matrix, view_cameras.Lens) or None], of the user's own views. is_still: whether
    nothing but cameras moves from frame to frame. error: the exception that kept it from being read, or None. seconds:
    that reading it took in this frame."""

    def __init__(self):
        self.camera = self.geometry = self.error = None
        self.by_hand, self.is_still, self.seconds = [], False, 0.0
        self._frames, self._is_read = 0, False

    def begin_frame(self):
        """Another frame is to be rendered."""
        self._is_read = False

    def read(self, scene, depsgraph):
        """Read what Blender has evaluated for a frame: the first time in a frame, since for motion blur and motion
        vectors it evaluates other times as well, and every view layer again."""
        if self._is_read:
            return
        start, self._is_read, self.error = time.perf_counter(), True, None
        try:
            self._read(scene, depsgraph)
        except Exception as error:  # a handler must not fail; the engine that places the views says it
            self.error = error
        self.seconds = time.perf_counter() - start

    def _read(self, scene, depsgraph):
        self._frames += 1
        # An edit made during a render can't be told from what the render itself sets off, so with a window, where there
        # may be one, a scene is never still. Within a render whatever moves is found in any frame.
        if self._frames == 2 and bpy.app.background:
            self.is_still = not animation.find_motion(scene, depsgraph)
        self.camera = cameras.camera(scene.camera.evaluated_get(depsgraph), depsgraph, scene)
        self.by_hand = [_pose_and_lens(each.camera, depsgraph, scene) for each in scene.afterlight.view_cameras]
        if self.geometry is None or not self.is_still:
            self.geometry = ray_cast.Geometry(depsgraph)


def is_wanted(scene):
    """Whether any view of `scene` may have to be placed."""
    return not roles.is_helper(scene) and scene.camera is not None and needs.views(scene) > 0


def _pose_and_lens(camera_object, depsgraph, scene):
    if view_cameras.unusable(camera_object):
        return None
    evaluated = camera_object.evaluated_get(depsgraph)
    return evaluated.matrix_world.copy(), view_cameras.lens_of(evaluated, depsgraph, scene)
