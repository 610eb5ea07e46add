# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own events: edits that the helper scenes and nodes follow, and the beginning and end of renders."""

import bpy
from bpy.app.handlers import persistent

from ..compositor import nodes, setup, view_scenes
from ..diagnosis import checks
from ..host import events, main_thread, render_lock, report, roles, temp_files
from ..scene import frame_store
from ..translations import say
from . import evaluated, frames, relight
from . import job as jobs


def _lit_scenes():
    return [
        scene
        for scene in bpy.data.scenes
        if scene.afterlight.enabled and scene.library is None and not roles.is_helper(scene)
    ]


@persistent
def follow_edits(_scene, depsgraph):
    """A scene, view layer or node tree was edited, copied or renamed."""
    if bpy.app.is_job_running("RENDER") or depsgraph.mode == "RENDER" or render_lock.is_locked():
        return
    if not (depsgraph.id_type_updated("SCENE") or depsgraph.id_type_updated("NODETREE")):
        return
    later = bool(roles.orphans())
    for scene in _lit_scenes():
        if setup.needs_rebuilding(scene):
            later = True
        else:
            setup.follow(scene)
    # Blender goes on evaluating when we return, and crashes where a scene is gone. Without a window nothing comes
    # after: the next render, or the next time the file is saved, sees to it.
    if later and not bpy.app.background and not bpy.app.timers.is_registered(follow_all):
        bpy.app.timers.register(follow_all, first_interval=0.0)


@persistent
def follow_all(*_):
    """A step was undone, or the file is about to be saved."""
    if render_lock.is_locked():
        return
    for scene in _lit_scenes():
        setup.follow(scene)
    for orphan in roles.orphans():
        setup.remove_orphan(orphan)
    frames.forget_deleted()


@persistent
def after_load(*_):
    """A file was loaded."""
    _reset()
    follow_all()


@persistent
def before_render(scene, *_):
    """A render begins. Say what will keep the light out even where our engine is never called to say it.

    Without a window nothing has followed the edits of a script, and nobody can press Repair: it is done here."""
    if bpy.app.background:
        follow_all()
    render_lock.begin()
    job = jobs.begin(scene, relight.replayed(scene))
    if scene.afterlight.enabled:
        main_thread.must_run(lambda: _begin(job, scene))  # in a window Blender calls this in the render's thread
    events.call_last("render_init", render_lock.lock)  # scripts may still tick the box in handlers of theirs


def _begin(job, scene):
    report.begin(scene)
    job.histories.look_for_animation()
    view_scenes.leave_all_out()
    if bpy.app.background and scene.library is None:
        setup.connect(scene)
        _ensure_render_result(job, scene.afterlight.helper)
    elif scene.library is None and scene.afterlight.helper:  # nothing has followed what became of its materials
        setup.follow_passes(scene)
    for finding in checks.findings(scene):
        if finding.fatal:
            report.fail(scene, finding.text)
        report.print_line(f"Afterlight: {finding.text}")
    if report.message(scene):
        _mute(job, scene)


@persistent
def before_frame(*_):
    """A frame of a render begins, before anything of it is evaluated."""
    if job := jobs.under_way():
        job.evaluated.begin_frame()


@persistent
def after_evaluation(scene, depsgraph):
    """Blender has evaluated a scene at a frame, for a render or for a window."""
    job = jobs.under_way()
    if job and depsgraph.mode == "RENDER" and job.renders(scene) and not job.replayed and evaluated.is_wanted(scene):
        job.evaluated.read(scene, depsgraph)


@persistent
def after_render(*_):
    """Complete or cancelled."""
    job = jobs.end()
    main_thread.must_run(lambda: _end(job))
    waited = render_lock.end()
    if waited:
        main_thread.later(lambda: main_thread.after_render(lambda: _catch_up(waited)))


def _catch_up(waited):
    """Set up, or clear, the scenes with these session_uids, which had to wait for the end of a render."""
    for scene in [scene for scene in bpy.data.scenes if scene.session_uid in waited and scene.library is None]:
        if scene.afterlight.enabled and not roles.own(scene, roles.HELPER):
            report.fail(scene, say("Indirect Light was enabled during a render. It takes effect in the next render"))
        (setup.connect if scene.afterlight.enabled else setup.disconnect)(scene)


def _end(job):
    """Undo what the views and _mute() did to the file."""
    view_scenes.leave_all_out()
    for tree, node in job.muted if job else ():
        if tree in bpy.data.node_groups and node in bpy.data.node_groups[tree].nodes:
            bpy.data.node_groups[tree].nodes[node].mute = False


def _mute(job, scene):
    """Keep our light out of this render: where our engine is not called, Blender would add the light of the last."""
    for node in nodes.all_nodes(scene.compositing_node_group):
        if nodes.role(node) == "add" and not node.mute:
            node.mute = True
            job.muted.append((node.id_data.name, node.name))


def _ensure_render_result(job, helper):
    """Make the image through which Python can save passes. F12 makes it by itself; `blender -b -f` and `-a` do not,
    and only Blender's render operator can: here with nothing to render."""
    if frame_store.render_result() is None:
        job.is_empty = True
        try:
            bpy.ops.render.render(scene=helper.name)
        finally:
            job.is_empty = False


def _reset():
    """Another file is loaded, or the extension goes."""
    jobs.end_all()
    render_lock.reset()


HANDLERS = (
    ("depsgraph_update_post", follow_edits),
    ("load_post", after_load),
    ("undo_post", follow_all),
    ("redo_post", follow_all),
    ("save_pre", follow_all),
    ("render_init", before_render),
    ("render_pre", before_frame),
    ("frame_change_post", after_evaluation),
    ("render_complete", after_render),
    ("render_cancel", after_render),
)


def register():
    events.listen(HANDLERS)
    report.register()
    temp_files.register()


def unregister():
    temp_files.unregister()
    report.unregister()
    events.ignore(HANDLERS)
    _reset()
