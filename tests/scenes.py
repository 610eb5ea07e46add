# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for the tests, and what a file holds, written down so that two states can be compared."""

from math import radians

import bpy
import numpy as np
import OpenEXR

SIZE = 64, 36


def box(scene, samples=4):
    """A white room with one red wall, a lamp and a camera inside: most of what it shows gets bounced light."""
    scene.render.engine = "BLENDER_EEVEE"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.eevee.taa_render_samples = samples
    scene.eevee.use_raytracing = False
    # Blender 5.2.3's GPU compositor crashes in a process that composites different trees for over a minute
    # (docs/blender/rendering.md). One test uses it all the same.
    scene.render.compositor_device = "CPU"
    # A black one is as none, but for its probe: at Blender's resolution that takes half of a small frame's time.
    scene.world = bpy.data.worlds.new("Black")
    scene.world.probe_resolution = "128"
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    white, red = matt("White", (0.8, 0.8, 0.8)), matt("Red", (0.8, 0.1, 0.1))
    wall(white, (0, 0, -1.5), (0, 0, 0))
    wall(white, (0, 0, 1.5), (180, 0, 0))
    wall(white, (0, 2, 0), (90, 0, 0))
    wall(red, (-2, 0, 0), (0, 90, 0))
    wall(white, (2, 0, 0), (0, -90, 0))
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size = 60, 0.1
    put(lamp, (0.5, 0.2, 1))
    scene.camera = put(bpy.data.cameras.new("Camera"), (0, -3.4, 0), (90, 0, 0))
    scene.camera.data.lens = 24
    scene.afterlight.method = "PAPER"  # one view: no further renders for tests that are about other things
    return scene


def matt(name, color):
    material = bpy.data.materials.new(name)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    shader.inputs["Specular IOR Level"].default_value = 0
    return material


