# SPDX-License-Identifier: GPL-3.0-or-later
"""A stand-in of few triangles for all meshes of a scene, for rays that need no detail. Arrays only; no Blender.

A fixed number of triangles is shared out by size. A mesh that gets fewer than it has is simplified by vertex
clustering: all vertices in a cell of a grid become one. Of more instances than can be had in any shape a random sample
stands for all, drawn as often as they are large, and scaled up to the area of those that it stands for.
"""

import numpy as np

TRIANGLE_BUDGET = 100_000  # of the whole stand-in, about
MIN_TRIANGLES = 20  # of an instance; a box has 12
MAX_COORDINATE = 1e18  # metres, of a point: its square is still a float


def build(found):
    """(points (V, 3), triangles (T, 3), looks (T,)) in world space that stand for meshes.Found."""
    boxes = np.array([solid.bounds for solid in found.meshes]).reshape(-1, 2, 3)
    sides = np.einsum("nij,nj->ni", np.abs(found.to_world[:, :3, :3]), np.ptp(boxes, axis=1)[found.mesh_indices])
    drawn, factors = sample_instances((sides * np.roll(sides, 1, 1)).sum(1))
    which, turn, place = found.mesh_indices[drawn], found.to_world[drawn, :3, :3], found.to_world[drawn, :3, 3]
    place = place + np.einsum("nij,nj,n->ni", turn, boxes.mean(1)[which], 1 - factors)  # scaled about their middles
    turn = turn * factors[:, None, None]
    uses, lengths = np.bincount(which, minlength=len(boxes)), np.zeros(len(boxes))
    np.maximum.at(lengths, which, factors * np.linalg.norm(sides[drawn], axis=1))
    used = np.flatnonzero(uses)
    most = triangle_shares(
        np.array([found.meshes[index].triangle_count for index in used], int), uses[used], lengths[used]
    )
    parts, start = [(np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros(0, int))], 0
    for index, share in zip(used, most):
        own, corners, looks = found.meshes[index].simplify(share)
        at = which == index
        points = (np.einsum("nij,vj->nvi", turn[at], own) + place[at, None]).reshape(-1, 3)
        first = start + len(own) * np.arange(uses[index])
        parts.append((points, (corners + first[:, None, None]).reshape(-1, 3), np.tile(looks, uses[index])))
        start += len(points)
    points, corners, looks = map(np.concatenate, zip(*parts))
    sound = (np.abs(points) < MAX_COORDINATE).all(1)  # nor is NaN
    points[~sound] = 0
    whole = sound[corners].all(1)
    return points, corners[whole], looks[whole]


def sample_instances(areas):
    """(indices, factors) of the instances that stand for all, and by how much each is to be scaled. areas: (N,)."""
    areas = np.maximum(areas, 1e-30)
    chance = np.minimum(1, _fill_level(np.ones(len(areas)), areas, TRIANGLE_BUDGET / (2 * MIN_TRIANGLES)) * areas)
    drawn = np.flatnonzero(np.random.default_rng(0).random(len(areas)) < chance)
    return drawn, chance[drawn] ** -0.5


def triangle_shares(counts, uses, lengths):
    """(M,) triangles that each of the meshes gets. counts: (M,), how many it has. uses: (M,), instances of it.
    lengths: (M,), of the longest instance."""
    lengths = np.maximum(lengths, 1e-30)
    return np.maximum(
        np.minimum(counts, _fill_level(counts * uses, lengths * uses, TRIANGLE_BUDGET) * lengths), MIN_TRIANGLES
    )


def simplify(points, corners, starts, box, most):
    """(points (V, 3), triangles (T, 3), the polygon of each (T,)): at most `most` triangles of a mesh, or all.

    points: (P, 3) float32. corners: (C,), indices of points, polygon by polygon. starts: (N,), the first corner of
    each polygon. box: (2, 3), what holds the points."""
    if len(corners) - 2 * len(starts) <= most:
        return points, *_fan_triangles(corners, starts)
    x, y, z = box[1] - box[0]
    # As many cells as triangles, were the surface that of the box.
    cell = max((4 * (x * y + y * z + z * x) / most) ** 0.5, max(x, y, z) / most) or 1.0
    points, build, polygons = _cluster(points, corners, starts, box, cell)
    while len(build) > most:
        cell *= 1.4
        points, build, kept = _cluster(points, build.ravel(), np.arange(0, build.size, 3), box, cell)
        polygons = polygons[kept]
    return points, build, polygons


def _cluster(points, corners, starts, box, cell):
    """As simplified(), with one point in each cell of a grid."""
    cells, outward, count = np.zeros(len(points), np.int32), np.zeros(len(points), np.float32), 1
    for axis, (low, high) in enumerate(box.T.astype(np.float32)):
        along, steps = points[:, axis] - low, int((high - low) / cell) + 1
        cells = cells * steps + np.fmax(np.fmin(along * np.float32(1 / cell), steps - 1), 0).astype(np.int32)  # no NaN
        outward += np.abs(along * np.float32(2 / max(high - low, 1e-30)) - 1)
        count *= steps
    # The outermost point of each cell, so that the edges of walls stay where they meet other walls.
    best = np.full(count, -1, np.int64)
    np.maximum.at(best, cells, ((outward * (1 << 20)).astype(np.int64) << 32) | np.arange(len(points)))
    used = np.flatnonzero(best >= 0)
    renumbered = np.zeros(count, np.int32)
    renumbered[used] = np.arange(len(used))
    build, polygons = _fan_triangles(renumbered[cells][corners], starts)
    _, once = np.unique(np.sort(build.astype(np.int64)) @ (1 << 42, 1 << 21, 1), return_index=True)
    return points[best[used] & 0xFFFFFFFF], build[once], polygons[once]


def _fan_triangles(corners, starts):
    """(triangles (T, 3), the polygon of each (T,)) about the first corners of polygons, but those that have a corner
    twice."""
    ends = np.append(starts[1:], len(corners))
    second = np.flatnonzero(corners[1:] != corners[:-1])  # few are left of a mesh whose points have become one
    polygons = np.searchsorted(starts, second, "right") - 1
    inside = (second > starts[polygons]) & (second + 1 < ends[polygons])
    second, polygons = second[inside], polygons[inside]
    found = np.stack([corners[starts[polygons]], corners[second], corners[second + 1]], 1)
    whole = (found[:, 0] != found[:, 1]) & (found[:, 0] != found[:, 2])
    return found[whole], polygons[whole]


def _fill_level(limits, parts, total):
    """The largest number L for which the sum of min(limits, L * parts) is at most `total`. limits, parts: (N,), above
    0."""
    if limits.sum() <= total:
        return np.inf
    at = limits / parts
    order = np.argsort(at)
    full, rest = np.cumsum(limits[order]), parts.sum() - np.cumsum(parts[order])
    first = int(np.argmax(full + at[order] * rest > total))  # neither it nor any behind it reaches its limit
    return (total - full[first] + limits[order[first]]) / (rest[first] + parts[order[first]])
