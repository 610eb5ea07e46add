# SPDX-License-Identifier: GPL-3.0-or-later
"""What placing views costs, and how much of the light they then see, without any render.

    .venv/bin/python -m benchmarks.studies.placing_study [FILE.blend or case of views_limits ...] [--seeds 3] [--places
    N] [--points N]

Prints a table: the processor's seconds to read the scene into a tree, to follow paths, and to choose places (the least
of all seeds), and the share of light that all views see, mean and standard error over the seeds, told by paths that
they were not placed by. The passes of the main view are made by rays, 160 x 90.

The tables in docs/blender/views.md are of commits 2738afa and 9934713 (28 November 2026).
"""

import argparse
import time
from pathlib import Path

import numpy as np

from ..cost import views_limits  # it starts Blender

# isort: split
import bpy

SIZE = 160, 90
TELLING = 4000  # paths that tell how much is seen
addon, light = views_limits.afterlight.addon, views_limits.afterlight.addon.gather
placement, rays = addon.views.placement, addon.views.ray_cast


def opened(name):
    """The scene of a file, or of a case of views_limits.py."""
    if name in views_limits.CASES:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        scene = views_limits.scenes.box(bpy.context.scene, samples=1)
        views_limits.CASES[name](scene)
    else:
        bpy.ops.wm.open_mainfile(filepath=name, load_ui=False, use_scripts=False)
        scene = bpy.context.scene
        scene.afterlight.enabled = False
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage, scene.render.use_border = 100, False
    bpy.context.view_layer.update()
    return scene, bpy.context.evaluated_depsgraph_get()


def main_view(scene, depsgraph, geometry):
    """A MainView made by rays through the camera."""
    camera = addon.scene.cameras.camera(scene.camera.evaluated_get(depsgraph), depsgraph, scene)
    i, j = np.meshgrid(*(np.arange(count) + 0.5 for count in SIZE))
    ray = camera.offset + camera.scale * np.stack([i, j[::-1]], -1).reshape(-1, 2)  # rows top first
    flat, ahead = np.pad(ray, ((0, 0), (0, 1))), np.tile((0.0, 0, -1), (len(ray), 1))
    start = camera.position + (flat if camera.orthographic else 0 * flat) @ camera.rotation
    way = (ahead if camera.orthographic else flat + ahead) @ camera.rotation
    length = np.linalg.norm(way, axis=1)
    far, normal, thing = geometry.cast(start, way / length[:, None], np.full(len(way), np.inf))
    hit = np.isfinite(far)
    normal[np.sum(normal * way, 1) > 0] *= -1
    color, emission, direct = np.zeros((3, len(way)))
    color[hit], emission[hit] = geometry.albedo_and_emission(thing[hit])
    places = start[hit] + way[hit] * (far / length)[hit, None]
    direct[hit] = rays.direct_light(geometry, places, normal[hit], np.random.default_rng(0))
    depth, color, emission, direct, *normal = (
        each.reshape(SIZE[::-1]) for each in (np.where(hit, far / length, 1e10), color, emission, direct, *normal.T)
    )
    frame = light.Passes(depth, tuple(normal), (color,) * 3, (direct,) * 3, (emission,) * 3)
    return addon.views.main_view.MainView(scene, scene.view_layers[0], frame, camera)


def study(name, seeds):
    """One row of the table."""
    scene, depsgraph = opened(name)
    picture, taken, shares, counts = main_view(scene, depsgraph, rays.Geometry(depsgraph)), [], [], []
    for seed in range(seeds):
        rng, marks = np.random.default_rng(seed), [time.process_time()]
        geometry = rays.Geometry(depsgraph)
        marks.append(time.process_time())
        picture.trace_paths(placement.SCORING_PATHS, geometry, rng, placement.MAX_BOUNCES)
        found, seen = picture.trace_paths(placement.PLACEMENT_PATHS, geometry, rng, placement.MAX_BOUNCES)
        marks.append(time.process_time())
        poses = placement.place(found, seen, geometry.cast, addon.scene.view_cameras.HALF_FIELD, 7, rng)
        taken.append(np.diff([*marks, time.process_time()]))
        told, shown = picture.trace_paths(TELLING, geometry, np.random.default_rng(seed + 1000), placement.MAX_BOUNCES)
        shares.append(placement.coverage(told, shown, geometry.cast, addon.scene.view_cameras.HALF_FIELD, poses)[-1])
        counts.append(len(poses))
    read, paths, choosing = np.min(taken, 0)
    return (
        f"| {Path(name).stem} | {read:.2f} | {paths:.2f} | {choosing:.2f} | {np.mean(shares):.2%} | "
        f"{np.std(shares) / seeds**0.5:.2%} | {', '.join(map(str, counts))} |"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=["crowd", "subdivided", "balls", "polygons"])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--places", type=int, default=placement.CANDIDATE_POSITIONS)
    parser.add_argument("--points", type=int, default=placement.PLACEMENT_POINTS)
    wanted = parser.parse_args()
    placement.CANDIDATE_POSITIONS, placement.PLACEMENT_POINTS = wanted.places, wanted.points
    print(
        "| scene | reading, s | paths, s | choosing, s | seen | standard error | views |\n|---|---|---|---|---|---|---|"
    )
    for name in wanted.scenes:
        print(study(name, wanted.seeds), flush=True)


if __name__ == "__main__":
    main()
