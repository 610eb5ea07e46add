# SPDX-License-Identifier: GPL-3.0-or-later
"""What ticking the box puts into a file, and unticking takes out: passes, helper scene, compositor nodes."""

import bpy

from ..translations import say
from . import between, lines, nodes, passes, roughness, transmittance, views, world
from .nodes import MARK
from .passes import MOTION, PASSES, needed

ENGINE = "AFTERLIGHT"
HELPER_NAME = ".Afterlight ({})"  # Blender leaves names with a leading dot out of its menus
TREE_NAME = "Afterlight Compositing"


def connect(scene):
    """Set up all that a lit render of `scene` needs. Does nothing to what is in place already."""
    settings = scene.afterlight
    old, helper = settings.helper, _own_helper(scene)
    _mirror_layers(scene, helper)
    for group in nodes.trees(scene.compositing_node_group):
        lines.unsplice(group, scene)
    tree = _tree_in_use(scene)
    views.connect(scene, tree, helper)
    for group in nodes.trees(tree):
        if _is_unshared(group, scene):
            nodes.retarget(group, scene, old, helper)
    for picture in nodes.pictures(tree, scene):
        nodes.splice(picture.id_data, picture, helper)
    if nodes.pictures(tree, scene) and not any(nodes.shows(node, helper) for node in tree.nodes):
        # Blender looks for scenes to render only among the nodes of the top level, not in groups.
        nodes.light_node(tree, helper, nodes.pictures(tree, scene)[0].layer).location = (-400, -400)
    _offer_passes(helper)
    for group in nodes.trees(tree):
        if wants_gloss(scene):
            between.splice_gloss(group, scene, helper)
        else:
            between.unsplice_gloss(group, helper)
    follow(scene)
    for group in nodes.trees(tree):  # now that the passes are on which the Denoise node gets
        if wants_denoise(scene):
            between.splice_denoise(group, scene)
        else:
            between.unsplice_denoise(group, helper)
        lines.splice(group, scene)
    # Blender 5.2 crashes in -b when the compositor asks for a scene that has never been evaluated.
    helper.view_layers[0].update()


def connect_if_enabled(scene):
    """For settings that decide what connect() makes."""
    if scene.afterlight.enabled and scene.library is None:
        connect(scene)


def wants_gloss(scene):
    """Whether the light off glossy surfaces is to be gathered."""
    settings = scene.afterlight
    return settings.enabled and settings.use_glossy and settings.method == "RADIOSITY"


def wants_denoise(scene):
    """Whether Blender's Denoise node is to have the light."""
    settings = scene.afterlight
    return settings.enabled and settings.denoise == "NODE" and settings.method == "RADIOSITY"


def follow(scene):
    """Bring helper scene, passes and our nodes in line with `scene` as it is now: layers added, removed or renamed,
    the scene renamed or copied. Puts no node where the user may have taken one away."""
    helper = scene.afterlight.helper
    if helper is not None and source(helper) != scene:
        connect(scene)  # a copied scene: it still names the helper of its original
        return
    if helper is None:
        return  # deleted by hand: checks.py says so, with a button
    _mirror_layers(scene, helper)
    world.mirror(scene, helper)
    views.follow(scene)
    for group in nodes.trees(scene.compositing_node_group):
        nodes.retarget(group, scene, helper, helper)
    lit = {node.layer for node in nodes.all_nodes(scene.compositing_node_group) if nodes.shows(node, helper)}
    for layer, mirror in zip(scene.view_layers, helper.view_layers, strict=True):
        nodes.assign(mirror, "use", layer.use and layer.name in lit)
    were_drawn = {layer.name for layer in scene.view_layers if lines.is_wanted(scene, layer.name)}
    for group in nodes.trees(scene.compositing_node_group):
        lines.unsplice(group, scene)
    follow_passes(scene)
    if {layer.name for layer in scene.view_layers if lines.is_wanted(scene, layer.name)} - were_drawn:
        for group in nodes.trees(scene.compositing_node_group):
            lines.splice(group, scene)
    if not helper.name.startswith(_helper_name(scene)):  # Blender may have put a number behind it
        helper.name = _helper_name(scene)


def follow_passes(scene):
    """Switch on the passes that are read of the view layers whose light is added, and off what we switched on and is read no more."""
    in_front = transmittance.needed(scene)
    lit = {node.layer for node in nodes.all_nodes(scene.compositing_node_group) if nodes.shows(node, scene.afterlight.helper)}
    for layer in scene.view_layers:
        if layer.name in lit:
            _switch_passes(scene, layer, [*_passes_of(scene, layer), *in_front, *lines.needed(scene, layer)])


