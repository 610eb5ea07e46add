# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast the light itself is on this machine's GPU, without Blender: passes, the paper's table, ceilings and growth.

    .venv/bin/python -m benchmarks.gpu [--quick] [--method paper|radiosity] [--out docs/measured/speed.md]

Any Python with numpy, moderngl and matplotlib will do. Writes docs/measured/speed/<renderer>.json, then
docs/measured/speed.md and its plots from all such files there. Exit code 1 where a frame of Paper takes longer than AIM
times its floor."""

import argparse
import json
import os
import re
import shlex
import sys
from functools import lru_cache, partial
from pathlib import Path

from .. import ROOT, commit
from ..cost import cost_report
from . import ceilings, fetchless, gpu_report, opengl, radiosity_speed, repeats, room

METHODS = "paper", "radiosity"
SIZE = 1280, 720
RADIUS = 16
PAPER = (4, 64), (4, 256), (2, 256), (2, 64)  # start and samples, in the order of the paper's table
LIGHT, HEAVY = (4, 64), (2, 256)  # those that growth is measured at
SIZES = (640, 360), (960, 540), (1280, 720), (1920, 1080), (2560, 1440), (3840, 2160)
SAMPLES = 16, 32, 64, 128, 256, 512, 1024
SAMPLES_RADIUS = 32  # its regions hold more than 1024 texels
RADII = 4, 8, 16, 32, 64


def measure(light, quick=False):
    """The part of Paper in the numbers of one machine. Seconds; lists hold one number a frame."""
    sizes, counts, radii = (SIZES[:3], SAMPLES[:4], RADII[:3]) if quick else (SIZES, SAMPLES, RADII)
    patience = repeats.PATIENCE / 4 if quick else repeats.PATIENCE
    frame = lru_cache(maxsize=1)(lambda size: room.frame(light, *size))

    def cases(some):
        return repeats.series(
            (
                (
                    _name(size, start, samples, radius),
                    cost,
                    lambda size=size, start=start, samples=samples, radius=radius: run(
                        light, *frame(size), settings(light, start, samples, radius), patience
                    ),
                    False,
                )
                for size, start, samples, radius, cost in some
            ),
            patience,
        )

    paper = [run(light, *frame(SIZE), settings(light, start, samples), patience, wall=True) for start, samples in PAPER]
    chosen = settings(light, *LIGHT)
    repeats.say("ceilings")
    rates = ceilings.measure(light, *frame(SIZE), chosen)
    floor = [
        {
            "stage": work.stage,
            "read": work.read,
            "written": work.written,
            "fetches": work.fetches,
            "samples": work.samples,
            "seconds": work.floor(rates)[0],
            "limit": work.floor(rates)[1],
        }
        for work in ceilings.work(light.pyramid, *SIZE, chosen)
    ]
    growth = {
        "samples": cases((SIZE, LIGHT[0], count, SAMPLES_RADIUS, count) for count in counts),
        "radius": cases((SIZE, *LIGHT, radius, 1) for radius in radii),
    }
    for name, setting in (("pixels_light", LIGHT), ("pixels_heavy", HEAVY)):
        growth[name] = cases((size, *setting, RADIUS, size[0] * size[1]) for size in sizes)
    return {
        "gather_passes": fetchless.gather_passes(light),
        "paper": paper,
        "rates": rates,
        "floor": floor,
        "growth": growth,
    }


def run(light, passes, camera, settings, patience=repeats.PATIENCE, wall=False):
    """Frames of one size and setting: the GPU's seconds by pass and in all, and, where asked for, those on the clock
    for the whole of gather_indirect() from arrays to an array, in frames of their own without timers."""
    sizes = light.pyramid.level_sizes(*(-(-extent // settings.start) for extent in passes.size), settings.radius)
    found = {
        "size": passes.size,
        "start": settings.start,
        "samples": settings.samples,
        "radius": settings.radius,
        "levels": len(sizes),
    }
    repeats.say(_name(passes.size, settings.start, settings.samples, settings.radius))
    gather = partial(light.gather_indirect, passes, camera, settings)
    gather()  # compiles
    return repeats.frames(light, gather, found, patience, wall)


def settings(light, start, samples, radius=RADIUS):
    return light.PaperSettings(start=start, samples=samples, radius=radius, seed=0, strength=1.0)


def machine():
    """What the numbers were measured on."""
    info = opengl.context().info
    return {
        "renderer": info["GL_RENDERER"],
        "vendor": info["GL_VENDOR"],
        "version": info["GL_VERSION"],
        "processor": cost_report.processor(),
        "cores": os.cpu_count(),
        "timer": "timer queries" if opengl.queries_cover_compute() else "the clock around each dispatch",
    }


def _name(size, start, samples, radius):
    return f"{size[0]}x{size[1]}, start {start}, {samples} samples, radius {radius}"


def measured(light, methods, quick, command):
    """All numbers of some METHODS on one machine, as they go into its JSON file. Those of Radiosity are a part of their
    own, with the command and the commit that they were measured by."""
    source = {"commit": commit.current(), "command": command, "quick": quick}
    found = {"machine": machine()}
    if "paper" in methods:
        found |= source | measure(light, quick)
    if "radiosity" in methods:
        found["radiosity"] = source | radiosity_speed.measure(light, quick)
    return found


def keep_others(found, before):
    """The numbers of a machine, and from those measured before the method that has not been measured now."""
    return before | found


def main():
    parser = argparse.ArgumentParser(description="Afterlight's speed on this machine's GPU, without Blender.")
    parser.add_argument("--quick", action="store_true", help="fewer and smaller frames, in a minute or two")
    parser.add_argument("--method", choices=METHODS, help="only this one; the numbers of the other are kept")
    parser.add_argument(
        "--out", type=Path, default=ROOT / "docs" / "measured" / "speed.md", help="the page; docs/measured/speed.md"
    )
    options = parser.parse_args()
    command = shlex.join(["python", "-m", "benchmarks.gpu", *sys.argv[1:]])
    light, folder = opengl.start(), gpu_report.folder_of(options.out)
    name = re.sub(r"[^a-z0-9]+", "-", machine()["renderer"].lower()).strip("-")
    file, before = folder / f"{name}.json", {}
    if options.method and file.exists():
        before = gpu_report.read(file)  # now, since it may not hold what it should
    found = measured(light, [options.method] if options.method else METHODS, options.quick, command)
    found = keep_others(found, before)
    folder.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(found, indent=1) + "\n")
    gpu_report.write(options.out)
    print("\n".join(gpu_report.sentences(found)))
    return int("paper" in found and options.method != "radiosity" and not gpu_report.verdict(found)[1])
