# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's images, read as small as they are needed. EEVEE has them on the GPU; their pixels as numbers would take 16
bytes each."""

import gpu
import numpy as np

from . import device


@device.on_gpu
def means(image, width, height, color=(1, 1, 1), limit=0.0):
    """(rows, columns, 4) float64, the lowest row first: means of an image's pixels, scene linear as EEVEE has them,
    over a grid of width x height, or of the image's own size where it is smaller. None where it has no colours, or
    some that are no numbers.

    color: (3,), which they are multiplied by first. limit: what is brighter then, in any channel, counts as that; 0
    for none. Raises device.GpuUnavailable."""
    if not all(image.size) or image.channels < 3:
        return None
    try:
        picture = device.Texture(gpu.texture.from_image(image))
    except (RuntimeError, ValueError):  # Blender can't load it, or the GPU has no room for it
        return None
    if (picture.width, picture.height) == (1, 1) != tuple(image.size):  # in the place of one that can't be had
        return None
    width, height = min(width, picture.width), min(height, picture.height)
    shrunk = device.texture(width, height)
    block = device.parameters(frame=(width, height), output_scale=(*color, limit))
    device.dispatch("shrink", block, {"picture": picture, "shrunk_out": shrunk}, device.groups(width, height))
    found = device.read(shrunk).astype(float)
    return found if np.isfinite(found).all() else None
