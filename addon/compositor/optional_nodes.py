# SPDX-License-Identifier: GPL-3.0-or-later
"""The optional nodes between our light and the nodes that add it to the image: Blender's Denoise node, and the glossy
light.

    light.Indirect -> denoise -> A
                                 gloss: A + B -> B of add
    light.Indirect Glossy -----> B

nodes.py has the rest of the chain.
"""

from .nodes import (
    GLOSSY_PASS,
    RESULT,
    A,
    B,
    adds_to_image_of,
    denoised_light_input,
    linked_node,
    new_node,
    new_sum_node,
    role,
    shows,
    socket,
)


def splice_gloss(tree, scene, helper):
    """Insert the nodes that add the glossy light of `helper` to its diffuse light, before that is added to the
    image."""
    for add in [node for node in tree.nodes if role(node) == "add" and adds_to_image_of(node, scene)]:
        light_socket = next((link.from_socket for link in socket(add.inputs, B).links), None)
        picture = linked_node(add, A)
        light = next(
            (
                node
                for node in tree.nodes
                if shows(node, helper) and role(node) == "light" and node.layer == picture.layer
            ),
            None,
        )
        if light_socket is None or light is None:
            continue
        gloss = light_socket.node
        if role(gloss) != "gloss":
            gloss = new_sum_node(tree, "gloss", "Afterlight: Glossy")
            tree.links.new(light_socket, socket(gloss.inputs, A))
            tree.links.new(socket(gloss.outputs, RESULT), socket(add.inputs, B))
            gloss.parent, gloss.hide = add.parent, True
            gloss.location = add.location[0] - 40, add.location[1] - 200
        if not linked_node(gloss, B):
            tree.links.new(light.outputs[GLOSSY_PASS], socket(gloss.inputs, B))


def unsplice_gloss(tree, helpers):
    """Remove what splice_gloss() inserted. helpers: the scenes whose light it was; None among them stands for deleted
    scenes."""
    for gloss in [node for node in tree.nodes if role(node) == "gloss"]:
        light = linked_node(gloss, B)
        if light is None or light.scene in helpers:
            light_socket = next((link.from_socket for link in socket(gloss.inputs, A).links), None)
            users = [link.to_socket for link in socket(gloss.outputs, RESULT).links]
            tree.nodes.remove(gloss)
            for user in users if light_socket else ():
                tree.links.new(light_socket, user)


def lacks_gloss(tree, scene):
    """Whether a node that adds light to the image of `scene` gets no glossy light."""
    lights = [linked_node(node, B) for node in tree.nodes if role(node) == "add" and adds_to_image_of(node, scene)]
    return any(light and (role(light) != "gloss" or not linked_node(light, B)) for light in lights)


def splice_denoise(tree, scene):
    """Insert a Denoise node behind each light that is added to the image of `scene`."""
    for add in [node for node in tree.nodes if role(node) == "add" and adds_to_image_of(node, scene)]:
        target = denoised_light_input(add)
        light_socket = next((link.from_socket for link in target.links), None)
        if light_socket is not None and role(light_socket.node) == "light":
            picture, denoise = linked_node(add, A), new_node(tree, "CompositorNodeDenoise", "denoise")
            denoise.name = denoise.label = "Afterlight: Denoise"
            for input_name, output in (
                ("Image", light_socket),
                ("Albedo", picture.outputs["Diffuse Color"]),
                ("Normal", picture.outputs["Normal"]),
            ):
                tree.links.new(output, denoise.inputs[input_name])
            tree.links.new(denoise.outputs["Image"], target)
            denoise.parent, denoise.hide = add.parent, True
            denoise.location = add.location[0] - 40, add.location[1] - 260


def unsplice_denoise(tree, helpers):
    """Remove what splice_denoise() inserted. helpers: the scenes whose light it was; None among them stands for deleted
    scenes."""
    for denoise in [node for node in tree.nodes if role(node) == "denoise"]:
        light = linked_node(denoise, "Image")
        if light is None or light.scene in helpers:
            light_socket = next((link.from_socket for link in denoise.inputs["Image"].links), None)
            users = [link.to_socket for link in denoise.outputs["Image"].links]
            tree.nodes.remove(denoise)
            for user in users if light_socket else ():
                tree.links.new(light_socket, user)


def lacks_denoise(tree, scene):
    """Whether light that went through no Denoise node is added to the image of `scene`."""
    return any(
        role(link.from_node) == "light"
        for node in tree.nodes
        if role(node) == "add" and adds_to_image_of(node, scene)
        for link in denoised_light_input(node).links
    )
