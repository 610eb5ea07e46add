# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough idea of how a material looks, read off its nodes: enough to weigh what views should see."""

from dataclasses import dataclass, field

import numpy as np

UNKNOWN = 0.5              # albedo where a texture or a group of nodes decides
DEEPEST = 8                # shader nodes behind one another that are looked through


@dataclass(frozen=True)
class Look:
    """albedo, emission: means over the colours. passes_light: whether EEVEE sees through it."""

    albedo: float = 0.8
    emission: float = 0.0
    passes_light: bool = False


def look(material):
    """Look of a material, or of None as Blender shows it."""
    if material is None:
        return Look()
    output = material.node_tree.get_output_node("EEVEE") if material.node_tree else None
    if output is None:
        return Look(sum(material.diffuse_color[:3]) / 3)
    shader = _linked(output.inputs["Surface"])
    if shader is None:  # nothing, or a volume only
        return Look(0.0, 0.0, passes_light=True)
    albedo, emission, alpha = _shader(shader, DEEPEST)
    return Look(albedo, emission, alpha < 0.5)


def sky(world):
    """Mean radiance of a world, roughly."""
    node = _shines(world) if world else None
    if node is None:
        return sum(world.color) / 3 if world and not world.node_tree else 0.0
    value = _values(node)
    return value("Color", UNKNOWN) * value("Strength", 1.0)


@dataclass(frozen=True)
class Sky:
    """A world whose light can be told. color: (3,), its radiance, or what its picture is multiplied by. image: equirectangular;
    None where it is of one colour. to_world: (3, 3), from the picture's directions to the world's."""

    color: np.ndarray
    image: object = None
    to_world: np.ndarray = field(default_factory=lambda: np.eye(3))


def sky_of(world):
    """Sky of a world; None where nodes decide it that are not read here."""
    if not world.node_tree:
        return Sky(np.array(world.color))
    node = _shines(world)
    if node is None:
        return Sky(np.zeros(3))
    if node.bl_idname != "ShaderNodeBackground" or node.inputs["Strength"].is_linked:
        return None
    strength, color = node.inputs["Strength"].default_value, node.inputs["Color"]
    texture = _linked(color)
    if texture is None:
        return Sky(strength * np.array(color.default_value[:3]))
    to_world = _turn(texture)
    if to_world is None or color.links[0].from_socket.name != "Color":
        return None
    return Sky(np.full(3, strength), texture.image, to_world)


def _turn(node):
    """(3, 3), from the directions of an environment texture's picture to the world's; None where it is no such texture, or is laid
    out by anything but a turn."""
    if (node.bl_idname != "ShaderNodeTexEnvironment" or node.projection != "EQUIRECTANGULAR" or node.image is None
            or node.image.source not in {"FILE", "GENERATED"}):
        return None
    vector, turn = node.inputs["Vector"], np.eye(3)
    mapping = _linked(vector)
    if mapping is not None and mapping.bl_idname == "ShaderNodeMapping":
        location, rotation, scale = (mapping.inputs[name] for name in ("Location", "Rotation", "Scale"))
        if (mapping.vector_type != "POINT" or any(socket.is_linked for socket in (location, rotation, scale))
                or any(location.default_value) or any(each != 1 for each in scale.default_value)):
            return None
        turn = np.array(rotation.default_value.to_matrix()).T
        vector = mapping.inputs["Vector"]
        if not vector.is_linked:
            return None
    if not vector.is_linked:
        return turn
    from_socket = vector.links[0].from_socket
    return turn if from_socket.node.bl_idname == "ShaderNodeTexCoord" and from_socket.name == "Generated" else None


def _shines(world):
    """The node that decides what a world sends, or None."""
    output = world.node_tree.get_output_node("EEVEE") if world.node_tree else None
    return _linked(output.inputs["Surface"]) if output else None


def _shader(node, depth):
    """(albedo, emission, alpha)."""
    if node is None:
        return 0.0, 0.0, 1.0
    value = _values(node)
    kind = node.bl_idname
    if kind == "ShaderNodeBsdfPrincipled":
        diffuse = value("Base Color", UNKNOWN) * (1 - value("Metallic", 0.0)) * (1 - value("Transmission Weight", 0.0))
        return diffuse, value("Emission Color", UNKNOWN) * value("Emission Strength", 1.0), value("Alpha", 1.0)
    if kind == "ShaderNodeEmission":
        return 0.0, value("Color", UNKNOWN) * value("Strength", 1.0), 1.0
    if kind in {"ShaderNodeBsdfTransparent", "ShaderNodeHoldout"}:
        return 0.0, 0.0, 0.0
    if kind in {"ShaderNodeBsdfGlass", "ShaderNodeBsdfRefraction", "ShaderNodeBsdfMetallic", "ShaderNodeBsdfAnisotropic"}:
        return 0.0, 0.0, 1.0
    if kind in {"ShaderNodeMixShader", "ShaderNodeAddShader"} and depth:
        shaders = [_shader(_linked(socket), depth - 1) for socket in node.inputs if socket.type == "SHADER"]
        share = value("Fac", UNKNOWN) if kind == "ShaderNodeMixShader" else None
        first, second = shaders
        if share is None:
            return first[0] + second[0], first[1] + second[1], min(first[2], second[2])
        return tuple((1 - share) * a + share * b for a, b in zip(first, second))
    return value("Color", UNKNOWN), 0.0, 1.0


def _linked(socket):
    return socket.links[0].from_node if socket.links else None


def _values(node):
    """value(name, otherwise): what a socket holds, colours as their mean; `otherwise` where there is none or it is linked."""
    def value(name, otherwise):
        socket = node.inputs.get(name)
        if socket is None or socket.links or not hasattr(socket, "default_value"):
            return otherwise
        found = socket.default_value
        return sum(found[:3]) / 3 if hasattr(found, "__len__") else float(found)
    return value