def wall(material, location, rotation):
    mesh = bpy.data.meshes.new("Wall")
    mesh.from_pydata([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    return put(mesh, location, rotation)


def put(data, location=(0, 0, 0), rotation=(0, 0, 0)):
    thing = bpy.data.objects.new(data.name if data else "Empty", data)
    thing.location, thing.rotation_euler = location, [radians(angle) for angle in rotation]
    bpy.context.scene.collection.objects.link(thing)
    return thing


def compositor(scene):
    """An empty compositor tree with an image output, in use."""
    tree = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    scene.compositing_node_group = tree
    return tree


def layers_node(tree, scene, layer=None):
    node = tree.nodes.new("CompositorNodeRLayers")
    node.scene = scene
    node.layer = layer or scene.view_layers[0].name
    return node


def simple_tree(scene):
    """Render Layers -> Hue/Saturation -> output, and the image in a viewer as well."""
    tree = compositor(scene)
    picture, grade = layers_node(tree, scene), tree.nodes.new("CompositorNodeHueSat")
    output, viewer = tree.nodes.new("NodeGroupOutput"), tree.nodes.new("CompositorNodeViewer")
    tree.links.new(picture.outputs["Image"], grade.inputs["Image"])
    tree.links.new(grade.outputs["Image"], output.inputs[0])
    tree.links.new(picture.outputs["Image"], viewer.inputs["Image"])
    return tree


def nested_tree(scene):
    """The picture comes from a Render Layers node in a group within a group; the tree itself only views one.

    Blender renders the scene only if there is a Render Layers node at the top level as well."""
    tree = compositor(scene)
    viewer = tree.nodes.new("CompositorNodeViewer")
    tree.links.new(layers_node(tree, scene).outputs["Image"], viewer.inputs["Image"])
    inner = bpy.data.node_groups.new("Inner", "CompositorNodeTree")
    outer = bpy.data.node_groups.new("Outer", "CompositorNodeTree")
    for group in (inner, outer):
        group.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    inner.links.new(layers_node(inner, scene).outputs["Image"], inner.nodes.new("NodeGroupOutput").inputs[0])
    for group, child in ((outer, inner), (tree, outer)):
        node = group.nodes.new("CompositorNodeGroup")
        node.node_tree = child
        group.links.new(node.outputs[0], group.nodes.new("NodeGroupOutput").inputs[0])
    return tree


def layered_tree(scene):
    """Two view layers laid over each other, and the first one's depth in use."""
    if len(scene.view_layers) < 2:
        scene.view_layers.new("Front")
    scene.view_layers[0].use_pass_z = True
    tree = compositor(scene)
    back, front = layers_node(tree, scene), layers_node(tree, scene, scene.view_layers[1].name)
    over, output = tree.nodes.new("CompositorNodeAlphaOver"), tree.nodes.new("NodeGroupOutput")
    viewer = tree.nodes.new("CompositorNodeViewer")
    colors = [socket for socket in over.inputs if socket.type == "RGBA"]
    tree.links.new(back.outputs["Image"], colors[0])
    tree.links.new(front.outputs["Image"], colors[1])
    tree.links.new(over.outputs["Image"], output.inputs[0])
    tree.links.new(back.outputs["Depth"], viewer.inputs["Image"])
    return tree


TREES = {"none": lambda scene: None, "simple": simple_tree, "nested": nested_tree, "layered": layered_tree}


def set_format(scene, file_format="OPEN_EXR"):
    """The scene's output format; EXR uncompressed, 32 bit."""
    settings = scene.render.image_settings
    settings.media_type = "MULTI_LAYER_IMAGE" if file_format == "OPEN_EXR_MULTILAYER" else "IMAGE"
    settings.file_format = file_format
    if "EXR" in file_format:
        settings.color_depth, settings.exr_codec = "32", "NONE"


def render(scene, path, file_format="OPEN_EXR"):
    """Render `scene` to `path`, with the format given or, for None, the scene's own."""
    if file_format:
        set_format(scene, file_format)
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True, scene=scene.name)
    return path


def read(path):
    """Channels of an EXR file by name, rows top first."""
    return {
        name: channel.pixels
        for part in OpenEXR.File(str(path), separate_channels=True).parts
        for name, channel in part.channels.items()
    }


def read_rgb(path):
    """(H, W, 3) of a plain EXR picture."""
    channels = read(path)
    return np.stack([channels[axis] for axis in "RGB"], axis=-1)


# Not part of what a user has in a file, or different in each session.
_VOLATILE = {
    "rna_type",
    "session_uid",
    "is_evaluated",
    "original",
    "depsgraph",
    "bl_rna",
    "is_updated",
    "is_updated_data",
    "preview",
    "id_properties_ui",
    "asset_data",
    "users",
    "dimensions",
    "tag",
    "active_section",
    "filepath",
    "report",
    "is_dirty",
    "runtime_data",
    "location_absolute",
    "has_data",
    "is_runtime_data",
    "version",
}


def written_down():
    """All datablocks of the file as nested dictionaries of plain values, so that == compares two states of it."""
    bpy.context.view_layer.update()
    state = {}
    for name in dir(bpy.data):
        collection = getattr(bpy.data, name)
        if isinstance(collection, bpy.types.bpy_prop_collection) and name not in {
            "all_ids",
            "window_managers",
            "screens",
            "workspaces",
            "brushes",
        }:
            state[name] = {each.name_full: _struct(each, 0) for each in collection}
    return state


def _struct(thing, depth):
    if thing is None:  # an empty place, as an image's layers have in a window
        return None
    found = {}
    for prop in thing.bl_rna.properties:
        key = prop.identifier
        if key in _VOLATILE or (isinstance(thing, bpy.types.Mesh) and prop.type == "COLLECTION"):
            continue
        try:
            value = getattr(thing, key)
        except (AttributeError, RuntimeError):
            continue
        found[key] = _value(value, prop, depth)
    if isinstance(thing, (bpy.types.ID, bpy.types.Node, bpy.types.ViewLayer)):
        # On scenes our settings stay, as any add-on's do; elsewhere nothing of ours may stay.
        found["custom"] = sorted(set(thing.keys()) - ({"afterlight"} if isinstance(thing, bpy.types.Scene) else set()))
    if isinstance(thing, bpy.types.NodeTree):  # the order of links has no meaning where a socket takes one
        found["links"].sort(key=lambda link: link["to_socket"])
    return found


def _value(value, prop, depth):
    if (
        isinstance(value, bpy.types.ID)
        and depth is not None
        and not (isinstance(value, bpy.types.NodeTree) and value.is_embedded_data)
    ):
        return value.name_full
    if isinstance(value, bpy.types.bpy_prop_collection):
        if depth > 5:
            return len(value)
        return [
            item.name_full if isinstance(item, bpy.types.ID) and not _embedded(item) else _struct(item, depth + 1)
            for item in value
        ]
    if isinstance(value, (bpy.types.Node, bpy.types.NodeSocket)):
        return value.name if isinstance(value, bpy.types.Node) else f"{value.node.name}.{value.identifier}"
    if isinstance(value, bpy.types.bpy_struct):
        return _struct(value, depth + 1) if depth < 6 else str(type(value))
    if prop.type in {"BOOLEAN", "INT", "FLOAT"} and getattr(prop, "is_array", False):
        return [list(row) if hasattr(row, "__len__") else row for row in value]
    if isinstance(value, (str, int, float, bool, type(None))):
        return value
    if isinstance(value, set):
        return sorted(value)
    return repr(value)


def _embedded(item):
    return bool(getattr(item, "is_embedded_data", False))


def differences(before, after, path=""):
    """Where two states differ, a line each."""
    if isinstance(before, dict) and isinstance(after, dict):
        return [
            line
            for key in sorted({*before, *after}, key=str)
            for line in differences(before.get(key), after.get(key), f"{path}/{key}")
        ]
    if isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        return [
            line for index, pair in enumerate(zip(before, after)) for line in differences(*pair, f"{path}[{index}]")
        ]
    return [] if before == after else [f"{path}: {before!r:.200} -> {after!r:.200}"]
