# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures for materials, drawn with numpy from fixed seeds and packed into the file as small as they can be.

A pattern is (color, height, roughness): floats from 0 to 1, the colour as it is shown (sRGB); all of them tile."""

import math
import tempfile
from pathlib import Path

import bpy
import numpy as np

KINDS = {"JPEG": "jpg", "PNG": "png", "OPEN_EXR": "exr"}


def packed(name, pixels, *, data=False, quality=75, kind="JPEG"):
    """An image with `pixels` (rows from the bottom, RGB or RGBA) packed into the file; `data`: not a colour."""
    pixels = np.asarray(pixels, np.float32)
    if pixels.ndim == 2:
        pixels = np.repeat(pixels[..., None], 3, axis=2)
    height, width, channels = pixels.shape
    whole = np.ones((height, width, 4), np.float32)
    whole[..., :channels] = pixels
    drawn = bpy.data.images.new(name, width, height, alpha=channels == 4, float_buffer=kind == "OPEN_EXR")
    drawn.pixels.foreach_set(whole.ravel())
    drawn.file_format = kind
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"{name.replace(' ', '_').lower()}.{KINDS[kind]}")
        drawn.save(filepath=str(path), quality=quality)
        bpy.data.images.remove(drawn)
        image = bpy.data.images.load(str(path))
        image.pack()
        image.name, image.filepath = name, f"//textures/{path.name}"
        image.packed_files[0].filepath = image.filepath
    if data:
        image.colorspace_settings.name = "Non-Color"
    return image


def noise(size, cells, seed, octaves=4, stretch=1):
    """Smooth noise from 0 to 1 that tiles; `cells` across the picture, `stretch` times fewer of them along it."""
    chance, total, weight = np.random.default_rng(seed), np.zeros((size, size)), 1.0
    for _ in range(octaves):
        rows, columns = max(1, min(cells, size)), max(1, min(cells // stretch, size))
        grid = chance.random((rows, columns))
        for axis, count in ((0, rows), (1, columns)):
            at = np.arange(size) * count / size
            low = at.astype(int)
            part = at - low
            part = (part * part * (3 - 2 * part)).reshape((-1, 1) if axis == 0 else (1, -1))
            grid = np.take(grid, low, axis) * (1 - part) + np.take(grid, (low + 1) % count, axis) * part
        total += weight * grid
        weight, cells = weight / 2, cells * 2
    total -= total.min()
    return total / total.max()


def normals(height, depth):
    """The normal map of a height that tiles; `depth`: of the whole height, in widths of the picture."""
    size = len(height)
    slope = [(np.roll(height, -1, axis) - np.roll(height, 1, axis)) * depth * size / 2 for axis in (1, 0)]
    normal = np.stack([-slope[0], -slope[1], np.ones_like(height)], axis=2)
    return normal / np.linalg.norm(normal, axis=2, keepdims=True) / 2 + 0.5


def _cells(size, rows, columns, shift, gap):
    """Bricks: (row, column of each pixel, how far inside its brick: 0 in the gap to 1)."""
    y, x = np.mgrid[0:size, 0:size] / size
    row = np.floor(y * rows).astype(int)
    along = x * columns + shift * row
    column = np.floor(along).astype(int) % columns
    from_edge = np.minimum(
        np.minimum(along % 1, 1 - along % 1) / columns, np.minimum(y * rows % 1, 1 - y * rows % 1) / rows
    )
    return row, column, np.clip((from_edge - gap / 2) / gap, 0, 1)


def _mix(first, second, part):
    return first + (np.asarray(second) - first) * part[..., None]


def bricks(size, seed=1, rows=12, columns=4, color=(0.55, 0.27, 0.18), mortar=(0.62, 0.58, 0.52), gap=0.008):
    """A wall of bricks in running bond, each of its own shade, chipped at the edges."""
    row, column, inside = _cells(size, rows, columns, 0.5, gap)
    shade = np.random.default_rng(seed).random((rows, columns))[row, column]
    rough = noise(size, 16, seed + 1, 5)
    inside = np.clip(inside * 1.5 - 0.5 * rough, 0, 1)
    brick = np.asarray(color) * (0.7 + 0.45 * shade + 0.35 * (rough - 0.5))[..., None]
    brick[..., 1] *= 0.9 + 0.2 * shade
    height = inside * (0.75 + 0.1 * shade) + 0.15 * rough
    return (
        np.clip(_mix(np.asarray(mortar) * (0.8 + 0.3 * rough)[..., None], brick, inside), 0, 1),
        height,
        0.95 - 0.25 * (inside * shade),
    )


def planks(size, seed=2, boards=8, color=(0.50, 0.33, 0.20), shine=0.3):
    """Floor boards along x, with grain, in two lengths of the picture's width."""
    row, column, inside = _cells(size, boards, 2, 0.37, 0.0025)
    shade = np.random.default_rng(seed).random((boards, 2))[row, column]
    grain = noise(size, 64, seed + 1, 4, stretch=16)
    grain = np.take_along_axis(grain, (np.mgrid[0:size, 0:size][1] + (size * shade).astype(int)) % size, 1)
    color = np.asarray(color) * (0.62 + 0.42 * shade + 0.5 * (grain - 0.4))[..., None]
    return np.clip(_mix(color * 0.25, color, inside), 0, 1), 0.8 * inside + 0.2 * grain, shine + 0.3 * grain


