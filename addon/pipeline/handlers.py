# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own events that the wiring has to follow."""

import bpy
from bpy.app.handlers import persistent

from . import checks, events, history, leftovers, nodes, passes, relight, status, still, turns, views, wiring, world
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
    relight.forget_deleted()


@persistent
def before_render(scene, *_):
    """Say what will keep the light out even where our engine is never called to say it.

    Without a window nothing has followed the edits of a script, and nobody can press Repair: it is done here."""
    if scene.afterlight.enabled:
        turns.surely(lambda: _begin(scene))  # in a window Blender calls this in the render's thread


def _begin(scene):
    status.begin(scene)
    views.reset()
    still.begin()
    history.begin(scene)
    world.forget()
    passes.discard_early()
    views.begin(scene)
    if bpy.app.background and scene.library is None:
        wiring.connect(scene)
        _ensure_render_result(scene.afterlight.helper)
    elif scene.library is None and scene.afterlight.helper:  # nothing has followed what became of its materials
        wiring.follow_passes(scene)
    for finding in checks.findings(scene):
        if finding.fatal:
            status.fail(scene, finding.text)
        print(f"Afterlight: {finding.text}")
    if status.message(scene):
        _mute(scene)


@persistent
def after_render(*_):
    """Complete or cancelled."""
    turns.surely(_end)


def _end():
    """Undo what views and _mute() did to the file."""
    views.reset()
    still.begin()
    history.end()
    world.forget()
    passes.discard_early()
    while _muted:
        tree, node = _muted.pop()
        if tree in bpy.data.node_groups and node in bpy.data.node_groups[tree].nodes:
            bpy.data.node_groups[tree].nodes[node].mute = False


def _mute(scene):
    """Keep our light out of this render: where our engine is not called, Blender would add the light of the last."""
    for node in nodes.all_nodes(scene.compositing_node_group):
        if nodes.role(node) == "add" and not node.mute:
            node.mute = True
            _muted.append((node.id_data.name, node.name))


def _ensure_render_result(helper):
    """Make the image through which Python can save passes. F12 makes it by itself; `blender -b -f` and `-a` do not,
    and only Blender's render operator can: here with nothing to render."""
    if passes.render_result() is None:
        AfterlightEngine.idle = True
        try:
            bpy.ops.render.render(scene=helper.name)
        finally:
            AfterlightEngine.idle = False


_muted = []  # names of trees and nodes

HANDLERS = (("depsgraph_update_post", follow_edits), ("load_post", follow_all), ("undo_post", follow_all),
            ("redo_post", follow_all), ("render_init", before_render),
            ("render_complete", after_render), ("render_cancel", after_render))


def register():
    events.listen(HANDLERS)
    status.register()
    leftovers.register()


def unregister():
    leftovers.unregister()
    status.unregister()
    events.ignore(HANDLERS)
