# SPDX-License-Identifier: GPL-3.0-or-later
"""The compositor tree of a lit scene: the user's own if it is in use, else one that Afterlight makes and later removes.

A tree is ours only if it carries our mark and the scene names it as `afterlight.own_tree`.
"""

import bpy

from ..host.roles import MARK
from . import nodes

NAME = "Afterlight Compositing"
TREE = "tree"


def is_ours(scene, tree):
    """Whether Afterlight made this tree for `scene`."""
    return tree is not None and tree == scene.afterlight.own_tree and tree.get(MARK) == TREE


def is_untouched(scene, tree):
    """Whether Afterlight made this tree for `scene` and it holds no other nodes than ours."""
    return is_ours(scene, tree) and _holds_only_ours(tree)


def adopt(scene):
    """Mark the tree that 0.1.0 to 0.3.0 made for `scene`."""
    tree = scene.afterlight.own_tree
    if (
        tree is not None
        and MARK not in tree
        and tree.name.startswith(NAME)
        and any(nodes.role(node) == "plain" for node in tree.nodes)
    ):
        tree[MARK] = TREE


def tree_to_use(scene):
    """The compositor tree to put our nodes into: the user's own if it is in use, else one of ours."""
    settings, render = scene.afterlight, scene.render
    tree = scene.compositing_node_group
    if tree is not None and settings.own_tree not in (None, tree) and tree.get(MARK) == TREE and _holds_only_ours(tree):
        settings.own_tree = tree  # a copied scene has a copy of the tree that we made for its original
    if tree is not None and (render.use_compositing or is_ours(scene, tree)):
        render.use_compositing = True
        if is_untouched(scene, tree):
            _link_image(tree)
        return tree
    if not render.use_compositing:
        # The user's tree is switched off and must stay so, although Afterlight needs the compositor.
        settings.compositing_was_off, settings.set_aside = True, tree
        render.use_compositing = True
    own_tree = settings.own_tree
    is_free = own_tree is not None and not _belongs_to_other_scene(own_tree, scene)
    if is_free and is_untouched(scene, own_tree):  # the user has switched to no tree
        _link_image(own_tree)
    else:
        if is_free and is_ours(scene, own_tree):
            _hand_over(own_tree)
        own_tree = _new_tree(scene)
    settings.own_tree = scene.compositing_node_group = own_tree
    return own_tree


def _new_tree(scene):
    """Make a tree that does what Blender does without one: output the first view layer's image."""
    tree = bpy.data.node_groups.new(NAME, "CompositorNodeTree")
    tree[MARK] = TREE
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    picture, output = nodes.new_image_node(tree, scene), tree.nodes.new("NodeGroupOutput")
    picture[MARK] = output[MARK] = "plain"
    output.location = (600, 0)
    _link_image(tree)
    return tree


def _link_image(tree):
    """In a tree of ours, link the image to the output again where a deleted node left a gap."""
    picture = next((node for node in tree.nodes if "Image" in node.outputs and nodes.role(node) == "plain"), None)
    for output in [node for node in tree.nodes if node.bl_idname == "NodeGroupOutput"]:
        if picture and not output.inputs[0].is_linked:
            tree.links.new(picture.outputs["Image"], output.inputs[0])


def restore(scene):
    """Give `scene` its own tree back and remove ours, unless the user has built on it."""
    settings, own_tree = scene.afterlight, scene.afterlight.own_tree
    if is_ours(scene, own_tree):
        shared = any(other != scene and other.compositing_node_group == own_tree for other in bpy.data.scenes)
        if not shared and is_untouched(scene, own_tree) and not _is_in_a_group(own_tree):
            if scene.compositing_node_group == own_tree:
                scene.compositing_node_group = settings.set_aside
                if settings.compositing_was_off:
                    scene.render.use_compositing = False
            bpy.data.node_groups.remove(own_tree)
        elif not shared:
            _hand_over(own_tree)
    settings.own_tree = settings.set_aside = None
    settings.compositing_was_off = False


def remove_orphans():
    """Remove our trees whose scene was deleted, unless somebody has come to use them."""
    named = {scene.afterlight.own_tree for scene in bpy.data.scenes}
    for tree in [
        tree for tree in bpy.data.node_groups if tree.get(MARK) == TREE and tree not in named and tree.library is None
    ]:
        if not tree.users and _holds_only_ours(tree):
            bpy.data.node_groups.remove(tree)


def _holds_only_ours(tree):
    return all(map(nodes.role, tree.nodes))


def _hand_over(tree):
    """Make a tree of ours the user's, who has built on it."""
    del tree[MARK]
    for node in tree.nodes:
        if nodes.role(node) == "plain":
            del node[MARK]


def _belongs_to_other_scene(tree, scene):
    """Whether a tree that `scene` names belongs to another scene: a copied scene names its original's."""
    return any(
        other != scene and tree in (other.compositing_node_group, other.afterlight.own_tree)
        for other in bpy.data.scenes
    )


def _is_in_a_group(tree):
    """Whether anything but a scene uses a tree."""
    return any(user.id_type != "SCENE" for user in bpy.data.user_map(subset={tree})[tree])
