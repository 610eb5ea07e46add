# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean over gathers in float64 numpy, function by function as in shaders/. Base textures have the bottom row
first."""

import numpy as np

from .paper import FLATNESS_SHARPNESS, LEAST_WEIGHT, NORMAL_POWER, direction, dot

MOVES, SAME_HEIGHT, SAME_DEPTH, SAME_COSINE, MOVED_COSINE = 0.5, 1.0, 0.1, 0.9, 0.5
AROUND, STRIDE, MAYBE, SURELY, NEVER, COMMON, SAME_SURFACE, FEWEST = 2, 2, 2.0, 3.0, 6.0, 0.03, 0.5, 8
LITTLE, MUCH = 0.1, 0.5


def texel_of(camera, start, place):
    """(..., 2): where a camera's base texels have places in its view space."""
    ray = place[..., :2] / (1 if camera.orthographic else np.maximum(-place[..., 2:], 1e-4))
    return (ray - camera.offset) / (np.asarray(camera.scale) * start)


def reproject(level, camera, past, past_camera, past_light, start, motion=None):
    """(H, W, 4): what `past_light` (H, W, 4) knows of the surfaces of `level`. level, past: reference.Level of both
    bases, each in its camera's view space. motion: (H, W, 2) in texels, or None."""
    surface = level.area > 0
    origin = np.asarray(past_camera.position) - np.asarray(camera.position)
    turn = np.asarray(past_camera.rotation) @ np.asarray(camera.rotation).T
    seen = level.place @ turn.T - np.asarray(past_camera.rotation) @ origin
    normal = direction(level.vector_area) @ turn.T
    spot = texel_of(past_camera, start, seen)
    moves = np.zeros(surface.shape, bool)
    if motion is not None:
        told = texel_of(camera, start, level.place) + motion
        moves = np.linalg.norm(told - spot, axis=-1) > MOVES
        spot = np.where(moves[..., None], told, spot)
    height, width = surface.shape
    corner = np.floor(spot - 0.5).astype(int)
    blend = spot - 0.5 - corner
    past_normal, side = direction(past.vector_area), np.sqrt(past.area)
    total, weights = np.zeros((*surface.shape, 4)), np.zeros(surface.shape)
    for sx, sy in ((0, 0), (1, 0), (0, 1), (1, 1)):
        i, j = corner[..., 0] + sx, corner[..., 1] + sy
        inside = (i >= 0) & (j >= 0) & (i < width) & (j < height)
        i, j = np.clip(i, 0, width - 1), np.clip(j, 0, height - 1)
        cosine = dot(normal, past_normal[j, i])
        rises = np.abs(dot(normal, past.place[j, i] - seen)) < SAME_HEIGHT * side[j, i]
        nears = np.abs(past.place[j, i, 2] - seen[..., 2]) < SAME_DEPTH * -seen[..., 2]
        same = np.where(moves, (cosine > MOVED_COSINE) & nears, (cosine > SAME_COSINE) & rises)
        linear = (blend[..., 0] if sx else 1 - blend[..., 0]) * (blend[..., 1] if sy else 1 - blend[..., 1])
        weight = np.where(inside & (past.area[j, i] > 0) & same, linear, 0)
        total += weight[..., None] * past_light[j, i]
        weights += weight
    ahead = camera.orthographic | (-seen[..., 2] > 1e-4)
    known = np.where((surface & ahead & (weights > 1e-3))[..., None], total / np.maximum(weights, 1e-300)[..., None], 0)
    known[..., 3] = np.where(surface, known[..., 3], -1)
    return known


def changes(level, known, now, same_surface):
    """(count, change, squares, now, past): sums over the taps around each texel, (H, W) and (H, W, 3) each."""
    height, width = level.area.shape
    normal, surface = direction(level.vector_area), known[..., 3] > 0
    change = now - known[..., :3]
    sums, count = np.zeros((4, height, width, 3)), np.zeros((height, width))
    for dx, dy in ((STRIDE * x, STRIDE * y) for y in range(-AROUND, AROUND + 1) for x in range(-AROUND, AROUND + 1)):
        here = slice(max(0, -dy), max(0, height - max(0, dy))), slice(max(0, -dx), max(0, width - max(0, dx)))
        there = slice(max(0, dy), max(0, height + min(0, dy))), slice(max(0, dx), max(0, width + min(0, dx)))
        rise = dot(normal[here], level.place[there] - level.place[here])
        flatness = 1 / (1 + FLATNESS_SHARPNESS * rise**2 / np.where(surface[there], level.area[there], 1))
        likeness = np.maximum(dot(normal[here], normal[there]), 0) ** NORMAL_POWER
        taken = surface[there] & (flatness * likeness + LEAST_WEIGHT > SAME_SURFACE if same_surface else True)
        for total, values in zip(sums, (change, change**2, now, known[..., :3])):
            total[here] += np.where(taken[..., None], values[there], 0)
        count[here] += taken
    return count, *sums


def deviations(count, change, squares, now, _past):
    few = np.maximum(count, FEWEST)[..., None]
    mean, square, light = change / few, squares / few, now / few
    deviation = np.sqrt(np.maximum(square - mean**2, 0) / (few - 1) + (COMMON * light) ** 2)
    return np.where((count >= FEWEST)[..., None], np.abs(mean) / np.maximum(deviation, 1e-37), 0)


def drift(level, known, now):
    """(H, W, 3): what surely changed of the light on the surface around each texel since it was known. now: (H, W,
    3)."""
    here = changes(level, known, now, same_surface=True)
    return here[1] / np.maximum(here[0], 1)[..., None] * np.clip((deviations(*here) - MAYBE) / (SURELY - MAYBE), 0, 1)


def kept(level, known, now):
    """(H, W): what is known counts by this much, since the light around is another."""
    around = changes(level, known, now, same_surface=False)
    _, change, _, light, past = around
    share = np.abs(change) / np.maximum(np.maximum(np.abs(light), np.abs(past)), 1e-37)
    sure = np.clip((deviations(*around) - SURELY) / (NEVER - SURELY), 0, 1)
    return 1 - (sure * np.clip((share - LITTLE) / (MUCH - LITTLE), 0, 1)).max(-1)


def accumulate(level, known, now, gathers, earlier, may_drift):
    """(H, W, 4): the mean of both, and of how many gathers it is. now: (H, W, 3)."""
    weight = np.clip(known[..., 3], 0, earlier) if may_drift else np.full(known.shape[:2], float(earlier))
    past = known[..., :3]
    if may_drift:
        past = past + drift(level, known, now) * (weight > 0)[..., None]
        weight = weight * kept(level, known, now)
    weight = weight[..., None]
    count = np.where(known[..., 3:] < 0, -1, weight + gathers)
    return np.concatenate([(past * weight + now * gathers) / (weight + gathers), count], -1)
