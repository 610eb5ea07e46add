# SPDX-License-Identifier: GPL-3.0-or-later
"""The method Radiosity in float64 numpy, function by function as in shaders/radiosity, and the sum over all pairs of a
receiver and an emitter that it estimates.

World space has the main camera's position as its origin. A ViewCamera holds the fields of the block `views`, and the
view's depth map, bottom row first.
"""

from dataclasses import dataclass

import numpy as np

from .paper import (
    COSINE_FLOOR,
    FARTHEST,
    FLATNESS_SHARPNESS,
    NORMAL_POWER,
    bottom_first,
    direction,
    dot,
    form_factor,
    pixel_centres,
    view_position,
)
from .paper import radiance as radiance_of

NEAREST = 1e-4
MARGIN = 0.01
FREE_TOLERANCE = 1.0005
THICKNESS = 0.03
BISECTIONS = 4
MAX_GAP_LEFT = 0.4
MAX_GAP_SLOPE = 2.0
MAX_REACH = 1.1
DEPTH_TOLERANCE = 0.02
SLOPE_TOLERANCE = 2.0
SMOOTH_STEPS = 1, 2
FIREFLY_RATIO = 4.0


@dataclass
class ViewCamera:
    rotation: np.ndarray  # (3, 3), world to view
    position: np.ndarray  # (3,)
    scale: np.ndarray  # (2,), of a texel of the depth map
    offset: np.ndarray  # (2,)
    is_orthographic: bool
    depths: np.ndarray  # (h, w, 2), the depth map: depth, and the farthest that the surface reaches within the texel


def cameras_of(views, step):
    """A ViewCamera for each view; step: pixels along the side of a depth map's texel."""
    origin = np.asarray(views[0].camera.position, float)
    return [
        ViewCamera(
            np.asarray(camera.rotation, float),
            np.asarray(camera.position, float) - origin,
            np.asarray(camera.scale) * step,
            np.asarray(camera.offset),
            camera.orthographic,
            depths(view, step),
        )
        for view in views
        for camera in [view.camera]
    ]