def disconnect(scene):
    """Take out all that connect() put in and restore what was there; keep what the user has built on it."""
    settings, helper = scene.afterlight, scene.afterlight.helper
    views.disconnect(scene)
    is_ours = helper is not None and source(helper) == scene
    for tree in {scene.compositing_node_group, settings.set_aside, settings.own_tree} - {None}:
        for group in nodes.trees(tree):
            lines.unsplice(group, scene)
            between.unsplice_denoise(group, helper)
            between.unsplice_gloss(group, helper)
            nodes.unsplice(group, scene, helper)
    _restore_tree(scene)
    for layer in scene.view_layers:
        _switch_passes(scene, layer, ())
    settings.helper = None
    if is_ours:
        _remove_helper(helper)


def is_helper(scene):
    """Whether the scene is one that connect() made."""
    return scene.get(MARK) in {"helper", "scout", "view"}


def source(helper):
    """The scene whose light `helper` gathers, or None. A copied scene names the helper of its original until follow()
    has seen it; the original is older."""
    return min((scene for scene in bpy.data.scenes if scene.afterlight.helper == helper
                or any(view.scene == helper for view in scene.afterlight.view_scenes)),
               key=lambda scene: scene.session_uid, default=None)


def clean_up():
    """Remove helper scenes whose own scene has been deleted."""
    for scene in [scene for scene in bpy.data.scenes if is_helper(scene) and not scene.library]:
        if source(scene) is None:
            _remove_helper(scene)


def faults(scene):
    """What is missing from the wiring of an enabled scene, as {sentence for people: what mends it in cures.py, or ""};
    empty where all is in place."""
    helper, tree = scene.afterlight.helper, scene.compositing_node_group
    if helper is None or source(helper) != scene or helper.render.engine != ENGINE:
        return {say("Afterlight's helper scene was deleted or changed"): "REPAIR"}
    if tree is None or not scene.render.use_compositing:
        return {say("Compositing is switched off, so the light can't be added to the picture"): "REPAIR"}
    if [layer.name for layer in helper.view_layers] != [layer.name for layer in scene.view_layers]:
        return {say("View layers were added, removed or renamed since Indirect Light was ticked"): "REPAIR"}
    pictures = nodes.pictures(tree, scene)
    if not pictures:
        return {say('The compositor has no Render Layers node of "{}", so there is no picture to add light to. Add one '
                    "and link its Image", scene.name): ""}
    if not any(picture.id_data == tree for picture in pictures):
        return {say("All Render Layers nodes of this scene are inside node groups, and then Blender does not render "
                    "the scene. Add one at the top level of the compositor; it need not be linked"): "RENDER_LAYERS"}
    found = {}
    lost = [layer for group in nodes.trees(tree) for layer in nodes.lost_image(group, scene, helper)]
    if lost:  # where links went is known in our own tree only
        found[say("The node that adds the light to {} was deleted, and the links of the image with it. Link the Image "
                  "of its Render Layers node again", ", ".join(lost))] = (
                      "REPAIR" if tree == scene.afterlight.own_tree else "")
    dark = sorted({picture.layer for picture in pictures if nodes.goes_dark(picture)})
    if dark:
        found[say("The compositor uses {} without the indirect light: a node of Afterlight was deleted, or a Render "
                  "Layers node is new", ", ".join(dark))] = "REPAIR"
    if not any(nodes.shows(node, helper) for node in tree.nodes):
        found[say("Afterlight's Render Layers node was deleted from the compositor")] = "REPAIR"
    elif any(nodes.role(node) == "add" and not nodes.source(node, nodes.B) for node in nodes.all_nodes(tree)):
        found[say("The indirect light is no longer linked to the node that adds it")] = "REPAIR"
    if views.faults(scene):
        found[say("A scene through which Afterlight renders its views, or its node in the compositor, was deleted")] = "REPAIR"
    if wants_gloss(scene) and any(between.lacks_gloss(group, scene) for group in nodes.trees(tree)):
        found[say("The glossy light is no longer linked to the node that adds it")] = "REPAIR"
    if wants_denoise(scene) and any(between.lacks_denoise(group, scene) for group in nodes.trees(tree)):
        found[say("The Denoise node of the indirect light was deleted")] = "REPAIR"
    if any(lines.lacks(group, scene) for group in nodes.trees(tree)):
        found[say("The node that lays the Freestyle lines over the light was deleted")] = "REPAIR"
    if any(mirror.use and not all(getattr(layer, switch) for switch, _ in _passes_of(scene, layer))
           for layer, mirror in zip(scene.view_layers, helper.view_layers)):
        found[say("A pass that Afterlight reads was switched off")] = "REPAIR"
    return found


def add_picture(scene):
    """Add a Render Layers node of `scene` to the top level of its compositor, the user's own from then on."""
    nodes.picture_node(scene.compositing_node_group, scene).location = (-400, 0)
    connect(scene)


