# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays through the evaluated scene of a render, and a rough idea of the light on what they hit.

Only an evaluated depsgraph that belongs to us may be asked during a render: Blender's own ray cast of a scene asks that
of the window, and leaves out the scene behind a background set. So all meshes are read (meshes.py), simplified where
they are many or heavy (proxy_mesh.py), into one tree: a ray is one call, however much is in the scene.
"""

import numpy as np
from mathutils.bvhtree import BVHTree

from . import meshes, proxy_mesh

MAX_LAMPS = 8  # drawn for each point where there are more


class Geometry:
    """All that a ray can hit in a depsgraph, and the lamps. It must not outlive the render() that the depsgraph was
    given to."""

    def __init__(self, depsgraph):
        found = meshes.read(depsgraph)
        self.lamps = [Lamp(*each) for each in found.lamps]
        self._albedo = np.array([look.albedo for look in found.materials])
        self._emission = np.array([look.emission for look in found.materials])
        points, triangles, self._material_indices = proxy_mesh.build(found)
        self._tree = BVHTree.FromPolygons(points.tolist(), triangles.tolist(), all_triangles=True)

    def cast(self, origins, directions, limits, nearest=True):
        """As placement.py has it. The thing is for look()."""
        distance, normal = np.full(len(origins), np.inf), np.zeros((len(origins), 3))
        thing = np.full(len(origins), -1)
        limits = np.minimum(limits, proxy_mesh.MAX_COORDINATE)
        rays = (np.asarray(each, float).tolist() for each in (origins, directions, limits))
        found = list(map(self._tree.ray_cast, *rays))
        hit = [index for index, (_, _, triangle, _) in enumerate(found) if triangle is not None]
        if hit:
            _, facing, triangles, far = zip(*(found[index] for index in hit))
            distance[hit] = far
            if nearest:
                normal[hit], thing[hit] = facing, self._material_indices[list(triangles)]
        return distance, normal, thing

    def albedo_and_emission(self, things):
        """(albedo, emission) of what was hit, (N,) each."""
        return self._albedo[things], self._emission[things]


class Lamp:
    """A light, as far as one point of it can tell."""

    def __init__(self, data, matrix):
        self._data, self._matrix = data, matrix

    def illuminate(self, places, normals):
        """(radiance of a white surface without shadow (N,), directions to the lamp (N, 3), distances (N,))."""
        data, back = self._data, self._matrix[:3, 2]
        back = back / (np.linalg.norm(back) or 1)  # lamps shine along their own -Z
        power = max(data.color) * data.energy * 2**data.exposure
        if data.type == "SUN":
            to, far = np.broadcast_to(back, places.shape), np.full(len(places), np.inf)
            light = np.full(len(places), power / np.pi)
        else:
            to = self._matrix[:3, 3] - places
            far = np.maximum(np.linalg.norm(to, axis=1), 1e-6)
            to = to / far[:, None]
            facing = np.clip(to @ back, 0, None)
            share = (
                facing / np.pi**2
                if data.type == "AREA"
                else np.where(facing > np.cos(data.spot_size / 2), 1, 0) / (4 * np.pi**2)
                if data.type == "SPOT"
                else 1 / (4 * np.pi**2)
            )
            light = power * share / far**2
        return light * np.clip(np.sum(to * normals, 1), 0, None), to, far


def direct_light(geometry, places, normals, rng):
    """(N,) radiance of white surfaces under the lamps of a Geometry, with shadows: an estimate where there are many."""
    total, lamps = np.zeros(len(places)), geometry.lamps
    if not lamps:
        return total
    drawn = range(len(lamps)) if len(lamps) <= MAX_LAMPS else rng.choice(len(lamps), MAX_LAMPS, replace=False)
    for index in drawn:
        light, to, far = lamps[index].illuminate(places, normals)
        lit = np.flatnonzero(light > 0)
        start = places[lit] + normals[lit] * (1e-3 * np.linalg.norm(np.ptp(places, axis=0)))
        blocked, _, _ = geometry.cast(start, to[lit], far[lit] * (1 - 5e-3), nearest=False)
        total[lit] += np.where(np.isfinite(blocked), 0, light[lit])
    return total * (len(lamps) / len(drawn))
