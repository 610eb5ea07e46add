# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of the light the views see, by their number, and what placing and rendering them costs.

    .venv/bin/python -m benchmarks.studies.views_study [FILE.blend ...] [--size 320x180]

Prints a table: the share of the light that leaves surfaces seen by the main view, and with each further view; the
seconds to place them (again in the frame after, where they stay), and to render the views beside those of one sample
of the frame.

The tables in docs/blender/views.md are of commit 0b4fe02 (25 November 2026), unless the page says otherwise.
"""

import argparse
import sys
import time
from pathlib import Path

import session

from ..accuracy import candidates
from ..cost import bench


def study(path, size, afterlight):
    """One row of the table."""
    import bpy

    status, views = afterlight.addon.host.report, afterlight.addon.compositor.view_scenes
    scene = bench.open_scene(path, size, afterlight)
    scene.eevee.taa_render_samples = 1
    bpy.ops.render.render()

    def seconds(mode):
        scene.afterlight.views = mode
        scene.afterlight.enabled = True
        start = time.perf_counter()
        bpy.ops.render.render()
        if scene.afterlight.report:
            sys.exit(scene.afterlight.report)
        return time.perf_counter() - start

    seconds("CAMERA")
    alone = seconds("CAMERA")
    seconds("AUTOMATIC")
    shares, first = status.coverage(scene)
    together = seconds("AUTOMATIC")
    _, again = status.coverage(scene)
    count = len(views.stored_placement(scene).poses)
    return (
        f"| {path.stem} | {shares[0]:.0%} | {', '.join(f'{share:.0%}' for share in shares[1:])} | {first:.2f} | "
        f"{again:.2f} "
        f"| {(together - alone - again) / max(count, 1):.2f} | {alone:.2f} |"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, default=candidates.diffuse_samples())
    parser.add_argument("--size", default="320x180")
    wanted = parser.parse_args()
    afterlight = session.enable_afterlight()
    print(
        "| scene | main view | with each view | placing, s | again, s | a view, s | frame with camera only, s |\n"
        "|---|---|---|---|---|---|---|"
    )
    for path in wanted.files:
        print(study(path, tuple(map(int, wanted.size.split("x"))), afterlight), flush=True)


if __name__ == "__main__":
    main()
