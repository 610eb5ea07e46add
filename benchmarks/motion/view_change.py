# SPDX-License-Identifier: GPL-3.0-or-later
"""What changes when automatic views are placed again in the middle of a shot, with and without the average over frames.

    .venv/bin/python -m benchmarks.motion.view_change [FILE.blend] [--size 160x90] [--frames 8]

Nothing moves, camera and light stay, so that every change is noise or the views'. In the middle of the shot the views
are told that they see too little, and are placed again, with those that are there among the candidates. Change: mean
absolute difference of two frames' blocks of 8 x 8 pixels, over the mean of the bounced light."""

import argparse
from pathlib import Path

import numpy as np

import session

from .. import ROOT
from ..accuracy import accuracy, candidates
from ..cost import bench
from . import motion, steadiness


def measure(scene, frames, average, afterlight):
    """[change from each frame to the next]; the views are placed again in frame `frames // 2 + 1`."""
    import bpy

    views, again = afterlight.addon.compositor.view_scenes, frames // 2 + 1

    def see_too_little(changed, *_):
        if changed.frame_current == again and (known := views.stored_placement(changed)):
            views.store_placement(
                changed, type(known)(known.poses, [share + 1 for share in known.coverage], known.clearance)
            )

    _, plain = candidates.written(scene)
    bench.use_preset("production", afterlight)
    scene.afterlight.enabled = scene.afterlight.use_animated_seed = True
    scene.afterlight.use_history = average
    scene.frame_start, scene.frame_end = 1, frames
    bpy.app.handlers.frame_change_pre.append(see_too_little)
    try:
        _, found = motion.job(scene)
    finally:
        bpy.app.handlers.frame_change_pre.remove(see_too_little)
        scene.afterlight.enabled = False
    pictures = [frame["Combined"] for frame in found]
    light = np.mean([picture - plain for picture in pictures])
    blocks = [steadiness.blocks(picture) for picture in pictures]
    return [float(np.abs(after - before).mean() / light) for before, after in zip(blocks, blocks[1:])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=Path, default=ROOT / "sample_blends" / "apartment.blend")
    parser.add_argument("--size", type=accuracy.picture_size, default=(160, 90), metavar="WxH", help="160x90")
    parser.add_argument("--frames", type=int, default=8)
    wanted = parser.parse_args()
    afterlight = session.enable_afterlight()
    rows = [f"| average | change between frames; placed again at frame {wanted.frames // 2 + 1} |", "|---|---|"]
    for average in (False, True):
        scene = candidates.open_scene(wanted.file, wanted.size, 1, afterlight)
        changes = measure(scene, wanted.frames, average, afterlight)
        rows.append(f"| {'on' if average else 'off'} | {', '.join(f'{each:.3f}' for each in changes)} |")
    print("\n".join(rows))


if __name__ == "__main__":
    main()
