# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a scene has anything that light passes on its way from surfaces to the camera and that EEVEE's surface passes
don't include: volumes, materials whose Render Method is Blended, and Grease Pencil."""

import bpy


def present(scene: bpy.types.Scene) -> bool:
    """Whether volumes, Blended materials or Grease Pencil can be in the image of `scene`. Hidden objects count: their
    visibility may be animated.

    Objects, and those of instanced collections, are only searched if the file has such a material. Materials set by
    Geometry Nodes are not traced to objects: any node tree that uses one is enough."""
    worlds = {scene.world, *(layer.world_override for layer in scene.view_layers)} - {None}
    if any(_has_volume(world.node_tree) for world in worlds):
        return True
    overrides = {layer.material_override for layer in scene.view_layers} - {None}
    transmitting = {material for material in bpy.data.materials if _transmits(material)}
    if transmitting & overrides:
        return True
    if not transmitting and not bpy.data.volumes and not bpy.data.grease_pencils:
        return False
    by_nodes = (
        any(
            isinstance(user, bpy.types.NodeTree) and user.bl_idname == "GeometryNodeTree"
            for users in bpy.data.user_map(subset=transmitting).values()
            for user in users
        )
        if transmitting
        else False
    )
    return any(
        thing.type in {"VOLUME", "GREASEPENCIL"}
        or any(slot.material in transmitting for slot in thing.material_slots)
        or any(
            modifier.type == "NODES" and (by_nodes or _uses_material(modifier, transmitting))
            for modifier in thing.modifiers
        )
        for thing in _objects(scene)
    )


def _transmits(material):
    return material.surface_render_method == "BLENDED" or _has_volume(material.node_tree)


def _has_volume(tree):
    """Whether anything is linked to the socket Volume of the output that EEVEE uses."""
    output = tree.get_output_node("EEVEE") if tree else None
    return output is not None and output.inputs["Volume"].is_linked


def _uses_material(modifier, materials):
    """Whether a Geometry Nodes modifier has one of the materials among its inputs."""
    return any(modifier[key] in materials for key in modifier.keys() if isinstance(modifier[key], bpy.types.Material))


def _objects(scene):
    """The objects of a scene and of the collections that it instances, each once."""
    seen, collections = set(), [scene.collection]
    while collections:
        for thing in collections.pop().all_objects:
            if thing not in seen:
                seen.add(thing)
                if thing.instance_type == "COLLECTION" and thing.instance_collection:
                    collections.append(thing.instance_collection)
                yield thing
