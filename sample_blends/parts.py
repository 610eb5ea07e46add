# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sample scenes are built from: materials, boxes, lights, a camera, render settings. Metres, watts,
radians."""

from math import cos, pi, radians, sin

import bpy
from bpy_extras import anim_utils
from mathutils import Vector


def empty_scene(name):
    """Empty the file, keeping the enabled extensions; return its one scene, named `name`, with a black world."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.name = name
    scene.world = bpy.data.worlds.new("World")
    sky(scene, (0, 0, 0), 0)
    # An empty file can hold scraps of the startup file; they would be saved with the sample.
    bpy.data.orphans_purge(do_recursive=True)
    return scene


def render_settings(scene, *, transform="AgX", look="AgX - Medium High Contrast", exposure=0.0):
    """EEVEE without its own ray tracing, which would count the bounce twice; 1280x720, 32 samples."""
    scene.render.engine = "BLENDER_EEVEE"
    scene.render.resolution_x, scene.render.resolution_y = 1280, 720
    scene.eevee.taa_render_samples = 32
    scene.eevee.use_raytracing = False
    # The default cuts a light off where it is still easy to see once the picture has no black shadows.
    scene.eevee.light_threshold = 0.0005
    scene.view_settings.view_transform = transform
    scene.view_settings.look = look
    scene.view_settings.exposure = exposure


def sky(scene, color, strength):
    """A world of one colour. EEVEE does not occlude it, so the interiors keep it black."""
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    return background


def diffuse(name, color):
    """A matt material. Specular is off: the bounce is what these scenes are about, and it is diffuse."""
    material = bpy.data.materials.new(name)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    shader.inputs["Roughness"].default_value = 1
    shader.inputs["Specular IOR Level"].default_value = 0
    material.diffuse_color = (*color, 1)
    return material


def glossy(name, color, roughness, metallic=0.0):
    """A plastic, or a metal, of this roughness."""
    material = bpy.data.materials.new(name)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Metallic"].default_value = metallic
    material.diffuse_color = (*color, 1)
    material.roughness, material.metallic = roughness, metallic
    return material


def glowing(name, color, strength):
    """A black body that shines: emission of `color` times `strength` W sr^-1 m^-2."""
    material = diffuse(name, (0, 0, 0))
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Emission Color"].default_value = (*color, 1)
    shader.inputs["Emission Strength"].default_value = strength
    return material


def place(name, data, material=None, location=(0, 0, 0), rotation=(0, 0, 0)):
    """Link an object that shows `data`; rotation in degrees."""
    thing = bpy.data.objects.new(name, data)
    thing.location = location
    thing.rotation_euler = [radians(angle) for angle in rotation]
    if material is not None and not data.materials:
        data.materials.append(material)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def mesh(name, vertices, faces, smooth=False):
    """A mesh datablock from lists of points and of faces."""
    data = bpy.data.meshes.new(name)
    data.from_pydata([tuple(map(float, v)) for v in vertices], [], faces)
    if smooth:
        data.shade_smooth()
    data.update()
    return data


def box(name, material, low, high, turn=0.0, bevel=0.0):
    """A box from corner `low` to corner `high`, turned by `turn` degrees about its own upright axis."""
    low, high = Vector(low), Vector(high)
    half = (high - low) / 2
    corners = [(x * half.x, y * half.y, z * half.z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    thing = place(name, mesh(name, corners, faces), material, (low + high) / 2, (0, 0, turn))
    if bevel:
        modifier = thing.modifiers.new("Bevel", "BEVEL")
        modifier.width, modifier.segments = bevel, 3
        thing.data.shade_smooth()
        modifier.harden_normals = True
    return thing


def turned(name, material, profile, location=(0, 0, 0), around=48):
    """A smooth surface of revolution about z; profile: (radius, height) from one end to the other, the outside to its
    right."""
    angles = [2 * pi * step / around for step in range(around)]
    vertices = [(radius * cos(angle), radius * sin(angle), height) for radius, height in profile for angle in angles]
    faces = [
        (
            ring * around + step,
            ring * around + (step + 1) % around,
            (ring + 1) * around + (step + 1) % around,
            (ring + 1) * around + step,
        )
        for ring in range(len(profile) - 1)
        for step in range(around)
    ]
    thing = place(name, mesh(name, vertices, faces, smooth=True), material, location)
    thing.data.set_sharp_from_angle(angle=radians(40))
    return thing


def ball(name, material, location, radius, around=48):
    """A smooth ball."""
    steps = around // 2
    return turned(
        name,
        material,
        [(radius * sin(pi * step / steps), -radius * cos(pi * step / steps)) for step in range(steps + 1)],
        location,
        around,
    )


def quad(name, material, corners):
    """A rectangle from four corners, counter-clockwise seen from its front."""
    return place(name, mesh(name, corners, [(0, 1, 2, 3)]), material)


def light_data(kind, name, color, energy, **settings):
    """Light datablock; energy in watts, for a sun in W/m^2."""
    data = bpy.data.lights.new(name, kind)
    data.color, data.energy = color, energy
    for key, value in settings.items():
        setattr(data, key, value)
    return data


def aim(location, target, axis="-Z", up="Y"):
    """Euler angles, in degrees, that turn `axis` from `location` towards `target`."""
    turn = (Vector(target) - Vector(location)).to_track_quat(axis, up).to_euler()
    return [angle * 180 / 3.141592653589793 for angle in turn]


def camera(scene, location, target, lens):
    """The scene's camera; lens in millimetres on a 36 mm sensor."""
    data = bpy.data.cameras.new("Camera")
    data.lens, data.clip_start, data.clip_end = lens, 0.05, 100
    scene.camera = place("Camera", data, None, location, aim(location, target))
    return scene.camera


def wall(name, material, start, end, height, openings=(), thick=0.1):
    """An upright wall along x or y, `thick` in the middle between (x, y) `start` and `end`, with openings in it.

    openings: (from, to, sill, lintel), the first two along the wall from `start`, the others above the floor."""
    along = 0 if abs(end[0] - start[0]) > abs(end[1] - start[1]) else 1
    across, side = start[1 - along], thick / 2
    length = abs(end[along] - start[along])
    edges = sorted({0, length, *(edge for opening in openings for edge in opening[:2])})
    origin = min(start[along], end[along])
    for low, high in zip(edges, edges[1:]):
        gap = next((each for each in openings if each[0] <= low and high <= each[1]), None)
        spans = [(0, height)] if gap is None else [(0, gap[2]), (gap[3], height)]
        for bottom, top in spans:
            if top > bottom:
                first, second = (origin + low, across - side), (origin + high, across + side)
                box(name, material, (*first[:: 1 - 2 * along], bottom), (*second[:: 1 - 2 * along], top))


def shot(scene, frames=24, **settings):
    """render_settings() of a moving shot: frames 1 to `frames`, 24 a second."""
    render_settings(scene, **settings)
    scene.frame_start, scene.frame_end = 1, frames
    scene.render.fps = 24
    # The world is black: on a processor its probe costs more than all else in a small frame.
    scene.world.probe_resolution = "128"


def animate(thing, path, keys, interpolation="LINEAR"):
    """Keyframes on the property `path` of an object, bone, lamp or shape: {frame: value}, a vector's or a number."""
    for frame, value in keys.items():
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)
    data, owner = thing.id_data.animation_data, thing.path_from_id(path)
    for curve in anim_utils.action_get_channelbag_for_slot(data.action, data.action_slot).fcurves:
        if curve.data_path == owner:
            for point in curve.keyframe_points:
                point.interpolation = interpolation
