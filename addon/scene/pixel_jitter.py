# SPDX-License-Identifier: GPL-3.0-or-later
"""Where in its pixels EEVEE's Depth and Normal lie.

EEVEE takes one sample a pixel at a time, all at the same place in their pixels. Colours and light are averaged, depth
and normal are those of one sample: meant is the one nearest to the middle, but two textures take turns in remembering
how near that was, and the one that is read has not heard of the sample before. So it may be a quarter of a pixel off,
which is a percent of the depth on a floor seen from far. The numbers are EEVEE's own (docs/blender/rendering.md has
how they were checked).
"""

import math

import bpy

MIN_FILTER = 0.01  # pixels: a smaller filter is none
MAX_DISK_FILTER = math.sqrt(0.5)  # below this radius EEVEE's samples fill a disk, above it the pixel
DISK_RADIUS = 0.5  # its radius, as a share of the filter's
MIN_SPARSE_FILTER = 2.2  # above this radius EEVEE draws the pixels around at random, and which is kept isn't known


def depth_sample_offset(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> tuple[float, float]:
    """(x, y), pixels to the right and up: where the depth of a pixel was sampled, from the pixel's middle. layer: the
    view layer that is rendered."""
    count, radius = layer.samples or scene.eevee.taa_render_samples, scene.render.filter_size
    if scene.render.use_motion_blur:
        count = math.ceil(count / scene.eevee.motion_blur_steps) * scene.eevee.motion_blur_steps
    if count <= 1 or not MIN_FILTER <= radius < MIN_SPARSE_FILTER:
        return 0.0, 0.0
    remembered, kept = [math.inf, math.inf], (0.0, 0.0)
    for number in range(count):
        jitter = _jitter(number, radius)
        distance = math.hypot(*jitter)
        if distance < remembered[number % 2]:
            kept, remembered[(number + 1) % 2] = jitter, distance
    return -kept[0], -kept[1]


def _jitter(number, radius):
    """How far EEVEE shifts its pictures for a sample, pixels."""
    across = (radical_inverse(number + 1, 2) + 1 / 2) % 1
    up = (radical_inverse(number + 1, 3) + 2 / 3) % 1
    if radius >= MAX_DISK_FILTER:
        return across - 0.5, up - 0.5
    length, angle = math.sqrt(across) * DISK_RADIUS * radius, 2 * math.pi * up
    return length * math.cos(angle), length * math.sin(angle)


def radical_inverse(number: int, base: int) -> float:
    """The digits of a number mirrored at the point (Halton 1960), in [0, 1)."""
    found, share = 0.0, 1.0
    while number:
        share /= base
        number, digit = divmod(number, base)
        found += digit * share
    return found
