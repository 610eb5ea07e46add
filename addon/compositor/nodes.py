# SPDX-License-Identifier: GPL-3.0-or-later
"""Our nodes in a compositor tree: how they get between a Render Layers node's image and what used it, and out again.

    Render Layers (scene, layer).Image ------------- A
                                                     add: A + B -> whatever used the image
    light: Render Layers (helper, layer).Indirect -- B

What may come between the light and B is in optional_nodes.py.

Nodes of ours carry the custom property MARK with their role, and are of its type. All that is known is read off the
nodes themselves, so what a user moves, renames or deletes is never restored from a record that has gone stale.
"""

from ..host.roles import MARK, is_helper

NODE_TYPES = {
    "add": {"ShaderNodeMix"},
    "gloss": {"ShaderNodeMix"},
    "denoise": {"CompositorNodeDenoise"},
    "lines": {"CompositorNodeAlphaOver"},
    "light": {"CompositorNodeRLayers"},
    "request": {"CompositorNodeRLayers"},
    "view": {"CompositorNodeRLayers"},
    "plain": {"CompositorNodeRLayers", "NodeGroupOutput"},
}
PASS, GLOSSY_PASS = "Indirect", "Indirect Glossy"
A, B, RESULT = "A_Color", "B_Color", "Result_Color"


def trees(tree):
    """The tree and every node group in it, at any depth, each once."""
    found, open_trees = [], [tree]
    while open_trees:
        tree = open_trees.pop()
        if tree is not None and tree not in found:
            found.append(tree)
            open_trees += [node.node_tree for node in tree.nodes if node.bl_idname == "CompositorNodeGroup"]
    return found


def all_nodes(tree):
    """Every node of the tree and of the groups in it."""
    return [node for group in trees(tree) for node in group.nodes]


def role(node):
    """One of KINDS, or None for the user's own: a mark on a node that can't have that role is not ours. "plain" is an
    ordinary node in a tree that we made."""
    kind = node.get(MARK)
    if not isinstance(kind, str) or node.bl_idname not in NODE_TYPES.get(kind, ()):
        return None
    if kind in {"light", "request", "view"} and node.scene is not None and not is_helper(node.scene):
        return None
    return kind


def shows(node, scene):
    """Whether the node is a Render Layers node of `scene`, ours or the user's."""
    return node.bl_idname == "CompositorNodeRLayers" and node.scene == scene


def image_nodes(tree, scene):
    """The Render Layers nodes that bring the plain picture of `scene` into the tree or its groups."""
    return [node for node in all_nodes(tree) if shows(node, scene) and "Image" in node.outputs]


def uses_light(tree, scene, helper):
    """Whether the tree or its groups use the image of `scene`, or, by nodes of the user's, its light alone."""
    return any(
        role(link.to_node) is None or shown == scene
        for node in all_nodes(tree)
        if node.bl_idname == "CompositorNodeRLayers"
        for name, shown in (("Image", scene), (PASS, helper))
        if node.scene == shown and name in node.outputs
        for link in node.outputs[name].links
    )


def adds_to_nothing(tree, helper):
    """The nodes that add the light of `helper` to nothing, since the link of the image was taken away."""
    return [
        node
        for node in tree.nodes
        if role(node) == "add"
        and linked_node(node, A) is None
        and (light := light_node_of(node))
        and light.bl_idname == "CompositorNodeRLayers"
        and light.scene == helper
    ]


def request_render(tree, scene, helper):
    """Have Blender render `helper`: it looks for scenes only among the nodes of the top level, not in groups."""
    others = [node for node in tree.nodes if shows(node, helper) and role(node) != "request"]
    for node in [node for node in tree.nodes if role(node) == "request" and others]:
        tree.nodes.remove(node)
    found = image_nodes(tree, scene)
    if found and not any(shows(node, helper) for node in tree.nodes):
        node = new_light_node(tree, helper, found[0].layer, "request")
        node.location = (-400, -400)


def used_passes(scene, layer):
    """Names of the passes of a view layer that the compositor of `scene` uses."""
    tree = scene.compositing_node_group
    used = {
        output.name
        for node in image_nodes(tree, scene)
        if node.layer == layer
        for output in node.outputs
        if output.is_linked
    }
    if any(
        node.bl_idname == "CompositorNodeCryptomatteV2" and node.source == "RENDER" and node.scene == scene
        for node in all_nodes(tree)
    ):  # which reads them without a link
        used.add("CryptoMaterial00")
    return used


