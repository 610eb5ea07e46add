# SPDX-License-Identifier: GPL-3.0-or-later
"""No light without its picture: where a Render Layers node is muted, or its link, so is our light."""

from ..host.assign import assign
from .nodes import RESULT, A, B, adds_to_image_of, light_node_of, role, socket

MUTED = "afterlight_muted"  # custom property of light nodes that we muted because their picture is
BLACK, CLEAR = (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0)
UNLINKED_VALUES = {
    "add": {B: BLACK},
    "gloss": {A: CLEAR, B: BLACK},
    "denoise": {"Image": BLACK},
}  # what our nodes have where nothing is linked


def follow(tree, scene):
    """Where a picture of `scene` is muted, by its node or by its link, mute its light as well: no light without its
    picture. Whoever used the picture then gets what it would get without us, the value of its own socket."""
    for node in tree.nodes:
        for identifier, value in UNLINKED_VALUES.get(role(node), {}).items():
            assign(socket(node.inputs, identifier), "default_value", value)
    for add in [node for node in tree.nodes if role(node) == "add" and adds_to_image_of(node, scene)]:
        link = socket(add.inputs, A).links[0]
        users = _users(socket(add.outputs, RESULT))
        assign(link.to_socket, "default_value", _as_color(users[0]) if users else CLEAR)
        light, is_muted = light_node_of(add), link.is_muted or link.from_node.mute
        if light is None or role(light) != "light":
            continue
        if is_muted and not light.mute:
            light.mute = light[MUTED] = True
        elif not is_muted and MUTED in light:
            light.mute = False
            del light[MUTED]


def _users(output):
    """The inputs that take an output, those of the user behind nodes of ours."""
    return [
        user
        for link in output.links
        for user in (_users(link.to_node.outputs["Image"]) if role(link.to_node) == "lines" else [link.to_socket])
    ]


def _as_color(socket):
    """The value that an input has where nothing is linked to it, as a colour."""
    value = getattr(socket, "default_value", 0.0)
    channels = tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else (value,) * 3
    return (*channels[:3], channels[3] if len(channels) > 3 else 1.0) if len(channels) > 2 else CLEAR
