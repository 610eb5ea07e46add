# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's images at a lower resolution. EEVEE has them on the GPU; to read all of their pixels would take 16 bytes
each."""

from collections.abc import Sequence
from typing import Any

import gpu
import numpy as np

from . import device


@device.on_gpu
def means(
    image: Any, width: int, height: int, color: Sequence[float] = (1, 1, 1), limit: float = 0.0
) -> np.ndarray | None:
    """(rows, columns, 4) float64, the lowest row first: means of an image's pixels, scene linear as EEVEE has them,
    over a grid of width x height, or of the image's own size where it is smaller. None where it has no colours, or
    where a mean is not finite.

    color: (3,), factor on the pixels. limit: pixels whose brightest channel exceeds it then are scaled down to it; 0:
    none. Raises device.GpuUnavailable."""
    if not all(image.size) or image.channels < 3:
        return None
    try:
        picture = device.Texture(gpu.texture.from_image(image))
    except (RuntimeError, ValueError):  # Blender can't load it, or the GPU has no room for it
        return None
    if (picture.width, picture.height) == (1, 1) != tuple(image.size):  # Blender's substitute for one that is missing
        return None
    width, height = min(width, picture.width), min(height, picture.height)
    shrunk = device.texture(width, height)
    device.dispatch(
        "shrink",
        {"picture": picture, "shrunk_out": shrunk},
        device.groups(width, height),
        size=(width, height),
        color=color,
        limit=limit,
    )
    grid = device.read(shrunk).astype(float)
    return grid if np.isfinite(grid).all() else None
