# SPDX-License-Identifier: GPL-3.0-or-later
"""Instant re-light: the passes of the last frame are kept, and its light is gathered again without EEVEE.

Blender composites only as the last step of a render, so a render is what happens: for a moment the scene's engine is
ours, and hands back the very passes that EEVEE had made. The helper scene and the compositor then follow as ever.
"""

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.app.handlers import persistent

from .. import gather
from ..compositor import freestyle
from ..compositor.setup import ENGINE
from ..host import events, report, roles
from ..host.report import Problem
from ..scene import passes
from ..translations import say

EEVEE = "BLENDER_EEVEE"  # the only engine that is ever exchanged for ours


@dataclass(frozen=True)
class Kept:
    """The passes of a finished frame. path, size: the file that passes.save() wrote, and its bytes. window, full: as
    passes.window() gave them. frame: its number. layers: {view layer: [(pass, channels)]} of all that the file
    holds."""

    path: str
    size: int
    window: tuple
    full: tuple
    frame: int
    camera: gather.Camera
    layers: dict
    views: tuple = ()  # of views.Saved
    wanted: int = 0  # how many views the settings asked for
    in_front: bool = False  # whether something may have taken of the light on its way (media.py)


_kept = {}  # by the scene's session_uid
_exchanged = {}  # session_uids of scenes that have our engine for a moment: whether it has been called by now


def keep(scene, path, camera, views=(), wanted=0, in_front=False):
    """Keep the file of a frame that is done; one that was kept before goes, and so does a file that can't be read."""
    forget(scene.session_uid, but=(path, *(view.path for view in views)))
    try:
        layers = passes.contents(path, [layer.name for layer in scene.view_layers])
    except Problem:  # the gather has said so
        passes.discard(path)
        return
    window, full = passes.window(scene)
    _kept[scene.session_uid] = Kept(
        path, passes.size(path), window, full, scene.frame_current, camera, layers, tuple(views), wanted, in_front
    )


def kept(scene):
    """Kept of a scene, or None."""
    return _kept.get(scene.session_uid)


def forget(uid, but=()):
    """Remove the kept file of the scene with this session_uid, and those of its views, unless they are in `but`."""
    gone = _kept.pop(uid, None)
    for path in (gone.path, *(view.path for view in gone.views)) if gone else ():
        if path not in but:
            passes.discard(path)


@persistent
def forget_all(*_):
    """Another file is loaded, or the extension goes."""
    for uid in list(_kept):
        forget(uid)


def forget_deleted():
    """Let go of frames whose scene is no longer there."""
    for uid in _kept.keys() - {scene.session_uid for scene in bpy.data.scenes}:
        forget(uid)


def obstacle(scene):
    """Why the light of `scene` can't be gathered again, as a sentence for people; empty where it can."""
    found = kept(scene)
    if found is None:
        return say("There are no passes of a render of this scene. Press F12 first")
    if scene.render.engine != EEVEE:
        return say("Indirect Light needs EEVEE. Set Render Engine to EEVEE")
    if passes.size(found.path) != found.size or not all(passes.size(view.path) for view in found.views):
        return say("The passes of the last render were deleted from the temporary folder. Press F12")
    if (found.window, found.full) != passes.window(scene):
        return say("The resolution or the render region has changed since the last render. Press F12")
    if any(layer.use and layer.name not in found.layers for layer in scene.view_layers):
        return say("View layers were added or renamed since the last render. Press F12")
    return ""


def is_replayed(scene):
    """Whether the render that is going on repeats a kept frame of `scene`."""
    return scene.session_uid in _exchanged


def exchange(scene):
    """Let the next render of `scene` repeat its kept frame. restore() must follow."""
    _exchanged[scene.session_uid] = False
    freestyle.hold(scene)
    scene.render.engine = ENGINE


@persistent
def restore(*_):
    """Give every scene its own engine again. A render that goes on keeps the one that it began with."""
    for scene in bpy.data.scenes:
        freestyle.release(scene)
        if scene.render.engine == ENGINE and not roles.is_helper(scene):
            scene.render.engine = EEVEE


