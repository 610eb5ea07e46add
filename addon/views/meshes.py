# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes and lamps of an evaluated depsgraph, read with as little as can be asked for each instance."""

from dataclasses import dataclass

import numpy as np

from ..scene import materials
from . import proxy_mesh


@dataclass(frozen=True, eq=False)
class SceneMeshes:
    """solids: [Solid]. which: (N,) int, of the instances: indices of solids. to_world: (N, 4, 4), their matrices.
    looks: [materials.Look], of what the solids are made of. lamps: [(light, (4, 4) matrix)]."""

    meshes: list
    mesh_indices: np.ndarray
    to_world: np.ndarray
    materials: list
    lamps: list


def read(depsgraph):
    """Found of what EEVEE draws and does not see through. The solids and lamps must not outlive the depsgraph's
    evaluation."""
    which, known, solids, looks, lamps = [], {}, [], _MaterialTable(), []
    for instance in depsgraph.object_instances:
        thing = instance.object
        data = thing.data
        kind = NOTHING if data is None else known.get(data.as_pointer())
        if kind is None:
            kind = known[data.as_pointer()] = _add_object(thing, solids, looks)
        if kind == LAMP:
            lamps.append((data, len(which)))
        which.append(kind)
    to_world, shown = np.empty((len(which), 4, 4), np.float32), np.empty(len(which), bool)
    depsgraph.object_instances.foreach_get("matrix_world", to_world.ravel())
    depsgraph.object_instances.foreach_get("show_self", shown)
    to_world, which = to_world.transpose(0, 2, 1).astype(float), np.array(which, int)  # Blender's are columns
    there = (which >= 0) & shown & np.isfinite(to_world).all((1, 2))
    return SceneMeshes(
        solids, which[there], to_world[there], looks.summaries, [(data, to_world[index]) for data, index in lamps]
    )


NOTHING, LAMP = -1, -2  # instead of the index of a solid


def _add_object(thing, solids, looks):
    """The index of an object's mesh in `solids`, which it is added to; or what else it is."""
    if thing.type == "LIGHT":
        return LAMP
    if thing.type != "MESH" or not len(thing.data.polygons):
        return NOTHING
    own = [looks.index(slot.material) for slot in thing.material_slots]
    if own and all(looks.summaries[each].passes_light for each in own):
        return NOTHING
    corners = np.array(thing.bound_box)
    solids.append(Mesh(thing.data, np.array(own or [looks.index(None)]), np.array((corners.min(0), corners.max(0)))))
    return len(solids) - 1


class _MaterialTable:
    """Looks of materials, each once."""

    def __init__(self):
        self.summaries, self._known = [], {}

    def index(self, material):
        if material not in self._known:
            self._known[material] = len(self.summaries)
            self.summaries.append(materials.summarize(material) if material else materials.MaterialSummary())
        return self._known[material]


class Mesh:
    """A mesh. looks: (slots,) int, of its materials. box: (2, 3), its bounds."""

    def __init__(self, mesh, looks, box):
        self._mesh, self._material_indices, self.bounds = mesh, looks, box
        self.triangle_count = len(mesh.loops) - 2 * len(mesh.polygons)  # triangles

    def simplify(self, most):
        """(points (V, 3), triangles (T, 3), looks (T,)), about `most` triangles or all."""
        mesh = self._mesh
        points = _array(mesh.attributes["position"].data, "vector", len(mesh.vertices), np.float32, 3)
        corners = _array(mesh.attributes[".corner_vert"].data, "value", len(mesh.loops), np.int32)
        starts = _array(mesh.polygons, "loop_start", len(mesh.polygons), np.int32)
        faces = None
        if np.diff(starts, append=len(corners)).max() > 4:  # a fan of such a polygon may reach beyond it
            faces = _array(mesh.loop_triangles, "polygon_index", self.triangle_count, np.int32)
            corners = _array(mesh.loop_triangles, "vertices", self.triangle_count, np.int32, 3).ravel()
            starts = np.arange(0, len(corners), 3)
        points, triangles, polygons = proxy_mesh.simplify(points, corners, starts, self.bounds, most)
        slots = mesh.attributes.get("material_index")
        if len(self._material_indices) < 2 or slots is None:
            return points, triangles, np.full(len(triangles), self._material_indices[0])
        slots = _array(slots.data, "value", len(mesh.polygons), np.int32)
        slots = slots[polygons if faces is None else faces[polygons]]
        return points, triangles, self._material_indices[np.clip(slots, 0, len(self._material_indices) - 1)]


def _array(collection, name, count, kind, width=1):
    found = np.empty((count, width) if width > 1 else count, kind)
    collection.foreach_get(name, found.ravel())
    return found
