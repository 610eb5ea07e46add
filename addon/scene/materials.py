# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough estimate of how materials look, read off their nodes: enough to weigh which surfaces views should see."""

from dataclasses import dataclass, field

import bpy
import numpy as np

from ..gather import images

UNKNOWN_ALBEDO = 0.5  # if a texture or a node group decides it
# Nodes whose socket "Roughness" is that of a reflection.
GLOSSY_NODES = {
    "ShaderNodeBsdfPrincipled",
    "ShaderNodeBsdfAnisotropic",
    "ShaderNodeBsdfGlossy",
    "ShaderNodeBsdfMetallic",
    "ShaderNodeBsdfGlass",
    "ShaderNodeEeveeSpecular",
}
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear Rec. 709, as Blender converts a colour to a number
MAX_TEXTURE_SIDE = 512  # pixels along a side that a texture is reduced to
MAX_SHADER_DEPTH = 8  # levels of nested mix and add shaders


@dataclass(frozen=True)
class MaterialSummary:
    """albedo, emission: means over the colour channels. passes_light: whether EEVEE sees through it."""

    albedo: float = 0.8
    emission: float = 0.0
    passes_light: bool = False


def summarize(material: bpy.types.Material | None) -> MaterialSummary:
    """MaterialSummary of a material; of None, that of Blender's default surface."""
    if material is None:
        return MaterialSummary()
    output = material.node_tree.get_output_node("EEVEE") if material.node_tree else None
    if output is None:
        return MaterialSummary(sum(material.diffuse_color[:3]) / 3)
    shader = _linked_node(output.inputs["Surface"])
    if shader is None:  # no surface, or only a volume
        return MaterialSummary(0.0, 0.0, passes_light=True)
    albedo, emission, alpha = _shader(shader, MAX_SHADER_DEPTH)
    return MaterialSummary(albedo, emission, alpha < 0.5)


def mean_radiance(world: bpy.types.World | None) -> float:
    """Mean radiance of a world, roughly."""
    node = _world_shader(world) if world else None
    if node is None:
        return sum(world.color) / 3 if world and not world.node_tree else 0.0
    value = _values(node)
    return value("Color", UNKNOWN_ALBEDO) * value("Strength", 1.0)


def roughness(material: bpy.types.Material, default: float) -> float:
    """Roughness of a material's specular reflection, 0 to 1; the weighted mean if a mixture has several. Image textures
    count as their mean. default: the result if it can't be read, or nothing is glossy."""
    output = material.node_tree.get_output_node("EEVEE") if material.node_tree else None
    shader = _linked_socket(output.inputs["Surface"]) if output else None
    total, share = _shader_roughness(shader.node, default, MAX_SHADER_DEPTH) if shader else (0.0, 0.0)
    return min(max(total / share, 0.0), 1.0) if share > 0 else default


@dataclass(frozen=True)
class Sky:
    """A world whose light is known. color: (3,), its radiance, or a factor on its image. image: equirectangular, or
    None if it is of one colour. to_world: (3, 3), from directions of the image to the world's."""

    color: np.ndarray
    image: object = None
    to_world: np.ndarray = field(default_factory=lambda: np.eye(3))


def world_sky(world: bpy.types.World) -> Sky | None:
    """Sky of a world; None if nodes decide it that are not read here."""
    if not world.node_tree:
        return Sky(np.array(world.color))
    node = _world_shader(world)
    if node is None:
        return Sky(np.zeros(3))
    if node.bl_idname != "ShaderNodeBackground" or node.inputs["Strength"].is_linked:
        return None
    strength, color = node.inputs["Strength"].default_value, node.inputs["Color"]
    texture = _linked_node(color)
    if texture is None:
        return Sky(strength * np.array(color.default_value[:3]))
    to_world = _rotation(texture)
    if to_world is None or color.links[0].from_socket.name != "Color":
        return None
    return Sky(np.full(3, strength), texture.image, to_world)


def _rotation(node):
    """(3, 3), from the directions of an environment texture's image to the world's; None if the node is no such
    texture, or its mapping is more than a rotation."""
    if (
        node.bl_idname != "ShaderNodeTexEnvironment"
        or node.projection != "EQUIRECTANGULAR"
        or node.image is None
        or node.image.source not in {"FILE", "GENERATED"}
    ):
        return None
    vector, rotation = node.inputs["Vector"], np.eye(3)
    mapping = _linked_node(vector)
    if mapping is not None and mapping.bl_idname == "ShaderNodeMapping":
        location, angles, scale = (mapping.inputs[name] for name in ("Location", "Rotation", "Scale"))
        if (
            mapping.vector_type != "POINT"
            or any(socket.is_linked for socket in (location, angles, scale))
            or any(location.default_value)
            or any(each != 1 for each in scale.default_value)
        ):
            return None
        rotation = np.array(angles.default_value.to_matrix()).T
        vector = mapping.inputs["Vector"]
        if not vector.is_linked:
            return None
    if not vector.is_linked:
        return rotation
    from_socket = vector.links[0].from_socket
    return rotation if from_socket.node.bl_idname == "ShaderNodeTexCoord" and from_socket.name == "Generated" else None


