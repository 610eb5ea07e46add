# SPDX-License-Identifier: GPL-3.0-or-later
"""Freestyle lines on top of the light.

Blender draws the lines into the image, so light added afterwards would cover them. While a scene is lit the lines are
rendered as a pass of their own, and one of our nodes lays it over the lit image, as Blender does over the plain one:

    add.Result ------------------------- Background
                                         lines (Alpha Over) -> whatever used the image
    Render Layers (scene).Freestyle ---- Foreground
"""

from ..scene import passes
from .nodes import RESULT, A, adds_to_image_of, linked_node, new_node, role, socket

# The path, from the view layer, of the property that switches the pass on, and the name of the pass.
LINE_PASS = "freestyle_settings.as_render_pass", "Freestyle"
FOREGROUND, BACKGROUND = "Foreground", "Background"

# session_uids of scenes where suspend_drawing() was called in this process; global, since undo may restore that state.
_held = set()


def needed(scene, layer):
    """(switch, pass) of a view layer's lines, in a tuple: empty if it has none or the user already renders them as a
    pass."""
    draws = (scene.render.use_freestyle or _is_held(scene)) and layer.use_freestyle
    return (LINE_PASS,) if draws and (_are_ours(layer) or not passes.is_on(layer, LINE_PASS[0])) else ()


def suspend_drawing(scene):
    """Keep Blender from drawing lines in the next render, which repeats kept passes that contain them. resume_drawing()
    must follow."""
    if scene.render.use_freestyle:
        # Also stored on the scene, so that undoing to this moment restores it.
        scene.afterlight.holds_lines = True
        _held.add(scene.session_uid)
        scene.render.use_freestyle = False


def resume_drawing(scene):
    """Let Blender draw the lines again after suspend_drawing()."""
    if _is_held(scene):
        scene.render.use_freestyle = True
        scene.afterlight.holds_lines = False


def _is_held(scene):
    return scene.afterlight.holds_lines and scene.session_uid in _held


def splice(tree, scene):
    """Insert nodes that lay the lines over the lit image of `scene`, where we made the lines a pass."""
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
    """Remove what splice() inserted if it is no longer wanted or has lost its background."""
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
    """Whether an image of `scene` is lit but lacks its lines, which were made a pass."""
    return any(
        role(link.to_node) != "lines" for add in _adding(tree, scene) for link in socket(add.outputs, RESULT).links
    )


def is_wanted(scene, name):
    """Whether a node is to lay the lines of this view layer, given by name, over the light."""
    layer = scene.view_layers.get(name)
    return scene.afterlight.enabled and layer is not None and bool(needed(scene, layer)) and _are_ours(layer)


def _adding(tree, scene):
    """The adding nodes of a tree whose image wants its lines."""
    return [
        node
        for node in tree.nodes
        if role(node) == "add" and adds_to_image_of(node, scene) and is_wanted(scene, linked_node(node, A).layer)
    ]


def _are_ours(layer):
    """Whether Afterlight made the lines of a view layer a pass."""
    return LINE_PASS[0] in layer.afterlight.passes.split(",")
