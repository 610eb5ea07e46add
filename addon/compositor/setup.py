# SPDX-License-Identifier: GPL-3.0-or-later
"""What ticking the box puts into a file, and unticking takes out: passes, helper scene, compositor nodes."""

import bpy

from ..host import engines, render_lock, roles
from ..host.assign import assign
from ..host.roles import HELPER, lit_scene
from ..scene import needs, passes
from ..translations import say
from . import freestyle, layer_passes, muting, nodes, optional_nodes, own_tree, view_scenes

HELPER_NAME = ".Afterlight ({})"  # Blender leaves names with a leading dot out of its menus


def connect(scene):
    """Set up all that a lit render of `scene` needs. Does nothing to what is in place already."""
    if render_lock.postpones(scene):
        return
    adopt(scene)
    settings = scene.afterlight
    old, helper = settings.helper, _own_helper(scene)
    _mirror_layers(scene, helper)
    for group in nodes.trees(scene.compositing_node_group):
        freestyle.unsplice(group, scene)
    tree = own_tree.tree_to_use(scene)
    view_scenes.connect(scene, tree, helper)
    for group in nodes.trees(tree):
        if _is_unshared(group, scene):
            nodes.retarget(group, scene, old, helper)
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
    for group in nodes.trees(tree):  # now that the passes are on which the Denoise node gets
        if needs.denoise_node(scene):
            optional_nodes.splice_denoise(group, scene)
        else:
            optional_nodes.unsplice_denoise(group, (helper, None))
        freestyle.splice(group, scene)
    # Blender 5.2 crashes in -b when the compositor asks for a scene that has never been evaluated.
    helper.view_layers[0].update()


def connect_if_enabled(scene):
    """For settings that decide what connect() makes."""
    if scene.afterlight.enabled and scene.library is None:
        connect(scene)


def follow(scene):
    """Bring helper scene, passes and our nodes in line with `scene` as it is now: layers added, removed or renamed,
    the scene renamed or copied. Puts no node where the user may have taken one away."""
    helper = scene.afterlight.helper
    if render_lock.is_locked() or helper is None:
        return  # deleted by hand: checks.py says so, with a button
    if lit_scene(helper) != scene:
        connect(scene)  # a copied scene: it still names the helper of its original
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
    were_drawn = {layer.name for layer in scene.view_layers if freestyle.is_wanted(scene, layer.name)}
    for group in nodes.trees(scene.compositing_node_group):
        freestyle.unsplice(group, scene)
    follow_passes(scene)
    if {layer.name for layer in scene.view_layers if freestyle.is_wanted(scene, layer.name)} - were_drawn:
        for group in nodes.trees(scene.compositing_node_group):
            freestyle.splice(group, scene)
    if not helper.name.startswith(_helper_name(scene)):  # Blender may have put a number behind it
        helper.name = _helper_name(scene)


def follow_passes(scene):
    """Switch on the passes that are read of the view layers whose light is added, and off what we switched on and is
    read no more."""
    lit = {
        node.layer
        for node in nodes.all_nodes(scene.compositing_node_group)
        if nodes.shows(node, scene.afterlight.helper)
    }
    for layer in [layer for layer in scene.view_layers if layer.name in lit]:
        layer_passes.switch(scene, layer, layer_passes.wanted(scene, layer))


def disconnect(scene):
    """Take out all that connect() put in and restore what was there; keep what the user has built on it."""
    if render_lock.postpones(scene):
        return
    adopt(scene)
    settings, helpers = scene.afterlight, roles.own(scene, HELPER)
    ours = [*helpers, *roles.own(scene, roles.SCOUT), *roles.own(scene, roles.VIEW)]
    in_use = [
        group
        for tree in (scene.compositing_node_group, settings.set_aside, settings.own_tree)
        for group in nodes.trees(tree)
    ]
    of_others = {
        group
        for other in bpy.data.scenes
        if other != scene and other.afterlight.enabled
        for group in nodes.trees(other.compositing_node_group)
    }
    for tree in _compositor_trees():  # the user may have taken another than the one in which we put nodes
        _clear(tree, scene, ours if tree in of_others and tree not in in_use else [*ours, None])
    own_tree.restore(scene)
    for layer in scene.view_layers:
        layer_passes.switch(scene, layer, ())
    settings.helper = None
    view_scenes.disconnect(scene)
    for each in helpers:
        roles.remove(each)


