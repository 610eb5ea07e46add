# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether anything but the camera moves in an animation.

Blender does not report what changes between frames: each engine evaluates the scene anew. So this asks what *could*
change with time or with the main camera, and whatever is not known to stay still counts as moving. Only the main camera
may move, and things on which nothing but cameras depends: the path of a camera through a building, a turntable that
carries the camera.
"""

import bpy

# Types of data-blocks, and modifiers below, that change only if they are animated.
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
# Constraints and nodes that change with time although they are not animated.
TIMED_CONSTRAINTS = {"CAMERA_SOLVER", "FOLLOW_TRACK", "OBJECT_SOLVER", "TRANSFORM_CACHE"}
TIMED_NODES = {
    "GeometryNodeInputSceneTime",
    "GeometryNodeInputActiveCamera",
    "GeometryNodeSimulationInput",
    "GeometryNodeSimulationOutput",
}
# Scripts in these handlers are called during an animation and may change anything.
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
    """The name of something that may look different in another frame of `scene`; empty if there is nothing. depsgraph:
    one in which everything that is looked at is evaluated."""
    for name in HANDLERS:
        for handler in getattr(bpy.app.handlers, name):
            if not getattr(handler, "__module__", "").startswith(__package__.rpartition(".")[0]):
                return f"{handler.__module__}.{name}"
    if _is_animated(scene) or scene.rigidbody_world:
        return scene.name
    animated = set()
    for datablock in depsgraph.ids:
        if datablock.id_type not in STILL_ID_TYPES or _is_timed(datablock):
            return datablock.name
        if _is_animated(datablock):
            animated.add(datablock.original)
    users = bpy.data.user_map() if animated else {}
    return next((datablock.name for datablock in animated if not _moves_cameras_only(datablock, users)), "")


def _is_animated(datablock):
    data = getattr(datablock, "animation_data", None)
    if data is None or getattr(datablock, "type", "") == "COMPOSITING":
        return False
    return bool(data.action or data.drivers or data.nla_tracks)


def _is_timed(datablock):
    """Whether a data-block changes with time, or with the camera, without being animated."""
    if datablock.id_type == "OBJECT":
        return (
            any(each.type not in STILL_MODIFIERS for each in datablock.modifiers)
            or any(each.type in TIMED_CONSTRAINTS for each in datablock.constraints)
            and datablock.type != "CAMERA"
            or datablock.rigid_body is not None
            or datablock.soft_body is not None
        )
    if datablock.id_type == "IMAGE":
        return datablock.source in {"MOVIE", "SEQUENCE"}
    if datablock.id_type == "VOLUME":
        return datablock.is_sequence
    if datablock.id_type == "NODETREE":
        return any(node.bl_idname in TIMED_NODES for node in datablock.nodes)
    return False


def _moves_cameras_only(datablock, users, seen=()):
    """Whether only cameras depend on a data-block: it is a camera, or an empty that nothing else follows."""
    if datablock in seen:
        return True
    if datablock.id_type == "OBJECT":
        if datablock.type not in {"CAMERA", "EMPTY"} or datablock.instance_type != "NONE":
            return False
    elif datablock.id_type not in {"CAMERA", "ACTION"}:
        return datablock.id_type in {"SCENE", "COLLECTION", "SCREEN", "WINDOWMANAGER", "WORKSPACE"} and bool(seen)
    return all(_moves_cameras_only(each, users, (*seen, datablock)) for each in users.get(datablock, ()))
