# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames for the tests of the gather: synthetic ones, and one that EEVEE renders."""

import importlib
from functools import cache

import bpy
import gpu
import numpy as np

import scenes
from reference import paper as reference

BACKGROUND = np.float32(1e10)
ROTATION_LOOKING_DOWN_MINUS_Z = np.eye(3)


def camera_for(light, width, height, *, fov_x=1.0, shift=(0.0, 0.0), rotation=None, orthographic_width=None):
    """A Camera with square pixels. fov_x in radians; shift in view units at depth 1; orthographic_width in metres."""
    half = np.tan(fov_x / 2) if orthographic_width is None else orthographic_width / 2
    scale = np.array([2 * half / width, 2 * half / width])
    offset = np.array([-half, -half * height / width]) + np.asarray(shift)
    rotation = ROTATION_LOOKING_DOWN_MINUS_Z if rotation is None else rotation
    return light.Camera(
        rotation=np.asarray(rotation, float), scale=scale, offset=offset, orthographic=orthographic_width is not None
    )


def passes_from(light, depth, normal, diffuse_color, diffuse_direct, emission):
    """Passes (rows top first) from arrays (H, W) and (H, W, 3) whose first row is the bottom one."""

    def split(image):
        return tuple(np.ascontiguousarray(image[::-1, :, c], np.float32) for c in range(3))

    return light.Passes(
        np.ascontiguousarray(depth[::-1], np.float32),
        split(normal),
        split(diffuse_color),
        split(diffuse_direct),
        split(emission),
    )


def random_frame(light, width, height, seed=0, holes=0.1):
    """A bumpy landscape of random surfels with some background: no symmetry for an error to hide behind."""
    rng = np.random.default_rng(seed)
    depth = 3 + rng.uniform(0, 0.5, (height, width)) + np.linspace(0, 1, width)
    depth[rng.uniform(size=depth.shape) < holes] = BACKGROUND
    normal = rng.normal(size=(height, width, 3)) * 0.5 + (0, 0, 1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    color, direct, emission = (rng.uniform(0, 1, (height, width, 3)) for _ in range(3))
    return passes_from(light, depth, normal, color, direct, emission * (emission > 0.9))


def box_frame(light, width, height, *, radiance=None, albedo=0.7):
    """A camera at the middle of the back of a closed box, 2 x 2 x 4 m, traced exactly.

    radiance: None for a lamp-like falloff on coloured walls, or a constant for a white furnace (then L = radiance)."""
    camera = camera_for(light, width, height, fov_x=1.6)
    i, j = np.meshgrid(np.arange(width), np.arange(height))
    ray = np.stack(
        [
            camera.offset[0] + camera.scale[0] * (i + 0.5),
            camera.offset[1] + camera.scale[1] * (j + 0.5),
            np.full(i.shape, -1.0),
        ],
        -1,
    )
    walls = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1]], float)  # outward normals
    distances = np.array([1, 1, 1, 1, 3.0])
    slope = ray @ walls.T
    depth = np.where(slope > 1e-9, distances / np.maximum(slope, 1e-9), np.inf)
    wall = depth.argmin(-1)
    depth = depth.min(-1)
    place, normal = ray * depth[..., None], -walls[wall]
    color = np.array([[0.8, 0.1, 0.1], [0.1, 0.8, 0.1], [0.7] * 3, [0.7] * 3, [0.7] * 3])[wall]
    to_lamp = np.array([0, 0.8, -1.8]) - place
    square = (to_lamp**2).sum(-1)
    direct = np.maximum((normal * to_lamp).sum(-1), 0) / square**1.5
    direct = np.repeat(direct[..., None], 3, -1)
    emission = np.zeros_like(color)
    if radiance is not None:
        color, direct, emission = np.full_like(color, albedo), np.zeros_like(color), np.full_like(color, radiance)
    return passes_from(light, depth, normal, color, direct, emission), camera


