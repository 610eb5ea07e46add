# SPDX-License-Identifier: GPL-3.0-or-later
"""A substitute of few triangles for all meshes of a scene, for rays that need no detail. Arrays only; no Blender.

A fixed number of triangles is divided among the meshes by size. A mesh that gets fewer than it has is simplified by
vertex clustering: all vertices in a cell of a grid become one. If there are too many instances for even the coarsest
shapes, a random sample stands for all: each is chosen with a probability proportional to its area, and scaled up to the
area of those that it stands for.
"""

import numpy as np

TRIANGLE_BUDGET = 100_000  # triangles of the whole substitute, about
MIN_TRIANGLES = 20  # triangles of an instance; a box has 12
MAX_COORDINATE = 1e18  # metres; its square is still a float32


def build(scene_meshes):
    """(points (V, 3), triangles (T, 3), material indices (T,)) in world space that stand for a meshes.SceneMeshes."""
    boxes = np.array([mesh.bounds for mesh in scene_meshes.meshes]).reshape(-1, 2, 3)
    sides = np.einsum(
        "nij,nj->ni", np.abs(scene_meshes.to_world[:, :3, :3]), np.ptp(boxes, axis=1)[scene_meshes.mesh_indices]
    )
    chosen, factors = sample_instances((sides * np.roll(sides, 1, 1)).sum(1))
    mesh_indices, to_world = scene_meshes.mesh_indices[chosen], scene_meshes.to_world[chosen]
    rotation, translation = to_world[:, :3, :3], to_world[:, :3, 3]
    # Scaled about their centres.
    translation = translation + np.einsum("nij,nj,n->ni", rotation, boxes.mean(1)[mesh_indices], 1 - factors)
    rotation = rotation * factors[:, None, None]
    uses, lengths = np.bincount(mesh_indices, minlength=len(boxes)), np.zeros(len(boxes))
    np.maximum.at(lengths, mesh_indices, factors * np.linalg.norm(sides[chosen], axis=1))
    used = np.flatnonzero(uses)
    budgets = triangle_shares(
        np.array([scene_meshes.meshes[index].triangle_count for index in used], int), uses[used], lengths[used]
    )
    parts, start = [(np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros(0, int))], 0
    for index, budget in zip(used, budgets):
        local_points, corners, materials = scene_meshes.meshes[index].simplify(budget)
        of_this = mesh_indices == index
        points = (np.einsum("nij,vj->nvi", rotation[of_this], local_points) + translation[of_this, None]).reshape(-1, 3)
        first = start + len(local_points) * np.arange(uses[index])
        parts.append((points, (corners + first[:, None, None]).reshape(-1, 3), np.tile(materials, uses[index])))
        start += len(points)
    points, corners, materials = map(np.concatenate, zip(*parts))
    is_finite = (np.abs(points) < MAX_COORDINATE).all(1)  # false for NaN, too
    points[~is_finite] = 0
    kept = is_finite[corners].all(1)
    return points, corners[kept], materials[kept]


def sample_instances(areas):
    """(indices, factors): the instances that stand for all, and by how much each is scaled. areas: (N,)."""
    areas = np.maximum(areas, 1e-30)
    probability = np.minimum(1, _fill_level(np.ones(len(areas)), areas, TRIANGLE_BUDGET / (2 * MIN_TRIANGLES)) * areas)
    chosen = np.flatnonzero(np.random.default_rng(0).random(len(areas)) < probability)
    return chosen, probability[chosen] ** -0.5


def triangle_shares(counts, uses, lengths):
    """(M,) number of triangles for each mesh. counts: (M,), how many it has. uses: (M,), its instances. lengths: (M,),
    the size of its largest instance."""
    lengths = np.maximum(lengths, 1e-30)
    return np.maximum(
        np.minimum(counts, _fill_level(counts * uses, lengths * uses, TRIANGLE_BUDGET) * lengths), MIN_TRIANGLES
    )


def simplify(points, corners, starts, box, max_triangles):
    """(points (V, 3), triangles (T, 3), polygon index of each triangle (T,)): at most `max_triangles` triangles, or
    all.

    points: (P, 3) float32. corners: (C,), point indices, polygon by polygon. starts: (N,), the first corner of each
    polygon. box: (2, 3), the bounding box."""
    if len(corners) - 2 * len(starts) <= max_triangles:
        return points, *_fan_triangles(corners, starts)
    x, y, z = box[1] - box[0]
    # For the surface of the bounding box this would give as many cells as triangles.
    cell = max((4 * (x * y + y * z + z * x) / max_triangles) ** 0.5, max(x, y, z) / max_triangles) or 1.0
    points, triangles, polygons = _cluster(points, corners, starts, box, cell)
    while len(triangles) > max_triangles:
        cell *= 1.4
        points, triangles, kept = _cluster(points, triangles.ravel(), np.arange(0, triangles.size, 3), box, cell)
        polygons = polygons[kept]
    return points, triangles, polygons


def _cluster(points, corners, starts, box, cell):
    """simplify() at a given cell size: one point in each cell of a grid."""
    cells, outward, count = np.zeros(len(points), np.int32), np.zeros(len(points), np.float32), 1
    for axis, (low, high) in enumerate(box.T.astype(np.float32)):
        along, steps = points[:, axis] - low, int((high - low) / cell) + 1
        step = np.fmax(np.fmin(along * np.float32(1 / cell), steps - 1), 0)  # these turn NaN into a number
        cells = cells * steps + step.astype(np.int32)
        outward += np.abs(along * np.float32(2 / max(high - low, 1e-30)) - 1)
        count *= steps
    # Keep the outermost point of each cell, so that the edges of walls still meet other walls.
    best = np.full(count, -1, np.int64)
    np.maximum.at(best, cells, ((outward * (1 << 20)).astype(np.int64) << 32) | np.arange(len(points)))
    used = np.flatnonzero(best >= 0)
    renumbered = np.zeros(count, np.int32)
    renumbered[used] = np.arange(len(used))
    triangles, polygons = _fan_triangles(renumbered[cells][corners], starts)
    _, once = np.unique(np.sort(triangles.astype(np.int64)) @ (1 << 42, 1 << 21, 1), return_index=True)
    return points[best[used] & 0xFFFFFFFF], triangles[once], polygons[once]


def _fan_triangles(corners, starts):
    """(triangles (T, 3), polygon index of each (T,)): fans about the first corner of each polygon, without degenerate
    triangles."""
    ends = np.append(starts[1:], len(corners))
    second = np.flatnonzero(corners[1:] != corners[:-1])  # few are left after clustering
    polygons = np.searchsorted(starts, second, "right") - 1
    inside = (second > starts[polygons]) & (second + 1 < ends[polygons])
    second, polygons = second[inside], polygons[inside]
    triangles = np.stack([corners[starts[polygons]], corners[second], corners[second + 1]], 1)
    kept = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 0] != triangles[:, 2])
    return triangles[kept], polygons[kept]


def _fill_level(limits, parts, total):
    """The largest number L for which the sum of min(limits, L * parts) is at most `total`. limits, parts: (N,),
    positive."""
    if limits.sum() <= total:
        return np.inf
    full_at = limits / parts
    order = np.argsort(full_at)
    full, rest = np.cumsum(limits[order]), parts.sum() - np.cumsum(parts[order])
    first = int(np.argmax(full + full_at[order] * rest > total))  # neither this one nor any after it reaches its limit
    return (total - full[first] + limits[order[first]]) / (rest[first] + parts[order[first]])
