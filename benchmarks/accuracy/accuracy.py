# SPDX-License-Identifier: GPL-3.0-or-later
"""How close EEVEE, its ray tracing and Afterlight come to Cycles, in tables and pictures, for any .blend files.

    .venv/bin/python -m benchmarks.accuracy [FILE.blend ...] [--out DIR] [--size 320x180] [--bounces 4] [--samples 16]

Exit code 0 where all was measured, 1 where a render failed, otherwise 2 where a file cannot be measured. The files
themselves are only read."""

import argparse
import json
import os
import shlex
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path
from statistics import median

import session

from .. import ROOT, commit
from . import accuracy_report, candidates, metrics, references, visible

KINDS = "indirect", "final"
CLEARLY = 5  # an error must be this many times the reference's own noise
LEAST_SHARE = 0.001  # of the frame, for a table of what is not diffuse
FAILED, SKIPPED = 1, 2


def measure(path, options, afterlight):
    """One scene's entry of accuracy.json; its contact sheet goes to options.out. Raises candidates.Unmeasurable."""
    scene = candidates.open_scene(path, options.size, options.samples, afterlight)
    shown = candidates.all_of(afterlight, options.bounces, options.presets)
    plain = candidates.render_all(scene, shown, options.rounds, afterlight)
    truth = references.Truth(scene, options.bounces, references.source_key(path))
    surface = (plain.passes.depth > 0) & (plain.passes.depth < 1e9)
    rendered = converge(truth, shown, surface, options)
    masks = masks_of(truth, surface)
    tables = [table(truth, rendered, kind, mask) for kind, mask in masks.items()]
    for one, mask in zip(tables, masks.values(), strict=True):
        add_visible(one, rendered, truth, mask)
    entry = {
        "tables": tables,
        "whole": whole_pictures(scene, rendered, truth),
        "samples": {str(number): 2 * each.samples for number, each in truth.of.items()},
    }
    sheet = options.out / f"{options.name}.webp"
    accuracy_report.sheet(rendered, truth.indirect(truth.longest), truth.final(truth.longest), surface, sheet)
    if not options.no_causes:
        entry["causes"] = causes_of(afterlight, scene, plain, truth, masks["diffuse"])
    return entry


def converge(truth, shown, surface, options):
    """Give the references samples until every error is clear of their noise, or until they have the most allowed.
    Returns all candidates, Cycles' references with fewer bounces among them."""
    for number in truth.of:
        truth.extend(number, options.first_samples // 2)
    while True:
        rendered = shown + [shorter(truth, number) for number in truth.of if 0 <= number < truth.longest]
        noisy = {
            number
            for kind, mask in masks_of(truth, surface).items()
            for number in too_noisy(table(truth, rendered, kind, mask, flip=False))
        }
        more = [number for number in sorted(noisy) if 4 * truth.of[number].samples <= options.most_samples]
        if not more:
            return rendered
        for number in more:
            print(f"  Cycles, {number} bounces: {4 * truth.of[number].samples} samples", file=sys.stderr)
            truth.extend(number, 2 * truth.of[number].samples)


def shorter(truth, bounces):
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
            row["cost"] = median(own / base for own, base in zip(each.seconds, first.seconds, strict=True))
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


def add_visible(one_table, rendered, truth, mask):
    """Blotches and dots of the light, in each row of a table. Where a way has no indirect light by itself, the error of
    its whole picture counts as the light's."""
    indirect, final = truth.indirect(truth.longest), truth.final(truth.longest)
    halves = [truth.indirect(truth.longest, half) for half in range(2)]
    for row, each in zip(one_table["rows"], rendered, strict=True):
        if each.failure or each.bounces is not None:
            continue
        light = each.indirect if each.indirect is not None else each.final - final + indirect
        row["visible"] = {
            "blotches": visible.blotches(light, indirect, mask, halves),
            "dots": visible.dots(light, indirect, mask, halves),
        }


def whole_pictures(scene, rendered, truth):
    """{way: {"cycles", "reachable"}}: LDR-FLIP of the whole picture as the scene's view transform shows it, against
    Cycles and against the reachable picture."""
    eevee = rendered[0]
    best = visible.reachable(eevee.final, eevee.indirect, truth.indirect(truth.longest))
    shown = {"cycles": truth.final(truth.longest), "reachable": best}
    shown = {name: visible.displayed(scene, picture) for name, picture in shown.items()}
    found = {}
    for each in rendered:
        if not each.failure and each.bounces is None:
            own = visible.displayed(scene, each.final)
            found[each.name] = {name: visible.ldr_flip(own, other) for name, other in shown.items()}
    return found


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


def measure_one(options):
    """In a process of its own: the entry of one file into options.into."""
    afterlight = session.enable_afterlight()
    try:
        entry = measure(options.blends[0], options, afterlight)
    except candidates.Unmeasurable as reason:
        entry = {"skipped": str(reason)}
    except Exception as error:  # one file's trouble must not cost the others' numbers
        traceback.print_exc()
        entry = {"failed": f"{type(error).__name__}: {error}"}
    from ..cost import bench

    machine = {} if "tables" not in entry else {"machine": bench.machine()}
    options.into.write_text(json.dumps(entry | machine))


def measure_all(options):
    """accuracy.json's content. Each file has a process: one that brings Blender down leaves the rest alone."""
    scenes, names = [], []
    for path in options.blends:
        name = path.stem if path.stem not in names else f"{path.stem}_{len(names)}"
        names.append(name)
        print(f"{path.name}:", flush=True)
        with tempfile.TemporaryDirectory(prefix="afterlight-accuracy-") as folder:
            into = Path(folder) / "entry.json"
            command = [
                sys.executable,
                "-m",
                "benchmarks.accuracy",
                *arguments_of(options),
                "--name",
                name,
                "--into",
                str(into),
                str(path),
            ]
            # Blender says a line a frame on stdout; what a person needs to know comes on stderr.
            code = subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL).returncode
            entry = json.loads(into.read_text()) if into.exists() else {"failed": f"Blender ended with code {code}"}
        scenes.append({"name": name, "file": path.name} | entry)
        print(f"  {verdict(scenes[-1])}", flush=True)
    machine = next((scene.pop("machine") for scene in scenes if "machine" in scene), None)
    for scene in scenes:
        scene.pop("machine", None)
    return {
        "machine": machine,
        "command": options.command,
        "commit": commit.current(),
        "size": options.size,
        "bounces": options.bounces,
        "samples": options.samples,
        "rounds": options.rounds,
        "cores": os.cpu_count(),
        "best": candidates.BEST,
        "cycles": references.SETTINGS,
        "clearly": CLEARLY,
        "not_diffuse": references.NOT_DIFFUSE,
        "scenes": scenes,
    }


