# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays through the evaluated scene of a render, and a rough idea of the light on what they hit.

Only an evaluated depsgraph that belongs to us may be asked during a render: Blender's own ray cast of a scene asks that
of the window, and leaves out the scene behind a background set. So each object is asked by itself, those whose boxes a
ray meets.
"""

import numpy as np
from mathutils.bvhtree import BVHTree

from .materials import Look, look

GROUP = 32                 # boxes that are tested together
CHUNK = 1 << 21            # tests of rays against boxes at once, for memory
LAMPS = 8                  # drawn for each point where there are more


class Geometry:
    """All that a ray can hit in a depsgraph, and the lamps. It must not outlive the render() that the depsgraph was
    given to."""

    def __init__(self, depsgraph):
        self._solids, self.lamps, low, high = [], [], [], []
        solids, looks = {}, {}
        to_world, which = [], []
        for instance in depsgraph.object_instances:
            thing = instance.object
            if thing.type == "LIGHT":
                self.lamps.append(Lamp(thing.data, np.array(instance.matrix_world)))
            if thing.type != "MESH" or not len(thing.data.polygons) or not instance.show_self:
                continue
            key = thing.data.as_pointer()
            if key not in solids:
                solids[key] = len(self._solids)
                self._solids.append(_Solid(instance, depsgraph, looks))
            if self._solids[solids[key]].passes_light:
                continue
            which.append(solids[key])
            to_world.append(np.array(instance.matrix_world))
            corners = np.array(thing.bound_box) @ to_world[-1][:3, :3].T + to_world[-1][:3, 3]
            low.append(corners.min(0))
            high.append(corners.max(0))
        self._which = np.array(which, int)
        self._from_world = np.linalg.pinv(np.array(to_world).reshape(-1, 4, 4))
        self._low, self._high = np.array(low).reshape(-1, 3), np.array(high).reshape(-1, 3)
        margin = 1e-5 * np.linalg.norm(self._high - self._low, axis=1)[:, None] + 1e-7  # flat boxes
        self._low, self._high = self._low - margin, self._high + margin
        self._group()

    def cast(self, origins, directions, limits, nearest=True):
        """As placement.py has it; without `nearest`, any hit will do. The thing is the index of a Look in looks()."""
        origins, directions = np.asarray(origins, float), np.asarray(directions, float)
        distance, normal = np.full(len(origins), np.inf), np.zeros((len(origins), 3))
        thing = np.full(len(origins), -1)
        if not len(self._which):
            return distance, normal, thing
        step = max(1, CHUNK // max(len(self._groups), GROUP))
        for first in range(0, len(origins), step):
            part = slice(first, first + step)
            self._cast(origins[part], directions[part], limits[part], nearest,
                       distance[part], normal[part], thing[part])
        return distance, normal, thing

    def look(self, things):
        """(albedo, emission) of what was hit, (N,) each."""
        looks = [self._found[thing] for thing in things]
        return np.array([each.albedo for each in looks]), np.array([each.emission for each in looks])

    def _group(self):
        """Boxes in groups that lie close together, with a box about each group."""
        middle = (self._low + self._high) / 2
        span = np.ptp(middle, axis=0) if len(middle) else np.ones(3)
        cells = ((middle - middle.min(0)) / np.where(span > 0, span, 1) * 1023).astype(np.int64) if len(middle) else middle
        code = np.zeros(len(middle), np.int64)
        for bit in range(10):  # a Z curve
            for axis in range(3):
                code |= ((cells[:, axis].astype(np.int64) >> bit) & 1) << (3 * bit + axis)
        order = np.argsort(code, kind="stable")
        self._groups = [order[first:first + GROUP] for first in range(0, len(order), GROUP)]
        self._group_low = np.array([self._low[group].min(0) for group in self._groups]).reshape(-1, 3)
        self._group_high = np.array([self._high[group].max(0) for group in self._groups]).reshape(-1, 3)
        self._found = []

    def _cast(self, origins, directions, limits, nearest, distance, normal, thing):
        with np.errstate(divide="ignore"):
            inverse = 1 / directions
        rays, boxes, entries = [], [], []
        met = _entry(origins, inverse, limits, self._group_low, self._group_high)
        for index, group in enumerate(self._groups):
            near = np.flatnonzero(np.isfinite(met[:, index]))
            entry = _entry(origins[near], inverse[near], limits[near], self._low[group], self._high[group])
            ray, box = np.nonzero(np.isfinite(entry))
            rays.append(near[ray])
            boxes.append(group[box])
            entries.append(entry[ray, box])
        rays, boxes, entries = np.concatenate(rays), np.concatenate(boxes), np.concatenate(entries)
        order = np.lexsort((entries, rays))
        rays, boxes, entries = rays[order], boxes[order], entries[order]
        matrices = self._from_world[boxes]
        local = np.einsum("nij,nj->ni", matrices[:, :3, :3], origins[rays]) + matrices[:, :3, 3]
        along = np.einsum("nij,nj->ni", matrices[:, :3, :3], directions[rays])
        scale = np.linalg.norm(along, axis=1)
        along /= np.where(scale > 0, scale, 1)[:, None]
        best = dict(enumerate(limits.tolist()))
        hits = {}
        for ray, box, entry, start, way, factor in zip(rays.tolist(), boxes.tolist(), entries.tolist(), local.tolist(),
                                                       along.tolist(), scale.tolist()):
            if entry > best[ray] or not factor:
                continue
            found = self._solids[self._which[box]].cast(start, way, min(best[ray] * factor, 3e38))
            if found is not None:
                far, *rest = found
                best[ray] = far / factor if nearest else -1.0
                hits[ray] = far / factor, box, *rest
        for ray, (far, box, facing, face) in hits.items():
            distance[ray] = far
            if nearest:
                turned = self._from_world[box][:3, :3].T @ np.array(facing)
                normal[ray] = turned / (np.linalg.norm(turned) or 1)
                thing[ray] = len(self._found)
                self._found.append(self._solids[self._which[box]].look(face))


class _Solid:
    """A mesh that rays hit in its own space."""

    def __init__(self, instance, depsgraph, looks):
        thing = instance.object
        self._mesh = thing.data
        self._looks = []
        for slot in thing.material_slots:
            material = slot.material
            if material not in looks:
                looks[material] = look(material)
            self._looks.append(looks[material])
        real = instance.instance_object.evaluated_get(depsgraph) if instance.is_instance else thing
        # What geometry nodes instance has no object of its own that outlives the loop.
        is_own = real.type == "MESH" and real.data.as_pointer() == self._mesh.as_pointer()
        self._object, self._tree = real if is_own else None, None

    @property
    def passes_light(self):
        return bool(self._looks) and all(look.passes_light for look in self._looks)

    def cast(self, start, way, limit):
        """(distance, normal, face) in the mesh's space, or None."""
        if self._object is not None:
            hit, at, normal, face = self._object.ray_cast(start, way, distance=limit)
            if not hit:
                return None
            return sum((a - b)**2 for a, b in zip(at, start))**0.5, normal, face
        if self._tree is None:
            corners = np.empty(3 * len(self._mesh.vertices), np.float32)
            self._mesh.vertices.foreach_get("co", corners)
            triangles = np.empty(3 * len(self._mesh.loop_triangles), np.int32)
            self._mesh.loop_triangles.foreach_get("vertices", triangles)
            self._tree = BVHTree.FromPolygons(corners.reshape(-1, 3).tolist(), triangles.reshape(-1, 3).tolist(),
                                              all_triangles=True)
        at, normal, triangle, far = self._tree.ray_cast(start, way, limit)
        if at is None:
            return None
        return far, normal, self._mesh.loop_triangles[triangle].polygon_index

    def look(self, face):
        """Look of the material on a face."""
        if len(self._looks) < 2:
            return self._looks[0] if self._looks else Look()
        index = self._mesh.polygons[face].material_index if 0 <= face < len(self._mesh.polygons) else 0
        return self._looks[min(index, len(self._looks) - 1)]