def lacks_light(node):
    """Whether somebody uses the image of this Render Layers node without our light in it."""
    return any(role(link.to_node) != "add" for link in node.outputs["Image"].links)


def layers_without_image(tree, scene, helper):
    """View layers whose adding node is gone together with the links it had: nobody uses their image any more."""
    found = []
    for light in [node for node in tree.nodes if shows(node, helper) and role(node) == "light" and _is_idle(node)]:
        images = [picture.outputs["Image"] for picture in image_nodes(tree, scene) if picture.layer == light.layer]
        if images and not any(image.is_linked for image in images):
            found.append(light.layer)
    return found


def splice(tree, picture, helper):
    """Put the light of `helper` between the image of a Render Layers node and whatever uses it."""
    for add in [add for add in adds_to_nothing(tree, helper) if light_node_of(add).layer == picture.layer]:
        tree.links.new(picture.outputs["Image"], socket(add.inputs, A))
    for link in picture.outputs["Image"].links:
        if role(link.to_node) == "add" and not light_input(link.to_node).links:
            tree.links.new(_light_for(tree, picture, helper).outputs[PASS], light_input(link.to_node))
    links = [link for link in picture.outputs["Image"].links if role(link.to_node) != "add"]
    if not links:
        return
    users = [(link.to_socket, link.is_muted) for link in links]
    add = new_sum_node(tree, "add", "Afterlight")
    light = _light_for(tree, picture, helper)
    for user, is_muted in users:
        tree.links.new(socket(add.outputs, RESULT), user).is_muted = is_muted
    tree.links.new(picture.outputs["Image"], socket(add.inputs, A))
    tree.links.new(light.outputs[PASS], socket(add.inputs, B))
    add.parent = light.parent = picture.parent
    x, y = picture.location
    add.location = (x + picture.width + 20, y + 60)
    light.location = (x, y - 330)


def unsplice(tree, scene, helpers):
    """Take out what splice() put in for `scene`, and give its users the plain image again. helpers: the scenes whose
    light it was; None among them stands for those that have been deleted."""
    lights = [node for node in tree.nodes if role(node) in {"light", "request"} and node.scene in helpers]
    for add in [node for node in tree.nodes if role(node) == "add"]:
        light, picture = linked_node(add, B), linked_node(add, A)
        if (light in lights) if light else (picture is None or shows(picture, scene)):
            plain, cut = next(
                ((link.from_socket, link.is_muted) for link in socket(add.inputs, A).links), (None, False)
            )
            users = [(link.to_socket, link.is_muted or cut) for link in socket(add.outputs, RESULT).links]
            tree.nodes.remove(add)
            for user, is_muted in users if plain else ():
                tree.links.new(plain, user).is_muted = is_muted
    for light in lights:
        tree.nodes.remove(light)


def adds_to_image_of(add, scene):
    """Whether an adding node adds to the picture of `scene`."""
    picture = linked_node(add, A)
    return picture is not None and shows(picture, scene)


def light_node_of(add):
    """The node whose light an adding node adds, before it is denoised and the glossy light comes to it."""
    return next((link.from_node for link in light_input(add).links), None)


def light_input(add):
    """The input of an adding node, or of the first node of ours before it, that takes the light as it was gathered."""
    taken = denoised_light_input(add)
    node = next((link.from_node for link in taken.links), None)
    return socket(node.inputs, "Image") if node and role(node) == "denoise" else taken


def new_light_node(tree, helper, layer, kind="light"):
    """A Render Layers node that shows the indirect light of one view layer."""
    light = new_node(tree, "CompositorNodeRLayers", kind)
    light.label = "Afterlight: Indirect Light"
    light.scene, light.layer = helper, layer
    return light


def new_view_node(tree, view):
    """A Render Layers node for which Blender renders a view. Nothing is linked to it."""
    node = new_node(tree, "CompositorNodeRLayers", "view")
    node.label = "Afterlight: View"
    node.scene = view
    node.hide = True
    return node


