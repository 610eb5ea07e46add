# SPDX-License-Identifier: GPL-3.0-or-later
"""Freestyle's lines over the light.

Blender draws them into the image, and light that is added afterwards would lie over them. While a scene is lit they
come as a pass of their own, and a node of ours lays that over the lit picture, as Blender does over the plain one:

    add.Result ------------------------- Background
                                         lines (Alpha Over) -> whatever used the image
    Render Layers (scene).Freestyle ---- Foreground
"""

from ..scene import passes
from .nodes import RESULT, A, adds_to_image_of, linked_node, new_node, role, socket

LINE_PASS = (
    "freestyle_settings.as_render_pass",
    "Freestyle",
)  # the view layer's switch, as passes.is_on() has it, and the pass
FOREGROUND, BACKGROUND = "Foreground", "Background"


_held = set()  # session_uids of scenes that held Freestyle off in this session


def needed(scene, layer):
    """(switch, pass) of the lines of a view layer: nothing where there are none, or the user has them as a pass
    already."""
    draws = (scene.render.use_freestyle or _is_held(scene)) and layer.use_freestyle
    return (LINE_PASS,) if draws and (_are_ours(layer) or not passes.is_on(layer, LINE_PASS[0])) else ()


def suspend_drawing(scene):
    """Keep Blender from drawing the lines in the next render, which repeats passes that have them. release() must
    follow."""
    if scene.render.use_freestyle:
        # On the scene, too, so that a step that is undone into this moment has it as well.
        scene.afterlight.holds_lines = True
        _held.add(scene.session_uid)
        scene.render.use_freestyle = False


def resume_drawing(scene):
    """Let Blender draw the lines again, after hold()."""
    if _is_held(scene):
        scene.render.use_freestyle = True
        scene.afterlight.holds_lines = False


def _is_held(scene):
    return scene.afterlight.holds_lines and scene.session_uid in _held


def splice(tree, scene):
    """Lay the lines over what the adding nodes of a tree make of the picture of `scene`, where we made them a pass."""
    for add in _adding(tree, scene):
        picture, result = linked_node(add, A), socket(add.outputs, RESULT)
        users = [(link.to_socket, link.is_muted) for link in result.links]
        if "Freestyle" not in picture.outputs or any(role(user.node) == "lines" for user, _ in users):
            continue
        over = new_node(tree, "CompositorNodeAlphaOver", "lines")
        over.name = over.label = "Afterlight: Freestyle"
        for user, is_muted in users:
            tree.links.new(over.outputs["Image"], user).is_muted = is_muted
        over.inputs[FOREGROUND].default_value = 0.0, 0.0, 0.0, 0.0
        tree.links.new(result, over.inputs[BACKGROUND])
        tree.links.new(picture.outputs["Freestyle"], over.inputs[FOREGROUND])
        over.parent, over.hide = add.parent, True
        over.location = add.location[0] + 160, add.location[1] + 40


def unsplice(tree, scene):
    """Take out what splice() put in and is not wanted any more, or has lost what it lay over."""
    for over in [node for node in tree.nodes if role(node) == "lines"]:
        add = linked_node(over, BACKGROUND)
        picture = linked_node(add, A) if add and role(add) == "add" else None
        if picture is None or picture.scene is None or picture.scene == scene and not is_wanted(scene, picture.layer):
            under = next((link.from_socket for link in over.inputs[BACKGROUND].links), None)
            users = [(link.to_socket, link.is_muted) for link in over.outputs["Image"].links]
            tree.nodes.remove(over)
            for user, is_muted in users if under else ():
                tree.links.new(under, user).is_muted = is_muted


def lacks(tree, scene):
    """Whether a picture of `scene` shows its light without the lines that were made a pass."""
    return any(
        role(link.to_node) != "lines" for add in _adding(tree, scene) for link in socket(add.outputs, RESULT).links
    )


def is_wanted(scene, name):
    """Whether the lines of the view layer of this name are to be laid over the light by a node."""
    layer = scene.view_layers.get(name)
    return scene.afterlight.enabled and layer is not None and bool(needed(scene, layer)) and _are_ours(layer)


def _adding(tree, scene):
    """The adding nodes of a tree whose picture's lines are wanted."""
    return [
        node
        for node in tree.nodes
        if role(node) == "add" and adds_to_image_of(node, scene) and is_wanted(scene, linked_node(node, A).layer)
    ]


def _are_ours(layer):
    """Whether it was us who made the lines of a view layer a pass."""
    return LINE_PASS[0] in layer.afterlight.passes.split(",")
