# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean over gathers in float64 numpy, function by function as in shaders/temporal. Base textures have the bottom
row first."""

import numpy as np

from .paper import FLATNESS_SHARPNESS, MIN_WEIGHT, NORMAL_POWER, direction, dot

MIN_MOTION, SAME_HEIGHT, SAME_DEPTH, SAME_COSINE, MOVED_COSINE = 0.5, 1.0, 0.1, 0.9, 0.5
DRIFT_RADIUS, DRIFT_STRIDE, DRIFT_START_SIGMA, DRIFT_END_SIGMA, RESET_SIGMA = 2, 2, 2.0, 3.0, 6.0
SHARED_NOISE, SAME_SURFACE, MIN_TAPS = 0.03, 0.5, 8
RESET_START_SHARE, RESET_END_SHARE = 0.1, 0.5


def texel_of(camera, start, position):
    """(..., 2): positions in a camera's view space, in its base texels."""
    ray = position[..., :2] / (1 if camera.orthographic else np.maximum(-position[..., 2:], 1e-4))
    return (ray - camera.offset) / (np.asarray(camera.scale) * start)


def reproject(level, camera, past, past_camera, past_light, start, motion=None):
    """(H, W, 4): the history of the surfaces of `level`, of `past_light` (H, W, 4). level, past: reference.Level of
    both bases, each in its camera's view space. motion: (H, W, 2) in texels, or None."""
    surface = level.area > 0
    origin = np.asarray(past_camera.position) - np.asarray(camera.position)
    turn = np.asarray(past_camera.rotation) @ np.asarray(camera.rotation).T
    seen = level.position @ turn.T - np.asarray(past_camera.rotation) @ origin
    normal = direction(level.vector_area) @ turn.T
    spot = texel_of(past_camera, start, seen)
    moves = np.zeros(surface.shape, bool)
    if motion is not None:
        by_motion = texel_of(camera, start, level.position) + motion
        moves = np.linalg.norm(by_motion - spot, axis=-1) > MIN_MOTION
        spot = np.where(moves[..., None], by_motion, spot)
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
        rises = np.abs(dot(normal, past.position[j, i] - seen)) < SAME_HEIGHT * side[j, i]
        nears = np.abs(past.position[j, i, 2] - seen[..., 2]) < SAME_DEPTH * -seen[..., 2]
        same = np.where(moves, (cosine > MOVED_COSINE) & nears, (cosine > SAME_COSINE) & rises)
        linear = (blend[..., 0] if sx else 1 - blend[..., 0]) * (blend[..., 1] if sy else 1 - blend[..., 1])
        weight = np.where(inside & (past.area[j, i] > 0) & same, linear, 0)
        total += weight[..., None] * past_light[j, i]
        weights += weight
    ahead = camera.orthographic | (-seen[..., 2] > 1e-4)
    history = np.where(
        (surface & ahead & (weights > 1e-3))[..., None], total / np.maximum(weights, 1e-300)[..., None], 0
    )
    history[..., 3] = np.where(surface, history[..., 3], -1)
    return history


def changes(level, history, now, same_surface):
    """(count, change, squares, now, past): sums over the taps around each texel, (H, W) and (H, W, 3) each."""
    height, width = level.area.shape
    normal, surface = direction(level.vector_area), history[..., 3] > 0
    change = now - history[..., :3]
    sums, count = np.zeros((4, height, width, 3)), np.zeros((height, width))
    for dx, dy in (
        (DRIFT_STRIDE * x, DRIFT_STRIDE * y)
        for y in range(-DRIFT_RADIUS, DRIFT_RADIUS + 1)
        for x in range(-DRIFT_RADIUS, DRIFT_RADIUS + 1)
    ):
        here = slice(max(0, -dy), max(0, height - max(0, dy))), slice(max(0, -dx), max(0, width - max(0, dx)))
        there = slice(max(0, dy), max(0, height + min(0, dy))), slice(max(0, dx), max(0, width + min(0, dx)))
        rise = dot(normal[here], level.position[there] - level.position[here])
        flatness = 1 / (1 + FLATNESS_SHARPNESS * rise**2 / np.where(surface[there], level.area[there], 1))
        likeness = np.maximum(dot(normal[here], normal[there]), 0) ** NORMAL_POWER
        taken = surface[there] & (flatness * likeness + MIN_WEIGHT > SAME_SURFACE if same_surface else True)
        for total, values in zip(sums, (change, change**2, now, history[..., :3])):
            total[here] += np.where(taken[..., None], values[there], 0)
        count[here] += taken
    return count, *sums


def deviations(count, change, squares, now, _past):
    few = np.maximum(count, MIN_TAPS)[..., None]
    mean, square, light = change / few, squares / few, now / few
    deviation = np.sqrt(np.maximum(square - mean**2, 0) / (few - 1) + (SHARED_NOISE * light) ** 2)
    return np.where((count >= MIN_TAPS)[..., None], np.abs(mean) / np.maximum(deviation, 1e-37), 0)


def drift(level, history, now):
    """(H, W, 3): the change of the light on the surface around each texel that is more than noise. now: (H, W, 3)."""
    here = changes(level, history, now, same_surface=True)
    return (
        here[1]
        / np.maximum(here[0], 1)[..., None]
        * np.clip((deviations(*here) - DRIFT_START_SIGMA) / (DRIFT_END_SIGMA - DRIFT_START_SIGMA), 0, 1)
    )


def kept(level, history, now):
    """(H, W): factor on the history's weight, where the light around has changed."""
    around = changes(level, history, now, same_surface=False)
    _, change, _, light, past = around
    share = np.abs(change) / np.maximum(np.maximum(np.abs(light), np.abs(past)), 1e-37)
    sure = np.clip((deviations(*around) - DRIFT_END_SIGMA) / (RESET_SIGMA - DRIFT_END_SIGMA), 0, 1)
    return 1 - (sure * np.clip((share - RESET_START_SHARE) / (RESET_END_SHARE - RESET_START_SHARE), 0, 1)).max(-1)


def accumulate(level, history, now, gathers, earlier_gathers, allows_drift):
    """(H, W, 4): the mean of both, and the number of gathers that it is of. now: (H, W, 3)."""
    weight = (
        np.clip(history[..., 3], 0, earlier_gathers)
        if allows_drift
        else np.full(history.shape[:2], float(earlier_gathers))
    )
    past = history[..., :3]
    if allows_drift:
        past = past + drift(level, history, now) * (weight > 0)[..., None]
        weight = weight * kept(level, history, now)
    weight = weight[..., None]
    count = np.where(history[..., 3:] < 0, -1, weight + gathers)
    return np.concatenate([(past * weight + now * gathers) / (weight + gathers), count], -1)
