# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames to be lit, from two sources: EEVEE has just finished one, or one is kept from the last render.

The engine asks both the same: for its camera, its passes, its views. A finished frame is kept until the next render of
its scene, so that its light can be gathered again without EEVEE (relight.py).
"""

from dataclasses import dataclass

import bpy
from bpy.app.handlers import persistent

from .. import gather
from ..compositor import view_scenes
from ..host import main_thread, report
from ..host.report import Problem
from ..scene import cameras, exr, frame_store, media, needs, passes, roughness, view_cameras
from ..translations import say


@dataclass(frozen=True, eq=False)
class SavedView:
    """A view of a finished frame. path: its pass file. layer: its view layer. window: as cameras.window() gave it."""

    path: str
    layer: str
    window: tuple
    camera: gather.Camera

    def load(self):
        """gather.Passes of the view. Raises report.Problem."""
        return passes.load(self.path, self.layer, self.window)

    def load_specular(self):
        """gather.Passes with the specular light in place of the diffuse, or None; as gather.View wants them."""
        return roughness.specular_passes(self.path, self.layer, self.window)


@dataclass(frozen=True, eq=False)
class Kept:
    """A finished frame. path, size: its pass file, and the file's bytes. window, full: as cameras.window() gave them.
    number: its frame number. layers: {view layer: [(pass, channels)]} of all that the file holds. views: [SavedView].
    wanted: how many views the settings asked for. in_front: whether something may have taken of the light on its
    way."""

    path: str
    size: int
    window: tuple
    full: tuple
    number: int
    camera: gather.Camera
    layers: dict
    views: tuple
    wanted: int
    in_front: bool


class RenderedFrame:
    """The frame of `scene` that EEVEE has just finished. Its passes are saved when its first view layer is lit."""

    def __init__(self, job, scene):
        self.scene, self.number, self.seconds = scene, scene.frame_current, {}
        self.in_front, self.problem = media.present(scene), ""
        self.path, self.views, self.camera = "", (), None
        self.wanted, self._job = needs.views(scene), job

    def averages(self):
        """Whether its light is averaged with that of the frames before."""
        return self._job.histories.averages(self.scene)

    def look(self, engine, depsgraph, layer):
        """gather.Camera of a view layer. The scene's camera is evaluated through the helper scene's `depsgraph`, with
        nothing else of the scene but what moves the camera."""
        scene, helper, render = self.scene, depsgraph.scene, self.scene.render
        self.camera = None

        def seen():
            return cameras.camera(scene.camera.evaluated_get(depsgraph), depsgraph, scene, layer)

        same_time = (helper.render.frame_map_old, helper.render.frame_map_new, helper.frame_subframe) == (
            render.frame_map_old,
            render.frame_map_new,
            scene.frame_subframe,
        )
        if helper.camera == scene.camera and same_time:
            self.camera = seen()
            return self.camera
        own = helper.camera

        def set_up():
            helper.render.frame_map_old, helper.render.frame_map_new = render.frame_map_old, render.frame_map_new
            helper.camera = scene.camera

        main_thread.must_run(set_up)
        try:
            engine.frame_set(scene.frame_current, scene.frame_subframe)
            self.camera = seen()
        finally:
            main_thread.must_run(lambda: setattr(helper, "camera", own))
        return self.camera

    def save(self, depsgraph, progress, warn):
        """Save the passes of all view layers and views, unless they are. progress(): whether to stop. warn(text):
        called where a view fails. Raises Problem, gather.Cancelled."""
        if self.path:
            return
        if progress():
            raise gather.Cancelled
        self.path = self._job.passes_file(self.scene)
        self.views = self._save_views(depsgraph, warn)

    def _save_views(self, depsgraph, warn):
        reuse, found, saved = self._job.reuse, [], {}
        if rendered := view_scenes.rendered_views(self.scene):
            try:
                saved = frame_store.save_views(rendered[0].scene, [view.suffix for view in rendered])
            except Problem as problem:
                saved = {view.suffix: problem for view in rendered}
        for view in view_scenes.views(self.scene):
            path = saved.get(view.suffix)
            if known := reuse.recalled(view):
                found.append(known)
            elif isinstance(path, Problem):
                warn(say("A view could not be used: {}", say(*path.args)))
            elif path:
                camera, layer = view_cameras.camera(view, depsgraph, self.scene), view.scene.view_layers[0].name
                found.append(SavedView(path, layer, cameras.window(self.scene)[0], camera))
                reuse.remember(view, view_cameras.view_state(view, self.scene), found[-1])
        self._job.hold_views(self.scene, self.path, found)
        reuse.end_frame(found)
        return tuple(found)

    def done(self):
        """All view layers have their light: the frame is kept, unless nothing was saved or it had no camera."""
        if self.path and self.camera:
            _keep(self)
        self._job.frame_done(self.scene.session_uid)


class KeptFrame:
    """A kept frame of `scene`, to be lit again. As RenderedFrame."""

    def __init__(self, kept, scene):
        self.scene, self.number, self.seconds = scene, kept.number, {}
        self.in_front = kept.in_front
        self.problem = report.message(scene)  # EEVEE's passes could not be handed back: there is nothing to light
        self.path, self.views, self.camera = kept.path, kept.views, kept.camera
        self.wanted = kept.wanted

    def averages(self):
        return False

    def look(self, _engine, _depsgraph, _layer):
        return self.camera

    def save(self, _depsgraph, _progress, warn):
        wanted = needs.views(self.scene)
        if wanted > self.wanted:
            warn(
                say(
                    "The last render had {} further views, but the settings now have {}. Press F12 to render all of "
                    "them",
                    len(self.views),
                    wanted,
                )
            )

    def done(self):
        pass


def of(job, scene):
    """The frame of `scene` that `job` has at hand."""
    return KeptFrame(job.replayed, scene) if job.replayed and job.renders(scene) else RenderedFrame(job, scene)


_kept = {}  # by the scene's session_uid; global, since frames outlive their render: the panel lights them again


def _keep(frame):
    """Keep a frame that is done; one that was kept before goes, and so does a file that can't be read."""
    scene = frame.scene
    try:
        layers = exr.contents(frame.path, [layer.name for layer in scene.view_layers])
    except Problem:  # the gather has said so
        forget(scene.session_uid)
        return
    window, full = cameras.window(scene)
    _kept[scene.session_uid] = Kept(
        frame.path,
        frame_store.size(frame.path),
        window,
        full,
        frame.number,
        frame.camera,
        layers,
        frame.views,
        frame.wanted,
        frame.in_front,
    )
    frame_store.hold(("kept", scene.session_uid), [frame.path, *(view.path for view in frame.views)])


def kept(scene):
    """Kept of a scene, or None."""
    return _kept.get(scene.session_uid)


def forget(uid):
    """Let go of the kept frame of the scene with this session_uid."""
    _kept.pop(uid, None)
    frame_store.release(("kept", uid))


@persistent
def forget_all(*_):
    """Another file is loaded, or the extension goes."""
    for uid in list(_kept):
        forget(uid)


def forget_deleted():
    """Let go of frames whose scene is no longer there."""
    for uid in _kept.keys() - {scene.session_uid for scene in bpy.data.scenes}:
        forget(uid)
