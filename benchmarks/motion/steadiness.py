# SPDX-License-Identifier: GPL-3.0-or-later
"""How calm the indirect light is while the camera moves: what changes between frames beyond what Cycles' frames change.

    .venv/bin/python -m benchmarks.motion.steadiness [FILE.blend] [--frames 24] [--travel=-0.25,0,-0.25] [--samples 64]
    [--size 320x180]
        [--page FILE]

The camera goes by `travel` (to its right, up and back, in parts of the picture's mean depth) in so many frames. For
each way to render, the error against Cycles is taken in every frame, and its change to the next: an error that stays
where it is does not flicker. Means over blocks of 8 x 8 pixels, over the mean of Cycles' indirect light: finer noise
than that is Cycles' own. What is left of that is measured from two halves of its samples, and stands beside it.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import session

from .. import ROOT
from ..accuracy import accuracy, candidates, references

BLOCK = 8
EEVEE_SAMPLES, BOUNCES = 16, 4


def blocks(picture):
    """(H // 8, W // 8, 3): means over blocks of pixels."""
    height, width = (side // BLOCK * BLOCK for side in picture.shape[:2])
    return picture[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3).mean((1, 3))


def truth(scene, samples, frame):
    """(mean, difference of the halves over 2): Cycles' indirect light, its noise."""
    halves = []
    for half in range(2):
        seed = 2 * frame + half
        found = references.render(scene, BOUNCES, samples, seed)["indirect"]
        halves.append(blocks(references.with_alone(scene, found, samples, seed)))
    return (halves[0] + halves[1]) / 2, (halves[0] - halves[1]) / 2


def dolly(camera, depth, frames, travel):
    """The camera's matrix in each frame: it goes by `travel` x `depth` along its own axes."""
    start = camera.matrix_world.copy()
    for frame in range(frames):
        matrix = start.copy()
        step = frame / max(frames - 1, 1) * depth * np.array(travel)
        matrix.translation = start.translation + start.to_3x3() @ type(start.translation)(step)
        yield matrix


def ways_of(afterlight):
    """[(candidate, whether its views are placed anew in every frame)]: the last is as on a farm, of a file without
    views."""
    names = ("eevee", "tracing", "tracing-best", "draft", "production")
    ways = [(each, False) for each in candidates.ways_of(names, afterlight, BOUNCES)]
    anew = candidates.ticked(afterlight, "production")
    anew.name += ", views placed anew"
    return [*ways, (anew, True)]


def measure(path, frames, travel, samples, size, afterlight):
    """{name: (frames, h, w, 3) of errors}, noise of the reference (frames, h, w, 3), mean of its light, {name:
    views}."""
    scene = candidates.open_scene(path, size, EEVEE_SAMPLES, afterlight)
    views, camera = afterlight.addon.compositor.view_scenes, scene.camera
    candidates.written(scene)
    depth = candidates.look(scene, None, afterlight).passes.depth
    matrices = list(dolly(camera, float(np.mean(depth[depth < 1e9])), frames, travel))
    true, noise, plain = [], [], []
    for frame, camera.matrix_world in enumerate(matrices):
        mean, half = truth(scene, samples, frame)
        true.append(mean)
        noise.append(half)
        plain.append(candidates.look(scene, candidates.written(scene)[1], afterlight))
        print(f"Cycles, frame {frame + 1} of {frames}", file=sys.stderr, flush=True)
    errors, poses = {}, {}
    for way, anew in ways_of(afterlight):
        found, seen = errors.setdefault(way.name, []), poses.setdefault(way.name, [])
        with way.mode(scene):  # all frames of it in one go: its views stay, and so does what they are rendered through
            for frame, camera.matrix_world in enumerate(matrices):
                has_views = scene.afterlight.enabled and views.wanted(scene)
                if has_views and anew:
                    views.forget_placement(scene)
                _, final = candidates.written(scene)
                if scene.afterlight.enabled and scene.afterlight.report:
                    sys.exit(scene.afterlight.report)
                found.append(blocks(way.bounced(scene, final, plain[frame])) - true[frame])
                known = views.stored_placement(scene) if has_views else None
                seen.append(np.array(known.poses).ravel().tolist() if known else [])
        print(f"{way.name}: {frames} frames", file=sys.stderr, flush=True)
    return {name: np.array(each) for name, each in errors.items()}, np.array(noise), float(np.mean(true)), poses


def table(errors, noise, light, poses):
    """The rows of the page."""
    rows = [
        "| way | error | change between frames, median | largest | views changed at frame | change there |",
        "|---|---:|---:|---:|---|---:|",
    ]
    for name, each in errors.items():
        change = np.abs(np.diff(each, axis=0)).mean((1, 2, 3)) / light
        moved = [frame for frame in range(1, len(each)) if poses[name][frame] != poses[name][frame - 1]]
        listed = (
            "–" if not moved else "all" if len(moved) == len(each) - 1 else ", ".join(str(frame + 1) for frame in moved)
        )
        there = f"{max(change[frame - 1] for frame in moved):.4f}" if moved else "–"
        rows.append(
            f"| {name} | {np.abs(each).mean() / light:.3f} | {np.median(change):.4f} | {change.max():.4f} | {listed} "
            f"| {there} |"
        )
    own = np.abs(np.diff(noise, axis=0)).mean((1, 2, 3)) / light
    rows.append(
        f"| *Cycles' own noise in these* | {np.abs(noise).mean() / light:.3f} | {np.median(own):.4f} | "
        f"{own.max():.4f} | | |"
    )
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=Path, default=ROOT / "sample_blends" / "apartment.blend")
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--travel", default="-0.25,0,-0.25")
    parser.add_argument("--samples", type=int, default=64, help="of each half of Cycles' frames; 64")
    parser.add_argument("--size", type=accuracy.picture_size, default=(320, 180), metavar="WxH", help="320x180")
    parser.add_argument("--page", type=Path)
    wanted = parser.parse_args()
    afterlight = session.enable_afterlight()
    travel = [float(part) for part in wanted.travel.split(",")]
    rows = table(*measure(wanted.file, wanted.frames, travel, wanted.samples, wanted.size, afterlight))
    text = "\n".join(
        [
            f"`{wanted.file.name}`, {wanted.frames} frames of {wanted.size[0]} x {wanted.size[1]}, travel "
            f"{wanted.travel} of the mean "
            f"depth, Cycles with {2 * wanted.samples} samples:",
            "",
            *rows,
            "",
        ]
    )
    print(text)
    if wanted.page:
        wanted.page.write_text(text)


if __name__ == "__main__":
    main()
