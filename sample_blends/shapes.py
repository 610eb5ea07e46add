# SPDX-License-Identifier: GPL-3.0-or-later
"""Round forms that flow into each other: signed distances of ellipsoids, and the surface where they are zero."""

import numpy as np


def blend(add, cut=()):
    """A function from points (..., 3) to a distance, negative inside. add, cut: (centre, radii, softness) each."""

    def ellipsoid(points, centre, radii):
        off = (points - centre) / radii
        far = np.linalg.norm(off, axis=-1)
        steep = np.maximum(np.linalg.norm(off / radii, axis=-1), 1e-6)
        return far * (far - 1) / steep

    def smallest(first, second, soft):
        part = np.clip(0.5 + 0.5 * (second - first) / soft, 0, 1)
        return second + (first - second) * part - soft * part * (1 - part)

    def field(points):
        whole = None
        for centre, radii, soft in add:
            one = ellipsoid(points, np.asarray(centre), np.asarray(radii))
            whole = one if whole is None else smallest(whole, one, soft)
        for centre, radii, soft in cut:
            whole = -smallest(-whole, ellipsoid(points, np.asarray(centre), np.asarray(radii)), soft)
        return whole

    return field


def surface(field, low, high, step):
    """Points and quads of the surface of a field within a box, by surface nets: a point in each cell that it crosses,
    a quad across each edge of the grid."""
    axes = [np.arange(a, b + step, step) for a, b in zip(low, high)]
    value = field(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1))
    cells = tuple(size - 1 for size in value.shape)
    total, count = np.zeros((*cells, 3)), np.zeros(cells)
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]

    def corner(at):
        return value[tuple(slice(a, a + n) for a, n in zip(at, cells))]

    for first in corners:
        for axis in range(3):
            if first[axis]:
                continue
            second = tuple(each + (axis == number) for number, each in enumerate(first))
            a, b = corner(first), corner(second)
            crossed = (a < 0) != (b < 0)
            part = np.where(crossed, a / np.where(crossed, a - b, 1), 0)
            point = np.stack([np.full(cells, float(each)) for each in first], axis=-1)
            point[..., axis] += part
            total += np.where(crossed[..., None], point, 0)
            count += crossed
    used = count > 0
    index = np.full(cells, -1)
    index[used] = np.arange(used.sum())
    where = np.argwhere(used)
    points = (where + total[used] / count[used][:, None]) * step + np.asarray(low)
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        ahead = np.take(value, range(1, value.shape[axis]), axis)
        behind = np.take(value, range(value.shape[axis] - 1), axis)
        for at in np.argwhere((ahead < 0) != (behind < 0)):
            if min(at[u], at[v]) < 1 or at[u] >= cells[u] or at[v] >= cells[v]:
                continue
            ring = []
            for du, dv in ((1, 1), (0, 1), (0, 0), (1, 0)):
                cell = at.copy()
                cell[u] -= du
                cell[v] -= dv
                ring.append(int(index[tuple(cell)]))
            faces.append(tuple(ring if behind[tuple(at)] < 0 else ring[::-1]))
    return points, faces
