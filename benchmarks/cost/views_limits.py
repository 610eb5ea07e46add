# SPDX-License-Identifier: GPL-3.0-or-later
"""What placing views takes in scenes that are hard on it.

    .venv/bin/python -m benchmarks.cost.views_limits [CASE ...]

Prints a table: seconds to place the views and again in the next frame where nothing has changed, and the share of light
that the main view and all views see. Cases: polygons, subdivided, instances, crowd, objects, balls, lamps,
outdoors."""

import argparse

import session

afterlight = session.enable_afterlight()

import bpy
import numpy as np

import scenes


def grid(side, size, rough=0.1):
    """A mesh of 2 * side**2 triangles, uneven, so that rays find no plane."""
    mesh = bpy.data.meshes.new("Grid")
    line = np.linspace(-size, size, side + 1)
    x, y = np.meshgrid(line, line)
    z = rough * np.sin(7 * x / size) * np.cos(5 * y / size) * size
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    quads = np.stack([corner, corner + 1, corner + side + 2, corner + side + 1], -1)
    mesh.vertices.add(x.size)
    mesh.vertices.foreach_set("co", np.stack([x, y, z], -1).ravel())
    mesh.loops.add(quads.size)
    mesh.loops.foreach_set("vertex_index", quads.ravel().astype(np.int32))
    mesh.polygons.add(len(quads))
    mesh.polygons.foreach_set("loop_start", np.arange(0, quads.size, 4, dtype=np.int32))
    mesh.update(calc_edges=True)
    return mesh


def polygons(scene):
    """Three million, in one object."""
    scenes.put(grid(1225, 1.8), (0, 0, -1.2))


def instances(scene):
    """Ten thousand instances of one mesh by geometry nodes, and the faces of a grid they stand on."""
    group = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    start, end, scatter, ball, join = map(
        group.nodes.new,
        (
            "NodeGroupInput",
            "NodeGroupOutput",
            "GeometryNodeInstanceOnPoints",
            "GeometryNodeMeshIcoSphere",
            "GeometryNodeJoinGeometry",
        ),
    )
    ball.inputs["Radius"].default_value = 0.01
    for source, target in (
        (start.outputs[0], scatter.inputs[0]),
        (ball.outputs[0], scatter.inputs["Instance"]),
        (scatter.outputs[0], join.inputs[0]),
        (start.outputs[0], join.inputs[0]),
        (join.outputs[0], end.inputs[0]),
    ):
        group.links.new(source, target)
    scenes.put(grid(99, 1.8), (0, 0, -1.2)).modifiers.new("Scatter", "NODES").node_group = group


def crowd(scene):
    """A hundred thousand cubes on the vertices of a mesh."""
    line = np.linspace(-1.8, 1.8, 316)
    points = np.stack([*np.meshgrid(line, line), np.full((316, 316), -1.3)], -1).reshape(-1, 3)
    mesh = bpy.data.meshes.new("Points")
    mesh.from_pydata(points.tolist(), [], [])
    parent = scenes.put(mesh)
    parent.instance_type = "VERTS"
    bpy.ops.mesh.primitive_cube_add(size=0.01)
    bpy.context.object.parent = parent


def subdivided(scene):
    """1.3 million polygons by Subdivision modifiers of the walls, and two million of a head."""
    bpy.ops.mesh.primitive_monkey_add(size=1, location=(0.5, 0.5, -0.5))
    for thing in [thing for thing in scene.objects if thing.type == "MESH"]:
        modifier, is_head = thing.modifiers.new("Finer", "SUBSURF"), thing == bpy.context.object
        modifier.subdivision_type = "CATMULL_CLARK" if is_head else "SIMPLE"
        modifier.levels = modifier.render_levels = 6 if is_head else 9


def balls(scene):
    """Four hundred meshes of 600 polygons."""
    rng = np.random.default_rng(0)
    for _ in range(400):
        bpy.ops.mesh.primitive_uv_sphere_add(
            segments=30,
            ring_count=20,
            radius=rng.uniform(0.03, 0.2),
            location=rng.uniform((-1.9, -1.9, -1.4), (1.9, 1.9, 1.4)),
        )


def objects(scene):
    """Three thousand objects."""
    mesh = grid(4, 0.03)
    for place in np.random.default_rng(0).uniform((-1.9, -1.9, -1.4), (1.9, 1.9, 1.4), (3000, 3)):
        scenes.put(mesh, place)


def lamps(scene):
    """Sixty lamps."""
    data = bpy.data.lights["Lamp"]
    for place in np.random.default_rng(0).uniform((-1.9, -1.9, 0), (1.9, 1.9, 1.4), (60, 3)):
        scenes.put(data, place)


def outdoors(scene):
    """Ground of 20 km with 400 houses near its middle, under the sun."""
    for thing in [thing for thing in scene.objects if thing.type != "CAMERA"]:
        bpy.data.objects.remove(thing)
    scenes.put(grid(100, 10000, 0.002))
    house = bpy.data.meshes.new("House")
    corners = [(x, y, z) for z in (0, 12) for x, y in ((-5, -5), (5, -5), (5, 5), (-5, 5))]
    house.from_pydata(corners, [], [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)])
    for x, y in np.ndindex(20, 20):
        scenes.put(house, (20 * x - 190, 20 * y - 190, 0))
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy = 5
    scenes.put(sun, (0, 0, 50), (50, 0, 30))
    scene.camera.location, scene.camera.data.clip_end = (0, -200, 1.7), 50000


CASES = {case.__name__: case for case in (polygons, subdivided, instances, crowd, objects, balls, lamps, outdoors)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", default=list(CASES))
    status, views = afterlight.addon.host.report, afterlight.addon.compositor.view_scenes
    print("| case | placing, s | again, s | main view | all views | views |\n|---|---|---|---|---|---|")
    for name in parser.parse_args().cases:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        scene = scenes.box(bpy.context.scene, samples=1)
        CASES[name](scene)
        scene.afterlight.method, scene.afterlight.views, scene.afterlight.enabled = "RADIOSITY", "AUTOMATIC", True
        bpy.ops.render.render()
        (shares, first), warnings = status.coverage(scene), status.warnings(scene)
        bpy.ops.render.render()
        _, again = status.coverage(scene)
        print(
            f"| {name} | {first:.2f} | {again:.2f} | {shares[0]:.0%} | {shares[-1]:.0%} | "
            f"{len(views.stored_placement(scene).poses)} |",
            *warnings,
            scene.afterlight.report,
            flush=True,
        )


if __name__ == "__main__":
    main()
