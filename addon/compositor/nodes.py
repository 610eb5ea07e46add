# SPDX-License-Identifier: GPL-3.0-or-later
"""Our nodes in a compositor tree, which go between a Render Layers node's image and whatever used it:

    Render Layers (scene, layer).Image ------------- A
                                                     add: A + B -> whatever used the image
    light: Render Layers (helper, layer).Indirect -- B

optional_nodes.py may put further nodes between the light and B.

Each of our nodes has the custom property MARK with its role, and the node type of that role. Everything is read off the
nodes themselves, so nothing that the user moves, renames or deletes is restored from a stale record.
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
    trees_found, pending = [], [tree]
    while pending:
        tree = pending.pop()
        if tree is not None and tree not in trees_found:
            trees_found.append(tree)
            pending += [node.node_tree for node in tree.nodes if node.bl_idname == "CompositorNodeGroup"]
    return trees_found


def all_nodes(tree):
    """Every node of the tree and of the node groups in it."""
    return [node for group in trees(tree) for node in group.nodes]


def role(node):
    """The role of one of our nodes, a key of NODE_TYPES; None for the user's nodes, including those with a mark that
    doesn't fit their type. "plain" is an ordinary node in a tree that we made."""
    role_name = node.get(MARK)
    if not isinstance(role_name, str) or node.bl_idname not in NODE_TYPES.get(role_name, ()):
        return None
    if role_name in {"light", "request", "view"} and node.scene is not None and not is_helper(node.scene):
        return None
    return role_name


def shows(node, scene):
    """Whether the node is a Render Layers node of `scene`, ours or the user's."""
    return node.bl_idname == "CompositorNodeRLayers" and node.scene == scene


def image_nodes(tree, scene):
    """The Render Layers nodes that bring the image of `scene` into the tree or its groups."""
    return [node for node in all_nodes(tree) if shows(node, scene) and "Image" in node.outputs]


def uses_light(tree, scene, helper):
    """Whether the tree or its groups use the image of `scene`, or nodes of the user's use its indirect light
    directly."""
    return any(
        role(link.to_node) is None or shown == scene
        for node in all_nodes(tree)
        if node.bl_idname == "CompositorNodeRLayers"
        for name, shown in (("Image", scene), (PASS, helper))
        if node.scene == shown and name in node.outputs
        for link in node.outputs[name].links
    )


def adds_to_nothing(tree, helper):
    """The nodes that add the light of `helper` to no image, because the link of the image was removed."""
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
    """Make Blender render `helper`: it only renders scenes of nodes at the top level, not in groups."""
    others = [node for node in tree.nodes if shows(node, helper) and role(node) != "request"]
    for node in [node for node in tree.nodes if role(node) == "request" and others]:
        tree.nodes.remove(node)
    images = image_nodes(tree, scene)
    if images and not any(shows(node, helper) for node in tree.nodes):
        node = new_light_node(tree, helper, images[0].layer, "request")
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
    if any(  # the Cryptomatte node reads its passes without a link
        node.bl_idname == "CompositorNodeCryptomatteV2" and node.source == "RENDER" and node.scene == scene
        for node in all_nodes(tree)
    ):
        used.add("CryptoMaterial00")
    return used


def lacks_light(node):
    """Whether the image of this Render Layers node is used anywhere without our light."""
    return any(role(link.to_node) != "add" for link in node.outputs["Image"].links)


def layers_without_image(tree, scene, helper):
    """View layers whose adding node was deleted along with its links, so that nothing uses their image any more."""
    layers = []
    for light in [node for node in tree.nodes if shows(node, helper) and role(node) == "light" and _is_idle(node)]:
        images = [picture.outputs["Image"] for picture in image_nodes(tree, scene) if picture.layer == light.layer]
        if images and not any(image.is_linked for image in images):
            layers.append(light.layer)
    return layers


