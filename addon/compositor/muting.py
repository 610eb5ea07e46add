# SPDX-License-Identifier: GPL-3.0-or-later
"""Muting our light along with its image: where the user mutes a Render Layers node or its link, no light is added."""

from ..host.assign import assign
from .nodes import RESULT, A, B, adds_to_image_of, light_node_of, role, socket

MUTED = "afterlight_muted"  # custom property of light nodes that we muted because their image is muted
BLACK, CLEAR = (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0)
# The values of our nodes' inputs while nothing is linked to them, by role.
UNLINKED_VALUES = {
    "add": {B: BLACK},
    "gloss": {A: CLEAR, B: BLACK},
    "denoise": {"Image": BLACK},
}


def follow(tree, scene):
    """Mute the light wherever the image of `scene` is muted, by its node or its link. Whatever used the image then gets
    what it would get without Afterlight: the value of its own input."""
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
    """The inputs that an output is linked to; behind our Freestyle nodes, the user's inputs."""
    return [
        user
        for link in output.links
        for user in (_users(link.to_node.outputs["Image"]) if role(link.to_node) == "lines" else [link.to_socket])
    ]


def _as_color(socket):
    """The value of an unlinked input, as a colour."""
    value = getattr(socket, "default_value", 0.0)
    channels = tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else (value,) * 3
    return (*channels[:3], channels[3] if len(channels) > 3 else 1.0) if len(channels) > 2 else CLEAR
