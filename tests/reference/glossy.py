# SPDX-License-Identifier: GPL-3.0-or-later
"""The specular light in float64 numpy, function by function as in shaders/glossy, and the integrals over the lobe that
it samples."""

import numpy as np

from .paper import COSINE_FLOOR, FARTHEST, FLATNESS_SHARPNESS, NORMAL_POWER, direction, dot
from .radiosity import (
    DEPTH_TOLERANCE,
    NEAREST,
    depth_at,
    gap_at,
    passes_through,
    project,
    shown_area,
    shows,
    to_camera,
    to_view,
    world_radiance,
)

MARCH_STEPS = 32
MARCH_TEXELS = 6.0
REFINEMENTS = 8
LOST = -1.0
MIN_ALPHA = 1e-3
MIN_COSINE = 0.02
CLEARANCE = 0.1
GLOSS_RADIUS = 3
LOBE_SHARE = 0.5
ROUGHNESS_SCALE = 0.1
R3 = np.array([0.8191725134, 0.6710436067, 0.5497004779])


def smith(cosine, alpha):
    square = cosine * cosine
    return 0.5 * (np.sqrt(1 + alpha * alpha * (1 - square) / np.maximum(square, 1e-12)) - 1)


def visible_normal(outgoing, alpha, random):
    """(..., 3) samples of the distribution of visible normals; outgoing: (..., 3), alpha: (...), random: (..., 2)."""
    stretched = direction(np.concatenate([alpha[..., None] * outgoing[..., :2], outgoing[..., 2:]], -1))
    turn = 2 * np.pi * random[..., 0]
    z = (1 - random[..., 1]) * (1 + stretched[..., 2]) - stretched[..., 2]
    radius = np.sqrt(np.clip(1 - z * z, 0, 1))
    facing = np.stack([radius * np.cos(turn), radius * np.sin(turn), z], -1) + stretched
    return direction(np.concatenate([alpha[..., None] * facing[..., :2], facing[..., 2:]], -1))


def lobe_weight(outgoing, towards, alpha):
    here = 1 + smith(outgoing, alpha)
    return np.where(towards > 0, here / (here + smith(towards, alpha)), 0)


def microfacets(cosine, alpha):
    """D: area of microfacets of this cosine to the normal, on a square metre and a steradian."""
    return alpha**2 / (np.pi * (cosine**2 * (alpha**2 - 1) + 1) ** 2)


def lobe(outgoing, towards, alpha):
    """The BRDF of white microfacets times the cosine, sr^-1: D G2 / (4 outgoing.n). outgoing: (3,), towards: (..., 3),
    normal z."""
    facet = direction(outgoing + towards)
    both = 1 / (1 + smith(outgoing[2], alpha) + smith(towards[..., 2], alpha))
    return np.where(towards[..., 2] > 0, microfacets(facet[..., 2], alpha) * both / (4 * outgoing[2]), 0)


def hemisphere(count, alpha=1.0):
    """(directions (n, 3), steradians (n,)) of the hemisphere about z. alpha: the smaller, the finer near z."""
    edges = np.linspace(0, 1, count + 1) ** 2 if alpha >= 1 else np.linspace(0, 1, count + 1)
    theta = np.arctan(alpha * np.tan(edges * (np.pi / 2 - 1e-9))) if alpha < 1 else edges * np.pi / 2
    phi = (np.arange(2 * count) + 0.5) / (2 * count) * 2 * np.pi
    middle, steradians = (theta[1:] + theta[:-1]) / 2, -np.diff(np.cos(theta)) * np.pi / count
    sine = np.sin(middle)[:, None]
    found = np.stack(
        [sine * np.cos(phi), sine * np.sin(phi), np.broadcast_to(np.cos(middle)[:, None], (count, 2 * count))], -1
    )
    return found.reshape(-1, 3), np.repeat(steradians, 2 * count)


def tangent_of(normal):
    side = np.where(normal[..., 2] < 0, -1.0, 1.0)
    a = -1 / (side + normal[..., 2])
    return np.stack(
        [1 + side * normal[..., 0] ** 2 * a, side * normal[..., 0] * normal[..., 1] * a, -side * normal[..., 0]], -1
    )


def projection_of(view, position):
    """(..., 4): x, y in texels of the depth map, times w; planar depth; w."""
    seen = to_view(view, position)
    w = np.ones(seen.shape[:-1]) if view.is_orthographic else -seen[..., 2]
    return np.concatenate([(seen[..., :2] - view.offset * w[..., None]) / view.scale, -seen[..., 2:], w[..., None]], -1)


def shown_span(view, start, rate, least, most):
    """(low, high) metres along rays, (n,) each, that a view has in frame."""
    height, width = view.depths.shape[:2]
    low, high = np.broadcast_to(least, start.shape[:1]).copy(), most.copy()
    sides = np.array([[1, 0, 0, 0], [-1, 0, 0, width], [0, 1, 0, 0], [0, -1, 0, height], [0, 0, 1, 0]], float)
    for side, free in zip(sides, (0, 0, 0, 0, NEAREST)):
        inside, slope = start @ side - free, rate @ side
        with np.errstate(divide="ignore", invalid="ignore"):
            at = -inside / slope
        low = np.where(slope > 0, np.maximum(low, at), low)
        high = np.where(slope < 0, np.minimum(high, at), high)
        high = np.where((slope == 0) & (inside <= 0), -1, high)
    return low, high


