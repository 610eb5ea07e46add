# SPDX-License-Identifier: GPL-3.0-or-later
"""Where within its pixels EEVEE samples Depth and Normal.

EEVEE takes one sample of all pixels at a time, each time at the same offset in every pixel. It averages colours and
light, but keeps depth and normal of a single sample. That is meant to be the one nearest to the pixel's middle; but two
textures alternate in remembering how near the best one was, so the one that is read misses every other sample. The
result may be a quarter of a pixel off, which is a percent of the depth on a floor seen from far. The numbers are
EEVEE's own (docs/blender/rendering.md tells how they were checked).
"""

import math

import bpy

MIN_FILTER = 0.01  # pixels: a smaller filter is no filter
MAX_DISK_FILTER = math.sqrt(0.5)  # below this radius EEVEE's samples fill a disk, above it the pixel
DISK_RADIUS = 0.5  # radius of that disk, as a share of the filter's
MIN_SPARSE_FILTER = 2.2  # above this radius EEVEE picks neighbouring pixels at random, so the offset is unknown


def depth_sample_offset(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> tuple[float, float]:
    """(x, y), in pixels to the right and up, from a pixel's middle to where its depth was sampled. layer: the view
    layer that is rendered."""
    count, radius = layer.samples or scene.eevee.taa_render_samples, scene.render.filter_size
    if scene.render.use_motion_blur:
        count = math.ceil(count / scene.eevee.motion_blur_steps) * scene.eevee.motion_blur_steps
    if count <= 1 or not MIN_FILTER <= radius < MIN_SPARSE_FILTER:
        return 0.0, 0.0
    nearest, chosen = [math.inf, math.inf], (0.0, 0.0)
    for number in range(count):
        jitter = _jitter(number, radius)
        distance = math.hypot(*jitter)
        if distance < nearest[number % 2]:
            chosen, nearest[(number + 1) % 2] = jitter, distance
    return -chosen[0], -chosen[1]


def _jitter(number, radius):
    """EEVEE's offset in pixels for a sample."""
    across = (radical_inverse(number + 1, 2) + 1 / 2) % 1
    up = (radical_inverse(number + 1, 3) + 2 / 3) % 1
    if radius >= MAX_DISK_FILTER:
        return across - 0.5, up - 0.5
    length, angle = math.sqrt(across) * DISK_RADIUS * radius, 2 * math.pi * up
    return length * math.cos(angle), length * math.sin(angle)


def radical_inverse(number: int, base: int) -> float:
    """The digits of a number mirrored at the radix point (Halton 1960), in [0, 1)."""
    result, share = 0.0, 1.0
    while number:
        share /= base
        number, digit = divmod(number, base)
        result += digit * share
    return result
