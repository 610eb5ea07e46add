# SPDX-License-Identifier: GPL-3.0-or-later
"""Which settings of EEVEE's ray tracing come closest to Cycles: what candidates.BEST is taken from.

    .venv/bin/python -m benchmarks.studies.eevee_study [FILE.blend ...] [--out FILE.json] [--size 160x90]

Writes the relative L1 error of the indirect light of each scene, by settings, for accuracy_report to show.

The tables in docs/measured/accuracy.md are of commit f5da531 (25 November 2026), unless the page says otherwise.
"""

import argparse
import json
import shlex
import sys
from contextlib import nullcontext
from pathlib import Path
from statistics import mean, median

import session

from .. import ROOT, commit
from ..accuracy import candidates, metrics, references

BOUNCES, SAMPLES, HALF = 4, 4, 64
ROUGH, THICK, SCALE = (
    f"ray_tracing_options.{name}" for name in ("trace_max_roughness", "screen_trace_thickness", "resolution_scale")
)
QUALITY, DENOISE = "ray_tracing_options.screen_trace_quality", "ray_tracing_options.use_denoise"
SCREEN = {ROUGH: 1.0}  # screen tracing for every roughness
FULL = SCREEN | {SCALE: "1"}
TRIED = {
    "default": {},
    "Fast GI, thickness 2 m": {"fast_gi_thickness_near": 2.0},
    "Fast GI, thickness 2 m, 16 steps, 8 rays, full resolution": {
        "fast_gi_thickness_near": 2.0,
        "fast_gi_step_count": 16,
        "fast_gi_ray_count": 8,
        "fast_gi_resolution": "1",
    },
    "screen tracing": SCREEN,
    "screen tracing, thickness 0.5 m": SCREEN | {THICK: 0.5},
    "screen tracing, thickness 2 m": SCREEN | {THICK: 2.0},
    "screen tracing, thickness 8 m": SCREEN | {THICK: 8.0},
    "screen tracing, thickness 2 m, full resolution": FULL | {THICK: 2.0},
    "screen tracing, thickness 2 m, full resolution, precision 1": FULL | {THICK: 2.0, QUALITY: 1.0},
    "screen tracing, thickness 8 m, precision 1": SCREEN | {THICK: 8.0, QUALITY: 1.0},
    "screen tracing, thickness 8 m, full resolution, precision 1": FULL | {THICK: 8.0, QUALITY: 1.0},
    "screen tracing, thickness 8 m, full resolution, precision 1, not denoised": FULL
    | {THICK: 8.0, QUALITY: 1.0, DENOISE: False},
}


def measure(path, size, afterlight):
    """{settings: (relative L1 or None, seconds over plain EEVEE's)} of one scene."""
    scene = candidates.open_scene(path, size, SAMPLES, afterlight)
    tried = [candidates.Candidate("EEVEE", "EEVEE", nullcontext, lambda scene, final, plain: final * 0)]
    tried += [
        candidates.Candidate(
            name,
            "EEVEE ray tracing",
            lambda scene, settings=settings: candidates.traced(scene, settings),
            candidates.traced_diffuse,
        )
        for name, settings in TRIED.items()
    ]
    plain = candidates.render_all(scene, tried, 1, afterlight)
    truth = references.Truth(scene, BOUNCES, references.source_key(path))
    truth.extend(BOUNCES, HALF)
    mask = (plain.passes.depth < 1e9) & ~truth.of[BOUNCES].not_diffuse()
    print(f"{path.stem}: noise of the reference {truth.noise(mask)['indirect']:.3f}", file=sys.stderr)
    base = median(tried[0].seconds)
    return {
        each.name: (
            metrics.compare(each.indirect, truth.indirect(BOUNCES), mask, flip=False)["l1"],
            median(each.seconds) / base,
        )
        for each in tried[1:]
    }


def main(arguments):
    def size(text):
        width, height = map(int, text.split("x"))
        return width, height

    parser = argparse.ArgumentParser(prog="benchmarks.studies.eevee_study", description="EEVEE's best ray tracing.")
    parser.add_argument("blends", nargs="*", type=Path, metavar="FILE.blend", help="all of sample_blends/ without")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "measured" / "accuracy" / "eevee_study.json")
    parser.add_argument("--size", type=size, default=(160, 90), metavar="WxH", help="160x90")
    options = parser.parse_args(arguments)
    afterlight = session.enable_afterlight()
    found = {}
    for path in options.blends or candidates.diffuse_samples():
        try:
            found[path.stem] = measure(path.resolve(), options.size, afterlight)
        except candidates.Unmeasurable as reason:
            print(f"{path}: skipped, {reason}", file=sys.stderr)
    if not found:
        sys.exit("No scene could be measured; the lines above say why.")
    rows = [
        {
            "name": name,
            "l1": {scene: numbers[name][0] for scene, numbers in found.items()},
            "mean": mean(numbers[name][0] for numbers in found.values()),
            "cost": mean(numbers[name][1] for numbers in found.values()),
        }
        for name in TRIED
    ]
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text(
        json.dumps(
            {
                "command": shlex.join([".venv/bin/python", "-m", "benchmarks.studies.eevee_study", *arguments]),
                "commit": commit.current(),
                "size": options.size,
                "samples": SAMPLES,
                "scenes": list(found),
                "rows": rows,
            },
            indent=1,
        )
        + "\n"
    )
    for row in rows:
        print(f"{row['mean']:.3f}  {row['cost']:.2f}  {row['name']}", file=sys.stderr)
    best = min(rows, key=lambda row: row["mean"])
    print(f"Best: {best['name']}, {TRIED[best['name']]}")


if __name__ == "__main__":
    main(sys.argv[1:])