def finish():
    """The render is over."""
    restore()
    _exchanged.clear()


def register_passes(engine, scene, layer):
    """What a Render Layers node of a scene with our engine offers: what the kept frame holds."""
    found = kept(scene)
    for name, channels in found.layers.get(layer.name, ()) if found else ():
        kind = "VALUE" if len(channels) == 1 else "COLOR" if channels.upper().startswith("RGB") else "VECTOR"
        engine.register_pass(scene, layer, name, len(channels), channels, kind)


def replay(engine, scene, layer):
    """Hand the passes of a view layer back, as EEVEE had made them. Raises status.Problem where the file is gone."""
    _exchanged[scene.session_uid] = True
    found = kept(scene)
    arrays = passes.read(found.path, found.window)
    *_, width, height = found.window
    result = engine.begin_result(0, 0, width, height, layer=layer)
    try:
        for name, channels in found.layers[layer]:
            pixels = np.stack([arrays(f"{layer}.{name}.{channel}")[::-1] for channel in channels], axis=-1)
            result.layers[0].passes[name].rect.foreach_set(pixels.ravel())
    finally:
        engine.end_result(result)


class AFTERLIGHT_OT_update(bpy.types.Operator):
    bl_idname = "afterlight.update"
    bl_label = "Update Indirect Light"
    bl_description = (
        "Compute the indirect light of the last render again with the current settings, and composite the image. EEVEE "
        "does not render again, so changes of the scene since then are not included"
    )

    @classmethod
    def poll(cls, context):
        scene = context.scene
        if not scene.afterlight.enabled:
            cls.poll_message_set(say("Enable Indirect Light first"))
        elif bpy.app.is_job_running("RENDER"):
            cls.poll_message_set(say("A render is in progress. Wait until it ends"))
        elif problem := obstacle(scene):
            cls.poll_message_set(problem)
        else:
            return True
        return False

    def execute(self, context):
        """Wait for the picture, as scripts want it."""
        return self._render(context.scene, "EXEC_DEFAULT")

    def invoke(self, context, _event):
        """Leave the interface free meanwhile."""
        if bpy.app.background:
            return self.execute(context)
        return self._render(context.scene, "INVOKE_DEFAULT")

    def _render(self, scene, how):
        exchange(scene)
        try:
            done = bpy.ops.render.render(how) & {"FINISHED", "CANCELLED"} or {"FINISHED"}
            problem = "" if bpy.app.is_job_running("RENDER") else report.message(scene)
        except RuntimeError as error:  # Blender's own words on why it does not render
            problem = " ".join(str(error).removeprefix("Error: ").split())
        finally:
            if bpy.app.is_job_running("RENDER"):
                bpy.app.timers.register(_watch)
            else:
                finish()
        if problem:
            self.report({"ERROR"}, problem)
            return {"CANCELLED"}
        return done


class AFTERLIGHT_OT_free_passes(bpy.types.Operator):
    bl_idname = "afterlight.free_passes"
    bl_label = "Free Kept Passes"
    bl_description = (
        "Delete the passes of the last render from the temporary folder, where they are kept until Blender quits. "
        "Updating the light then requires a new render"
    )

    @classmethod
    def poll(cls, context):
        return kept(context.scene) is not None

    def execute(self, context):
        forget(context.scene.session_uid)
        return {"FINISHED"}


def _watch():
    """Restore the engine as soon as ours has been called, and end with the render."""
    if not bpy.app.is_job_running("RENDER"):
        finish()
        return None
    if any(_exchanged.values()):
        restore()
    return 0.02


HANDLERS = (("save_pre", restore), ("load_pre", forget_all), ("undo_post", restore), ("redo_post", restore))
_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (AFTERLIGHT_OT_update, AFTERLIGHT_OT_free_passes)
)


def register():
    _register_classes()
    events.listen(HANDLERS)


def unregister():
    events.ignore(HANDLERS)
    finish()
    forget_all()
    _unregister_classes()
