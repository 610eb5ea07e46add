# SPDX-License-Identifier: GPL-3.0-or-later
"""How close EEVEE, its ray tracing and Afterlight come to Cycles, in tables and pictures, for any .blend files.

    .venv/bin/python -m benchmarks.accuracy [FILE.blend ...] [--out DIR] [--size 320x180] [--bounces 4] [--samples 16]

Exit code 0 where all was measured, 1 where a render failed, otherwise 2 where a file cannot be measured. The files
themselves are only read."""

import argparse
import json
import os
import shlex
import time
import traceback
from pathlib import Path

import session

from .. import ROOT, apart, commit
from . import accuracy_report, candidates, measuring, references

WAYS = "eevee,tracing-best,production,cycles-1,cycles-4,cycles-16"
FAILED, SKIPPED = 1, 2


def measure_one(options):
    """In a process of its own: the entry of one file into options.into."""
    afterlight = session.enable_afterlight()
    try:
        entry = measuring.measure(options.blends[0], options, afterlight)
    except candidates.Unmeasurable as reason:
        entry = {"skipped": str(reason)}
    except Exception as error:  # one file's trouble must not cost the others' numbers
        traceback.print_exc()
        entry = {"failed": f"{type(error).__name__}: {error}"}
    from ..cost import bench

    machine = {} if "tables" not in entry else {"machine": bench.machine()}
    options.into.write_text(json.dumps(entry | machine))


def measure_all(options, path):
    """accuracy.json's content, written to `path` after each scene, lest an interrupted run lose the others."""
    found = {
        "machine": None,
        "command": options.command,
        "commit": commit.current(),
        "size": options.size,
        "bounces": options.bounces,
        "samples": options.samples,
        "rounds": options.rounds,
        "cores": os.cpu_count(),
        "best": candidates.BEST,
        "cycles": references.SETTINGS,
        "clearly": measuring.CLEARLY,
        "not_diffuse": references.NOT_DIFFUSE,
        "scenes": [],
    }
    names = []
    for blend in options.blends:
        names.append(blend.stem if blend.stem not in names else f"{blend.stem}_{len(names)}")
        print(f"{blend.name}:", flush=True)
        start = time.perf_counter()
        entry = apart.measured("benchmarks.accuracy", *arguments_of(options), "--name", names[-1], str(blend))
        found["machine"] = entry.pop("machine", found["machine"])
        scene = {"name": names[-1], "file": blend.name, "took": time.perf_counter() - start} | entry
        found["scenes"].append(scene)
        path.write_text(json.dumps(found, indent=1) + "\n")
        print(f"  {verdict(scene)}, in {scene['took']:.0f} s", flush=True)
    return found


def verdict(scene):
    """What came of a file, in a sentence."""
    if "skipped" in scene:
        return f"skipped, it cannot be measured: {scene['skipped']}"
    if trouble := troubles(scene):
        return f"not all is measured: {'; '.join(trouble)}"
    if any(map(measuring.too_noisy, scene["tables"])):
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
    for name in ("bounces", "samples", "rounds", "first_samples", "most_samples", "reference_seconds"):
        given += [f"--{name.replace('_', '-')}", str(getattr(options, name))]
    return given + ["--ways", ",".join(options.ways)] + ["--causes"] * options.causes


def parse(arguments):
    ways = candidates.names_of_ways()
    parser = argparse.ArgumentParser(prog="benchmarks.accuracy", description="Afterlight's error beside EEVEE's.")
    parser.add_argument(
        "blends", nargs="*", type=Path, metavar="FILE.blend", help="the matt and the artists' samples without"
    )
    parser.add_argument("--scenes", type=Path, metavar="FOLDER", help="every .blend file in it and below")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "accuracy", help="folder; build/accuracy")
    parser.add_argument("--page", type=Path, help="the tables in Markdown; accuracy.md in that folder")
    parser.add_argument("--size", type=picture_size, default=(320, 180), metavar="WxH", help="320x180")
    parser.add_argument("--bounces", type=int, default=4, help="diffuse bounces of the reference; 4")
    parser.add_argument("--samples", type=int, default=16, help="EEVEE's; 16")
    parser.add_argument("--ways", default=WAYS, help=f"to render, of {','.join(ways)}; without: {WAYS}")
    parser.add_argument("--rounds", type=int, default=2, help="timed frames of each; 2, of slow ones 1")
    parser.add_argument("--first-samples", type=int, default=64, help="of a reference, to begin with; 64")
    parser.add_argument("--most-samples", type=int, default=4096, help="of a reference, at most; 4096")
    parser.add_argument("--reference-seconds", type=float, default=100, help="of rendering a reference, at most; 100")
    parser.add_argument("--causes", action="store_true", help="also where the error of the preset Paper comes from")
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
    options.ways = options.ways.split(",")
    if unknown := [name for name in options.ways if name not in ways]:
        parser.error(f"there is no way {unknown[0]}; there are {', '.join(ways)}")
    if options.scenes and not (below := sorted(options.scenes.rglob("*.blend"))):
        parser.error(f"there is no .blend file in {options.scenes}")
    chosen = [*options.blends, *(below if options.scenes else ())]
    options.blends = [path.resolve() for path in chosen or candidates.samples()]
    options.out = options.out.resolve()
    options.page = (options.page or options.out / "accuracy.md").resolve()
    return options


def main(arguments):
    options = parse(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    if options.into:
        return measure_one(options)
    path = options.out / "accuracy.json"
    found = measure_all(options, path)
    accuracy_report.write(path, options.page)
    print(f"Written: {options.page} and {options.out}")
    return exit_code(found["scenes"])
