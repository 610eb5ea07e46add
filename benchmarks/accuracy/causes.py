# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the error of Afterlight comes from: a chain of pictures from its own to Cycles', each step one cause.

    causes.measure(...)          called for each scene by `python -m benchmarks.accuracy`; the rows of its table

The chain: Afterlight as set; the same without noise; the sum over all pairs of texels; that sum with what stands
between two texels; the same with Cycles' direct light; Cycles with one bounce; Cycles with all of the reference's.
Pictures are (H, W, 3), rows top first; all else follows tests/reference.py: view space, metres, bottom row first.
"""

import importlib
from dataclasses import replace

import numpy as np

from reference import paper as reference

from . import metrics

CAUSES = (
    ("sampling noise", "random samples instead of every texel of each region"),
    ("hierarchy", "levels of the pyramid instead of all pairs of texels at the base"),
    ("missing visibility", "light passes through whatever stands between two surfaces"),
    ("EEVEE's direct light", "what the surfaces send is lit by EEVEE instead of Cycles"),
    ("off screen and hidden surfaces", "surfaces that the picture does not show send nothing"),
    ("later bounces", "one bounce instead of all of the reference's"),
)
TOTAL = "total", "Afterlight as set against the reference"
RAY_NOISE = "noise of the visibility rays", "of this table itself: the rays of one half against all of them"

RAYS = 64  # from each texel, half of them in each of two independent estimates
CLEARANCE = 1e-3  # how far from both surfaces a ray keeps, in sides of their texels
SNAP = 0.05  # how far from the pass' depth, as a share of it, a pixel's surface may lie
CHUNK = 128  # receivers at a time: a row of all pairs is 0.4 MB at 160 x 90 texels


def measure(afterlight, scene, passes, camera, settings, cycles_direct, one_bounce, n_bounces, mask):
    """The rows of the table by cause, as dictionaries: name, explanation, what metrics.compare() says of the picture
    against the next one, "share": mean |difference| over the mean of the reference, and "gain": mean difference over
    the mean of the reference. The gains of the causes add up to the total's; the last row is the noise of the rays.

    passes, camera: of the plain EEVEE frame of `scene`. settings: light.PaperSettings. cycles_direct: (H, W, 3),
    Diffuse Direct without albedo. one_bounce, n_bounces: (H, W, 3) indirect radiance. mask: (H, W), pixels that count.
    """
    light = importlib.import_module(f"{afterlight.__name__}.addon.gather")
    tree = tree_of(scene, camera)
    shown = points_shown(tree, passes, camera)
    complete = with_normals(passes, shown[1], camera)
    guide, base = reference.pack(complete, camera, settings.start)
    lit_by_cycles = replace(complete, diffuse_direct=tuple(np.moveaxis(cycles_direct, -1, 0)))
    cycles_base = reference.pack(lit_by_cycles, camera, settings.start)[1]
    surfaces = Surfaces(tree, *shown, guide, camera, settings.start)
    everything, halves = sums(base, cycles_base.radiance, surfaces, settings.seed)

    def picture(total, columns=slice(0, 3)):
        total = np.concatenate([total[..., columns], total[..., 6:]], -1)
        lit = reference.composite(passes, guide, base, total, camera, settings.start, settings.strength)
        return lit[::-1, :, :3]

    def gathered(chosen):
        return light.gather_indirect(passes, camera, chosen)[::-1, :, :3]

    chain = [
        gathered(settings),
        gathered(replace(settings, samples=0)),
        picture(everything),
        picture(halves.mean(0)),
        picture(halves.mean(0), slice(3, 6)),
        one_bounce,
        n_bounces,
    ]
    steps = [
        *zip(CAUSES, chain, chain[1:], strict=False),
        (TOTAL, chain[0], chain[-1]),
        (RAY_NOISE, chain[3], picture(halves[0])),
    ]
    mean = n_bounces[mask].mean(dtype=np.float64) if mask.any() else 0
    return [row(*step, mean, mask) for step in steps]


def row(cause, picture, target, mean, mask):
    """One line of the table; its share and gain are None where the reference is black, as metrics.compare()'s are."""
    name, explanation = cause
    line = {"name": name, "explanation": explanation, **metrics.compare(picture, target, mask)}
    if not mean > 0:
        return line | {"share": None, "gain": None}
    difference = np.subtract(picture[mask], target[mask], dtype=np.float64)
    return line | {"share": float(np.abs(difference).mean() / mean), "gain": float(difference.mean() / mean)}


