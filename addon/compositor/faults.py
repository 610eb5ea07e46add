# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of what setup.connect() has put into the file: which helper scene, node, link or pass is missing."""

from ..host import engines, roles
from ..scene import needs, passes
from ..translations import say
from . import freestyle, layer_passes, nodes, optional_nodes, own_tree, view_scenes


def find(scene):
    """The faults of an enabled scene's setup: {sentence for people: name of its remedy in diagnosis/fixes.py, or ""};
    empty if nothing is missing."""
    return _obstacle(scene) or _gaps(scene)


def _obstacle(scene):
    """The one fault that keeps all light out of the picture, or {}. Further checks make no sense until it is fixed."""
    helper, tree = scene.afterlight.helper, scene.compositing_node_group
    if (
        helper is None
        or roles.lit_scene(helper) != scene
        or helper.render.engine != engines.LIGHT
        or roles.camera(helper) is None
    ):
        return {say("Afterlight's helper scene was deleted or changed. Press Repair"): "REPAIR"}
    if tree is None or not scene.render.use_compositing:
        return {say("Compositing is disabled, so no light can be added to the image. Press Repair"): "REPAIR"}
    if [layer.name for layer in helper.view_layers] != [layer.name for layer in scene.view_layers]:
        return {
            say("View layers were added, removed or renamed since Indirect Light was enabled. Press Repair"): "REPAIR"
        }
    pictures = nodes.image_nodes(tree, scene)
    if not pictures:
        return {
            say(
                'The compositor has no Render Layers node of "{}", so there is no image to add light to. Add one '
                "and link its Image",
                scene.name,
            ): ""
        }
    pictures = [picture for picture in pictures if not picture.mute]
    if not pictures:
        return {
            say(
                'All Render Layers nodes of "{}" are muted, so there is no image to add light to. Unmute one',
                scene.name,
            ): ""
        }
    if not any(picture.id_data == tree for picture in pictures):
        return {
            say(
                "All Render Layers nodes of this scene are inside node groups, so Blender does not render the "
                "scene. Add one outside of the groups. It does not have to be linked"
            ): "RENDER_LAYERS"
        }
    return {}


def _gaps(scene):
    """All other faults: nodes, links, view scenes and passes that are missing."""
    helper, tree = scene.afterlight.helper, scene.compositing_node_group
    pictures = [picture for picture in nodes.image_nodes(tree, scene) if not picture.mute]
    faults = {}
    layers = [layer for group in nodes.trees(tree) for layer in nodes.layers_without_image(group, scene, helper)]
    if layers:  # only in our own tree is it known where the links led
        faults[
            say(
                "The node that adds the light to {} was deleted, and with it the links of the image. Link the "
                "Image of its Render Layers node again",
                ", ".join(layers),
            )
        ] = "REPAIR" if own_tree.is_ours(scene, tree) else ""
    if any(nodes.adds_to_nothing(group, helper) for group in nodes.trees(tree)):
        faults[say("The image is no longer linked to the node that adds the light to it. Press Repair")] = "REPAIR"
    unlit_layers = sorted({picture.layer for picture in pictures if nodes.lacks_light(picture)})
    if unlit_layers:
        faults[
            say(
                "The compositor uses {} without the indirect light, because a node of Afterlight was deleted or "
                "a Render Layers node was added. Press Repair",
                ", ".join(unlit_layers),
            )
        ] = "REPAIR"
    if not any(nodes.shows(node, helper) for node in tree.nodes):
        faults[say("Afterlight's Render Layers node was deleted from the compositor. Press Repair")] = "REPAIR"
    elif not faults and not nodes.uses_light(tree, scene, helper) and not own_tree.is_untouched(scene, tree):
        faults[
            say(
                'The compositor does not use the Image of any Render Layers node of "{}", so there is no image '
                "to add light to. Link the Image of one, or the output Indirect of Afterlight's own Render "
                "Layers node",
                scene.name,
            )
        ] = ""
    elif any(
        nodes.role(node) == "add" and nodes.adds_to_image_of(node, scene) and not nodes.light_input(node).links
        for node in nodes.all_nodes(tree)
    ):
        faults[say("The indirect light is no longer linked to the node that adds it. Press Repair")] = "REPAIR"
    if view_scenes.is_incomplete(scene):
        faults[say("A helper scene for the views was deleted, or its node in the compositor. Press Repair")] = "REPAIR"
    if needs.glossy_light(scene) and any(optional_nodes.lacks_gloss(group, scene) for group in nodes.trees(tree)):
        faults[say("The glossy light is no longer linked to the node that adds it. Press Repair")] = "REPAIR"
    if needs.denoise_node(scene) and any(optional_nodes.lacks_denoise(group, scene) for group in nodes.trees(tree)):
        faults[say("The Denoise node of the indirect light was deleted. Press Repair")] = "REPAIR"
    if any(freestyle.lacks(group, scene) for group in nodes.trees(tree)):
        faults[say("The node that draws the Freestyle lines over the light was deleted. Press Repair")] = "REPAIR"
    if any(
        mirror.use and not all(passes.is_on(layer, switch) for switch, _ in layer_passes.for_gather(scene, layer))
        for layer, mirror in zip(scene.view_layers, helper.view_layers)
    ):
        faults[say("A pass that Afterlight needs was disabled. Press Repair")] = "REPAIR"
    return faults
