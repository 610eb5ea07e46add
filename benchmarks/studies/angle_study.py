# SPDX-License-Identifier: GPL-3.0-or-later
"""What views that look along a surface cost: the light in a white box by the least angle at which a view is said to
see.

    .venv/bin/python -m benchmarks.studies.angle_study [--seeds 6] [--size 256x144]

Prints a table: placement.MIN_VIEW_COSINE, the indirect light of a frame over Cycles' (mean and standard deviation over
seeds, each with views of its own), and how many views there were.

The tables in docs/blender/views.md are of commit 359e2bd (25 November 2026), unless the page says otherwise.
"""

import argparse

import numpy as np

import session

from ..accuracy import candidates, references

BOUNCES, CYCLES_SAMPLES = 4, 64


def study(seeds, size, afterlight):
    import bpy

    import scenes

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = scenes.box(bpy.context.scene)
    scene.render.resolution_x, scene.render.resolution_y = size
    scenes.set_format(scene)
    scene.render.image_settings.color_mode = "RGBA"
    true = references.render(scene, BOUNCES, CYCLES_SAMPLES, 0)["indirect"].mean()
    _, plain = candidates.written(scene)
    views, placement = afterlight.addon.compositor.view_scenes, afterlight.addon.views.placement
    scene.afterlight.method, scene.afterlight.enabled = "RADIOSITY", True
    print("| `MIN_VIEW_COSINE` | energy, mean | standard deviation | views |\n|---|---:|---:|---|")
    for cosine in (0.0, 0.05, 0.1, 0.2, 0.3):
        placement.MIN_VIEW_COSINE = cosine
        energies, counts = [], []
        for seed in range(seeds):
            views.forget_placement(scene)
            scene.afterlight.seed = seed
            _, final = candidates.written(scene)
            energies.append((final.mean() - plain.mean()) / true)
            counts.append(len(views.stored_placement(scene).poses))
        print(
            f"| {cosine} | {np.mean(energies):.3f} | {np.std(energies):.3f} | {', '.join(map(str, counts))} |",
            flush=True,
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--size", default="256x144")
    wanted = parser.parse_args()
    afterlight = session.enable_afterlight()
    study(wanted.seeds, tuple(map(int, wanted.size.split("x"))), afterlight)


if __name__ == "__main__":
    main()
