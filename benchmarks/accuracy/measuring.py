# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene's numbers: every way to render it against Cycles, light by light and as whole pictures."""

import sys
import time
from statistics import median

import numpy as np

from . import accuracy_plots, candidates, denoise, metrics, references, visible

KINDS = "indirect", "final"
CLEARLY = 5  # an error must be this many times the reference's own noise
LEAST_SHARE = 0.001  # of the frame, for a table of what is not diffuse


def measure(path, options, afterlight):
    """One scene's entry of accuracy.json; its contact sheet goes to options.out. Raises candidates.Unmeasurable."""
    scene = candidates.open_scene(path, options.size, options.samples, afterlight)
    shown = candidates.ways_of(options.ways, afterlight, options.bounces)
    plain = candidates.render_all(scene, shown, options.rounds, afterlight)
    start = time.perf_counter()
    truth = references.Truth(scene, options.bounces, references.source_key(path), shorter=options.causes)
    surface = (plain.passes.depth > 0) & (plain.passes.depth < 1e9)
    rendered = converge(truth, shown, surface, options)
    masks = masks_of(truth, surface)
    caustics = caustics_of(truth, masks, options)
    print(f"  Cycles' references took {time.perf_counter() - start:.0f} s", file=sys.stderr)
    clean = Clean(truth, np.stack(plain.passes.normal, -1))
    tables = [table(truth, rendered, kind, mask) for kind, mask in masks.items()]
    shines = np.stack(plain.passes.emission, -1).max(-1) > 0  # a lamp, and no surface that is lit
    for one, mask in zip(tables, masks.values(), strict=True):
        add_visible(one, rendered, truth, clean, mask & ~shines)
    entry = {
        "tables": tables,
        "whole": whole_pictures(scene, rendered, clean, masks),
        "caustics": caustics,
        "samples": {str(number): 2 * each.samples for number, each in truth.of.items()},
    }
    accuracy_plots.sheet(rendered, clean.indirect, clean.final, surface, options.out / f"{options.name}.webp")
    if options.causes:
        entry["causes"] = causes_of(afterlight, scene, plain, truth, masks["diffuse"])
    return entry