def depths(view, step):
    """(h, w, 2): the depth of the pixel in the middle of each step x step, and the farthest depth of its plane at
    their corners."""
    camera, depth = view.camera, view.load_passes().depth[::-1].astype(np.float64)
    normal = bottom_first(view.load_passes().normal) @ np.asarray(camera.rotation).T
    rows, columns = (np.minimum(np.arange(0, side, step) + step // 2, side - 1) for side in depth.shape)
    surface = (depth > 0) & (depth < FARTHEST)
    position = view_position(camera, pixel_centres(*depth.shape), np.where(surface, depth, 1))
    depth, normal, position = (
        image[np.ix_(rows, columns)] for image in (np.where(surface, depth, 2 * FARTHEST), normal, position)
    )
    surface, farthest = depth < FARTHEST, depth
    texel = np.stack(np.meshgrid(np.arange(len(columns)), np.arange(len(rows))), -1)
    for corner in ((0, 0), (1, 0), (0, 1), (1, 1)):
        ray = np.asarray(camera.offset) + np.asarray(camera.scale) * step * (texel + corner)
        ray = np.concatenate([ray, np.zeros(depth.shape)[..., None] - (not camera.orthographic)], -1)
        with np.errstate(divide="ignore", invalid="ignore"):
            # The corner's ray meets the plane n.(p - position) = 0 there; below 0: behind the camera, or never.
            reach = (
                dot(normal, ray - position * (1, 1, 0)) / normal[..., 2] + depth
                if camera.orthographic
                else dot(normal, position) / dot(normal, ray)
            )
        known = surface & np.isfinite(reach) & normal.any(-1)
        reach = np.where(known & (reach > 0), np.minimum(reach, MAX_REACH * depth), MAX_REACH * depth)
        farthest = np.maximum(farthest, np.where(known, reach, 0))
    return np.stack([depth, farthest], -1)


def to_view(view, position):
    return (position - view.position) @ view.rotation.T


def to_camera(view, position):
    """Towards the camera."""
    return np.broadcast_to(view.rotation[2], position.shape) if view.is_orthographic else view.position - position


def project(view, position):
    """(..., 3): x, y in texels of the depth map, planar depth."""
    seen = to_view(view, position)
    w = np.ones(seen.shape[:-1]) if view.is_orthographic else np.maximum(-seen[..., 2], NEAREST)
    return np.concatenate([(seen[..., :2] / w[..., None] - view.offset) / view.scale, -seen[..., 2:]], -1)


def shown_area(view, position, normal, depth):
    """Area that a texel of the depth map shows of a surface: z^3 du dv / |n.p| in perspective."""
    footprint = abs(view.scale[0] * view.scale[1])
    outgoing = to_camera(view, position)
    cosine = np.maximum(np.abs(dot(normal, direction(outgoing))), COSINE_FLOOR)
    return (
        footprint / cosine
        if view.is_orthographic
        else depth**3 * footprint / np.linalg.norm(outgoing, axis=-1) / cosine
    )


def depth_at(view, projected, which=0):
    """Depth of the surface that the view shows there (which=1: the farthest in its texel); 0 outside its frame and
    behind the camera."""
    height, width = view.depths.shape[:2]
    x, y = (np.floor(np.clip(projected[..., axis], -1e6, 1e6)).astype(int) for axis in (0, 1))
    inside = (projected[..., 2] > NEAREST) & (x >= 0) & (y >= 0) & (x < width) & (y < height)
    return np.where(inside, view.depths[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1), which], 0)


def shows(view, position, normal, outgoing, projected):
    """Does the view show this very surface, from the side to which `outgoing` points?"""
    other = to_camera(view, position)
    cosine = np.maximum(np.abs(dot(normal, direction(other))), COSINE_FLOOR)
    depth = projected[..., 2]
    texel = max(abs(view.scale)) * (1 if view.is_orthographic else depth)
    slope = np.sqrt(np.maximum(1 - cosine**2, 0)) / cosine
    near = np.abs(depth_at(view, projected) - depth) < DEPTH_TOLERANCE * depth + SLOPE_TOLERANCE * slope * texel
    return (dot(normal, other) * dot(normal, outgoing) > 0) & near


def own_share(cameras, own, position, normal, depth):
    """One view's share of a surface: w_k = A_k^-1 / sum_j A_j^-1."""
    mine = 1 / shown_area(cameras[own], position, normal, depth)
    everyone, outgoing = mine.copy(), to_camera(cameras[own], position)
    for index, view in enumerate(cameras):
        projected = project(view, position)
        seen = (depth_at(view, projected) > 0) & shows(view, position, normal, outgoing, projected)
        if index != own:
            depths_there = np.where(seen, projected[..., 2], 1)
            everyone += np.where(seen, 1 / shown_area(view, position, normal, depths_there), 0)
    return mine / everyone


def emit(views, cameras, own, side, step, receives):
    """(rows, columns, 4, 4): the records of one view's blocks of side x side pixels, as shaders/radiosity/emit.glsl
    stores them."""
    passes, camera, view = views[own].load_passes(), views[own].camera, cameras[own]
    depth = passes.depth[::-1].astype(np.float64)
    height, width = depth.shape
    normal, color, light = bottom_first(passes.normal), bottom_first(passes.diffuse_color), radiance_of(passes)
    sound = (depth > 0) & (depth < FARTHEST) & normal.any(-1)
    sound &= np.isfinite(normal.sum(-1) + light.sum(-1))
    depth = np.where(sound, depth, 1)
    normal = np.where(sound[..., None], direction(np.where(sound[..., None], normal, 1)), (0, 0, 1))
    light, color = (np.where(sound[..., None], image, 0) for image in (light, color))
    position = view_position(camera, pixel_centres(height, width), depth) @ view.rotation + view.position
    shown = np.where(sound, shown_area(view, position, normal, depth), 0)
    mine = shown if receives else shown * own_share(cameras, own, position, normal, depth)

    def blocks(image):
        image = np.pad(image, [(0, -height % side), (0, -width % side)] + [(0, 0)] * (image.ndim - 2))
        return image.reshape(image.shape[0] // side, side, image.shape[1] // side, side, *image.shape[2:]).sum((1, 3))

    area = blocks(mine)
    share = np.where(area > 0, 1 / np.where(area > 0, area, 1), 0)[..., None]
    means = [blocks(mine[..., None] * image) * share for image in (position, normal, light, color)]
    last = [area / step**2, blocks(shown) / step**2, 0 * area, 0 * area]
    return np.stack([np.concatenate([mean, end[..., None]], -1) for mean, end in zip(means, last)], -2)


def radiate(emitters, irradiance):
    """(n, 4): radiance and area of emitters (n, 4, 4), given the irradiance (n, 3) of the receiver that each belongs
    to; no radiance where it overflows float32."""
    with np.errstate(invalid="ignore"):
        sent = emitters[:, 2, :3] + emitters[:, 3, :3] * irradiance / np.pi
        fits = np.abs(sent).sum(-1, keepdims=True) <= np.finfo(np.float32).max
    return np.concatenate([np.where(fits, sent, 0), emitters[:, 0, 3:]], -1)


def receiver_of(grid, receivers):
    """The number of each emitter's receiver, for one view; grids: (first, across, up, side)."""
    _, across, up, side = grid
    first, wide, high, large = receivers
    x, y = (np.minimum(np.arange(count) * side // large, most - 1) for count, most in ((across, wide), (up, high)))
    return (first + y[:, None] * wide + x).ravel()


def gap_at(view, positions):
    """(shown, gap): whether a position is in the view's frame, and the depth of the surface there less that of the
    position; below 0 behind it. Outside the frame, the surface at its edge."""
    projected = project(view, positions)
    height, width = view.depths.shape[:2]
    shown = depth_at(view, projected) > 0
    texel = np.clip(projected[..., :2], 0, (width - 1e-9, height - 1e-9)).astype(int)
    return shown, view.depths[texel[..., 1], texel[..., 0], 1] * FREE_TOLERANCE - projected[..., 2]


def passes_through(view, start, path, low, high):
    """((n,) bool, (n,), (n,)): whether segments that are visible at one end of a step and hidden at the other pass
    through a surface, and not behind the silhouette of something nearer, where the gap jumps; the narrowed step."""
    gap_low, gap_high = (gap_at(view, start + path * share[:, None])[1] for share in (low, high))
    whole = np.minimum(np.abs(gap_low - gap_high), MAX_GAP_SLOPE * np.linalg.norm(path, axis=-1) * (high - low))
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        gap = gap_at(view, start + path * middle[:, None])[1]
        before = (gap > 0) == (gap_low > 0)
        low, gap_low = np.where(before, middle, low), np.where(before, gap, gap_low)
        high, gap_high = np.where(before, high, middle), np.where(before, gap_high, gap)
    return np.abs(gap_low - gap_high) < MAX_GAP_LEFT * whole, low, high


def is_blocked(cameras, start, end, jitter, steps):
    """(n,) bool: some view sees the segment pass through a surface, or a point of it lies close behind a view's
    surfaces and is visible in none. start, end: (n, 3)."""
    share = (np.arange(steps)[:, None] + np.broadcast_to(jitter, len(start))) / steps  # (steps, n)
    path = end - start
    positions = start + path * share[..., None]
    thickness = THICKNESS * np.linalg.norm(path, axis=-1)
    free, within = np.zeros((2, *share.shape), bool)
    passed = np.zeros((steps - 1, len(start)), bool)
    counted = (share >= MARGIN) & (share <= 1 - MARGIN)
    both = counted[:-1] & counted[1:]
    for view in cameras:
        shown, gap = gap_at(view, positions)
        seen, hidden = shown & (gap > 0), shown & (gap <= 0)
        free |= seen
        within |= hidden & (gap > -thickness)
        step, segment = np.nonzero(((seen[:-1] & hidden[1:]) | (hidden[:-1] & seen[1:])) & both)
        passed[step, segment] |= passes_through(
            view, start[segment], path[segment], share[step, segment], share[step + 1, segment]
        )[0]
    return passed.any(0) | (within & ~free & counted).any(0)


def power_of(sent):
    return np.abs(sent[:, :3]).sum(-1)


def world_light(world, normal):
    """EEVEE's world light on a white surface: (4, 3) coefficients of 1, x, y, z."""
    return world[0] + normal @ world[1:]


def world_radiance(world, towards):
    """The radiance from a direction which makes this light: a cosine lobe damps the first order to 2/3."""
    return world_light(world, 1.5 * towards)


def pdf_factors(sent, by_area, world=0.0):
    """(power_pdf, area_pdf): an emitter has the pdf (power_pdf * (power + world) + area_pdf) * area."""
    area, power = sent[:, 3], power_of(sent) + world
    bright = (power * area).sum()
    by_area = by_area if bright > 0 else 1
    return ((1 - by_area) / bright if bright > 0 else 0), by_area / area.sum()


def pdfs(sent, by_area):
    """(n,) the pdf of every emitter, 1 in all."""
    power_pdf, area_pdf = pdf_factors(sent, by_area)
    return (power_pdf * power_of(sent) + area_pdf) * sent[:, 3]


def all_pairs(positions, normals, emitters, sent, share_free=1.0, world=None):
    """(n, 3): the irradiance of receivers from every emitter. share_free: (n, emitters), or 1 without visibility.
    world: (4, 3), the light of which each emitter covers its part."""
    form = form_factor(
        positions[:, None], normals[:, None], emitters[:, 0, :3], emitters[:, 1, 3], sent[:, 3:] * emitters[:, 1, :3]
    )
    lit = (form * share_free) @ sent[:, :3]
    if world is not None:
        towards = world_radiance(world, direction(emitters[:, 0, :3] - positions[:, None]))
        lit -= ((form * share_free)[..., None] * towards).sum(1)
    return np.pi * lit


def share_free(cameras, positions, normals, emitters, steps, jitters=16):
    """(n, emitters): the share of the jitters for which the segment is free; 1 where the form factor is 0."""
    path = emitters[:, 0, :3] - positions[:, None]
    lit = (dot(normals[:, None], path) > 0) & (dot(emitters[:, 1, :3], path) < 0) & (emitters[:, 0, 3] > 0)
    here, there = np.nonzero(lit)
    free = np.ones(lit.shape)
    free[here, there] -= np.mean(
        [
            is_blocked(cameras, positions[here], emitters[there, 0, :3], (k + 0.5) / jitters, steps)
            for k in range(jitters)
        ],
        axis=0,
    )
    return free


def brightness(light):
    return np.abs(light).sum(-1)


def smooth(level, irradiance, world=None):
    """(H, W, 3): means over the texels around on the same surface, one and two texels apart. level: reference.Level
    of the base. world: (H, W, 3), the world's light: no more than that is taken away."""
    height, width = level.area.shape
    normal, surface = direction(level.vector_area), level.area > 0
    spline = {0: 1.0, 1: 2 / 3, 2: 1 / 6}
    mean = irradiance
    for step in SMOOTH_STEPS:
        total, weights = mean.copy(), np.ones(level.area.shape)
        brightest, its_weight = mean.copy(), np.ones(level.area.shape)
        for x, y in ((x, y) for y in range(-2, 3) for x in range(-2, 3) if x or y):
            dx, dy = step * x, step * y
            here = slice(max(0, -dy), max(0, height - max(0, dy))), slice(max(0, -dx), max(0, width - max(0, dx)))
            there = slice(max(0, dy), max(0, height + min(0, dy))), slice(max(0, dx), max(0, width + min(0, dx)))
            distance = dot(normal[here], level.position[there] - level.position[here])
            flatness = 1 / (1 + FLATNESS_SHARPNESS * distance**2 / np.where(surface[there], level.area[there], 1))
            likeness = np.maximum(dot(normal[here], normal[there]), 0) ** NORMAL_POWER
            weight = np.where(surface[here] & surface[there], spline[abs(x)] * spline[abs(y)] * flatness * likeness, 0)
            total[here] += weight[..., None] * mean[there]
            weights[here] += weight
            brighter = (brightness(mean[there]) > brightness(brightest[here])) & (weight > 0)
            brightest[here] = np.where(brighter[..., None], mean[there], brightest[here])
            its_weight[here] = np.where(brighter, weight, its_weight[here])
        if step == 1:
            others = weights - its_weight
            most = FIREFLY_RATIO * brightness(total - its_weight[..., None] * brightest) / np.maximum(others, 1e-37)
            over = np.where(others > 1, 1 - np.minimum(most / np.maximum(brightness(brightest), 1e-37), 1), 0)
            total -= (its_weight * over)[..., None] * brightest
        mean = total / weights[..., None]
    return mean if world is None else np.maximum(mean, -np.pi * np.maximum(world, 0))