def remove_orphan(orphan):
    """Remove a scene of ours whose lit scene has been deleted, and the nodes that show it."""
    for tree in _compositor_trees():
        _clear(tree, None, [orphan])
    roles.remove(orphan)
    own_tree.remove_orphans()


def adopt(scene):
    """Take over what 0.1.0 to 0.3.0 left in the file for `scene`, which marked it otherwise."""
    roles.adopt(scene)
    own_tree.adopt(scene)
    layer_passes.adopt(scene)


def needs_rebuilding(scene):
    """Whether follow() would add or remove scenes or view layers, which crashes Blender where it evaluates
    something."""
    helper = scene.afterlight.helper
    return helper is not None and (lit_scene(helper) != scene or len(helper.view_layers) > len(scene.view_layers))


def faults(scene):
    """What is missing from the wiring of an enabled scene, as {sentence for people: what mends it in fixes.py, or ""};
    empty where all is in place."""
    helper, tree = scene.afterlight.helper, scene.compositing_node_group
    if (
        helper is None
        or lit_scene(helper) != scene
        or helper.render.engine != engines.LIGHT
        or roles.camera(helper) is None
    ):
        return {say("Afterlight's helper scene was deleted or changed"): "REPAIR"}
    if tree is None or not scene.render.use_compositing:
        return {say("Compositing is switched off, so the light can't be added to the picture"): "REPAIR"}
    if [layer.name for layer in helper.view_layers] != [layer.name for layer in scene.view_layers]:
        return {say("View layers were added, removed or renamed since Indirect Light was ticked"): "REPAIR"}
    pictures = nodes.image_nodes(tree, scene)
    if not pictures:
        return {
            say(
                'The compositor has no Render Layers node of "{}", so there is no picture to add light to. Add one '
                "and link its Image",
                scene.name,
            ): ""
        }
    pictures = [picture for picture in pictures if not picture.mute]
    if not pictures:
        return {
            say(
                'All Render Layers nodes of "{}" are muted, so there is no picture to add light to. Unmute one',
                scene.name,
            ): ""
        }
    if not any(picture.id_data == tree for picture in pictures):
        return {
            say(
                "All Render Layers nodes of this scene are inside node groups, and then Blender does not render "
                "the scene. Add one at the top level of the compositor; it need not be linked"
            ): "RENDER_LAYERS"
        }
    found = {}
    lost = [layer for group in nodes.trees(tree) for layer in nodes.layers_without_image(group, scene, helper)]
    if lost:  # where links went is known in our own tree only
        found[
            say(
                "The node that adds the light to {} was deleted, and the links of the image with it. Link the Image "
                "of its Render Layers node again",
                ", ".join(lost),
            )
        ] = "REPAIR" if own_tree.is_ours(scene, tree) else ""
    if any(nodes.adds_to_nothing(group, helper) for group in nodes.trees(tree)):
        found[say("The image is no longer linked to the node that adds the light to it")] = "REPAIR"
    dark = sorted({picture.layer for picture in pictures if nodes.lacks_light(picture)})
    if dark:
        found[
            say(
                "The compositor uses {} without the indirect light: a node of Afterlight was deleted, or a Render "
                "Layers node is new",
                ", ".join(dark),
            )
        ] = "REPAIR"
    if not any(nodes.shows(node, helper) for node in tree.nodes):
        found[say("Afterlight's Render Layers node was deleted from the compositor")] = "REPAIR"
    elif not found and not nodes.uses_light(tree, scene, helper) and not own_tree.is_untouched(scene, tree):
        found[
            say(
                'The compositor uses the Image of no Render Layers node of "{}", so the light is added to '
                "nothing. Link the Image "
                "of one, or the output Indirect of Afterlight's",
                scene.name,
            )
        ] = ""
    elif any(
        nodes.role(node) == "add" and nodes.adds_to_image_of(node, scene) and not nodes.light_input(node).links
        for node in nodes.all_nodes(tree)
    ):
        found[say("The indirect light is no longer linked to the node that adds it")] = "REPAIR"
    if view_scenes.is_incomplete(scene):
        found[say("A scene through which Afterlight renders its views, or its node in the compositor, was deleted")] = (
            "REPAIR"
        )
    if needs.glossy_light(scene) and any(optional_nodes.lacks_gloss(group, scene) for group in nodes.trees(tree)):
        found[say("The glossy light is no longer linked to the node that adds it")] = "REPAIR"
    if needs.denoise_node(scene) and any(optional_nodes.lacks_denoise(group, scene) for group in nodes.trees(tree)):
        found[say("The Denoise node of the indirect light was deleted")] = "REPAIR"
    if any(freestyle.lacks(group, scene) for group in nodes.trees(tree)):
        found[say("The node that lays the Freestyle lines over the light was deleted")] = "REPAIR"
    if any(
        mirror.use and not all(passes.is_on(layer, switch) for switch, _ in layer_passes.for_gather(scene, layer))
        for layer, mirror in zip(scene.view_layers, helper.view_layers)
    ):
        found[say("A pass that Afterlight reads was switched off")] = "REPAIR"
    return found


