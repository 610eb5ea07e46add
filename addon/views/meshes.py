# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes and lamps of an evaluated depsgraph, read with as few calls per instance as possible."""

from dataclasses import dataclass

import numpy as np

from ..scene import materials
from . import proxy_mesh


@dataclass(frozen=True, eq=False)
class SceneMeshes:
    """meshes: [Mesh]. mesh_indices: (N,) int, index into meshes of each instance. to_world: (N, 4, 4), the instances'
    matrices. materials: [materials.MaterialSummary] of all meshes. lamps: [(bpy light, (4, 4) matrix)]."""

    meshes: list
    mesh_indices: np.ndarray
    to_world: np.ndarray
    materials: list
    lamps: list


def read(depsgraph):
    """SceneMeshes of everything that EEVEE draws and that is not transparent. The meshes and lamps must not outlive the
    depsgraph's evaluation."""
    kinds, kind_of_data, found_meshes, materials_table, lamp_indices = [], {}, [], _MaterialTable(), []
    for instance in depsgraph.object_instances:
        instance_object = instance.object
        data = instance_object.data
        kind = NOTHING if data is None else kind_of_data.get(data.as_pointer())
        if kind is None:
            kind = kind_of_data[data.as_pointer()] = _add_object(instance_object, found_meshes, materials_table)
        if kind == LAMP:
            lamp_indices.append((data, len(kinds)))
        kinds.append(kind)
    to_world, shown = np.empty((len(kinds), 4, 4), np.float32), np.empty(len(kinds), bool)
    depsgraph.object_instances.foreach_get("matrix_world", to_world.ravel())
    depsgraph.object_instances.foreach_get("show_self", shown)
    to_world, kinds = to_world.transpose(0, 2, 1).astype(float), np.array(kinds, int)  # Blender stores columns
    is_drawn = (kinds >= 0) & shown & np.isfinite(to_world).all((1, 2))
    return SceneMeshes(
        found_meshes,
        kinds[is_drawn],
        to_world[is_drawn],
        materials_table.summaries,
        [(data, to_world[index]) for data, index in lamp_indices],
    )


NOTHING, LAMP = -1, -2  # kinds of instances that have no index into meshes


def _add_object(evaluated_object, found_meshes, materials_table):
    """The index of an object's mesh in `found_meshes`, which it is appended to; LAMP or NOTHING for other objects."""
    if evaluated_object.type == "LIGHT":
        return LAMP
    if evaluated_object.type != "MESH" or not len(evaluated_object.data.polygons):
        return NOTHING
    indices = [materials_table.index(slot.material) for slot in evaluated_object.material_slots]
    if indices and all(materials_table.summaries[each].passes_light for each in indices):
        return NOTHING
    corners = np.array(evaluated_object.bound_box)
    found_meshes.append(
        Mesh(
            evaluated_object.data,
            np.array(indices or [materials_table.index(None)]),
            np.array((corners.min(0), corners.max(0))),
        )
    )
    return len(found_meshes) - 1


class _MaterialTable:
    """Summaries of materials, one of each."""

    def __init__(self):
        self.summaries, self._known = [], {}

    def index(self, material):
        if material not in self._known:
            self._known[material] = len(self.summaries)
            self.summaries.append(materials.summarize(material) if material else materials.MaterialSummary())
        return self._known[material]


class Mesh:
    """A mesh to be simplified. material_indices: (slots,) int, into SceneMeshes.materials. bounds: (2, 3), its bounding
    box."""

    def __init__(self, mesh, material_indices, bounds):
        self._mesh, self._material_indices, self.bounds = mesh, material_indices, bounds
        self.triangle_count = len(mesh.loops) - 2 * len(mesh.polygons)  # of the whole mesh

    def simplify(self, max_triangles):
        """(points (V, 3), triangles (T, 3), material indices (T,)): about `max_triangles` triangles, or all."""
        mesh = self._mesh
        points = _array(mesh.attributes["position"].data, "vector", len(mesh.vertices), np.float32, 3)
        corners = _array(mesh.attributes[".corner_vert"].data, "value", len(mesh.loops), np.int32)
        starts = _array(mesh.polygons, "loop_start", len(mesh.polygons), np.int32)
        faces = None
        # A polygon of more than four corners may be concave, and a fan of triangles could leave it.
        if np.diff(starts, append=len(corners)).max() > 4:
            faces = _array(mesh.loop_triangles, "polygon_index", self.triangle_count, np.int32)
            corners = _array(mesh.loop_triangles, "vertices", self.triangle_count, np.int32, 3).ravel()
            starts = np.arange(0, len(corners), 3)
        points, triangles, polygons = proxy_mesh.simplify(points, corners, starts, self.bounds, max_triangles)
        slots = mesh.attributes.get("material_index")
        if len(self._material_indices) < 2 or slots is None:
            return points, triangles, np.full(len(triangles), self._material_indices[0])
        slots = _array(slots.data, "value", len(mesh.polygons), np.int32)
        slots = slots[polygons if faces is None else faces[polygons]]
        return points, triangles, self._material_indices[np.clip(slots, 0, len(self._material_indices) - 1)]


def _array(collection, name, count, kind, width=1):
    values = np.empty((count, width) if width > 1 else count, kind)
    collection.foreach_get(name, values.ravel())
    return values