def move_behind(tree, late, early):
    """Make Blender render the scenes of the nodes `late` after those of `early`. It goes by the order in which nodes
    were made, so that those that are too old are made anew, with all that the user has done to them."""
    order = {node: index for index, node in enumerate(tree.nodes)}
    if not late or not early or min(map(order.get, late)) > max(map(order.get, early)):
        return
    for old in late:
        _remake(tree, old)


def _remake(tree, old):
    new = new_node(tree, old.bl_idname, role(old) or "")
    del new[MARK]
    for name in old.keys():
        new[name] = old[name]
    new.scene, new.layer = old.scene, old.layer
    for name in ("parent", "location", "width", "label", "hide", "mute", "use_custom_color", "color", "select"):
        setattr(new, name, getattr(old, name))
    for output in old.outputs:
        for link in output.links:
            target = new.outputs.get(output.name)
            if target is not None:
                is_muted = link.is_muted
                tree.links.new(target, link.to_socket).is_muted = is_muted
    name, was_active = old.name, tree.nodes.active == old
    tree.nodes.remove(old)
    new.name = name
    if was_active:
        tree.nodes.active = new


def new_image_node(tree, scene):
    """A Render Layers node that shows `scene`: the first view layer that is rendered."""
    picture = tree.nodes.new("CompositorNodeRLayers")
    picture.scene = scene
    picture.layer = next((layer for layer in scene.view_layers if layer.use), scene.view_layers[0]).name
    return picture


def retarget(tree, scene, old, helper):
    """Make our light nodes show `helper` instead of `old`, and the view layer that the picture beside them shows."""
    for node in tree.nodes:
        if (
            node.get(MARK) in {"light", "request"}
            and node.bl_idname == "CompositorNodeRLayers"
            and (node.scene in (old, None) and node.scene not in (scene, helper))
        ):
            layer = node.layer
            node.scene = helper
            if layer in helper.view_layers:
                node.layer = layer
    for add in [node for node in tree.nodes if role(node) == "add"]:
        light, picture = light_node_of(add), linked_node(add, A)
        if light and picture and role(light) == "light" and light.scene == helper and shows(picture, scene):
            if light.layer != picture.layer:
                light.layer = picture.layer


def linked_node(node, identifier):
    """The node that an input is linked to, or None."""
    return next((link.from_node for link in socket(node.inputs, identifier).links), None)


def socket(sockets, identifier):
    return next(each for each in sockets if each.identifier == identifier)


def _light_for(tree, picture, helper):
    """A light node for the layer of `picture`: one that lost its adding node, or a new one."""
    idle = (
        node
        for node in tree.nodes
        if shows(node, helper) and role(node) == "light" and node.layer == picture.layer and _is_idle(node)
    )
    return next(idle, None) or new_light_node(tree, helper, picture.layer)


def _is_idle(light):
    """Whether nothing uses the light of one of our Render Layers nodes, or only nodes of ours that nothing uses."""
    output = light.outputs.get(PASS)  # which is missing where Blender has no such engine
    return output is None or not any(_is_used(link.to_node) for link in output.links)


def _is_used(node):
    """Whether a node that takes light is not one of ours that leads nowhere."""
    return role(node) not in {"gloss", "denoise"} or any(
        _is_used(link.to_node) for output in node.outputs for link in output.links
    )


def denoised_light_input(add):
    """The input by which the light comes to an adding node, or to the node that adds the glossy light before it."""
    node = linked_node(add, B)
    return socket(node.inputs, A) if node and role(node) == "gloss" else socket(add.inputs, B)


def new_sum_node(tree, kind, name):
    """A node of ours that adds B to A."""
    node = new_node(tree, "ShaderNodeMix", kind)
    node.name = node.label = name
    node.data_type, node.blend_type, node.clamp_result = "RGBA", "ADD", False
    socket(node.inputs, "Factor_Float").default_value = 1.0
    socket(node.inputs, B).default_value = (0.0, 0.0, 0.0, 1.0)
    return node


def new_node(tree, idname, kind):
    active, selected = tree.nodes.active, [node for node in tree.nodes if node.select]
    node = tree.nodes.new(idname)
    node[MARK] = kind
    node.select = False
    tree.nodes.active = active
    for other in selected:
        other.select = True
    return node
