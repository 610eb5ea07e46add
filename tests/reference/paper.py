# SPDX-License-Identifier: GPL-3.0-or-later
"""The method Paper in float64 numpy, function by function as in shaders/, and the all-pairs sum that it estimates.

Images are (H, W, ...) with the bottom row first, in view space, metres. A Level is what the pyramid holds.
"""

from dataclasses import dataclass

import numpy as np

COSINE_FLOOR = 0.05
FARTHEST = 1e9
NORMAL_POWER = 8
FLATNESS_SHARPNESS = 16.0
MIN_WEIGHT = 1e-3
DIRECTION_STEPS = np.array([1023, 1023, 511])
RADIANCE_STEPS = np.array([1024, 1024, 512])
MIN_AREA = 2.0**-26


@dataclass
class Level:
    radiance: np.ndarray  # (H, W, 3), mean over the area
    position: np.ndarray  # (H, W, 3), mean
    area: np.ndarray  # (H, W), sum of A
    vector_area: np.ndarray  # (H, W, 3), sum of A n


def dot(a, b):
    return np.einsum("...c,...c->...", a, b)


def direction(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-30)


def bottom_first(triple):
    return np.stack(triple, -1)[::-1].astype(np.float64)


def pixel_centres(height, width):
    return np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5), -1)


def view_position(camera, pixel, depth):
    ray = np.asarray(camera.offset) + np.asarray(camera.scale) * pixel
    if not camera.orthographic:
        ray = ray * depth[..., None]
    return np.concatenate([ray, -depth[..., None]], -1)


def texel_area(camera, pixel, depth, normal):
    """Surface area that a pixel shows. Perspective: z^3 du dv / |n.p|."""
    footprint = abs(camera.scale[0] * camera.scale[1])
    if camera.orthographic:
        return footprint / np.maximum(np.abs(normal[..., 2]), COSINE_FLOOR)
    position = view_position(camera, pixel, depth)
    cosine = np.maximum(np.abs(dot(normal, position)), COSINE_FLOOR * np.linalg.norm(position, axis=-1))
    return depth**3 * footprint / np.maximum(cosine, 1e-30)


def radiance(passes):
    """L = Diffuse Direct * Diffuse Color + Emission."""
    return bottom_first(passes.diffuse_direct) * bottom_first(passes.diffuse_color) + bottom_first(passes.emission)


def form_factor(receiver, normal, position, area, vector_area):
    """(n.w)+ (-V.w)+ / (pi r^2 + A); arrays that broadcast."""
    path = position - receiver
    square = dot(path, path)
    cosines = np.maximum(dot(normal, path), 0) * np.maximum(-dot(vector_area, path), 0)
    return np.where(cosines > 0, cosines, 0) / np.maximum(square * (np.pi * square + area), 1e-300)


def pack(passes, camera, start):
    """(guide, base): guide (H, W, 4) is the view normal and depth. Every pixel's normal must be there (not 0)."""
    depth = passes.depth[::-1].astype(np.float64)
    height, width = depth.shape
    sound = np.logical_and.reduce([np.isfinite(a[::-1]) for arrays in passes.channels().values() for a in arrays])
    sound &= (depth > 0) & (depth < FARTHEST)
    with np.errstate(invalid="ignore", over="ignore"):
        light = np.where(sound[..., None], radiance(passes), 0)
        normal = np.where(sound[..., None], direction(bottom_first(passes.normal) @ np.asarray(camera.rotation).T), 0)
    depth = np.where(sound, depth, 0)
    centres = pixel_centres(height, width)
    area = np.where(sound, texel_area(camera, centres, depth, normal), 0)
    position = view_position(camera, centres, depth)
    return np.concatenate([normal, depth[..., None]], -1), _sum_blocks(
        Level(light, position, area, area[..., None] * normal), start
    )


def footprint(camera, depth, step):
    """Area on a plane across the view, m^2, of a texel of step x step pixels at a depth."""
    area = step * step * abs(camera.scale[0] * camera.scale[1])
    return area * np.ones_like(depth) if camera.orthographic else area * depth**2


