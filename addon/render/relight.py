# SPDX-License-Identifier: GPL-3.0-or-later
"""Update Indirect Light: the light of a kept frame (frames.py) is gathered again, without EEVEE.

Blender composites only as the last step of a render, so a render is what happens: for a moment the scene's engine is
one that hands back the very passes that EEVEE had made. The helper scene and the compositor then follow as ever.
"""

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..compositor import freestyle
from ..host import engines, events, main_thread, report
from ..host.report import Problem
from ..scene import cameras, exr, frame_store
from ..translations import say
from . import frames

# Whether the engine has been called by now, by the session_uid of the scenes that have it; global, since Blender's
# operator, its engine and a timer take turns at it.
_called = {}


def obstacle(scene):
    """Why the light of `scene` can't be gathered again, as a sentence for people; empty where it can."""
    found = frames.kept(scene)
    if found is None:
        return say("There are no passes of a render of this scene. Press F12 first")
    if scene.render.engine != engines.EEVEE:
        return say("Indirect Light needs EEVEE. Set Render Engine to EEVEE")
    if frame_store.size(found.path) != found.size or not all(frame_store.size(view.path) for view in found.views):
        return say("The passes of the last render were deleted from the temporary folder. Press F12")
    if (found.window, found.full) != cameras.window(scene):
        return say("The resolution or the render region has changed since the last render. Press F12")
    if any(layer.use and layer.name not in found.layers for layer in scene.view_layers):
        return say("View layers were added or renamed since the last render. Press F12")
    return ""


def replayed(scene):
    """frames.Kept that the render of `scene` is to repeat, or None where EEVEE renders a new one."""
    return frames.kept(scene) if scene.session_uid in _called else None


def exchange(scene):
    """Let the next render of `scene` repeat its kept frame. restore() must follow."""
    _called[scene.session_uid] = False
    freestyle.suspend_drawing(scene)
    scene.render.engine = engines.REPLAY


@persistent
def restore(*_):
    """Give every scene its own engine again. A render that goes on keeps the one that it began with."""
    for scene in bpy.data.scenes:
        freestyle.resume_drawing(scene)
        if scene.render.engine == engines.REPLAY:
            scene.render.engine = engines.EEVEE


def finish():
    """The render is over."""
    restore()
    _called.clear()


class AfterlightReplay(report.Reporter, bpy.types.RenderEngine):
    bl_idname = engines.REPLAY
    bl_label = "Afterlight's last render (used to update its light)"
    bl_use_gpu_context = False

    def update_render_passes(self, scene, layer):
        """Offer what the kept frame holds."""
        found = frames.kept(scene)
        for name, channels in found.layers.get(layer.name, ()) if found else ():
            kind = "VALUE" if len(channels) == 1 else "COLOR" if channels.upper().startswith("RGB") else "VECTOR"
            self.register_pass(scene, layer, name, len(channels), channels, kind)

    def render(self, depsgraph):
        """Hand the passes of a view layer back, as EEVEE had made them."""
        scene, layer = depsgraph.scene, depsgraph.view_layer.name
        _called[scene.session_uid] = True
        with self.failures_of(scene), main_thread.cancel_when(self.test_break):
            found = frames.kept(scene)
            if found is None:
                raise Problem("There are no passes of a render of this scene. Press F12 first")
            self._hand_back(found, layer)

    def _hand_back(self, found, layer):
        arrays = exr.read(found.path, found.window)
        *_, width, height = found.window
        result = self.begin_result(0, 0, width, height, layer=layer)
        try:
            for name, channels in found.layers[layer]:
                pixels = np.stack([arrays(f"{layer}.{name}.{channel}")[::-1] for channel in channels], axis=-1)
                result.layers[0].passes[name].rect.foreach_set(pixels.ravel())
        finally:
            self.end_result(result)


class AFTERLIGHT_OT_update(bpy.types.Operator):
    bl_idname = "afterlight.update"
    bl_label = "Update Indirect Light"
    bl_description = (
        "Compute the indirect light of the last render again with the current settings, and composite "
        "the image. EEVEE does not render again, so changes of the scene since then are not included"
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
        "Delete the passes of the last render from the temporary folder, where they are kept until "
        "Blender quits. Updating the light then requires a new render"
    )

    @classmethod
    def poll(cls, context):
        return frames.kept(context.scene) is not None

    def execute(self, context):
        frames.forget(context.scene.session_uid)
        return {"FINISHED"}


def _watch():
    """Restore the engine as soon as ours has been called, and end with the render."""
    if not bpy.app.is_job_running("RENDER"):
        finish()
        return None
    if any(_called.values()):
        restore()
    return 0.02


HANDLERS = (
    ("save_pre", restore),
    ("load_pre", frames.forget_all),
    ("undo_post", restore),
    ("redo_post", restore),
)
_register_operators, _unregister_operators = bpy.utils.register_classes_factory(
    (AFTERLIGHT_OT_update, AFTERLIGHT_OT_free_passes)
)


def register():
    bpy.utils.register_class(AfterlightReplay)
    _register_operators()
    events.listen(HANDLERS)


def unregister():
    """The engine goes when the render ends, if one is under way: Blender frees the engines of all renders when any
    engine's class goes."""
    events.ignore(HANDLERS)
    finish()
    frames.forget_all()
    _unregister_operators()
    main_thread.after_render(lambda: bpy.utils.unregister_class(AfterlightReplay))