def _own_helper(scene):
    helper = scene.afterlight.helper
    if helper is None or source(helper) != scene:
        helper = bpy.data.scenes.new(_helper_name(scene))
        helper[MARK] = "helper"
        # Blender asks every scene of the compositor for a camera. This one only answers; nothing looks through it.
        helper.camera = bpy.data.objects.new(helper.name, bpy.data.cameras.new(helper.name))
        helper.collection.objects.link(helper.camera)
        helper.render.resolution_x = helper.render.resolution_y = 4  # it is always rendered at its source's
        helper.eevee.taa_render_samples = 1  # what is rendered in its place where the extension is missing
        scene.afterlight.helper = helper
    helper.render.engine = ENGINE
    return helper


def _helper_name(scene):
    return HELPER_NAME.format(scene.name)[:250]


def _remove_helper(helper):
    for camera in [each for each in helper.collection.objects if each.type == "CAMERA"]:
        bpy.data.cameras.remove(camera.data)  # and the object with it
    bpy.data.scenes.remove(helper)


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
    for name in names[len(helper.view_layers):]:
        helper.view_layers.new(name)


def _is_unshared(tree, scene):
    """Whether no other enabled scene has this tree in its compositor."""
    return not any(tree in nodes.trees(other.compositing_node_group)
                   for other in bpy.data.scenes if other != scene and other.afterlight.enabled)


def _tree_in_use(scene):
    """The compositor tree to wire: the user's own where it is in use, else one of ours."""
    settings, render = scene.afterlight, scene.render
    tree = scene.compositing_node_group
    if tree is not None and settings.own_tree not in (None, tree) and all(map(nodes.role, tree.nodes)):
        settings.own_tree = tree  # a copied scene has a copy of the tree we made for its original
    if tree is not None and (render.use_compositing or tree == settings.own_tree):
        render.use_compositing = True
        if tree == settings.own_tree:
            _link_image(tree)
        return tree
    if not render.use_compositing:
        # A tree that is switched off must not come to life because Afterlight needs the compositor.
        settings.compositing_was_off, settings.set_aside = True, tree
        render.use_compositing = True
    settings.own_tree = scene.compositing_node_group = _new_tree(scene)
    return settings.own_tree


def _new_tree(scene):
    """The tree that does what Blender does without one: the first view layer's image is the picture."""
    tree = bpy.data.node_groups.new(TREE_NAME, "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    picture, output = nodes.picture_node(tree, scene), tree.nodes.new("NodeGroupOutput")
    picture[MARK] = output[MARK] = "plain"
    output.location = (600, 0)
    _link_image(tree)
    return tree


def _link_image(tree):
    """In a tree that holds nothing but our nodes, link the image to the output where a deleted node left a gap."""
    if all(map(nodes.role, tree.nodes)):
        picture = next((node for node in tree.nodes if "Image" in node.outputs and nodes.role(node) == "plain"), None)
        for output in [node for node in tree.nodes if node.bl_idname == "NodeGroupOutput"]:
            if picture and not output.inputs[0].is_linked:
                tree.links.new(picture.outputs["Image"], output.inputs[0])


def _restore_tree(scene):
    settings, own = scene.afterlight, scene.afterlight.own_tree
    shared = any(other != scene and other.compositing_node_group == own for other in bpy.data.scenes)
    if own is not None and not shared and all(map(nodes.role, own.nodes)):
        if scene.compositing_node_group == own:
            scene.compositing_node_group = settings.set_aside
            if settings.compositing_was_off:
                scene.render.use_compositing = False
        bpy.data.node_groups.remove(own)
    elif own is not None:  # the user has built on it: from now on it is theirs
        for node in own.nodes:
            if nodes.role(node) == "plain":
                del node[MARK]
    settings.own_tree = settings.set_aside = None
    settings.compositing_was_off = False


def _offer_passes(helper):
    """Let the Render Layers nodes of `helper` offer the passes that its engine gives now."""
    for layer in helper.view_layers:
        layer.update_render_passes()


def _passes_of(scene, layer):
    """(switch, pass) of all that is read of a view layer."""
    return [*((switch, name) for _, switch, name, _ in needed(scene.afterlight)),
            *(roughness.needed(layer) if wants_gloss(scene) else ())]


def _switch_passes(scene, layer, wanted):
    """Switch on what is wanted, (switch, pass) each, and off what we once switched on and is not wanted, but for passes that the
    user's own nodes have come to use."""
    ours, wanted = set(layer.get(MARK, ())), {switch for switch, _ in wanted}
    unwanted = ours - wanted
    used = nodes.used_passes(scene, layer.name) if unwanted else ()
    for switch, name in (*((switch, name) for _, switch, name, _ in (*PASSES, MOTION)),
                         roughness.MATERIAL, *transmittance.PASSES, lines.LINES):
        if switch in wanted and not passes.is_on(layer, switch):
            ours.add(switch)
            passes.turn(layer, switch, True)
        elif switch in unwanted and name not in used:
            passes.turn(layer, switch, False)
    ours -= unwanted
    if ours != set(layer.get(MARK, ())):
        if ours:
            layer[MARK] = sorted(ours)
        else:
            del layer[MARK]