def pack_surfel(level, camera, step):
    """(H, W, 4) uint32: the bits of a Level's surfels; step: pixels along the side of a texel."""
    height, width = level.area.shape
    surface = level.area > 0
    depth = np.where(surface, -level.position[..., 2], 1)
    ray = level.position[..., :2] / (1 if camera.orthographic else depth[..., None])
    corner = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1)
    within = (ray - camera.offset) / (np.asarray(camera.scale) * step) - corner
    offset = np.clip(np.round(within * 128), 0, 127).astype(np.uint32)
    area = np.clip(level.area / footprint(camera, depth, step), MIN_AREA, 64)
    area = np.minimum((_bits(area) - _bits(MIN_AREA) + 0x200) >> 10, 0x3FFFF)
    largest = np.abs(level.radiance).max(-1)
    exponent = np.minimum((_bits(largest) >> 23) + 1, 254)
    mantissa = level.radiance / 2.0 ** (exponent.astype(float)[..., None] - 127) * (exponent > 1)[..., None]
    bits = np.stack(
        [
            ((_bits(depth) + 0x100) >> 9) << 10 | exponent,
            area << 14 | offset[..., 1] << 7 | offset[..., 0],
            _pack_signed(level.vector_area / np.maximum(level.area, 1e-300)[..., None], DIRECTION_STEPS),
            _pack_signed(mantissa, RADIANCE_STEPS),
        ],
        -1,
    )
    return np.where(surface[..., None], bits, 0).astype(np.uint32)


def unpack_surfel(bits, camera, step):
    """The Level that (H, W, 4) uint32 stand for."""
    height, width = bits.shape[:2]
    x, y, z, w = (bits[..., k].astype(np.uint32) for k in range(4))
    depth = ((x >> 10) << 9).view(np.float32).astype(np.float64)
    within = np.stack([y & 0x7F, (y >> 7) & 0x7F], -1) / 128
    corner = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1)
    ray = np.asarray(camera.offset) + np.asarray(camera.scale) * step * (corner + within)
    position = np.concatenate([ray if camera.orthographic else ray * depth[..., None], -depth[..., None]], -1)
    area = (((y >> 14) << 10) + _bits(MIN_AREA)).astype(np.uint32).view(np.float32).astype(np.float64)
    area = np.where(depth > 0, area * footprint(camera, depth, step), 0)
    scale = ((x & 0xFF) << 23).astype(np.uint32).view(np.float32).astype(np.float64)
    return Level(
        scale[..., None] * _unpack_signed(w, RADIANCE_STEPS),
        position * (depth > 0)[..., None],
        area,
        area[..., None] * _unpack_signed(z, DIRECTION_STEPS),
    )


def _bits(values):
    return np.asarray(values, np.float32).view(np.uint32).astype(np.int64)


def _pack_signed(vectors, steps):
    whole = (np.minimum(np.round(vectors * steps), DIRECTION_STEPS) + steps).astype(np.int64)
    return whole[..., 0] | whole[..., 1] << 11 | whole[..., 2] << 22


def _unpack_signed(bits, steps):
    return np.stack([bits & 0x7FF, (bits >> 11) & 0x7FF, bits >> 22], -1) / steps - 1


def merge(level, side=2):
    """The level that sums side x side texels of this one."""
    return _sum_blocks(level, side)