def plaster(size, seed=3, color=(0.86, 0.83, 0.78), stains=0.08):
    """Trowelled plaster, faintly stained."""
    broad, fine = noise(size, 4, seed, 3), noise(size, 24, seed + 1, 5)
    tone = 1 - stains * broad - 0.05 * fine
    return np.clip(np.asarray(color) * tone[..., None], 0, 1), 0.6 * broad + 0.4 * fine, 0.75 + 0.2 * fine


def tiles(size, seed=4, count=6, colors=((0.75, 0.70, 0.62), (0.65, 0.58, 0.49)), gap=0.006, joint=0.45):
    """Square tiles in colours that are drawn for each, with dark joints."""
    row, column, inside = _cells(size, count, count, 0, gap)
    chance, speck = np.random.default_rng(seed), noise(size, 32, seed + 1, 4)
    palette = np.asarray(colors)[chance.integers(len(colors), size=(count, count))]
    palette = palette * chance.uniform(0.85, 1.1, (count, count, 1))
    color = palette[row, column] * (0.85 + 0.3 * speck)[..., None]
    return (
        np.clip(_mix(color * joint, color, inside), 0, 1),
        inside + 0.08 * speck,
        0.25 + 0.35 * speck + 0.3 * (1 - inside),
    )


def weave(size, seed=5, threads=48, color=(0.45, 0.44, 0.42), second=None):
    """Cloth: threads over and under each other; `second`: the colour of every other band of eight threads."""
    y, x = np.mgrid[0:size, 0:size] * threads / size
    over = (np.floor(x) + np.floor(y)) % 2
    height = np.where(over, np.abs(np.sin(math.pi * y)), np.abs(np.sin(math.pi * x)))
    tone = 0.6 + 0.35 * height + 0.2 * noise(size, threads // 2, seed, 3)
    base = np.broadcast_to(np.asarray(color), (size, size, 3))
    if second is not None:
        base = np.where((np.floor(y / 8) % 2)[..., None], np.asarray(second), base)
    return np.clip(base * tone[..., None], 0, 1), height, np.full((size, size), 0.9)


def leaf(size=128, color=(0.25, 0.42, 0.12)):
    """A leaf on nothing, its stalk at the bottom: RGBA."""
    y, x = np.mgrid[0:size, 0:size] / size
    middle = x - 0.5
    half = 0.36 * np.sin(math.pi * np.clip((y - 0.1) / 0.88, 0, 1) ** 0.8) * (1 + 0.06 * np.sin(60 * y))
    alpha = (np.abs(middle) < half) | ((np.abs(middle) < 0.012) & (y < 0.3))
    veins = np.maximum(np.exp(-((middle / 0.012) ** 2)), 0.6 * (np.sin(2 * math.pi * 9 * (y - np.abs(middle))) > 0.9))
    tone = 0.8 + 0.3 * noise(size, 8, 9, 3) + 0.25 * veins
    return np.dstack([np.clip(np.asarray(color) * tone[..., None], 0, 1), alpha])


def material(name, pattern, metres, *, depth=0.004, map_quality=70, quality=70, maps=True, kind="JPEG"):
    """A material with a pattern's colour, roughness and normal map; one picture covers `metres` of the UV map.

    depth: of the pattern's height, in metres; maps: False for the colour alone."""
    made = bpy.data.materials.new(name)
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    color, height, roughness = pattern
    made.diffuse_color = (*np.mean(color, axis=(0, 1)) ** 2.2, 1)
    mapping, source = nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Scale"].default_value = [1 / metres] * 3
    links.new(source.outputs["UV"], mapping.inputs["Vector"])

    def picture(suffix, pixels, data):
        node = nodes.new("ShaderNodeTexImage")
        node.image = packed(f"{name} {suffix}", pixels, data=data, quality=map_quality if data else quality, kind=kind)
        links.new(mapping.outputs["Vector"], node.inputs["Vector"])
        return node.outputs["Color"]

    links.new(picture("color", color, False), shader.inputs["Base Color"])
    if maps:
        links.new(picture("roughness", roughness, True), shader.inputs["Roughness"])
        bump = nodes.new("ShaderNodeNormalMap")
        links.new(picture("normal", normals(height, depth / metres), True), bump.inputs["Color"])
        links.new(bump.outputs["Normal"], shader.inputs["Normal"])
    else:
        shader.inputs["Roughness"].default_value = float(np.mean(roughness))
    return made


def unwrap(scene):
    """UV maps in metres for the meshes without one: each face from the side that it looks to."""
    for thing in scene.objects:
        if thing.type != "MESH" or thing.data.uv_layers or not thing.data.polygons:
            continue
        data = thing.data
        points = np.empty(len(data.vertices) * 3, np.float32)
        data.vertices.foreach_get("co", points)
        points = points.reshape(-1, 3) + np.asarray(thing.location, np.float32)
        layer = data.uv_layers.new(name="UVMap")
        for face in data.polygons:
            axis = int(np.argmax(np.abs(face.normal)))
            u, v = ((1, 2), (0, 2), (0, 1))[axis]
            for loop, vertex in zip(face.loop_indices, face.vertices):
                layer.data[loop].uv = (points[vertex][u], points[vertex][v])
