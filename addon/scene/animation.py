# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether anything but the camera moves in an animation.

Blender does not say what a frame has changed: each engine evaluates the scene anew. So the file is asked what *could*
change with time or with the main camera, and whatever is not known to hold still counts as moving. Only the main camera
may move, and what nothing but cameras depends on: a camera's path through a building, a turntable that turns the
camera.
"""

import bpy

STILL_ID_TYPES = {
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
STILL_MODIFIERS = {
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


def find_motion(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> str:
    """The name of something that may look otherwise in another frame of `scene`; empty where there is nothing.

    depsgraph: one in which all that is looked at is evaluated."""
    for name in HANDLERS:
        for handler in getattr(bpy.app.handlers, name):
            if not getattr(handler, "__module__", "").startswith(__package__.rpartition(".")[0]):
                return f"{handler.__module__}.{name}"
    if _is_animated(scene) or scene.rigidbody_world:
        return scene.name
    animated = set()
    for each in depsgraph.ids:
        if each.id_type not in STILL_ID_TYPES or _is_timed(each):
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
            any(each.type not in STILL_MODIFIERS for each in thing.modifiers)
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
