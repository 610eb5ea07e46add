# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of benchmarks.cost.tick: one closed room, in which a single thing grows from case to case.

    SERIES = {series: {case: build(scene)}}

Each build() adds to a scene that empty_room() has made."""

from functools import partial
from math import cos, pi, sin

import numpy as np

from .boxes import box, link, put

ROOM = np.array([[-4.0, -5.0, 0.0], [4.0, 5.0, 3.0]])  # opposite corners, m
BLOCKS = ((-2.4, 1.6, 0.8), (0.2, 0.4, 0.6), (2.2, 2.2, 0.9))  # place on the floor and half a side, m
COLORS = (0.7, 0.68, 0.65, 1), (0.7, 0.2, 0.1, 1), (0.2, 0.4, 0.7, 1), (0.6, 0.6, 0.2, 1)
POWER = 400.0  # of all lamps together, W
POLYGONS = 1_000, 30_000, 300_000, 3_000_000
OBJECTS = 1, 50, 500, 2000
TEXTURES = 0, 10, 30, 100
LAMPS = 1, 10, 100
VIEWS = 0, 1, 3, 5, 7
TEXTURE_SIZE = 2048
EACH = 1000  # polygons of an instanced mesh, about
FRAMES = 6  # of an animation


def empty_room(size, lamps=1):
    """A scene in an empty file: the room, its camera and so many lamps; size: of its frames."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.name = "Tick"
    scene.render.engine = "BLENDER_EEVEE"
    scene.eevee.use_raytracing = False
    scene.render.resolution_x, scene.render.resolution_y = size
    put("Room", box(*ROOM, 1, inside=True), COLORS[0])
    for index in range(lamps):
        light = bpy.data.lights.new("Lamp", "POINT")
        light.energy, light.shadow_soft_size = POWER / lamps, 0.1
        across = int(np.ceil(lamps**0.5))
        place = (index % across + 0.5) / across, (index // across + 0.5) / across
        link(bpy.data.objects.new("Lamp", light), (-3 + 6 * place[0], -4 + 8 * place[1], 2.7))
    scene.camera = link(bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera")), (0, -4.7, 1.5))
    scene.camera.rotation_euler = pi / 2, 0, 0
    scene.camera.data.lens = 22
    return scene


def blocks(side):
    """The three blocks that stand on the floor."""
    return [
        put("Block", box((x - half, y - half, 0), (x + half, y + half, 2 * half), side), color)
        for (x, y, half), color in zip(BLOCKS, COLORS[1:], strict=True)
    ]


def as_mesh(polygons, scene):
    blocks(round((polygons / (6 * len(BLOCKS))) ** 0.5))


def by_modifiers(polygons, scene):
    levels = max(0, round(np.log(polygons / (18 * 36)) / np.log(4)))
    for thing in blocks(max(1, round((polygons / 18 / 4**levels) ** 0.5))):
        modifier = thing.modifiers.new("Subdivision", "SUBSURF")
        modifier.subdivision_type, modifier.levels, modifier.render_levels = "SIMPLE", levels, levels


def by_instances(polygons, scene):
    """Small blocks, one mesh, on the points of a grid, by geometry nodes."""
    import bpy

    count = max(1, round(polygons / EACH))
    across = int(np.ceil(count**0.5))
    step = 6.0 / across
    small = put("Small", box(*[np.full(3, 0.4 * step * end) for end in (-1, 1)], round((EACH / 6) ** 0.5)), COLORS[1])
    small.hide_render = small.hide_viewport = True
    places = [(-3 + step * (k % across + 0.5), -2.5 + step * (k // across + 0.5), 0.4 * step) for k in range(count)]
    grid = bpy.data.meshes.new("Grid")
    grid.from_pydata(places, [], [])
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    for in_out in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    kinds = "NodeGroupInput", "GeometryNodeObjectInfo", "GeometryNodeInstanceOnPoints", "NodeGroupOutput"
    points, info, instance, output = map(tree.nodes.new, kinds)
    info.inputs["Object"].default_value = small
    tree.links.new(points.outputs[0], instance.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], instance.inputs["Instance"])
    tree.links.new(instance.outputs[0], output.inputs[0])
    link(bpy.data.objects.new("Grid", grid)).modifiers.new("Scatter", "NODES").node_group = tree


def objects(count, scene):
    """Blocks in rows, each an object with a mesh of its own and one of four materials."""
    import bpy

    across = int(np.ceil(count**0.5))
    step = 6.0 / across
    materials = []
    for index in range(count):
        half = np.array([0.3 * step, 0.3 * step, 0.4])
        mesh = box(-half, half, 2)
        place = (-3 + step * (index % across + 0.5), -2.5 + step * (index // across + 0.5), 0.4)
        if len(materials) < len(COLORS):
            materials.append(put("Block", mesh, COLORS[len(materials)], place).active_material)
        else:
            mesh.materials.append(materials[index % len(materials)])
            link(bpy.data.objects.new("Block", mesh), place)


def textures(count, scene):
    """A hundred blocks, of which so many have a texture of their own."""
    import bpy

    objects(max(TEXTURES), scene)
    things = [thing for thing in scene.objects if thing.name.startswith("Block")]
    for index, thing in enumerate(things[:count]):
        image = bpy.data.images.new("Texture", TEXTURE_SIZE, TEXTURE_SIZE)
        image.generated_type, image.generated_color = "COLOR_GRID", COLORS[index % len(COLORS)]
        material = bpy.data.materials.new("Textured")
        tree = material.node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
        thing.data.materials[0] = material


def views(count, scene):
    """Cameras of the user's as views, all over the room: as many as wanted, whatever they see."""
    import bpy

    objects(50, scene)
    settings = scene.afterlight
    settings.views = "MANUAL" if count else "CAMERA"
    for index in range(count):
        angle = 2 * pi * index / count
        camera = link(bpy.data.objects.new("View", bpy.data.cameras.new("View")), (3 * cos(angle), 4 * sin(angle), 1.5))
        camera.rotation_euler = pi / 2, 0, angle + pi / 2
        camera.data.lens = 18
        settings.view_cameras.add().camera = camera


def moving(what, scene):
    """An animation in which nothing moves, or only the camera, only the lamp, or everything."""
    objects(50, scene)
    scene.frame_start, scene.frame_end = 1, FRAMES
    lamp = next(thing for thing in scene.objects if thing.type == "LIGHT")
    others = [thing for thing in scene.objects if thing.name.startswith("Block")]
    moved = {"nothing": [], "camera": [scene.camera], "lamp": [lamp], "everything": [scene.camera, lamp, *others]}
    for thing in moved[what]:
        for frame in (1, FRAMES):
            thing.location.x += 0.02 * frame
            thing.keyframe_insert("location", index=0, frame=frame)


SERIES = {
    "polygons, as mesh": {f"{number:,}": partial(as_mesh, number) for number in POLYGONS},
    "polygons, by modifiers": {f"{number:,}": partial(by_modifiers, number) for number in POLYGONS},
    "polygons, by instances": {f"{number:,}": partial(by_instances, number) for number in POLYGONS},
    "objects": {f"{number:,}": partial(objects, number) for number in OBJECTS},
    "textures": {f"{number}": partial(textures, number) for number in TEXTURES},
    "lamps": {f"{number}": partial(objects, 50) for number in LAMPS},
    "views": {f"{number}": partial(views, number) for number in VIEWS},
    "animation": {what: partial(moving, what) for what in ("nothing", "camera", "lamp", "everything")},
}


def build(series, case, size):
    """The scene of a case, in an empty file. Returns it and the number of its polygons as they are rendered."""
    import bpy

    scene = empty_room(size, lamps=int(case) if series == "lamps" else 1)
    SERIES[series][case](scene)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    seen = [each.object for each in depsgraph.object_instances if each.object.type == "MESH"]
    return scene, sum(len(thing.data.polygons) for thing in seen)