def _sum_blocks(level, side):
    """Sums of A, A L, A p and A n over side x side blocks, stored as means where they are means."""

    def blocks(image):
        height, width = image.shape[:2]
        image = np.pad(image, [(0, -height % side), (0, -width % side)] + [(0, 0)] * (image.ndim - 2))
        shape = (image.shape[0] // side, side, image.shape[1] // side, side, *image.shape[2:])
        return image.reshape(shape).sum((1, 3))

    area = blocks(level.area)
    share = np.where(area > 0, 1 / np.maximum(area, 1e-300), 0)[..., None]
    weight = level.area[..., None]
    return Level(
        blocks(weight * level.radiance) * share,
        blocks(weight * level.position) * share,
        area,
        blocks(level.vector_area),
    )


def pyramid(base, radius):
    levels = [base]
    while np.hypot(*levels[-1].area.shape) > radius:
        levels.append(merge(levels[-1]))
    return levels


def hole(radius):
    """Squared radius of a ring's hole: four times its texels come nearest to the texels of the disk."""

    def texels(largest):
        return sum(x * x + y * y <= largest for x in range(-radius, radius + 1) for y in range(-radius, radius + 1))

    return min(range(radius * radius), key=lambda square: abs(4 * texels(square) - texels(radius * radius - 1)))


def gather(level, finest, radius):
    """(H, W, 4): irradiance and the sum of form factors over the whole disk or ring."""
    height, width = level.area.shape
    inner = 0 if finest else hole(radius)
    normal = direction(level.vector_area)
    result = np.zeros((height, width, 4))
    for dy in range(1 - radius, radius):
        for dx in range(1 - radius, radius):
            square = dx * dx + dy * dy
            if square >= radius * radius or square <= inner:
                continue
            here = (slice(max(0, -dy), min(height, height - dy)), slice(max(0, -dx), min(width, width - dx)))
            there = (slice(max(0, dy), min(height, height + dy)), slice(max(0, dx), min(width, width + dx)))
            if here[0].start >= here[0].stop or here[1].start >= here[1].stop:
                continue
            form = form_factor(
                level.position[here], normal[here], level.position[there], level.area[there], level.vector_area[there]
            ) * (level.area[here] > 0)
            result[here] += form[..., None] * _emitted(level)[there]
    return result


def _emitted(level):
    """pi L, and 1 for the sum of form factors."""
    return np.concatenate([np.pi * level.radiance, np.ones_like(level.radiance[..., :1])], -1)


def all_pairs(level, chunk=256):
    """(H, W, 4): irradiance and form factors that every texel receives from every other one. O(texels^2)."""
    shape = level.area.shape
    position, area = level.position.reshape(-1, 3), level.area.ravel()
    vector_area, emitted = level.vector_area.reshape(-1, 3), _emitted(level).reshape(-1, 4)
    normal = direction(vector_area)
    there = np.flatnonzero(area > 0)
    result = np.zeros((area.size, 4))
    y, v = position[there], vector_area[there]
    for first in range(0, there.size, chunk):
        here = there[first : first + chunk]
        x, n = position[here], normal[here]
        square = np.maximum(dot(x, x)[:, None] + dot(y, y) - 2 * x @ y.T, 1e-30)
        cosines = np.maximum(n @ y.T - dot(n, x)[:, None], 0) * np.maximum(x @ v.T - dot(y, v), 0)
        form = cosines / square / (np.pi * square + area[there])
        form[np.arange(here.size), np.arange(first, first + here.size)] = 0
        result[here] = form @ emitted[there]
    return result.reshape(*shape, 4)


def bilateral(coarse, total, position, receiver, normal):
    """What receivers at `position` (in coarse texels) take from the four texels around each."""
    height, width = coarse.area.shape
    coarse_normal = direction(coarse.vector_area)
    corner = np.floor(position - 0.5)
    blend = position - 0.5 - corner
    result, weights = np.zeros((*position.shape[:-1], 4)), np.zeros(position.shape[:-1])
    for sx, sy in ((0, 0), (1, 0), (0, 1), (1, 1)):
        i, j = (corner[..., 0] + sx).astype(int), (corner[..., 1] + sy).astype(int)
        inside = (i >= 0) & (j >= 0) & (i < width) & (j < height)
        i, j = np.clip(i, 0, width - 1), np.clip(j, 0, height - 1)
        area = coarse.area[j, i]
        linear = (blend[..., 0] if sx else 1 - blend[..., 0]) * (blend[..., 1] if sy else 1 - blend[..., 1])
        distance = dot(normal, coarse.position[j, i] - receiver)
        flatness = 1 / (1 + FLATNESS_SHARPNESS * distance**2 / np.maximum(area, 1e-300))
        likeness = np.maximum(dot(normal, coarse_normal[j, i]), 0) ** NORMAL_POWER
        weight = np.where(inside & (area > 0), linear * (flatness * likeness + MIN_WEIGHT), 0)
        result += weight[..., None] * total[j, i]
        weights += weight
    return result / np.maximum(weights, 1e-300)[..., None]


def upsample(levels, own):
    """(H, W, 4) at the base: what each level gathered, coarser ones interpolated along the base's surface."""
    base = levels[0]
    total = own[0].copy()
    for index in range(1, len(levels)):
        position = pixel_centres(*base.area.shape) / 2**index
        upsampled = bilateral(levels[index], own[index], position, base.position, direction(base.vector_area))
        total += np.where(base.area[..., None] > 0, upsampled, 0)
    return total


def hierarchical_sum(levels, radius):
    """(H, W, 4) at the base: every level's exhaustive gather, upsampled and summed."""
    return upsample(levels, [gather(level, index == 0, radius) for index, level in enumerate(levels)])


def composite(passes, guide, base, total, camera, start, strength):
    """(H, W, 3): strength * albedo / pi * E / max(1, F)."""
    centres = pixel_centres(*guide.shape[:2])
    received = bilateral(base, total, centres / start, view_position(camera, centres, guide[..., 3]), guide[..., :3])
    irradiance = received[..., :3] / np.maximum(received[..., 3:], 1)
    with np.errstate(invalid="ignore"):
        indirect = strength * bottom_first(passes.diffuse_color) * irradiance / np.pi
    return np.where(guide[..., 3:] > 0, indirect, 0)