def is_seen(cameras, position):
    """(n,) bool: is a position visible in any view?"""
    found = [gap_at(view, position) for view in cameras]
    return np.any([shown & (gap > 0) for shown, gap in found], axis=0) if len(position) else np.zeros(0, bool)


def emitter_at(view, grid, position):
    """(n,) numbers of the emitters that a view shows at positions, -1 outside its frame. grid: (first, across, up,
    side, step)."""
    first, across, up, side, step = grid
    projected = project(view, position)
    block = np.floor(np.clip(projected[:, :2] * (step / side), -1e6, 1e6)).astype(int)
    inside = (projected[:, 2] > NEAREST) & (block >= 0).all(-1) & (block < (across, up)).all(-1)
    return np.where(inside, first + block[:, 1] * across + block[:, 0], -1)


def can_pass(view, grid, emitters, position, start, towards, goes_in):
    """(n,) bool: can rays enter (goes_in), or leave, the surface that a view shows at positions?"""
    number = emitter_at(view, grid, position)
    normal, from_ = emitters[number, 1, :3], start - emitters[number, 0, :3]
    return (number >= 0) & ((dot(normal, towards) < 0) == goes_in) & ((dot(normal, from_) > 0) == goes_in)


def first_hit(cameras, grids, emitters, position, normal, towards, least, jitter, reach):
    """(n,) metres to the first surface that some view sees the ray pass through; 0 in the open, LOST out of sight."""
    nearest = np.full(len(position), reach)
    hidden, sky = np.zeros((2, len(position)), bool)
    for index, (view, grid) in enumerate(zip(cameras, grids)):
        start = projection_of(view, position)
        rate = projection_of(view, position + towards) - start
        low, high = shown_span(view, start, rate, least, nearest)
        rays = np.flatnonzero(low < high)
        low, high, begin, path = low[rays], high[rays], position[rays], towards[rays]
        first, last = start[rays] + rate[rays] * low[:, None], start[rays] + rate[rays] * high[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            texels = np.linalg.norm(
                first[:, :2] / np.maximum(first[:, 3:], NEAREST) - last[:, :2] / np.maximum(last[:, 3:], NEAREST),
                axis=-1,
            )
        steps = np.clip(np.ceil(texels / MARCH_TEXELS), 4, MARCH_STEPS)
        before, open_ = low.copy(), np.ones(len(rays), bool)
        was_free = _is_free(view, begin + path * low[:, None])
        here = project(view, begin)
        shown = (depth_at(view, here) > 0) & shows(view, begin, normal[rays], to_camera(cameras[0], begin), here)
        has_begun = was_free | ~(shown | (index == 0))
        for k in range(MARCH_STEPS + 1):
            share = np.minimum((k + jitter[rays]) / steps, 1)
            at = low + (high - low) * share * first[:, 3] / (last[:, 3] + (first[:, 3] - last[:, 3]) * share)
            is_free = _is_free(view, begin + path * at[:, None])
            turn = np.flatnonzero(open_ & (k <= steps) & (is_free != was_free))
            passed, lower, upper = passes_through(view, begin[turn], path[turn], before[turn], at[turn])
            behind = np.where(was_free[turn], upper, lower)
            passed &= can_pass(
                view,
                grid,
                emitters,
                begin[turn] + path[turn] * behind[:, None],
                begin[turn],
                path[turn],
                was_free[turn],
            )
            passed &= was_free[turn] | (has_begun[turn] & ~is_seen(cameras, begin[turn] + path[turn] * lower[:, None]))
            for _ in range(REFINEMENTS):
                middle = (lower + upper) / 2
                same = _is_free(view, begin[turn] + path[turn] * middle[:, None]) == was_free[turn]
                lower, upper = np.where(same, middle, lower), np.where(same, upper, middle)
            nearest[rays[turn[passed]]] = ((lower + upper) / 2)[passed]
            open_[turn[passed]] = False
            before, was_free, has_begun = at, is_free, has_begun | is_free
        hidden[rays[~was_free]] = True
        sky[rays[was_free & (gap_at(view, begin + path * high[:, None])[1] > FARTHEST)]] = True
    return np.where(nearest < reach, nearest, np.where(hidden & ~sky, LOST, 0))


def _is_free(view, positions):
    return gap_at(view, positions)[1] > 0


def radiance_at(cameras, grids, emitters, sent, position, towards):
    """((n, 3), (n,) bool): radiance that leaves positions against `towards`, and whether any view shows it. grids: as
    emitter_at() has them, of each view, emitters (count, 4, 4) and sent (count, 4) as the shaders have them; a block
    is one texel of a depth map or a part of it."""
    total, weights = np.zeros((len(position), 3)), np.zeros(len(position))
    for view, grid in zip(cameras, grids):
        number, projected = emitter_at(view, grid, position), project(view, position)
        inside = number >= 0
        normal = direction(emitters[number, 1, :3])
        seen = inside & (emitters[number, 0, 3] > 0)
        seen &= np.abs(dot(normal, position - emitters[number, 0, :3])) < DEPTH_TOLERANCE * projected[:, 2]
        seen &= dot(normal, towards) * dot(normal, to_camera(view, position)) < 0
        weight = np.where(seen, 1 / np.where(seen, shown_area(view, position, normal, projected[:, 2]), 1), 0)
        total += weight[:, None] * sent[number, :3]
        weights += weight
    return total / np.where(weights > 0, weights, 1)[:, None], weights > 0


def rays_of(positions, normals, outgoing, roughness, random):
    """(towards (n, 3), weights (n,)) of one ray a texel. outgoing: directions to the camera; random: (n, 2)."""
    alpha = np.maximum(roughness**2, MIN_ALPHA)
    lean = np.maximum(MIN_COSINE - dot(normals, outgoing), 0)
    normal = direction(normals + lean[:, None] * outgoing)
    x = tangent_of(normal)
    y = np.cross(normal, x)
    seen = np.stack([dot(outgoing, x), dot(outgoing, y), dot(outgoing, normal)], -1)
    facet = visible_normal(seen, alpha, random)
    away = 2 * dot(seen, facet)[:, None] * facet - seen
    towards = direction(away[:, :1] * x + away[:, 1:2] * y + away[:, 2:] * normal)
    return towards, lobe_weight(seen[:, 2], away[:, 2], alpha)


def reflect(cameras, grids, emitters, sent, positions, normals, areas, roughness, shifts, rays, reach, world=None):
    """(n, 4): pi times the mean radiance over each texel's lobe, and the mean of 1 / distance. shifts: (n, 3)."""
    total, weights = np.zeros((len(positions), 4)), np.zeros(len(positions))
    outgoing = direction(to_camera(cameras[0], positions))
    least = CLEARANCE * np.sqrt(areas / np.maximum(dot(normals, outgoing), COSINE_FLOOR))
    for k in range(rays):
        random = np.modf(shifts + k * R3)[0]
        towards, weight = rays_of(positions, normals, outgoing, roughness, random[:, :2])
        far = first_hit(cameras, grids, emitters, positions, normals, towards, least, random[:, 2], reach)
        hit = np.flatnonzero((far > 0) & (weight > 0))
        met = positions[hit] + far[hit, None] * towards[hit]
        found, known = radiance_at(cameras, grids, emitters, sent, met, towards[hit])
        weight[hit] *= known
        weights += np.where(far == LOST, 0, weight)
        if world is not None:
            found = found - world_radiance(world, towards[hit])
        total[hit] += weight[hit, None] * np.concatenate([found, 1 / far[hit, None]], -1)
    return total * (np.pi, np.pi, np.pi, 1) / np.where(weights > 0, weights, 1)[:, None]


def smooth_gloss(level, found, gloss):
    """(H, W, 3): a mean over the texels around on the same surface with the same roughness. level: reference.Level of
    the base; found: (H, W, 4) as reflect() gives it; gloss: (H, W, 2), roughness and amount."""
    height, width = level.area.shape
    normal, rough, amount = direction(level.vector_area), gloss[..., 0], gloss[..., 1]
    shines = (level.area > 0) & (amount > 0)
    deviation = LOBE_SHARE * rough**2 / np.maximum(found[..., 3] * np.sqrt(level.area), 1e-6)
    deviation = np.minimum(deviation, GLOSS_RADIUS * 0.7)
    within = np.where(shines, np.minimum(np.ceil(2 * deviation), GLOSS_RADIUS), 0)
    sum_, weights = found[..., :3].copy(), np.ones(level.area.shape)
    reach = range(-GLOSS_RADIUS, GLOSS_RADIUS + 1)
    for dx, dy in ((dx, dy) for dy in reach for dx in reach if dx or dy):
        here = slice(max(0, -dy), max(0, height - max(0, dy))), slice(max(0, -dx), max(0, width - max(0, dx)))
        there = slice(max(0, dy), max(0, height + min(0, dy))), slice(max(0, dx), max(0, width + min(0, dx)))
        away = dot(normal[here], level.position[there] - level.position[here])
        flatness = 1 / (1 + FLATNESS_SHARPNESS * away**2 / np.where(shines[there], level.area[there], 1))
        likeness = np.maximum(dot(normal[here], normal[there]), 0) ** NORMAL_POWER
        near = np.exp(
            -0.5 * (dx * dx + dy * dy) / np.maximum(deviation[here], 1e-9) ** 2
            - np.abs(rough[there] - rough[here]) / ROUGHNESS_SCALE
        )
        weight = np.where(shines[there] & (within[here] >= max(abs(dx), abs(dy))), near * flatness * likeness, 0)
        sum_[here] += weight[..., None] * found[there][..., :3]
        weights[here] += weight
    return sum_ / weights[..., None]
