# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own events that the wiring has to follow."""

import bpy
from bpy.app.handlers import persistent

from . import checks, passes, status, wiring
from .engine import AfterlightEngine


def _lit_scenes():
    return [scene for scene in bpy.data.scenes if scene.afterlight.enabled and scene.library is None]


@persistent
def follow_edits(_scene, depsgraph):
    """A scene, view layer or node tree was edited, copied or renamed."""
    if bpy.app.is_job_running("RENDER") or depsgraph.mode == "RENDER":
        return
    if depsgraph.id_type_updated("SCENE") or depsgraph.id_type_updated("NODETREE"):
        follow_all()


@persistent
def follow_all(*_):
    """A file was loaded, or a step undone."""
    for scene in _lit_scenes():
        wiring.follow(scene)
    wiring.clean_up()


@persistent
def before_render(scene, *_):
    """Say what will keep the light out even where our engine is never called to say it.

    Without a window nothing has followed the edits of a script, and nobody can press Repair: it is done here."""
    if not scene.afterlight.enabled:
        return
    status.begin(scene)
    if bpy.app.background and scene.library is None:
        wiring.connect(scene)
        _ensure_render_result(scene.afterlight.helper)
    for finding in checks.findings(scene):
        if finding.fatal:
            status.fail(scene, finding.text)
        print(f"Afterlight: {finding.text}")


def _ensure_render_result(helper):
    """Make the image through which Python can save passes. F12 makes it by itself; `blender -b -f` and `-a` do not,
    and only Blender's render operator can: here with nothing to render."""
    if passes.render_result() is None:
        AfterlightEngine.idle = True
        try:
            bpy.ops.render.render(scene=helper.name)
        finally:
            AfterlightEngine.idle = False


HANDLERS = (("depsgraph_update_post", follow_edits), ("load_post", follow_all), ("undo_post", follow_all),
            ("redo_post", follow_all), ("render_init", before_render))


def register():
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)
    status.register()


def unregister():
    status.unregister()
    for event, handler in HANDLERS:
        if handler in getattr(bpy.app.handlers, event):
            getattr(bpy.app.handlers, event).remove(handler)
