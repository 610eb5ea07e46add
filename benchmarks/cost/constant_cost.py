# SPDX-License-Identifier: GPL-3.0-or-later
"""Is the cost of the light the same for any scene? The same picture with few and many polygons and lights.

    .venv/bin/python -m benchmarks.cost.constant_cost [--size 1280x720] [--rounds 60]

EEVEE renders the four rooms once each; then the light is gathered from their passes in turn. Writes the last part of
docs/measured/bench.md (or --output). Exit code 1 where one of the ratios is further from 1 than is promised."""

import argparse
import random
import shlex
import sys
import time
from dataclasses import dataclass, field
from importlib import import_module
from itertools import product
from pathlib import Path
from statistics import median, quantiles

import numpy as np

import session

from .. import commit
from . import bench, boxes, cost_report

POLYGONS = 1_000, 3_000_000
LIGHTS = 1, 1_000
POWER = 60.0  # of all lights together, W
BOUND = 0.03  # how far from 1 a ratio of times may be
# The room and what stands in it: two opposite corners of each, m.
BOXES = ((-2, -3, 0), (2, 3, 2.5)), ((-1.2, 0.8, 0), (-0.3, 1.7, 1.4)), ((0.3, -0.2, 0), (1.1, 0.6, 0.7))
COLORS = (0.7, 0.68, 0.65, 1), (0.7, 0.2, 0.1, 1), (0.2, 0.4, 0.7, 1)


@dataclass
class Room:
    """One of the rooms, and what was measured with it. seconds: of the light, one number a round."""

    polygons: int
    lights: int
    passes: object
    camera: object
    eevee: float  # seconds of EEVEE's frame
    seconds: list = field(default_factory=list)

    def ratios(self, first):
        """Times over those of another room, round by round."""
        return [mine / other for mine, other in zip(self.seconds, first.seconds, strict=True)]


