# SPDX-License-Identifier: GPL-3.0-or-later
"""Setting up a scene to be lit, and undoing it: passes, helper scenes and compositor nodes."""

import bpy

from ..host import engines, render_lock, roles
from ..host.assign import assign
from ..host.roles import HELPER, lit_scene
from ..scene import needs
from . import freestyle, layer_passes, muting, nodes, optional_nodes, own_tree, view_scenes

HELPER_NAME = ".Afterlight ({})"  # Blender's menus hide names with a leading dot


def connect(scene):
    """Set up everything that rendering `scene` with indirect light needs. Leaves alone what is already in place."""
    if render_lock.postpones(scene):
        return
    adopt(scene)
    settings = scene.afterlight
    previous_helper, helper = settings.helper, _own_helper(scene)
    _mirror_layers(scene, helper)
    for group in nodes.trees(scene.compositing_node_group):
        freestyle.unsplice(group, scene)
    tree = own_tree.tree_to_use(scene)
    view_scenes.connect(scene, tree, helper)
    for group in nodes.trees(tree):
        if _is_unshared(group, scene):
            nodes.retarget(group, scene, previous_helper, helper)
    _offer_passes(helper)
    for picture in nodes.image_nodes(tree, scene):
        nodes.splice(picture.id_data, picture, helper)
    nodes.request_render(tree, scene, helper)
    for group in nodes.trees(tree):
        if needs.glossy_light(scene):
            optional_nodes.splice_gloss(group, scene, helper)
        else:
            optional_nodes.unsplice_gloss(group, (helper, None))
    follow(scene)
    for group in nodes.trees(tree):  # only now are the passes on that the Denoise node takes
        if needs.denoise_node(scene):
            optional_nodes.splice_denoise(group, scene)
        else:
            optional_nodes.unsplice_denoise(group, (helper, None))
        freestyle.splice(group, scene)
    # Blender 5.2 crashes in -b when the compositor asks for a scene that has never been evaluated.
    helper.view_layers[0].update()


def connect_if_enabled(scene):
    """connect() if the scene is enabled: called when a setting changes that connect() depends on."""
    if scene.afterlight.enabled and scene.library is None:
        connect(scene)


def follow(scene):
    """Bring helper scenes, passes and our nodes in line with edits of `scene`: view layers added, removed or renamed,
    the scene renamed or copied. Adds no node where the user may have removed one."""
    helper = scene.afterlight.helper
    if render_lock.is_locked() or helper is None:
        return  # the user deleted it: diagnosis/checks.py says so and offers a button
    if lit_scene(helper) != scene or view_scenes.is_of_0_3_0(scene):
        connect(scene)  # a copied scene still names the helper of its original
        return
    _mirror_layers(scene, helper)
    _mirror_world(scene, helper)
    view_scenes.follow(scene)
    for group in nodes.trees(scene.compositing_node_group):
        nodes.retarget(group, scene, helper, helper)
        muting.follow(group, scene)
    lit = {node.layer for node in nodes.all_nodes(scene.compositing_node_group) if nodes.shows(node, helper)}
    for layer, mirror in zip(scene.view_layers, helper.view_layers, strict=True):
        assign(mirror, "use", layer.use and layer.name in lit)
    drawn_before = {layer.name for layer in scene.view_layers if freestyle.is_wanted(scene, layer.name)}
    for group in nodes.trees(scene.compositing_node_group):
        freestyle.unsplice(group, scene)
    follow_passes(scene)
    if {layer.name for layer in scene.view_layers if freestyle.is_wanted(scene, layer.name)} - drawn_before:
        for group in nodes.trees(scene.compositing_node_group):
            freestyle.splice(group, scene)
    if not helper.name.startswith(_helper_name(scene)):  # Blender may have appended a number
        helper.name = _helper_name(scene)


def follow_passes(scene):
    """Switch on the passes needed of the view layers whose light is added, and off those that we switched on and that
    are no longer needed."""
    lit = {
        node.layer
        for node in nodes.all_nodes(scene.compositing_node_group)
        if nodes.shows(node, scene.afterlight.helper)
    }
    for layer in [layer for layer in scene.view_layers if layer.name in lit]:
        layer_passes.switch(scene, layer, layer_passes.wanted(scene, layer))


