# SPDX-License-Identifier: GPL-3.0-or-later
"""Costs that must not grow with a scene: the time to place views with its instances and polygons, the memory with its
images."""

import subprocess
import sys
import time
from importlib import import_module

import bpy
import numpy as np
import OpenEXR
import pytest

from scenes import box, matt, put


@pytest.fixture
def scene(fresh):
    return box(fresh, samples=1)


@pytest.fixture
def ray_cast(afterlight):
    return afterlight.addon.views.ray_cast


@pytest.fixture
def proxy_mesh(ray_cast):
    return ray_cast.proxy_mesh


def seconds(call, times=2):
    """(least CPU seconds of several calls, the last result)."""
    taken = []
    for _ in range(times):
        start = time.process_time()
        given = call()
        taken.append(time.process_time() - start)
    return min(taken), given


def evaluated():
    bpy.context.view_layer.update()
    return bpy.context.evaluated_depsgraph_get()


def instances(count, size=0.01):
    """That many cubes, instanced in a square on the floor."""
    line = np.linspace(-1.8, 1.8, int(count**0.5))
    points = np.stack([*np.meshgrid(line, line), np.full((len(line), len(line)), -1.3)], -1).reshape(-1, 3)
    mesh = bpy.data.meshes.new("Points")
    mesh.from_pydata(points.tolist(), [], [])
    parent = put(mesh)
    parent.instance_type = "VERTS"
    bpy.ops.mesh.primitive_cube_add(size=size)
    bpy.context.object.parent = parent


def about(count=2000):
    """Rays from the middle of the box, in all directions."""
    directions = np.random.default_rng(0).normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return np.full((count, 3), (0.1, 0.2, 0.3)), directions, np.full(count, np.inf)


def place(ray_cast, placement, depsgraph):
    """Place views as the placement engine does, with the floor as what the main view shows."""
    geometry, rng = ray_cast.Geometry(depsgraph), np.random.default_rng(0)
    x, y = rng.uniform(-1, 1, (2, 500))
    starts, up = np.stack([x, y, np.full(500, -1.2)], -1), np.tile((0.0, 0, 1), (500, 1))

    def radiance(positions, normals, things):
        albedo, emission = geometry.albedo_and_emission(things)
        return ray_cast.direct_light(geometry, positions, normals, rng), albedo, emission

    light = placement.trace(starts, up, np.full(500, 0.8), geometry.cast, radiance, rng)
    half, unseen = (1.7, 1.7), np.zeros(len(light.positions), bool)
    poses = placement.place(light, unseen, geometry.cast, half, 3, rng)
    return placement.coverage(light, unseen, geometry.cast, half, poses)[-1]


def test_many_instances_cost_little(scene, ray_cast, afterlight):
    """Before, 2,000 instances took 2.3 seconds, and 20,000 took 14. Now 100,000 take at most one second more than none,
    on a busy machine two."""
    placement = afterlight.addon.views.placement
    depsgraph = evaluated()
    bare, sees = seconds(lambda: place(ray_cast, placement, depsgraph))
    instances(100_000)
    depsgraph = evaluated()
    full, still_sees = seconds(lambda: place(ray_cast, placement, depsgraph))
    assert full < 2 * bare + 2, (bare, full)
    assert sees > 0.95 and still_sees > 0.8


def test_heavy_meshes_cost_little_and_are_where_they_were(scene, ray_cast):
    """The walls of the box with 1.3 million polygons, seen from its middle."""
    plain = ray_cast.Geometry(evaluated())
    exact = plain.cast(*about())
    for thing in [thing for thing in scene.objects if thing.type == "MESH"]:
        modifier = thing.modifiers.new("Finer", "SUBSURF")
        modifier.subdivision_type, modifier.levels = "SIMPLE", 9
    depsgraph = evaluated()
    for thing in depsgraph.objects:  # Blender subdivides a mesh when it is first asked for
        assert thing.type != "MESH" or len(thing.data.polygons) == 2**18
    taken, (geometry, found) = seconds(
        lambda: (geometry := ray_cast.Geometry(depsgraph), geometry.cast(*about())), times=1
    )
    assert taken < 2
    assert (np.isfinite(found[0]) == np.isfinite(exact[0])).mean() > 0.999
    both = np.isfinite(found[0]) & np.isfinite(exact[0])
    assert np.allclose(found[0][both], exact[0][both], atol=1e-3)
    assert np.abs(np.sum(found[1] * exact[1], 1))[both].min() > 0.999
    assert np.array_equal(geometry.albedo_and_emission(found[2][both]), plain.albedo_and_emission(exact[2][both]))


