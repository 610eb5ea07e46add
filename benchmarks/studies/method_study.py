# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurements that decided the method, printed as the tables of docs/method/paper.md.

    .venv/bin/python -m benchmarks.studies.method_study [radius] [samples] [bound] [upsampling]    three minutes for all

Frames: the box room of the tests as EEVEE renders it, 160 x 90 (radius, upsampling: against the float64 sum over all
pairs of pixels, which is only affordable there) and 640 x 360 (samples), and a closed box traced exactly (bound).

The tables in docs/method/paper.md are of commit dc1554d (23 November 2026), unless the page says otherwise.
"""

import argparse
import importlib
from itertools import product

import extension

afterlight = extension.start()
import numpy as np

import gather_fixtures as fixtures
from reference import paper as reference

light = importlib.import_module(f"{afterlight.__name__}.addon.gather")
SEEDS = 8


def settings(start=1, samples=0, radius=16, seed=0):
    return light.PaperSettings(start=start, samples=samples, radius=radius, seed=seed, strength=1.0)


def base_total(passes, camera, chosen):
    """(H, W, 4): irradiance and form factors at the base, and the texture samples spent per base texel."""
    pyramid = fixtures.pyramid_of(light, passes, camera, chosen)
    spent = 0
    for index, (_, _, width, height) in enumerate(pyramid.boxes):
        region = len(light.paper.offsets(chosen.radius, index == 0))
        spent += width * height * light.paper.samples_at(index, chosen.samples, region)
    total = light.upsample(pyramid, light.gather(pyramid, chosen))
    return np.array(total.read(), np.float64), spent / np.prod(pyramid.boxes[0][2:])


def same_at_each_level(level, samples, texels):
    """What pyramid.samples_at() would be without doubling."""
    return min(samples, texels) if samples else texels


def bounded(total):
    return total[..., :3] / np.maximum(total[..., 3:], 1)


def compare(picture, true):
    """(RMSE over the mean, mean over the true mean)."""
    return np.sqrt(((picture - true) ** 2).mean()) / true.mean(), picture.mean() / true.mean()


def against_all_pairs():
    """The EEVEE frame, and its indirect light by the sum over all pairs."""
    passes, camera = fixtures.rendered_box(light)
    guide, base = reference.pack(passes, camera, 1)
    sums = reference.all_pairs(base)
    return passes, camera, sums, reference.composite(passes, guide, base, sums, camera, 1, 1.0)[..., :3]


def radius_table():
    passes, camera, _, true = against_all_pairs()
    print("\nradius: RMSE / mean and energy against all pairs, mean of seeds; 160 x 90\n")
    print("| start | radius | exhaustive | 64 samples | 256 samples |\n|---|---|---|---|---|")
    for start, radius in product((1, 2, 4), (4, 8, 12, 16, 24, 32)):
        cells = []
        for samples in (0, 64, 256):
            results = [
                compare(light.gather_indirect(passes, camera, settings(start, samples, radius, seed))[..., :3], true)
                for seed in range(SEEDS if samples else 1)
            ]
            cells.append("{:.3f}, {:.3f}".format(*np.mean(results, axis=0)))
        print(f"| {start} | {radius} | {' | '.join(cells)} |", flush=True)


def samples_table():
    passes, camera = fixtures.rendered_box(light, 640, 360)
    doubled = light.paper.samples_at
    print(
        "\nsamples: noise (RMSE against the exhaustive sum / mean) and flicker of the frame's mean over seeds; "
        "640 x 360\n"
    )
    print("| start | radius | samples | the same at each level: cost, noise, flicker | doubled: cost, noise, flicker |")
    print("|---|---|---|---|---|")
    for start, radius, samples in product((1, 4), (8, 16, 24), (64, 256)):
        exhaustive = bounded(base_total(passes, camera, settings(start, 0, radius))[0])
        cells = []
        for schedule in (same_at_each_level, doubled):
            light.paper.samples_at = schedule
            runs = [base_total(passes, camera, settings(start, samples, radius, seed)) for seed in range(SEEDS)]
            noise = np.mean([compare(bounded(total), exhaustive)[0] for total, _ in runs])
            means = np.array([bounded(total).mean() for total, _ in runs])
            cells.append(f"{runs[0][1]:.0f}, {noise:.3f}, {means.std() / means.mean():.4f}")
        print(f"| {start} | {radius} | {samples} | {' | '.join(cells)} |", flush=True)


def bound_table():
    print(
        "\nbound: E / max(1, F) in a white furnace (closed box, 160 x 120); energy is the mean of seeds over the "
        "exhaustive mean\n"
    )
    print(
        "| radius | samples | largest F, exhaustive | largest F | energy unbounded | bounded | bounded where F > 0.8 |"
    )
    print("|---|---|---|---|---|---|---|")
    passes, camera = fixtures.box_frame(light, 160, 120, radiance=1.0)
    for radius, samples in product((8, 16), (16, 64, 256)):
        exhaustive = base_total(passes, camera, settings(1, 0, radius))[0]
        runs = np.array([base_total(passes, camera, settings(1, samples, radius, seed))[0] for seed in range(16)])
        high = exhaustive[..., 3] > 0.8
        true = bounded(exhaustive)
        print(
            f"| {radius} | {samples} | {exhaustive[..., 3].max():.3f} | {runs[..., 3].max():.2f} "
            f"| {runs[..., :3].mean() / exhaustive[..., :3].mean():.4f} | {bounded(runs).mean() / true.mean():.4f} "
            f"| {bounded(runs)[:, high].mean() / true[high].mean():.4f} |",
            flush=True,
        )


def upsampling_table():
    passes, camera, _, true = against_all_pairs()
    print("\nupsampling: RMSE / mean and energy against all pairs, exhaustive, float64; 160 x 90\n")
    print("| flatness | cosine's power | least weight | start 1, R 8 | start 1, R 16 | start 4, R 16 |")
    print("|---|---|---|---|---|---|")
    cases = []
    for start, radius in ((1, 8), (1, 16), (4, 16)):
        guide, base = reference.pack(passes, camera, start)
        levels = reference.pyramid(base, radius)
        cases.append(
            (start, guide, levels, [reference.gather(level, k == 0, radius) for k, level in enumerate(levels)])
        )
    for flatness, power, least in (
        (16, 8, 1e-3),
        (1, 8, 1e-3),
        (256, 8, 1e-3),
        (16, 2, 1e-3),
        (16, 32, 1e-3),
        (16, 8, 1e-1),
        (16, 8, 1e-2),
        (16, 8, 1e-4),
        (0, 0, 1),
    ):
        reference.FLATNESS_SHARPNESS, reference.NORMAL_POWER, reference.MIN_WEIGHT = flatness, power, least
        cells = []
        for start, guide, levels, own in cases:
            total = reference.upsample(levels, own)
            picture = reference.composite(passes, guide, levels[0], total, camera, start, 1.0)[..., :3]
            cells.append("{:.3f}, {:.3f}".format(*compare(picture, true)))
        print(f"| {flatness} | {power} | {least} | {' | '.join(cells)} |", flush=True)


TABLES = {"radius": radius_table, "samples": samples_table, "bound": bound_table, "upsampling": upsampling_table}

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=f"of {', '.join(TABLES)}; all without")
    wanted = parser.parse_args()
    if unknown := [name for name in wanted.tables if name not in TABLES]:
        parser.error(f"there is no table {unknown[0]}; there are {', '.join(TABLES)}")
    for name in wanted.tables or TABLES:
        TABLES[name]()
