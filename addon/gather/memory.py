# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame takes on the GPU, from its size and settings alone."""

from . import radiosity
from .pyramid import TABLE_WIDTH, level_boxes, offsets
from .types import Draws, Settings

TEXEL = 16  # bytes of RGBA32F and RGBA32UI
PASSES, LIGHT = 13, 6  # channels that are uploaded, and those of them that go once the surfels are packed


def gpu_bytes(
    width: int,
    height: int,
    settings: Settings | Draws,
    further: int = 0,
    *,
    shines: bool = False,
    averages: bool = False,
) -> int:
    """Bytes of textures that gather_indirect(), or gather_views() with so many further views, has on the GPU at its
    fullest, for a frame of width x height pixels. shines, averages: with Gloss, with a History of the frame before."""
    if isinstance(settings, Draws):
        return radiosity.gpu_bytes(width, height, settings, further, shines, averages)
    channel = -(-width // 4) * height * TEXEL
    boxes = level_boxes(-(-width // settings.start), -(-height // settings.start), settings.radius)
    pyramid = max(x + w for x, _, w, _ in boxes) * max(y + h for _, y, _, h in boxes) * TEXEL
    base = boxes[0][2] * boxes[0][3] * TEXEL
    entries = len(offsets(settings.radius, finest=True)) + len(offsets(settings.radius, finest=False))
    table = -(-entries // TABLE_WIDTH) * TABLE_WIDTH * 8
    packing = PASSES * channel + pyramid
    lit = (PASSES - LIGHT) * channel + 2 * pyramid  # surfels and irradiance
    return max(packing, lit + table, lit + base + 3 * channel)


def is_exact(settings: Settings | Draws) -> bool:
    """Whether every texel visits all of its region, so that there is no noise and the seed means nothing."""
    if isinstance(settings, Draws):
        return False
    disk, ring = (len(offsets(settings.radius, finest)) for finest in (True, False))
    return not settings.samples or settings.samples >= disk and 2 * settings.samples >= ring