def converge(truth, shown, surface, options):
    """Give the references samples until every error is clear of their noise, or until they have the most allowed, or
    twice as many would take longer than allowed. Returns all candidates, Cycles' references with fewer bounces among
    them."""
    for number in truth.of:
        truth.extend(number, options.first_samples // 2)
    if not truth.final(truth.longest).any():
        raise candidates.Unmeasurable("Cycles renders it black: it was made for EEVEE alone, and there is no truth")
    while True:
        rendered = shown + [fewer_bounces(truth, number) for number in truth.of if 0 <= number < truth.longest]
        noisy = {
            number
            for kind, mask in masks_of(truth, surface).items()
            for number in too_noisy(table(truth, rendered, kind, mask, flip=False))
        }
        more = [
            number
            for number in sorted(noisy)
            if 4 * truth.of[number].samples <= options.most_samples
            and 2 * truth.seconds(number) <= options.reference_seconds
        ]
        if not more:
            return rendered
        for number in more:
            print(f"  Cycles, {number} bounces: {4 * truth.of[number].samples} samples", file=sys.stderr)
            truth.extend(number, 2 * truth.of[number].samples)


def fewer_bounces(truth, bounces):
    """A reference with fewer bounces, as a candidate."""
    name = "Cycles, direct light only" if bounces == 0 else f"Cycles, {bounces} bounce{'s' * (bounces > 1)}"
    made = candidates.Candidate(name, "Cycles, fewer bounces", None, None)
    made.final, made.indirect, made.bounces = truth.final(bounces), truth.indirect(bounces), bounces
    return made


def masks_of(truth, surface):
    """{"diffuse", and "not diffuse" where there is enough of it: (H, W) bool}."""
    other = truth.of[truth.longest].not_diffuse() & surface
    masks = {"diffuse": surface & ~other}
    return masks | ({"not diffuse": other} if other.mean() > LEAST_SHARE else {})


def table(truth, rendered, kind, mask, flip=True):
    """The rows of one kind of surface. An error that the reference's noise could have made is never given; what the
    true one is about is, and at most: what was measured and that noise together. Energy is a mean of so many pixels
    that noise is none there."""
    pictures = {"indirect": truth.indirect(truth.longest), "final": truth.final(truth.longest)}
    noise, first, rows = truth.noise(mask), rendered[0], []
    for each in rendered:
        row = {"name": each.name, "group": each.group}
        rows.append(row)
        if each.failure:
            row["failed"] = each.failure
            continue
        if each.seconds:
            row["seconds"] = median(each.seconds)
            # A slow way has fewer rounds than the others.
            row["cost"] = median(own / base for own, base in zip(each.seconds, first.seconds, strict=False))
            row["host"] = median(own / base for own, base in zip(each.host, first.seconds, strict=False))
        for picture in [kind for kind in KINDS if getattr(each, kind) is not None]:
            found = metrics.compare(getattr(each, picture), pictures[picture], mask, flip)
            level = (noise if each.bounces is None else truth.noise(mask, each.bounces))[picture]
            spoilt = None not in (level, found["l1"]) and found["l1"] < CLEARLY * level
            row[picture] = (
                found
                if not spoilt
                else {
                    "energy": found["energy"],
                    "at_most": found["l1"] + level,
                    "about": None
                    if each.bounces is not None
                    else metrics.l1_without_noise(
                        getattr(each, picture),
                        *(getattr(truth, picture)(truth.longest, half) for half in range(2)),
                        mask,
                    ),
                    "refused": f"the reference's noise, {level:.4f}, is over a fifth of the error",
                    "bounces": sorted({truth.longest, each.bounces} - {None}),
                }
            )
    whole = pictures["indirect"][mask].mean(dtype=float)
    world = 1 - truth.bounced(truth.longest)[mask].mean(dtype=float) / whole if whole > 0 else 0.0
    return {"surface": kind, "share": float(mask.mean()), "world": float(world), "noise": noise, "rows": rows}


class Clean:
    """The longest reference as Blender's denoiser leaves it (denoise.py). final, indirect: (H, W, 3). halves: [final]
    of each half."""

    def __init__(self, truth, normal):
        albedo = truth.of[truth.longest].whole_albedo()

        def clean(picture):
            return denoise.denoised(picture, albedo, normal)

        self.final, self.indirect = clean(truth.final(truth.longest)), clean(truth.indirect(truth.longest))
        self.halves = [clean(truth.final(truth.longest, half)) for half in range(2)]


def add_visible(one_table, rendered, truth, clean, mask):
    """Blotches and dots of the light, over the brightness of the whole picture, in each row of a table. Where a way has
    no indirect light by itself, the error of its whole picture counts as the light's."""
    indirect = truth.indirect(truth.longest)
    halves, final_halves = ([part(truth.longest, half) for half in range(2)] for part in (truth.indirect, truth.final))
    for row, each in zip(one_table["rows"], rendered, strict=True):
        if each.failure or each.bounces is not None:
            continue
        own = each.indirect is not None
        blotchy = each.indirect if own else each.final - truth.final(truth.longest) + indirect
        dotty = each.indirect if own else each.final - clean.final + clean.indirect
        row["visible"] = {
            "blotches": visible.blotches(blotchy, indirect, mask, clean.final, halves if own else final_halves),
            "dots": visible.dots(dotty, clean.indirect, mask, clean.final),
        }


def whole_pictures(scene, rendered, clean, masks):
    """{picture: {"cycles", "reachable", "cycles, <kind>"}}: LDR-FLIP of the whole picture as the scene's view transform
    shows it, against Cycles, the same on each kind of surface, and against the reachable picture, which is one of the
    rows. visible.NOISE: what the reference's own noise may have in each number, from its halves."""
    eevee = rendered[0]
    best = visible.reachable(eevee.final, eevee.indirect, clean.indirect)
    to_cycles, to_best = (visible.displayed(scene, picture) for picture in (clean.final, best))
    pictures = {each.name: each.final for each in rendered if not each.failure and each.bounces is None}
    found = {}
    for name, picture in (pictures | {visible.REACHABLE: best}).items():
        own = visible.displayed(scene, picture)
        errors = visible.flip_map(own, to_cycles)
        found[name] = {
            "cycles": float(errors.mean(dtype=float)),
            "reachable": float(visible.flip_map(own, to_best).mean(dtype=float)),
        } | {f"cycles, {kind}": float(errors[mask].mean(dtype=float)) for kind, mask in masks.items() if mask.any()}
    found[visible.NOISE] = {"cycles": visible.flip_of_noise([visible.displayed(scene, half) for half in clean.halves])}
    return found


def caustics_of(truth, masks, options):
    """Share of the indirect light on diffuse surfaces that comes to them by way of gloss and glass, which EEVEE cannot
    do; None where there is neither."""
    if "not diffuse" not in masks or not masks["diffuse"].any():
        return None
    without = references.Reference(truth.scene, truth.longest, truth.source, truth.folder, caustics=False)
    without.extend(options.first_samples // 2)
    mask, whole = masks["diffuse"], truth.of[truth.longest].mean("indirect")
    return float(1 - without.mean("indirect")[mask].mean(dtype=float) / max(whole[mask].mean(dtype=float), 1e-30))


def too_noisy(one_table):
    """Numbers of bounces whose references spoil a row of a table."""
    return {
        number for row in one_table["rows"] for picture in KINDS for number in row.get(picture, {}).get("bounces", ())
    }


def causes_of(afterlight, scene, plain, truth, mask):
    """Where the error of the preset Paper comes from."""
    from ..cost import bench
    from . import causes

    bench.use_preset("paper", afterlight)
    settings = afterlight.addon.properties.light_settings(scene.afterlight, scene.frame_current)
    return causes.measure(
        afterlight,
        scene,
        plain.passes,
        plain.camera,
        settings,
        truth.of[0].white_direct(),
        truth.bounced(1),
        truth.bounced(truth.longest),
        mask,
    )
