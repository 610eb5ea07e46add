# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough idea of how a material looks, read off its nodes: enough to weigh what views should see."""

from dataclasses import dataclass

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


def plain_sky(world):
    """(3,) radiance of a world of one colour; None where nodes decide it."""
    if not world.node_tree:
        return tuple(world.color)
    node = _shines(world)
    if node is None:
        return 0.0, 0.0, 0.0
    if node.bl_idname != "ShaderNodeBackground" or any(socket.is_linked for socket in node.inputs):
        return None
    strength = node.inputs["Strength"].default_value
    return tuple(strength * channel for channel in node.inputs["Color"].default_value[:3])


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