def build(polygons, lights, size):
    """A scene in an empty file: a closed room of about so many polygons, lit by so many lights of the same total power.
    Returns the scene and the number of its polygons."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    side = round((polygons / (6 * len(BOXES))) ** 0.5)

    for (low, high), color in zip(BOXES, COLORS, strict=True):
        boxes.put("Box", boxes.box(np.array(low), np.array(high), side, inside=(low, high) == BOXES[0]), color)
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy, lamp.use_shadow = POWER / lights, False
    across = np.ceil(lights**0.5)
    for k in range(lights):
        place = -1.6 + 3.2 * (k % across + 0.5) / across, -2.4 + 4.8 * (k // across + 0.5) / across, 2.3
        boxes.link(bpy.data.objects.new("Lamp", lamp), place)
    scene.camera = boxes.link(bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera")), (0, -2.9, 1.3))
    scene.camera.rotation_euler = np.pi / 2, 0, 0
    scene.camera.data.lens = 24
    scene.render.engine = "BLENDER_EEVEE"
    scene.eevee.taa_render_samples = 1
    scene.eevee.light_threshold = 1e-6  # or each of many weak lights would end a few hand's breadths away
    scene.render.resolution_x, scene.render.resolution_y = size
    return scene, 6 * len(BOXES) * side**2


def rooms(afterlight, polygons, lights, size):
    """[Room], each rendered once by EEVEE after one frame that compiles its shaders."""
    import bpy

    package, found = afterlight.addon.scene, []
    for index, (few_or_many, lamps) in enumerate(product(polygons, lights)):
        scene, count = build(few_or_many, lamps, size)
        for _, switch, _, _ in package.passes.PASSES:
            setattr(scene.view_layers[0], switch, True)
        for _ in range(2 if index == 0 else 1):
            start = time.perf_counter()
            bpy.ops.render.render()
            seconds = time.perf_counter() - start
        path = package.frame_store.save(scene)
        passes = package.passes.load(path, scene.view_layers[0].name, package.cameras.window(scene)[0])
        package.frame_store.discard(path)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        camera = package.cameras.camera(scene.camera.evaluated_get(depsgraph), depsgraph, scene)
        found.append(Room(count, lamps, passes, camera, seconds))
        print(f"{count} polygons, {lamps} lights: EEVEE {seconds:.1f} s", file=sys.stderr, flush=True)
    return found


def clock():
    """(function that tells seconds, what it tells). A software GPU is the processor, whose time other processes do not
    disturb as they do that on the clock."""
    import gpu

    if gpu.platform.device_type_get() == "SOFTWARE":
        return time.process_time, "processor time, since this GPU is software"
    return time.perf_counter, "time on the clock"


def measure(light, found, settings, rounds):
    """Fill in the seconds of each room: whole calls of gather_indirect() in turn, in another order each round."""
    now, _ = clock()
    order = random.Random(0)
    for number in range(-1, rounds):  # the first compiles the shaders and is not counted
        for room in order.sample(found, len(found)):
            start = now()
            light.gather_indirect(room.passes, room.camera, settings)
            if number >= 0:
                room.seconds.append(now() - start)


def verdicts(found):
    """[(sentence, whether the promise is kept)] for each room but the first."""
    first, sentences = found[0], []
    for room in found[1:]:
        ratio = median(room.ratios(first))
        kept = abs(ratio - 1) <= BOUND
        sentences.append(
            (
                f"{'Kept' if kept else 'MISSED'}: {room.polygons:,} polygons and {_lights(room)} take "
                f"{ratio:.3f} of the time of {first.polygons:,} polygons and {_lights(first)}. "
                f"Promised: within {BOUND:.0%} of 1.",
                kept,
            )
        )
    return sentences


def section(found, settings, size, machine, command, commit):
    """The part of the page."""
    first = found[0]
    rows = []
    for room in found:
        low, middle, high = quantiles(room.ratios(first), n=4)
        rows.append(
            (
                f"{room.polygons:,}",
                f"{room.lights:,}",
                f"{median(room.seconds):.3f}",
                f"{middle:.3f}",
                f"{low:.3f} to {high:.3f}",
                f"{room.eevee:.2f}",
                f"{room.eevee / first.eevee:.1f}",
            )
        )
    return (
        "\n\n".join(
            [
                cost_report.CONSTANT_COST,
                f"One closed room at {size[0]}x{size[1]}, its surfaces cut into few and many polygons, lit by one "
                "and by many "
                f"lights of the same total power, measured at commit {commit} by",
                f"    {command}",
                f"on {machine}.",
                "\n".join(f"- {sentence}" for sentence, _ in verdicts(found)),
                f"The light: the whole of `gather_indirect()`, arrays in and an array out, at start {settings.start}, "
                f"{settings.samples} samples, radius {settings.radius}; {len(first.seconds)} rounds in one "
                "process, the rooms "
                f"in another order each round; {clock()[1]}. Ratios are taken round by round, and their median "
                "counts. EEVEE: "
                "one frame of one sample without shadows, on the clock, for contrast.",
                cost_report.table(
                    ("polygons", "lights", "gather, s", "ratio", "middle half of ratios", "EEVEE, s", "ratio"), rows
                ),
            ]
        )
        + "\n"
    )


def _lights(room):
    return f"{room.lights:,} light{'s' * (room.lights > 1)}"


def main():
    parser = argparse.ArgumentParser(description="Afterlight's time by polygons and lights.")
    parser.add_argument("--size", type=bench.size, default=(1280, 720), metavar="WxH", help="of the frames; 1280x720")
    parser.add_argument("--rounds", type=int, default=60, help="how often each room's light is gathered; 60")
    parser.add_argument("--output", type=Path, default=bench.PAGE, help="the page; docs/measured/bench.md")
    options = parser.parse_args(session.arguments())
    if options.rounds < 2:
        parser.error("--rounds must be 2 or more: the spread of the ratios is reported")
    afterlight = session.enable_afterlight()
    import gpu

    gpu.init()
    light = import_module(f"{afterlight.__name__}.addon.gather")
    found = rooms(afterlight, POLYGONS, LIGHTS, options.size)
    settings = light.PaperSettings(start=4, samples=64, radius=16, seed=0, strength=1.0)
    measure(light, found, settings, options.rounds)
    command = shlex.join([".venv/bin/python", "-m", "benchmarks.cost.constant_cost", *session.arguments()])
    text = section(found, settings, options.size, bench.machine(), command, commit.current())
    cost_report.write(options.output, constant_cost=text)
    print(text)
    return int(not all(kept for _, kept in verdicts(found)))


if __name__ == "__main__":
    sys.exit(main())
