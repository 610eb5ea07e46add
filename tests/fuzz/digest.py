# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file holds of the user's, in short, and what it holds of ours: for the state machines of this folder."""

import bpy

MARK = "afterlight"
COLLECTIONS = "objects", "cameras", "lights", "meshes", "materials", "worlds", "collections"
VALUES = {
    "cameras": ("lens", "shift_x", "clip_end", "type", "sensor_width"),
    "lights": ("energy", "type"),
    "worlds": ("use_fake_user",),
    "objects": ("type", "hide_render", "rotation_mode"),
}


def of_the_user():
    """{(kind, names ...): value} of everything that is not ours. What is in one digest must be in the next one
    unchanged."""
    found = {}
    for kind in COLLECTIONS:
        for each in getattr(bpy.data, kind):
            if MARK not in each:
                found[kind, each.name] = (
                    *(getattr(each, name) for name in VALUES.get(kind, ())),
                    *sorted(each.keys()),
                    *_of_object(each, kind),
                )
    for scene in bpy.data.scenes:
        if not scene.afterlight.role:
            found.update(_of_scene(scene))
    for tree in bpy.data.node_groups:
        found.update(_of_tree(tree))
    return found


def lost(before, after):
    """Lines that tell what of the user's was lost or altered from one digest to the next."""
    return [
        f"{key}: {value!r} -> {after.get(key, 'gone')!r}"
        for key, value in before.items()
        if after.get(key, None) != value
    ]


def of_ours():
    """Names of everything in the file that is there for the light's sake."""
    found = [f"scene {scene.name}" for scene in bpy.data.scenes if scene.afterlight.role]
    found += [
        f"{kind} {each.name}"
        for kind in ("objects", "cameras", "node_groups")
        for each in getattr(bpy.data, kind)
        if MARK in each
    ]
    found += [f"node {tree.name}/{node.name}" for tree in bpy.data.node_groups for node in tree.nodes if MARK in node]
    found += [
        f"pass of {scene.name}/{layer.name}: {layer.afterlight.passes}"
        for scene in bpy.data.scenes
        for layer in scene.view_layers
        if layer.afterlight.passes
    ]
    return found


def _of_object(each, kind):
    if kind != "objects":
        return ()
    ours = [scene.collection for scene in bpy.data.scenes if scene.afterlight.role and scene.render.resolution_x == 4]
    users = sorted(holder.name for holder in each.users_collection if holder not in ours)
    return each.data.name if each.data else "", tuple(each.location), tuple(each.scale), tuple(users)


def _of_scene(scene):
    render, images = scene.render, scene.render.image_settings
    yield (
        ("scene", scene.name),
        (
            scene.camera.name if scene.camera else "",
            scene.world.name if scene.world else "",
            render.engine,
            render.resolution_x,
            render.resolution_y,
            render.filepath,
            images.file_format,
            images.color_depth,
            images.color_management,
            images.linear_colorspace_settings.name,
            scene.background_set.name if scene.background_set else "",
            tuple(sorted(thing.name for thing in scene.collection.all_objects)),
        ),
    )
    for layer in scene.view_layers:
        yield ("layer", scene.name, layer.name), (layer.use, layer.use_pass_combined, tuple(sorted(layer.keys())))


def _of_tree(tree):
    for node in tree.nodes:
        if MARK not in node:
            shown = getattr(node, "scene", None)
            yield (
                ("node", tree.name, node.name),
                (node.bl_idname, node.mute, shown.name if shown else "", getattr(node, "layer", "")),
            )
    for link in tree.links:
        if MARK not in link.to_node:
            origin = _origin(link.from_socket)
            if origin is not None:
                yield (
                    ("link", tree.name, link.to_node.name, link.to_socket.identifier),
                    (origin.node.name, origin.identifier, link.is_muted),
                )


def _origin(socket):
    """The socket whose picture comes out of a socket, without the nodes of ours in between; None where that is ours,
    too."""
    while socket is not None and socket.node.get(MARK) in {"add", "lines"}:
        first = (
            next((each for each in socket.node.inputs if each.identifier == "A_Color"), None) or socket.node.inputs[0]
        )
        socket = first.links[0].from_socket if first.links else None
    return None if socket is None or MARK in socket.node else socket