def splice(tree, picture, helper):
    """Insert the nodes that add the light of `helper` between the image of a Render Layers node and whatever uses
    it."""
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
    """Remove what splice() inserted for `scene`, and relink the plain image. helpers: the scenes whose light was added;
    None among them stands for deleted scenes."""
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
    """Whether an adding node adds light to the image of `scene`."""
    picture = linked_node(add, A)
    return picture is not None and shows(picture, scene)


def light_node_of(add):
    """The node whose light an adding node adds: the start of the chain, before denoising and the glossy light."""
    return next((link.from_node for link in light_input(add).links), None)


def light_input(add):
    """The input that takes the light as gathered: of the Denoise node if there is one, else denoised_light_input()."""
    target = denoised_light_input(add)
    before = next((link.from_node for link in target.links), None)
    return socket(before.inputs, "Image") if before and role(before) == "denoise" else target


def new_light_node(tree, helper, layer, role_name="light"):
    """Add a Render Layers node that shows the indirect light of one view layer."""
    light = new_node(tree, "CompositorNodeRLayers", role_name)
    light.label = "Afterlight: Indirect Light"
    light.scene, light.layer = helper, layer
    return light


def new_view_node(tree, view):
    """Add a Render Layers node that makes Blender render a view. It has no links."""
    node = new_node(tree, "CompositorNodeRLayers", "view")
    node.label = "Afterlight: View"
    node.scene = view
    node.hide = True
    return node


def new_image_node(tree, scene):
    """Add a Render Layers node that shows `scene`: its first view layer that is rendered."""
    picture = tree.nodes.new("CompositorNodeRLayers")
    picture.scene = scene
    picture.layer = next((layer for layer in scene.view_layers if layer.use), scene.view_layers[0]).name
    return picture


def retarget(tree, scene, previous_helper, helper):
    """Make our light nodes show `helper` instead of `previous_helper`, and the same view layer as the image beside
    them."""
    for node in tree.nodes:
        if (
            node.get(MARK) in {"light", "request"}
            and node.bl_idname == "CompositorNodeRLayers"
            and (node.scene in (previous_helper, None) and node.scene not in (scene, helper))
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
    """A light node for the view layer of `picture`: one that lost its adding node, or a new one."""
    idle = (
        node
        for node in tree.nodes
        if shows(node, helper) and role(node) == "light" and node.layer == picture.layer and _is_idle(node)
    )
    return next(idle, None) or new_light_node(tree, helper, picture.layer)


def _is_idle(light):
    """Whether the light of one of our Render Layers nodes is unused, or used only by our own nodes that lead
    nowhere."""
    output = light.outputs.get(PASS)  # missing where the extension, and so the engine, is missing
    return output is None or not any(_is_used(link.to_node) for link in output.links)


def _is_used(node):
    """Whether a node that takes light is the user's, or leads on to something that is used."""
    return role(node) not in {"gloss", "denoise"} or any(
        _is_used(link.to_node) for output in node.outputs for link in output.links
    )


def denoised_light_input(add):
    """The input that takes the light after denoising: of the node that adds the glossy light if there is one, else B of
    `add`."""
    before = linked_node(add, B)
    return socket(before.inputs, A) if before and role(before) == "gloss" else socket(add.inputs, B)


def new_sum_node(tree, role_name, name):
    """Add a node of ours that computes A + B."""
    node = new_node(tree, "ShaderNodeMix", role_name)
    node.name = node.label = name
    node.data_type, node.blend_type, node.clamp_result = "RGBA", "ADD", False
    socket(node.inputs, "Factor_Float").default_value = 1.0
    socket(node.inputs, B).default_value = (0.0, 0.0, 0.0, 1.0)
    return node


def new_node(tree, idname, role_name):
    """Add a node with a role. The active and selected nodes stay as they are."""
    active, selected = tree.nodes.active, [node for node in tree.nodes if node.select]
    node = tree.nodes.new(idname)
    node[MARK] = role_name
    node.select = False
    tree.nodes.active = active
    for other in selected:
        other.select = True
    return node
