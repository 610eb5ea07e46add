# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of the world automatic views should show: the error of a preset by the field of its views.

    .venv/bin/python -m benchmarks.studies.field_study [FILE.blend ...] [--fields 110w,110,120,130] [--seeds 2]
    [--samples 512]

A field in degrees is the same across and up; with a w behind it, it is the one across, and up it is less, so that
pixels are squares. Prints a table: relative L1 error and energy of the indirect light against Cycles, the share of the
light that the views see, and how many there are, for each seed, each with views of its own. --samples: of each half of
a reference.

The tables in docs/blender/views.md are of commit fe3c69f (25 November 2026), unless the page says otherwise.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import session

from ..accuracy import accuracy, candidates, metrics, references
from ..cost import bench

SIZE, EEVEE_SAMPLES, BOUNCES = (320, 180), 16, 4


def half_field(field):
    """Tangents of half of it, across and up."""
    half = np.tan(np.radians(float(field.rstrip("w"))) / 2) * np.ones(2)
    return half * np.array(SIZE) / max(SIZE) if field.endswith("w") else half


def lit(scene, seed, preset, afterlight):
    """The picture with views placed for this seed alone, and (shares of the light that they see, seconds)."""
    bench.use_preset(preset, afterlight)
    scene.afterlight.seed, scene.afterlight.enabled = seed, True  # to untick it takes the views away
    _, final = candidates.written(scene)
    if scene.afterlight.report:
        sys.exit(scene.afterlight.report)
    seen = afterlight.addon.host.report.coverage(scene)
    scene.afterlight.enabled = False
    return final, seen


def study(path, wanted, afterlight):
    """Prints the rows of one scene."""
    scene = candidates.open_scene(path, SIZE, EEVEE_SAMPLES, afterlight)
    truth = references.Truth(scene, BOUNCES, references.source_key(path))
    truth.extend(BOUNCES, wanted.samples)
    _, final = candidates.written(scene)
    plain = candidates.look(scene, final, afterlight)
    mask = accuracy.masks_of(truth, (plain.passes.depth > 0) & (plain.passes.depth < 1e9))["diffuse"]
    noise = truth.noise(mask)["indirect"]
    for field in wanted.fields.split(","):
        afterlight.addon.scene.view_cameras.HALF_FIELD = half_field(field)
        cells = []
        for seed in range(wanted.seeds):
            final, (shares, _) = lit(scene, seed, wanted.preset, afterlight)
            found = metrics.compare(final - plain.final + plain.world, truth.indirect(BOUNCES), mask, False)
            cells.append(f"{found['l1']:.3f}, {found['energy']:.3f} ({shares[-1]:.0%} by {len(shares) - 1})")
        print(f"| {path.stem} | {noise:.3f} | {field} | {' | '.join(cells)} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, default=candidates.diffuse_samples())
    parser.add_argument("--fields", default="110w,110,120,130")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--samples", type=int, default=512)
    parser.add_argument("--preset", default="production")
    wanted = parser.parse_args()
    afterlight = session.enable_afterlight()
    print(
        f"| scene | noise | field | {' | '.join(f'seed {seed}' for seed in range(wanted.seeds))} |\n"
        f"|---|---:|---:|{'---|' * wanted.seeds}",
        flush=True,
    )
    for path in wanted.files:
        study(path.resolve(), wanted, afterlight)


if __name__ == "__main__":
    main()
