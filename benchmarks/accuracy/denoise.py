# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's denoiser on a picture that is there already: OpenImageDenoise by a compositor's Denoise node.

For references that FLIP and the count of dots compare with. Of hundreds of samples it takes the noise, which those two
see in every pixel; its own error is far below that of any way that is compared. Means and squares need it not: there
the noise of two halves is taken off."""

import tempfile
from pathlib import Path

import numpy as np


def denoised(picture, albedo, normal):
    """(H, W, 3) float32: a picture, (H, W, 3), linear, its noise taken off by the guides of the same shape."""
    import bpy
    import OpenEXR

    height, width = picture.shape[:2]
    scene = bpy.data.scenes.new("Denoise")
    tree = bpy.data.node_groups.new("Denoise", "CompositorNodeTree")
    images = []
    try:
        node, output = tree.nodes.new("CompositorNodeDenoise"), tree.nodes.new("NodeGroupOutput")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        for name, pixels in (("Image", picture), ("Albedo", albedo), ("Normal", normal)):
            images.append(_image(name, pixels))
            source = tree.nodes.new("CompositorNodeImage")
            source.image = images[-1]
            tree.links.new(source.outputs["Image"], node.inputs[name])
        node.inputs["Quality"].default_value = "High"
        tree.links.new(node.outputs["Image"], output.inputs[0])
        scene.compositing_node_group = tree
        render = scene.render
        render.engine, render.compositor_device = "BLENDER_WORKBENCH", "CPU"
        render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
        file = render.image_settings
        file.media_type, file.file_format = "IMAGE", "OPEN_EXR"
        file.color_mode, file.color_depth, file.exr_codec = "RGB", "32", "NONE"
        scene.camera = None
        with tempfile.TemporaryDirectory(prefix="afterlight-denoise-") as folder:
            render.filepath = str(Path(folder) / "picture.exr")
            bpy.ops.render.render(write_still=True, scene=scene.name)
            with OpenEXR.File(render.filepath) as found:
                return np.array(found.channels()["RGB"].pixels, np.float32)
    finally:
        for image in images:
            bpy.data.images.remove(image)
        bpy.data.scenes.remove(scene)
        bpy.data.node_groups.remove(tree)


def _image(name, pixels):
    import bpy

    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    whole = np.ones((height, width, 4), np.float32)
    whole[..., :3] = pixels[::-1]  # Blender's images begin at the bottom
    image.pixels.foreach_set(whole.ravel())
    return image