class Lamp:
    """A light, as far as one point of it can tell."""

    def __init__(self, data, matrix):
        self.kind, self.place = data.type, matrix[:3, 3].copy()
        axis = matrix[:3, 2]
        self.back = axis / (np.linalg.norm(axis) or 1)  # lamps shine along their own -Z
        self.power = max(data.color) * data.energy * 2**data.exposure
        self.cone = np.cos(data.spot_size / 2) if data.type == "SPOT" else None

    def shine(self, places, normals):
        """(radiance of a white surface without shadow (N,), directions to the lamp (N, 3), distances (N,))."""
        if self.kind == "SUN":
            to, far = np.broadcast_to(self.back, places.shape), np.full(len(places), np.inf)
            light = np.full(len(places), self.power / np.pi)
        else:
            to = self.place - places
            far = np.maximum(np.linalg.norm(to, axis=1), 1e-6)
            to = to / far[:, None]
            facing = np.clip(to @ self.back, 0, None)
            share = (facing / np.pi**2 if self.kind == "AREA" else
                     np.where(facing > self.cone, 1, 0) / (4 * np.pi**2) if self.kind == "SPOT" else 1 / (4 * np.pi**2))
            light = self.power * share / far**2
        return light * np.clip(np.sum(to * normals, 1), 0, None), to, far


def direct_light(geometry, places, normals, rng):
    """(N,) radiance of white surfaces under the lamps of a Geometry, with shadows: an estimate where there are many."""
    total, lamps = np.zeros(len(places)), geometry.lamps
    if not lamps:
        return total
    drawn = range(len(lamps)) if len(lamps) <= LAMPS else rng.choice(len(lamps), LAMPS, replace=False)
    for index in drawn:
        light, to, far = lamps[index].shine(places, normals)
        lit = np.flatnonzero(light > 0)
        start = places[lit] + normals[lit] * (1e-3 * np.linalg.norm(np.ptp(places, axis=0)))
        blocked, _, _ = geometry.cast(start, to[lit], far[lit] * (1 - 5e-3), nearest=False)
        total[lit] += np.where(np.isfinite(blocked), 0, light[lit])
    return total * (len(lamps) / len(drawn))


def _entry(origins, inverse, limits, low, high):
    """(rays, boxes): how far from its origin each ray enters each box, infinite where it does not within its limit."""
    near, far = np.zeros((len(origins), len(low))), np.repeat(limits[:, None].astype(float), len(low), 1)
    for axis in range(3):
        with np.errstate(invalid="ignore"):  # 0 times infinity: along a face of the box
            first = (low[:, axis] - origins[:, axis, None]) * inverse[:, axis, None]
            second = (high[:, axis] - origins[:, axis, None]) * inverse[:, axis, None]
        np.fmax(near, np.fmin(first, second), out=near)
        np.fmin(far, np.fmax(first, second), out=far)
    return np.where(near <= far, near, np.inf)