def sums(base, other_radiance, surfaces, seed, rays=RAYS):
    """What each texel receives from all others: irradiance by the base's radiance (columns 0-2), by `other_radiance`
    (3-5) and the sum of form factors (6), all in one because they share their rays.

    Returns (H, W, 7), all pairs; and (2, H, W, 7), with true visibility, two independent estimates without bias.

    A ray's emitter is drawn in proportion to form factor x weight, with a weight that none of the seven can exceed by
    much: the brightness of each radiance over its mean, plus one. What arrives is estimated around `c E`, with E the
    exact sum and c the share that arrives in the *other* half: where all or nothing arrives, that is exact.
    """
    shape, area = base.area.shape, base.area.ravel()
    place, vector_area = base.position.reshape(-1, 3), base.vector_area.reshape(-1, 3)
    normal, there = reference.direction(vector_area), np.flatnonzero(area > 0)
    sent = np.concatenate([np.pi * base.radiance, np.pi * other_radiance, np.ones((*shape, 1))], -1).reshape(-1, 7)
    weight = 1 + sum(light.mean(-1) / max(light[there].mean(), 1e-300) for light in (sent[:, :3], sent[:, 3:6]))
    rng = np.random.default_rng(seed)
    everything, halves = np.zeros((area.size, 7)), np.zeros((2, area.size, 7))
    for first in range(0, there.size, CHUNK):
        here = there[first : first + CHUNK]
        form = reference.form_factor(
            place[here, None], normal[here, None], place[there], area[there], vector_area[there]
        )
        everything[here] = form @ sent[there]
        ladder = np.cumsum(form * weight[there], axis=1)
        some = ladder[:, -1] > 0
        here, ladder = here[some], ladder[some]
        strata = (np.arange(rays // 2) + rng.random((here.size, 2, rays // 2))) / (rays // 2)
        drawn = there[
            [
                np.searchsorted(steps, steps[-1] * u.ravel(), side="right").clip(max=there.size - 1)
                for steps, u in zip(ladder, strata)
            ]
        ]
        arrives = surfaces.see(np.repeat(here, rays), drawn.ravel(), rng).reshape(strata.shape)
        share = arrives.mean(2)[:, ::-1, None]
        carried = sent[drawn] / weight[drawn][..., None] * ladder[:, -1, None, None]
        carried = carried.reshape(*strata.shape, 7)
        halves[:, here] = np.moveaxis(
            share * everything[here, None] + ((arrives[..., None] - share[:, :, None]) * carried).mean(2), 1, 0
        )
    return everything.reshape(*shape, 7), halves.reshape(2, *shape, 7)


class Surfaces:
    """The texels of a frame's base, and whether they see each other past every triangle of the scene."""

    def __init__(self, tree, place, normal, guide, camera, start):
        """place, normal: of each pixel, as points_shown() gives them. guide: (H, W, 4), the pass' normal and depth.
        start: pixels along the side of a texel."""
        height, width = guide.shape[:2]
        area = reference.texel_area(camera, reference.pixel_centres(height, width), guide[..., 3], guide[..., :3])
        area = np.where(guide[..., 3] > 0, area, 0)
        ladder = np.cumsum(_blocks(area[..., None], start)[..., 0], axis=1)
        self.tree, self.place, self.normal = tree, _blocks(place, start), _blocks(normal, start)
        self.ladder, self.side = ladder / np.maximum(ladder[:, -1:], 1e-300), np.sqrt(ladder[:, -1])

    def see(self, receivers, emitters, rng):
        """(n,) bool for texels (n,) and (n,), counted row by row: does a ray between a point of each arrive?

        The points are pixels of theirs, drawn by area, as a texel on an edge has its pixels on several surfaces."""
        start, end = self._points(receivers, rng), self._points(emitters, rng)
        path = end - start
        length = np.linalg.norm(path, axis=-1)
        path /= np.maximum(length, 1e-300)[:, None]
        cast = self.tree.ray_cast
        return np.array([cast(*ray)[0] is None for ray in zip(start.tolist(), path.tolist(), length.tolist())], bool)

    def _points(self, texels, rng):
        pixel = (rng.random((texels.size, 1)) >= self.ladder[texels]).sum(1).clip(max=self.ladder.shape[1] - 1)
        return self.place[texels, pixel] + CLEARANCE * self.side[texels, None] * self.normal[texels, pixel]


def points_shown(tree, passes, camera):
    """(place, normal), both (H, W, 3) in view space, bottom row first: the point of the scene that each pixel's centre
    shows and its triangle's normal towards the camera; where none is near, those of the passes.

    The passes alone will not do: theirs is a point elsewhere in the pixel, perhaps beyond an edge, and its normal may
    be smoothed. From there a ray would hit the surface that it leaves."""
    depth = passes.depth[::-1].astype(np.float64)
    depth = np.where((depth > 0) & (depth < reference.FARTHEST), depth, 0)
    place = reference.view_position(camera, reference.pixel_centres(*depth.shape), depth)
    reach = depth[..., None] * (0, 0, -1) if camera.orthographic else place.copy()
    normal = reference.direction(reference.bottom_first(passes.normal) @ np.asarray(camera.rotation).T)
    for index in zip(*np.nonzero(depth)):
        ray = reach[index]
        hit, facing, _, _ = tree.ray_cast(place[index] - SNAP * ray, ray, 2 * SNAP * np.linalg.norm(ray))
        if hit is not None:
            place[index], normal[index] = hit, -np.sign(np.dot(facing, ray)) * np.array(facing)
    towards_camera = -reference.direction(reach)
    return place, np.where(normal.any(-1, keepdims=True), normal, towards_camera)


def with_normals(passes, normal, camera):
    """The passes with `normal`, in view space, where a material of pure emission wrote (0, 0, 0)."""
    given = np.stack(passes.normal, -1)
    given = np.where(given.any(-1, keepdims=True), given, normal[::-1] @ np.asarray(camera.rotation))
    return replace(passes, normal=tuple(np.moveaxis(given.astype(np.float32), -1, 0)))


def tree_of(scene, camera):
    """mathutils' BVHTree of all that `scene` renders, in view space. Three to thirteen times as fast as
    scene.ray_cast(), which tries one object after another."""
    from mathutils.bvhtree import BVHTree

    vertices, corners, eye = triangles(scene)
    view = (vertices - eye) @ np.asarray(camera.rotation).T
    return BVHTree.FromPolygons(view.tolist(), corners.tolist(), all_triangles=True)


def triangles(scene):
    """(vertices (n, 3), triangles (m, 3), eye (3,)) in world space: everything that `scene` renders, instances and all,
    and the camera's place. The scene's Render Result is gone afterwards."""
    import bpy

    vertices, corners, eye, offset = [np.empty((0, 3))], [np.empty((0, 3), int)], [], 0

    class Geometry(bpy.types.RenderEngine):
        """Only a render engine is given what is rendered: the viewport has other modifiers, and hides other things."""

        bl_idname, bl_label = "AFTERLIGHT_GEOMETRY", "Geometry"

        def render(self, depsgraph):
            nonlocal offset
            if eye:  # a further view layer
                return
            eye.append(np.array(scene.camera.evaluated_get(depsgraph).matrix_world.translation))
            for instance in depsgraph.object_instances:
                thing = instance.object
                if not instance.show_self or thing.type != "MESH":  # texts, curves and the like come as meshes too
                    continue
                mesh = thing.to_mesh()
                here, faces = np.empty((len(mesh.vertices), 3), np.float32), mesh.loop_triangles
                three = np.empty((len(faces), 3), np.int32)
                mesh.vertices.foreach_get("co", here.ravel())
                faces.foreach_get("vertices", three.ravel())
                thing.to_mesh_clear()
                matrix = np.array(instance.matrix_world)
                vertices.append(here @ matrix[:3, :3].T + matrix[:3, 3])
                corners.append(three + offset)
                offset += len(here)

    engine, compositing = scene.render.engine, scene.render.use_compositing
    bpy.utils.register_class(Geometry)
    try:
        scene.render.engine, scene.render.use_compositing = Geometry.bl_idname, False
        bpy.ops.render.render(scene=scene.name)
    finally:
        scene.render.engine, scene.render.use_compositing = engine, compositing
        bpy.utils.unregister_class(Geometry)
    return np.concatenate(vertices), np.concatenate(corners), eye[0]


def _blocks(image, side):
    """(H, W, C) as (texels, side x side, C), row by row; what hangs over the edge is 0."""
    height, width, channels = image.shape
    image = np.pad(image, [(0, -height % side), (0, -width % side), (0, 0)])
    shape = image.shape[0] // side, side, image.shape[1] // side, side, channels
    return image.reshape(shape).swapaxes(1, 2).reshape(-1, side * side, channels)