def build_box_scene(width, height, samples):
    """A Cornell-like room with two solids and an emissive sign, seen by EEVEE without its own ray tracing."""
    from mathutils import Euler, Vector

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)  # keeps extensions enabled
    scene = bpy.context.scene

    def material(name, color, emission=0.0):
        made = scenes.matt(name, color)
        shader = made.node_tree.nodes["Principled BSDF"]
        shader.inputs["Roughness"].default_value = 1.0
        shader.inputs["Emission Color"].default_value = (*color, 1)
        shader.inputs["Emission Strength"].default_value = emission
        return made

    def add(name, vertices, faces, made, **where):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(vertices, [], faces)
        mesh.materials.append(made)
        thing = bpy.data.objects.new(name, mesh)
        for key, value in where.items():
            setattr(thing, key, value)
        scene.collection.objects.link(thing)

    corner = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    cube = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    white, red, green = (
        material("White", (0.75,) * 3),
        material("Red", (0.7, 0.06, 0.05)),
        material("Green", (0.1, 0.5, 0.1)),
    )
    for name, made, face in (
        ("Left", red, 0),
        ("Right", green, 1),
        ("Back", white, 3),
        ("Floor", white, 4),
        ("Ceiling", white, 5),
    ):
        add(name, [corner[k] for k in cube[face]], [(0, 1, 2, 3)], made)
    add("Tall", corner, cube, white, scale=(0.28, 0.28, 0.6), location=(-0.35, 0.35, -0.4), rotation_euler=(0, 0, 0.35))
    add(
        "Short", corner, cube, white, scale=(0.28, 0.28, 0.28), location=(0.4, -0.3, -0.72), rotation_euler=(0, 0, -0.3)
    )
    add(
        "Sign",
        [(-0.3, -0.98, 0.1), (0.3, -0.98, 0.1), (0.3, -0.98, 0.4), (-0.3, -0.98, 0.4)],
        [(0, 1, 2, 3)],
        material("Sign", (1, 0.6, 0.2), 4.0),
        location=(0, 1.95, 0),
    )

    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "AREA"))
    lamp.data.energy, lamp.data.size, lamp.location = 20, 0.5, (0, 0, 0.98)
    scene.collection.objects.link(lamp)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.sensor_width, camera.data.lens = 36, 32
    camera.location = Vector((0, -3.0, 0.1))
    camera.rotation_euler = Euler((np.pi / 2 - 0.03, 0, 0))
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "BLENDER_EEVEE"
    scene.eevee.taa_render_samples = samples
    scene.render.resolution_x, scene.render.resolution_y = width, height
    return scene


@cache
def rendered_box(light, width=160, height=90, samples=16):
    """(Passes, Camera) of the box scene as EEVEE renders it."""
    package = importlib.import_module(f"{light.__package__.rpartition('.')[0]}.scene")
    cameras, frame_store, passes = package.cameras, package.frame_store, package.passes
    scene = build_box_scene(width, height, samples)
    layer = scene.view_layers[0]
    for _, switch, _, _ in passes.PASSES:
        setattr(layer, switch, True)
    bpy.ops.render.render()
    path = frame_store.save(scene)
    rendered = passes.load(path, layer.name, cameras.window(scene)[0])
    frame_store.discard(path)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return rendered, cameras.camera(scene.camera.evaluated_get(depsgraph), depsgraph, scene)


def pyramid_of(light, passes, camera, settings):
    """The full pyramid of a frame, on the GPU."""
    pyramid = light.pack(light.upload(passes), passes, camera, settings)
    light.merge(pyramid)
    return pyramid


def level_of(image, pyramid, index):
    """The part of an image, laid out as the pyramid is, that belongs to one level."""
    x, y, width, height = pyramid.boxes[index]
    return image[y : y + height, x : x + width]


@cache
def halves_shader():
    info = gpu.types.GPUShaderCreateInfo()
    info.sampler(0, "UINT_2D", "source")
    info.image(0, "RGBA32F", "FLOAT_2D", "halves", qualifiers={"WRITE"})
    info.local_group_size(8, 8, 1)
    info.compute_source("""
        void main()
        {
          ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(source, 0);
          uvec4 bits = texelFetch(source, min(texel, size - 1), 0);
          if (texel.x < size.x && texel.y < size.y) {
            imageStore(halves, ivec2(2 * texel.x, texel.y), vec4(bits & 0xFFFFu));
            imageStore(halves, ivec2(2 * texel.x + 1, texel.y), vec4(bits >> 16u));
          }
        }""")
    return gpu.shader.create_from_info(info)


def bits_of(texture):
    """(H, W, 4) uint32 of a texture of integers. Blender reads textures as floats alone, so two make one integer."""
    halves = gpu.types.GPUTexture((2 * texture.width, texture.height), format="RGBA32F")
    shader = halves_shader()
    shader.bind()
    shader.uniform_sampler("source", texture.handle)
    shader.image("halves", halves)
    gpu.compute.dispatch(shader, -(-texture.width // 8), -(-texture.height // 8), 1)
    gpu.shader.unbind()
    read = np.array(halves.read()).astype(np.uint32)
    return read[:, 0::2] | read[:, 1::2] << 16


def level_arrays(pyramid, camera, start):
    """The levels of a pyramid on the GPU, each as a reference.Level."""
    bits = bits_of(pyramid.surfels)
    return [
        reference.unpack_surfel(level_of(bits, pyramid, index), camera, start << index)
        for index in range(len(pyramid.boxes))
    ]
