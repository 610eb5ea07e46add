# SPDX-License-Identifier: GPL-3.0-or-later
"""What the rooms of the benchmarks of cost are built of: boxes of any number of polygons, with diffuse materials."""

import numpy as np


def link(thing, location=(0, 0, 0)):
    import bpy

    thing.location = location
    bpy.context.scene.collection.objects.link(thing)
    return thing


def put(name, mesh, color, location=(0, 0, 0)):
    """An object with a diffuse material of its own."""
    import bpy

    material = bpy.data.materials.new(name)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value, shader.inputs["Roughness"].default_value = color, 1
    mesh.materials.append(material)
    return link(bpy.data.objects.new(name, mesh), location)


def box(low, high, side, inside=False):
    """A mesh of a box with side x side quadrilaterals on each face, with a UV map."""
    import bpy

    steps = np.linspace(0, 1, side + 1)
    u, v = (grid.ravel() for grid in np.meshgrid(steps, steps))
    corner = np.arange(side * (side + 1)).reshape(side, side + 1)[:, :-1].ravel()
    quads = np.stack([corner, corner + 1, corner + side + 2, corner + side + 1], -1)
    vertices, faces = [], []
    for axis in range(3):
        for end in (0.0, 1.0):
            outward = (end == 1.0) == (axis != 1)  # the order of a face's corners decides its normal
            faces.append((quads if outward != inside else quads[:, ::-1]) + len(u) * len(faces))
            vertices.append(np.insert(np.stack([u, v], -1), axis, end, axis=-1))
    mesh = bpy.data.meshes.new("Box")
    corners, order = np.concatenate(vertices), np.concatenate(faces)
    mesh.from_pydata(low + corners * (np.array(high) - low), [], order)
    flat = np.tile(np.stack([u, v], -1), (6, 1))[order.ravel()]
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", flat.astype(np.float32).ravel())
    return mesh