def disconnect(scene):
    """Remove everything that connect() added and restore what was there before; keep what the user has built on it."""
    if render_lock.postpones(scene):
        return
    adopt(scene)
    settings, helpers = scene.afterlight, roles.own(scene, HELPER)
    ours = [*helpers, *roles.own(scene, roles.SCOUT), *roles.own(scene, roles.VIEW)]
    groups_in_use = [
        group
        for tree in (scene.compositing_node_group, settings.set_aside, settings.own_tree)
        for group in nodes.trees(tree)
    ]
    groups_of_others = {
        group
        for other in bpy.data.scenes
        if other != scene and other.afterlight.enabled
        for group in nodes.trees(other.compositing_node_group)
    }
    for tree in _compositor_trees():  # the user may have switched to another tree than the one with our nodes
        _clear(tree, scene, ours if tree in groups_of_others and tree not in groups_in_use else [*ours, None])
    own_tree.restore(scene)
    for layer in scene.view_layers:
        layer_passes.switch(scene, layer, ())
    settings.helper = None
    view_scenes.disconnect(scene)
    for each in helpers:
        roles.remove(each)


def remove_orphan(orphan):
    """Remove one of our scenes whose lit scene was deleted, and the nodes that show it."""
    for tree in _compositor_trees():
        _clear(tree, None, [orphan])
    roles.remove(orphan)
    own_tree.remove_orphans()


def adopt(scene):
    """Take over the marks that 0.1.0 to 0.3.0 left in the file for `scene`."""
    roles.adopt(scene)
    own_tree.adopt(scene)
    layer_passes.adopt(scene)


def needs_rebuilding(scene):
    """Whether follow() would add or remove scenes or view layers. Blender crashes if that happens while it evaluates a
    scene."""
    helper = scene.afterlight.helper
    return helper is not None and (
        lit_scene(helper) != scene or len(helper.view_layers) > len(scene.view_layers) or view_scenes.is_of_0_3_0(scene)
    )


def add_picture(scene):
    """Add a Render Layers node of `scene` to the top level of its compositor. The node belongs to the user."""
    nodes.new_image_node(scene.compositing_node_group, scene).location = (-400, 0)
    connect(scene)


def _compositor_trees():
    return [tree for tree in bpy.data.node_groups if tree.bl_idname == "CompositorNodeTree" and tree.library is None]


def _clear(tree, scene, ours):
    """Remove our nodes for `scene` from one tree. ours: our scenes, whose nodes go; None among them stands for deleted
    scenes."""
    freestyle.unsplice(tree, scene)
    optional_nodes.unsplice_denoise(tree, ours)
    optional_nodes.unsplice_gloss(tree, ours)
    nodes.unsplice(tree, scene, ours)
    for node in [node for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours]:
        tree.nodes.remove(node)


def _own_helper(scene):
    helpers = roles.own(scene, HELPER)
    helper = helpers[0] if helpers else roles.new(scene, HELPER, _helper_name(scene), engines.LIGHT)
    assign(scene.afterlight, "helper", helper)
    # Blender requires a camera of every scene in the compositor. Nothing is rendered through this one.
    roles.give_camera(helper)
    helper.eevee.taa_render_samples = 1  # EEVEE renders the scene instead where the extension is missing
    helper.render.engine = engines.LIGHT
    return helper


def _helper_name(scene):
    return HELPER_NAME.format(scene.name)[:250]


def _mirror_layers(scene, helper):
    """Give `helper` the same view layers as `scene`, by name and order."""
    names = [layer.name for layer in scene.view_layers]
    if [layer.name for layer in helper.view_layers] == names:
        return
    while len(helper.view_layers) > len(names):
        helper.view_layers.remove(helper.view_layers[-1])
    for index, layer in enumerate(helper.view_layers):
        layer.name = f"\x7f{index}"  # names are unique, so free them all before some are swapped
    for layer, name in zip(helper.view_layers, names):
        layer.name = name
    for name in names[len(helper.view_layers) :]:
        helper.view_layers.new(name)


def _is_unshared(tree, scene):
    """Whether no other enabled scene has this tree in its compositor."""
    return not any(
        tree in nodes.trees(other.compositing_node_group)
        for other in bpy.data.scenes
        if other != scene and other.afterlight.enabled
    )


def _offer_passes(helper):
    """Update the outputs of the Render Layers nodes of `helper` to the passes that its engine offers now."""
    for layer in helper.view_layers:
        layer.update_render_passes()


def _mirror_world(scene, helper):
    """Give `helper` the world of `scene`, so that its depsgraph holds the world as evaluated for the frame."""
    assign(helper, "world", scene.world)
    for layer, own in zip(scene.view_layers, helper.view_layers):
        assign(own, "world_override", layer.world_override)
