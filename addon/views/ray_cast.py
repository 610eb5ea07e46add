# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays through the evaluated scene of a render, and a rough estimate of the light on what they hit.

Only the depsgraph of the render itself may be used during a render, and only while it is being evaluated, and Blender's
Scene.ray_cast() uses that of the window. So all meshes are read (meshes.py), simplified if they are many or
heavy (proxy_mesh.py), and put into one BVH tree: a ray is one call, however much is in the scene.
"""

import numpy as np
from mathutils.bvhtree import BVHTree

from . import meshes, proxy_mesh

# Keep shadow rays from hitting the surface that they start on, and one that the lamp touches; both chosen by eye.
SHADOW_RAY_OFFSET = 1e-3  # along the normal, as a share of the extent of all points
SHADOW_RAY_GAP = 5e-3  # at the lamp, as a share of the distance to it
MAX_LAMPS = 8  # lamps sampled at each call of direct_light() if there are more


class Geometry:
    """Everything in a depsgraph that a ray can hit, and the lamps. It may outlive the depsgraph."""

    def __init__(self, depsgraph):
        scene_meshes = meshes.read(depsgraph)
        self.lamps = [Lamp(*each) for each in scene_meshes.lamps]
        self._albedo = np.array([material.albedo for material in scene_meshes.materials])
        self._emission = np.array([material.emission for material in scene_meshes.materials])
        points, triangles, self._material_indices = proxy_mesh.build(scene_meshes)
        self._tree = BVHTree.FromPolygons(points.tolist(), triangles.tolist(), all_triangles=True)

    def cast(self, origins, directions, limits, nearest=True):
        """Cast rays: origins (N, 3), directions (N, 3) of length 1, limits (N,) of their lengths. Returns (distance
        (N,), inf where nothing is hit; normal (N, 3), facing either side; material (N,) int, an index for
        albedo_and_emission()). Without `nearest` only whether the distance is finite matters."""
        distance, normal = np.full(len(origins), np.inf), np.zeros((len(origins), 3))
        material = np.full(len(origins), -1)
        limits = np.minimum(limits, proxy_mesh.MAX_COORDINATE)
        arguments = (np.asarray(each, float).tolist() for each in (origins, directions, limits))
        results = list(map(self._tree.ray_cast, *arguments))
        hit = [index for index, (_, _, triangle, _) in enumerate(results) if triangle is not None]
        if hit:
            _, facing, triangles, distances = zip(*(results[index] for index in hit))
            distance[hit] = distances
            if nearest:
                normal[hit], material[hit] = facing, self._material_indices[list(triangles)]
        return distance, normal, material

    def albedo_and_emission(self, materials):
        """(albedo, emission) of what was hit, (N,) each. materials: (N,) int, from cast()."""
        return self._albedo[materials], self._emission[materials]


class Lamp:
    """A light object, treated as a point (a sun: as a direction)."""

    def __init__(self, data, matrix):
        self._type, self._matrix = data.type, matrix
        self._power = max(data.color) * data.energy * 2**data.exposure
        self._least_cosine = np.cos(data.spot_size / 2) if data.type == "SPOT" else -1.0

    def illuminate(self, positions, normals):
        """(radiance of a white diffuse surface without shadow (N,), directions to the lamp (N, 3), distances (N,))."""
        axis, power = self._matrix[:3, 2], self._power
        axis = axis / (np.linalg.norm(axis) or 1)  # lamps emit along their own -Z
        if self._type == "SUN":
            to_lamp, distance = np.broadcast_to(axis, positions.shape), np.full(len(positions), np.inf)
            radiance = np.full(len(positions), power / np.pi)
        else:
            to_lamp = self._matrix[:3, 3] - positions
            distance = np.maximum(np.linalg.norm(to_lamp, axis=1), 1e-6)
            to_lamp = to_lamp / distance[:, None]
            facing = np.clip(to_lamp @ axis, 0, None)
            share = (
                facing / np.pi**2
                if self._type == "AREA"
                else np.where(facing > self._least_cosine, 1, 0) / (4 * np.pi**2)
                if self._type == "SPOT"
                else 1 / (4 * np.pi**2)
            )
            radiance = power * share / distance**2
        return radiance * np.clip(np.sum(to_lamp * normals, 1), 0, None), to_lamp, distance


def direct_light(geometry, positions, normals, rng):
    """(N,) radiance of white diffuse surfaces under the lamps of a Geometry, with shadows; an estimate if there are
    many lamps."""
    total, lamps = np.zeros(len(positions)), geometry.lamps
    if not lamps:
        return total
    chosen = range(len(lamps)) if len(lamps) <= MAX_LAMPS else rng.choice(len(lamps), MAX_LAMPS, replace=False)
    for index in chosen:
        radiance, to_lamp, distance = lamps[index].illuminate(positions, normals)
        facing = np.flatnonzero(radiance > 0)
        start = positions[facing] + normals[facing] * (SHADOW_RAY_OFFSET * np.linalg.norm(np.ptp(positions, axis=0)))
        hit_distance, _, _ = geometry.cast(
            start, to_lamp[facing], distance[facing] * (1 - SHADOW_RAY_GAP), nearest=False
        )
        total[facing] += np.where(np.isfinite(hit_distance), 0, radiance[facing])
    return total * (len(lamps) / len(chosen))
