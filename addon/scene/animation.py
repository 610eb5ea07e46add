# SPDX-License-Identifier: GPL-3.0-or-later
"""Views that need not be rendered in every frame of an animation, because what they see can't have changed.

Blender does not say what a frame has changed: each engine evaluates the scene anew. So it is asked what *could* change
with time or with the main camera, and whatever is not known to keep still counts as moving. Only the main camera may
move, and what nothing but cameras depends on: a camera's way through a building, a turntable that turns the camera.
Views are kept within one render job, since between two anything may be edited, and not in a window, where it may be in
the midst of one: what the dependency graph reports there does not tell an edit from what a render itself sets off.
"""

import os

import bpy

KINDS = {
    "ACTION",
    "ARMATURE",
    "CAMERA",
    "COLLECTION",
    "CURVE",
    "CURVES",
    "FONT",
    "IMAGE",
    "KEY",
    "LATTICE",
    "LIGHT",
    "LIGHT_PROBE",
    "MATERIAL",
    "MESH",
    "META",
    "NODETREE",
    "OBJECT",
    "POINTCLOUD",
    "SCENE",
    "SPEAKER",
    "TEXTURE",
    "VOLUME",
    "WORLD",
}
MODIFIERS = {
    "ARMATURE",
    "ARRAY",
    "BEVEL",
    "BOOLEAN",
    "CAST",
    "CORRECTIVE_SMOOTH",
    "CURVE",
    "DATA_TRANSFER",
    "DECIMATE",
    "DISPLACE",
    "EDGE_SPLIT",
    "HOOK",
    "LAPLACIANDEFORM",
    "LAPLACIANSMOOTH",
    "LATTICE",
    "MASK",
    "MESH_DEFORM",
    "MIRROR",
    "MULTIRES",
    "NODES",
    "NORMAL_EDIT",
    "REMESH",
    "SCREW",
    "SHRINKWRAP",
    "SIMPLE_DEFORM",
    "SKIN",
    "SMOOTH",
    "SOLIDIFY",
    "SUBSURF",
    "SURFACE_DEFORM",
    "TRIANGULATE",
    "UV_PROJECT",
    "UV_WARP",
    "VERTEX_WEIGHT_EDIT",
    "VERTEX_WEIGHT_MIX",
    "VERTEX_WEIGHT_PROXIMITY",
    "WARP",
    "WEIGHTED_NORMAL",
    "WELD",
    "WIREFRAME",
}
TIMED_CONSTRAINTS = {"CAMERA_SOLVER", "FOLLOW_TRACK", "OBJECT_SOLVER", "TRANSFORM_CACHE"}
TIMED_NODES = {
    "GeometryNodeInputSceneTime",
    "GeometryNodeInputActiveCamera",
    "GeometryNodeSimulationInput",
    "GeometryNodeSimulationOutput",
}
# Scripts that Blender calls in the midst of an animation may do anything.
HANDLERS = (
    "frame_change_pre",
    "frame_change_post",
    "render_pre",
    "render_post",
    "render_write",
    "depsgraph_update_pre",
    "depsgraph_update_post",
)

_moving = {}  # what moving() found, by the session_uid of the lit scene
_known = {}  # (what shown() gave, views.Saved) by the session_uid of the view
_again = {}  # of those, the views.Saved that the frame at hand uses again


def begin():
    """A render begins or is over: nothing is known to keep still."""
    for each in (_moving, _known, _again):
        each.clear()


def recall(scene, depsgraph, view, shown):
    """Whether `view` of `scene` need not be rendered in this frame. shown: all that decides what it sees of a still
    scene. depsgraph: one in which all that the view sees is evaluated."""
    if not bpy.app.background:
        return False
    before, saved = _known.get(view.session_uid, (None, None))
    if before != shown or not os.path.exists(saved.path) or moving(scene, depsgraph):
        return False
    _again[view.session_uid] = saved
    return True


def begin_frame():
    """No view is used again as yet."""
    _again.clear()


def recalled(view):
    """views.Saved of a view that this frame uses again, or None."""
    return _again.get(view.session_uid)


def remember(view, shown, saved):
    """The view was rendered."""
    _known[view.session_uid] = shown, saved


def files():
    """The files that views may be read from once more."""
    return [saved.path for _, saved in _known.values()]


def forget_others(found):
    """Forget the views that are not in `found`, [views.Saved] of the frame at hand. Returns their files, which nobody
    needs."""
    others = [uid for uid, (_, saved) in _known.items() if saved not in found]
    return [_known.pop(uid)[1].path for uid in others]


def moving(scene, depsgraph):
    """The name of something that may look otherwise in another frame of `scene`; empty where there is nothing. Asked
    once in a render: whatever changes within it is of a kind that this finds."""
    if scene.session_uid not in _moving:
        _moving[scene.session_uid] = _find_moving(scene, depsgraph)
    return _moving[scene.session_uid]


def _find_moving(scene, depsgraph):
    for name in HANDLERS:
        for handler in getattr(bpy.app.handlers, name):
            if not getattr(handler, "__module__", "").startswith(__package__.rpartition(".")[0]):
                return f"{handler.__module__}.{name}"
    if _is_animated(scene) or scene.rigidbody_world:
        return scene.name
    animated = set()
    for each in depsgraph.ids:
        if each.id_type not in KINDS or _is_timed(each):
            return each.name
        if _is_animated(each):
            animated.add(each.original)
    users = bpy.data.user_map() if animated else {}
    return next((each.name for each in animated if not _moves_cameras_only(each, users)), "")


def _is_animated(thing):
    data = getattr(thing, "animation_data", None)
    if data is None or getattr(thing, "type", "") == "COMPOSITING":
        return False
    return bool(data.action or data.drivers or data.nla_tracks)


def _is_timed(thing):
    """Whether an ID changes with time, or with the camera, of itself."""
    if thing.id_type == "OBJECT":
        return (
            any(each.type not in MODIFIERS for each in thing.modifiers)
            or any(each.type in TIMED_CONSTRAINTS for each in thing.constraints)
            and thing.type != "CAMERA"
            or thing.rigid_body is not None
            or thing.soft_body is not None
        )
    if thing.id_type == "IMAGE":
        return thing.source in {"MOVIE", "SEQUENCE"}
    if thing.id_type == "VOLUME":
        return thing.is_sequence
    if thing.id_type == "NODETREE":
        return any(node.bl_idname in TIMED_NODES for node in thing.nodes)
    return False


def _moves_cameras_only(thing, users, known=()):
    """Whether only cameras depend on an ID: it is one, or an empty that nothing else follows."""
    if thing in known:
        return True
    if thing.id_type == "OBJECT":
        if thing.type not in {"CAMERA", "EMPTY"} or thing.instance_type != "NONE":
            return False
    elif thing.id_type not in {"CAMERA", "ACTION"}:
        return thing.id_type in {"SCENE", "COLLECTION", "SCREEN", "WINDOWMANAGER", "WORKSPACE"} and bool(known)
    return all(_moves_cameras_only(each, users, (*known, thing)) for each in users.get(thing, ()))