def add_picture(scene):
    """Add a Render Layers node of `scene` to the top level of its compositor, the user's own from then on."""
    nodes.new_image_node(scene.compositing_node_group, scene).location = (-400, 0)
    connect(scene)


def _compositor_trees():
    return [tree for tree in bpy.data.node_groups if tree.bl_idname == "CompositorNodeTree" and tree.library is None]


def _clear(tree, scene, ours):
    """Take our nodes for `scene` out of one tree. ours: our scenes that they show; None among them stands for deleted
    ones."""
    freestyle.unsplice(tree, scene)
    optional_nodes.unsplice_denoise(tree, ours)
    optional_nodes.unsplice_gloss(tree, ours)
    nodes.unsplice(tree, scene, ours)
    for node in [node for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours]:
        tree.nodes.remove(node)


def _own_helper(scene):
    found = roles.own(scene, HELPER)
    helper = found[0] if found else roles.new(scene, HELPER, _helper_name(scene), engines.LIGHT)
    assign(scene.afterlight, "helper", helper)
    # Blender asks every scene of the compositor for a camera. This one only answers; nothing looks through it.
    roles.give_camera(helper)
    helper.eevee.taa_render_samples = 1  # what is rendered in its place where the extension is missing
    helper.render.engine = engines.LIGHT
    return helper


def _helper_name(scene):
    return HELPER_NAME.format(scene.name)[:250]


def _mirror_layers(scene, helper):
    """Give `helper` the view layers of `scene`, name by name in the same order."""
    names = [layer.name for layer in scene.view_layers]
    if [layer.name for layer in helper.view_layers] == names:
        return
    while len(helper.view_layers) > len(names):
        helper.view_layers.remove(helper.view_layers[-1])
    for index, layer in enumerate(helper.view_layers):
        layer.name = f"\x7f{index}"  # names are unique: make room for those that only change places
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
    """Let the Render Layers nodes of `helper` offer the passes that its engine gives now."""
    for layer in helper.view_layers:
        layer.update_render_passes()


def _mirror_world(scene, helper):
    """Let `helper`'s depsgraph hold what shines on `scene`, so that it can be looked at as it is in a frame."""
    assign(helper, "world", scene.world)
    for layer, own in zip(scene.view_layers, helper.view_layers):
        assign(own, "world_override", layer.world_override)