def test_few_triangles_are_hit_as_they_are(scene, ray_cast):
    """A ball, a concave polygon with two materials, and instances of both: hit as by Blender's own ray cast."""
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5, location=(0.8, 0.9, -0.4), scale=(1, 0.5, 1.3))
    mesh = bpy.data.meshes.new("Arrow")
    mesh.from_pydata(
        [(-1, 0, 0), (0, 0.4, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0.2), (1, 0, 0.2), (0, 0, 0.5)],
        [],
        [
            (
                0,
                1,
                2,
                3,
            ),
            (4, 6, 5),
            (0, 1, 2, 6, 3),
        ],
    )
    mesh.materials.append(matt("Gray", (0.4, 0.4, 0.4)))
    mesh.materials.append(matt("Dark", (0.1, 0.1, 0.1)))
    mesh.polygons[1].material_index = 1
    arrow = put(mesh, (-0.5, 0.9, 0.2), (70, 20, 10))
    put(mesh, (-0.8, -0.5, -0.5), (30, -20, 50)).scale = (0.5, -0.7, 1)
    assert arrow.data is mesh
    depsgraph = evaluated()
    geometry, (origins, directions, limits) = ray_cast.Geometry(depsgraph), about()
    distance, normal, thing = geometry.cast(origins, directions, limits)
    albedo, dark = geometry.albedo_and_emission(thing)[0], 0
    for index, (origin, direction) in enumerate(zip(origins, directions)):
        hit, place, facing, face, on, _ = scene.ray_cast(depsgraph, origin, direction)
        assert hit == np.isfinite(distance[index])
        if hit:
            assert distance[index] == pytest.approx(np.linalg.norm(np.array(place) - origin), abs=1e-4)
            if on.data.original == mesh:
                dark += face == 1
                assert albedo[index] == pytest.approx(0.1 if on.data.polygons[face].material_index else 0.4)
    assert dark > 3


def test_a_sample_of_instances_covers_as_much(proxy_mesh):
    """The sample covers the same area, contains no instance twice, and keeps large ones unscaled."""
    areas = np.concatenate([np.random.default_rng(1).uniform(0.5, 2, 200_000), [1e5, 1e9]])
    drawn, factors = proxy_mesh.sample_instances(areas)
    assert len(drawn) < 1.1 * proxy_mesh.TRIANGLE_BUDGET / (2 * proxy_mesh.MIN_TRIANGLES) and len(set(drawn)) == len(
        drawn
    )
    assert {200_000, 200_001} <= set(drawn) and np.all(factors[-2:] == 1)
    assert (areas[drawn] * factors**2)[:-2].sum() == pytest.approx(areas[:-2].sum(), rel=0.05)
    few, whole = proxy_mesh.sample_instances(areas[:100])
    assert np.array_equal(few, np.arange(100)) and np.all(whole == 1)


def test_triangles_are_shared_out_by_length(proxy_mesh):
    counts, uses = np.array([10, 10**6, 10**6, 50]), np.array([1, 1, 10, 10**3])
    given = proxy_mesh.triangle_shares(counts, uses, np.array([1e4, 30.0, 3.0, 1.0]))
    assert given[0] == proxy_mesh.MIN_TRIANGLES and given[1] == pytest.approx(10 * given[2])
    assert (np.minimum(given, counts) * uses).sum() == pytest.approx(proxy_mesh.TRIANGLE_BUDGET, rel=0.25)


def test_places_that_are_no_numbers_stop_no_ray(scene, ray_cast):
    """An object at infinity, one at NaN, a mesh with a NaN vertex: the rest is hit as before."""
    exact = ray_cast.Geometry(evaluated()).cast(*about())
    for place in ((np.inf, 0, 0), (np.nan, 0, 0), (1e30, 0, 0)):
        bpy.ops.mesh.primitive_cube_add(size=0.1)
        bpy.context.object.location = place
    bpy.ops.mesh.primitive_cube_add(size=0.1, location=(0, 50, 0))
    bpy.context.object.data.vertices[0].co.x = np.nan
    put(bpy.data.meshes.new("Nothing"))
    assert np.array_equal(ray_cast.Geometry(evaluated()).cast(*about())[0], exact[0])


# Images


@pytest.fixture
def images(afterlight):
    return import_module(f"{afterlight.addon.gather.__name__}.images")


def pattern(width, height):
    """(height, width, 3) of radiance up to 2, bottom row first."""
    y, x = np.mgrid[:height, :width]
    return np.stack([1 + np.sin(x / 7.0), 0.5 + 0.4 * np.cos(y / 5.0), (x + y) % 8 / 4], -1).astype(np.float32)


def image(kind, tmp_path, values):
    height, width, _ = values.shape
    if kind == "EXR":
        path = tmp_path / "picture.exr"
        OpenEXR.File({"type": OpenEXR.scanlineimage}, {"RGB": np.ascontiguousarray(values[::-1])}).write(str(path))
        return bpy.data.images.load(str(path))
    made = bpy.data.images.new("Made", width, height, float_buffer=kind == "float")
    made.colorspace_settings.name = {"sRGB": "sRGB", "data": "Non-Color"}.get(kind, "Linear Rec.709")
    made.pixels.foreach_set(np.concatenate([values, np.ones((height, width, 1))], -1).astype(np.float32).ravel())
    made.update()
    made.pack()
    return made