def verdict(scene):
    """What came of a file, in a sentence."""
    if "skipped" in scene:
        return f"skipped, it cannot be measured: {scene['skipped']}"
    if trouble := troubles(scene):
        return f"not all is measured: {'; '.join(trouble)}"
    if any(map(too_noisy, scene["tables"])):
        return "measured; where the reference is too noisy for an error, only what it is at most (--most-samples)"
    return "measured"


def troubles(scene):
    """Why numbers of a scene are missing that should be there."""
    rows = [row for one in scene.get("tables", ()) for row in one["rows"]]
    found = [scene["failed"]] if "failed" in scene else []
    return found + sorted({f"{row['name']} failed: {row['failed']}" for row in rows if "failed" in row})


def exit_code(scenes):
    if any(troubles(scene) for scene in scenes):
        return FAILED
    return SKIPPED if any("skipped" in scene for scene in scenes) else 0


def picture_size(text):
    width, height = map(int, text.split("x"))
    return width, height


def arguments_of(options):
    """The command line of one file's process."""
    given = ["--out", str(options.out), "--size", "x".join(map(str, options.size))]
    for name in ("bounces", "samples", "rounds", "first_samples", "most_samples"):
        given += [f"--{name.replace('_', '-')}", str(getattr(options, name))]
    return given + ["--presets", ",".join(options.presets)] + ["--no-causes"] * options.no_causes


def parse(arguments):
    parser = argparse.ArgumentParser(prog="benchmarks.accuracy", description="Afterlight's error beside EEVEE's.")
    parser.add_argument("blends", nargs="*", type=Path, metavar="FILE.blend", help="all of sample_blends/ without")
    parser.add_argument("--scenes", type=Path, metavar="FOLDER", help="every .blend file in it and below")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "accuracy", help="folder; build/accuracy")
    parser.add_argument("--page", type=Path, help="the tables in Markdown; accuracy.md in that folder")
    parser.add_argument("--size", type=picture_size, default=(320, 180), metavar="WxH", help="320x180")
    parser.add_argument("--bounces", type=int, default=4, help="diffuse bounces of the reference; 4")
    parser.add_argument("--samples", type=int, default=16, help="EEVEE's; 16")
    parser.add_argument("--presets", default="", help="Afterlight's, as draft,paper; all that there are")
    parser.add_argument("--rounds", type=int, default=2, help="timed frames of each; 2")
    parser.add_argument("--first-samples", type=int, default=64, help="of a reference, to begin with; 64")
    parser.add_argument("--most-samples", type=int, default=4096, help="of a reference, at most; 4096")
    parser.add_argument("--no-causes", action="store_true", help="leave out where the error comes from")
    parser.add_argument("--name", help=argparse.SUPPRESS)
    parser.add_argument("--into", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if (
        options.bounces < 1
        or options.samples < 1
        or options.rounds < 1
        or options.first_samples < 2
        or (min(options.size) < 8)
    ):
        parser.error(
            "--bounces, --samples and --rounds are at least 1, --first-samples 2, each side of --size 8 pixels"
        )
    options.command = shlex.join([".venv/bin/python", "-m", "benchmarks.accuracy", *arguments])
    options.presets = [name for name in options.presets.split(",") if name]
    known = sorted(path.stem for path in (ROOT / "addon" / "presets" / "afterlight").glob("*.py"))
    if unknown := [name for name in options.presets if name not in known]:
        parser.error(f"there is no preset {unknown[0]}; there are {', '.join(known)}")
    if options.scenes and not (below := sorted(options.scenes.rglob("*.blend"))):
        parser.error(f"there is no .blend file in {options.scenes}")
    chosen = [*options.blends, *(below if options.scenes else ())]
    options.blends = [path.resolve() for path in chosen or candidates.diffuse_samples()]
    options.out = options.out.resolve()
    options.page = (options.page or options.out / "accuracy.md").resolve()
    return options


def main(arguments):
    options = parse(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    if options.into:
        return measure_one(options)
    found = measure_all(options)
    path = options.out / "accuracy.json"
    path.write_text(json.dumps(found, indent=1) + "\n")
    accuracy_report.write(path, options.page)
    print(f"Written: {options.page} and {options.out}")
    return exit_code(found["scenes"])