def _world_shader(world):
    """The node linked to the Surface of a world's output, or None."""
    output = world.node_tree.get_output_node("EEVEE") if world.node_tree else None
    return _linked_node(output.inputs["Surface"]) if output else None


def _shader(node, depth):
    """(albedo, emission, alpha) of a shader node."""
    if node is None:
        return 0.0, 0.0, 1.0
    value = _values(node)
    node_type = node.bl_idname
    if node_type == "ShaderNodeBsdfPrincipled":
        diffuse = (
            value("Base Color", UNKNOWN_ALBEDO) * (1 - value("Metallic", 0.0)) * (1 - value("Transmission Weight", 0.0))
        )
        return diffuse, value("Emission Color", UNKNOWN_ALBEDO) * value("Emission Strength", 1.0), value("Alpha", 1.0)
    if node_type == "ShaderNodeEmission":
        return 0.0, value("Color", UNKNOWN_ALBEDO) * value("Strength", 1.0), 1.0
    if node_type in {"ShaderNodeBsdfTransparent", "ShaderNodeHoldout"}:
        return 0.0, 0.0, 0.0
    if node_type in {
        "ShaderNodeBsdfGlass",
        "ShaderNodeBsdfRefraction",
        "ShaderNodeBsdfMetallic",
        "ShaderNodeBsdfAnisotropic",
    }:
        return 0.0, 0.0, 1.0
    if node_type in {"ShaderNodeMixShader", "ShaderNodeAddShader"} and depth:
        shaders = [_shader(_linked_node(socket), depth - 1) for socket in node.inputs if socket.type == "SHADER"]
        share = value("Fac", UNKNOWN_ALBEDO) if node_type == "ShaderNodeMixShader" else None
        first, second = shaders
        if share is None:
            return first[0] + second[0], first[1] + second[1], min(first[2], second[2])
        return tuple((1 - share) * a + share * b for a, b in zip(first, second))
    return value("Color", UNKNOWN_ALBEDO), 0.0, 1.0


def _shader_roughness(node, default, depth):
    """(roughness times weight, weight) of the specular reflection of a shader node."""
    if node.bl_idname in {"ShaderNodeMixShader", "ShaderNodeAddShader"} and depth:
        shaders = [_linked_socket(socket) for socket in node.inputs if socket.type == "SHADER"]
        results = [_shader_roughness(each.node, default, depth - 1) if each else (0.0, 0.0) for each in shaders]
        first = 1 - _values(node)("Fac", UNKNOWN_ALBEDO) if node.bl_idname == "ShaderNodeMixShader" else 0.5
        return tuple(first * a + (1 - first) * b for a, b in zip(*results))
    if node.bl_idname not in GLOSSY_NODES:
        return 0.0, 0.0
    socket = node.inputs["Roughness"]
    source = _linked_socket(socket)
    if source is None:
        return (default if socket.links else socket.default_value), 1.0
    if source.node.bl_idname == "ShaderNodeValue":
        return source.default_value, 1.0
    mean = _image_mean(source.node.image, source.name) if source.node.bl_idname == "ShaderNodeTexImage" else None
    return (default if mean is None else mean), 1.0


def _image_mean(image, channel):
    """Mean of the value that an image texture's socket "Color" or "Alpha" gives as a number; None without pixels."""
    means = images.means(image, MAX_TEXTURE_SIDE, MAX_TEXTURE_SIDE) if image else None
    if means is None:
        return None
    return float((means[..., 3] if channel == "Alpha" else means[..., :3] @ LUMINANCE).mean())


def _linked_socket(socket):
    """The output socket that an input is linked to, behind reroutes; None if there is none."""
    while socket.links:
        socket = socket.links[0].from_socket
        if socket.node.bl_idname != "NodeReroute":
            return socket
        socket = socket.node.inputs[0]
    return None


def _linked_node(socket):
    return socket.links[0].from_node if socket.links else None


def _values(node):
    """value(name, default): the value of an input socket, the mean of a colour; `default` if it is missing or
    linked."""

    def value(name, default):
        socket = node.inputs.get(name)
        if socket is None or socket.links or not hasattr(socket, "default_value"):
            return default
        value_found = socket.default_value
        return sum(value_found[:3]) / 3 if hasattr(value_found, "__len__") else float(value_found)

    return value