def linear(kind, values):
    if kind not in {"sRGB", "data"}:
        return values
    values = np.round(np.clip(values, 0, 1) * 255) / 255
    return values if kind == "data" else np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


@pytest.mark.parametrize("kind", ["EXR", "float", "sRGB", "data"])
def test_pictures_are_read_as_their_means(fresh, images, kind, tmp_path):
    values = pattern(256, 128)
    found = images.means(image(kind, tmp_path, values), 32, 16)
    wanted = linear(kind, values).reshape(16, 8, 32, 8, 3).mean((1, 3))
    close = 1.5e-3 if kind == "sRGB" else 1e-4  # Mesa's software driver decodes sRGB by a polynomial, for EEVEE as well
    assert np.allclose(found[..., :3], wanted, rtol=1e-3, atol=close)
    assert np.allclose(found[..., 3], 1)
    whole = images.means(bpy.data.images[-1], 1000, 1000)
    assert np.allclose(whole[..., :3], linear(kind, values), rtol=1e-3, atol=close)


def test_a_sun_is_dimmed_before_the_mean(fresh, images, tmp_path):
    """A single bright pixel, which sampling every eighth one would miss; with a limit it counts as the limit, in its
    own colour."""
    values = np.full((64, 128, 3), 0.5, np.float32)
    values[11, 21] = 20000, 10000, 0
    sunny = image("float", tmp_path, values)
    assert images.means(sunny, 16, 8)[1, 2, 0] == pytest.approx(0.5 * 63 / 64 + 20000 / 64, rel=1e-3)
    dimmed = images.means(sunny, 16, 8, (2, 2, 2), 4)
    assert np.allclose(dimmed[1, 2, :3], np.array((4, 2, 0)) / 64 + 63 / 64, rtol=1e-3)
    assert np.allclose(dimmed[0], 1)


def test_what_is_no_picture_is_none(fresh, images, tmp_path):
    missing = bpy.data.images.new("Missing", 4, 4)
    missing.source, missing.filepath = "FILE", str(tmp_path / "none.png")
    assert images.means(missing, 8, 8) is None
    broken = image("float", tmp_path, np.full((4, 4, 3), np.nan, np.float32))
    broken.use_half_precision = False  # with it Blender turns NaN into black, for EEVEE as well
    assert images.means(broken, 8, 8) is None


MEMORY = """
import resource, sys
sys.path[:0] = {paths!r}
import bpy, gpu
gpu.init()
from addon.scene import world_light as world
scene = bpy.context.scene
tree = scene.world.node_tree
picture = tree.nodes.new("ShaderNodeTexEnvironment")
background = next(node for node in tree.nodes if node.type == "BACKGROUND")
picture.image = bpy.data.images.new("Sky", 8192, 4096)
tree.links.new(picture.outputs[0], background.inputs[0])
gpu.texture.from_image(picture.image)  # as EEVEE does
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
assert world.read(bpy.context.evaluated_depsgraph_get(), dict()) is None  # black
print("MB:", (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024)
"""


def test_a_large_world_picture_takes_no_memory(pytestconfig):
    """As an array of floats 8192 x 4096 pixels took 512 MB more than EEVEE already had."""
    code = MEMORY.format(paths=[str(pytestconfig.rootpath)])
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=600)
    assert "MB:" in told.stdout, told.stderr
    assert float(told.stdout.split("MB:")[1]) < 150


# Edits


def test_edits_cost_nothing_where_no_viewport_is_lit(scene, afterlight, monkeypatch):
    changes, asked = import_module(f"{afterlight.addon.__name__}.viewport.scene_changes"), []
    monkeypatch.setattr(changes, "_state", lambda *arguments: asked.append(1))
    for enabled, viewport in ((False, True), (True, False), (True, True)):
        scene.afterlight.enabled, scene.afterlight.use_viewport = enabled, viewport
        bpy.context.view_layer.update()
        asked.clear()
        bpy.data.objects["Lamp"].location.x += 0.1
        bpy.context.view_layer.update()
        assert bool(asked) == (enabled and viewport)


def test_a_scene_with_a_camera_is_not_searched_for_one(scene, afterlight, monkeypatch):
    checks, asked = afterlight.addon.diagnosis.checks, []
    monkeypatch.setattr(checks.fixes, "spare_camera", lambda scene: asked.append(scene))
    checks.findings(scene)
    assert not asked
    scene.camera = None
    checks.findings(scene)
    assert asked == [scene]
