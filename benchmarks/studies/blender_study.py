# SPDX-License-Identifier: GPL-3.0-or-later
"""What docs/blender/rendering.md says of EEVEE and of Blender's files, measured.

    .venv/bin/python -m benchmarks.studies.blender_study

Prints two tables: the mean of EEVEE's Diffuse Direct pass under its ray tracing settings, and the time to save and
read all passes of a 1280x720 frame with one part a pass and with one part in all (medians of 5).

The tables in docs/blender/rendering.md are of commit 12b7a92 (23 November 2026), unless the page says otherwise.
"""

import argparse
import statistics
import time

import session

from .. import ROOT
from ..cost import bench

afterlight = session.enable_afterlight()

import bpy
import numpy as np
import OpenEXR


def ray_tracing(scene):
    """Does any of EEVEE's settings keep its own bounce out of the pass that we read?"""
    passes, eevee, layer = afterlight.addon.scene.passes, scene.eevee, scene.view_layers[0]
    eevee.taa_render_samples = 16

    def mean():
        bpy.ops.render.render()
        path = afterlight.addon.scene.frame_store.save(scene)
        loaded = passes.load(path, layer.name, afterlight.addon.scene.cameras.window(scene)[0])
        afterlight.addon.scene.frame_store.discard(path)
        return float(np.mean(loaded.diffuse_direct))

    print(
        "| ray tracing | fast GI | maximum roughness | indirect strength | mean of Diffuse Direct "
        "|\n|---|---|---|---|---|"
    )
    for tracing, fast, roughness, strength in (
        (False, True, 0.5, 1),
        (True, True, 0.5, 1),
        (True, False, 0.5, 1),
        (True, True, 0.0, 1),
        (True, False, 1.0, 1),
        (True, True, 0.5, 0),
    ):
        eevee.use_raytracing, eevee.use_fast_gi, eevee.indirect_light_intensity = tracing, fast, strength
        eevee.ray_tracing_options.trace_max_roughness = roughness
        print(f"| {'on' if tracing else 'off'} | {'on' if fast else 'off'} | {roughness} | {strength} | {mean():.4f} |")
    eevee.use_raytracing, eevee.indirect_light_intensity = False, 1


def files(scene):
    """One part a pass, or one part in all?"""
    scene.render.resolution_x, scene.render.resolution_y = 1280, 720
    scene.eevee.taa_render_samples = 1
    bpy.ops.render.render()
    image, path = scene.render.image_settings, f"{bpy.app.tempdir}study.exr"
    image.media_type, image.color_depth, image.exr_codec = "MULTI_LAYER_IMAGE", "32", "NONE"
    seconds = {(interleave, what): [] for interleave in (False, True) for what in ("save", "read")}
    for _ in range(6):
        for interleave in (False, True):
            image.use_exr_interleave = interleave
            start = time.perf_counter()
            bpy.data.images["Render Result"].save_render(path, scene=scene)
            saved = time.perf_counter()
            OpenEXR.File(path, separate_channels=True)
            seconds[interleave, "save"].append(saved - start)
            seconds[interleave, "read"].append(time.perf_counter() - saved)
    print("\n| file | save, ms | read, ms |\n|---|---|---|")
    for interleave, name in ((False, "one part a pass"), (True, "one part")):
        save, read = (1000 * statistics.median(seconds[interleave, what][1:]) for what in ("save", "read"))
        print(f"| {name} | {save:.0f} | {read:.0f} |")


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    scene = bench.open_scene(ROOT / "sample_blends" / "cornell_box.blend", (160, 90), afterlight)
    ray_tracing(scene)
    files(scene)


if __name__ == "__main__":
    main()
