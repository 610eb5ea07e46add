# SPDX-License-Identifier: GPL-3.0-or-later
"""What ticking Indirect Light adds to a frame, by what the scene weighs.

    .venv/bin/python -m benchmarks.cost.tick [SERIES ...] [--size 320x180] [--page docs/measured/tick.md]

Each case has a process of its own: the peak of its memory is its own, and one that fails leaves the others' numbers.
Writes a JSON file after each case, and the page from it. Exit code 1 where a case failed."""

import argparse
import json
import shlex
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

import session

from .. import ROOT, apart, commit
from . import bench, shares, tick_cases, tick_report

PAGE = ROOT / "docs" / "measured" / "tick.md"
SAMPLES = 9  # of EEVEE, for the cost of one more


@contextmanager
def counted_evaluations():
    """[count], which grows each time that a dependency graph evaluates the geometry of a scene: its first evaluation
    does, and one for another frame only where something changes shape."""
    import bpy

    count = [0]

    def on_evaluated(scene, depsgraph):
        count[0] += depsgraph.mode == "RENDER" and any(
            update.is_updated_geometry and isinstance(update.id, bpy.types.Object) and update.id.type == "MESH"
            for update in depsgraph.updates
        )

    with shares.listening(frame_change_post=on_evaluated):
        yield count


def measure_still(scene, afterlight):
    """{"plain", "plain, 9 samples", "anew", "kept"}: frames, see frame(). anew: views are placed in that very frame.
    kept: the frame after it, whose views are where they were."""
    frame(scene, afterlight)  # EEVEE compiles the scene's materials
    forget_peak()
    found = {"plain": frame(scene, afterlight)}
    found[f"plain, {SAMPLES} samples"] = frame(scene, afterlight, SAMPLES)
    scene.afterlight.enabled = True
    if scene.afterlight.views == "AUTOMATIC":
        afterlight.addon.compositor.view_scenes.forget_placement(scene)
    found["anew"] = frame(scene, afterlight)
    found["kept"] = frame(scene, afterlight)
    return found


def frame(scene, afterlight, samples=1):
    """{"seconds", "gpu", "evaluations", "peak", "stages"} of a frame as F12 renders it. peak: most memory so far, MB.
    Raises RuntimeError where it was not lit."""
    import bpy

    scene.eevee.taa_render_samples = samples
    start = time.perf_counter()
    with shares.clock() as clock, counted_evaluations() as count:
        bpy.ops.render.render(scene=scene.name)
    found = {
        "seconds": time.perf_counter() - start,
        "gpu": clock.gpu,
        "evaluations": count[0],
        "peak": peak(),
    }
    if scene.afterlight.enabled:
        if scene.afterlight.report:
            raise RuntimeError(scene.afterlight.report)
        found["stages"] = dict(afterlight.addon.host.report.stages(scene))
    return found


def measure_animation(scene, afterlight):
    """As measure_still(), of a frame of an animation, the mean of all but the first: "plain", "plain, 9 samples" and
    "lit"."""
    animation(scene, afterlight)
    forget_peak()
    found = {"plain": animation(scene, afterlight)}
    found[f"plain, {SAMPLES} samples"] = animation(scene, afterlight, SAMPLES)
    scene.afterlight.enabled = True
    return found | {"lit": animation(scene, afterlight)}


def animation(scene, afterlight, samples=1):
    """What frame() gives, of a frame of the animation, in which all but the first count."""
    import bpy

    scene.eevee.taa_render_samples = samples
    scene.render.image_settings.file_format = "OPEN_EXR"
    ends, stages = [], []

    def note(*_):
        ends.append((time.perf_counter(), clock.gpu, count[0]))
        stages.append(dict(afterlight.addon.host.report.stages(scene)))

    with (
        tempfile.TemporaryDirectory(prefix="afterlight-tick-") as folder,
        shares.clock() as clock,
        counted_evaluations() as count,
        shares.listening(render_write=note),
    ):
        scene.render.filepath = str(Path(folder) / "frame_####")
        bpy.ops.render.render(animation=True, scene=scene.name)
    if scene.afterlight.enabled and scene.afterlight.report:
        raise RuntimeError(scene.afterlight.report)
    seconds, gpu, evaluations = (
        (last - first) / (len(ends) - 1) for first, last in zip(ends[0], ends[-1], strict=True)
    )
    found = {"seconds": seconds, "gpu": gpu, "evaluations": evaluations, "peak": peak()}
    if scene.afterlight.enabled:
        names = dict.fromkeys(name for each in stages[1:] for name in each)
        found["stages"] = {name: sum(each.get(name, 0) for each in stages[1:]) / len(stages[1:]) for name in names}
    return found


def forget_peak():
    """Begin peak() anew. Linux alone can do that."""
    if sys.platform == "linux":
        Path("/proc/self/clear_refs").write_text("5")


def peak():
    """The most memory that this process has held since forget_peak(), MB; None but on Linux."""
    if sys.platform != "linux":
        return None
    lines = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines() if ":" in line)
    return int(lines["VmHWM"].split()[0]) * 1024 / 1e6


def measure(series, case, options):
    """One case in this process: its entry of the JSON file."""
    afterlight = session.enable_afterlight()
    import bpy

    afterlight.addon.host.report.wants_stages = True
    scene, _ = tick_cases.build("objects", "1", options.size)  # compiles EEVEE's shaders and ours
    scene.afterlight.enabled, scene.eevee.taa_render_samples = True, 1
    bpy.ops.render.render(scene=scene.name)
    scene, polygons = tick_cases.build(series, case, options.size)
    of = measure_animation if series == "animation" else measure_still
    return {"polygons": polygons, "machine": bench.machine()} | of(scene, afterlight)


def measure_apart(series, case, options):
    """One case in a process of its own."""
    size = "x".join(map(str, options.size))
    return apart.measured("benchmarks.cost.tick", series, "--case", case, "--size", size)


def measure_into(options):
    try:
        found = measure(options.series[0], options.case, options)
    except Exception as error:  # one case's trouble must not cost the others' numbers
        found = {"failed": str(error) or type(error).__name__}
    options.into.write_text(json.dumps(found))
    return int("failed" in found)


def parse(arguments):
    parser = argparse.ArgumentParser(prog="benchmarks.cost.tick", description="What ticking Indirect Light costs.")
    parser.add_argument("series", nargs="*", metavar="SERIES", help=f"of {'; '.join(tick_cases.SERIES)}; all without")
    parser.add_argument("--case", help="one case of a series")
    parser.add_argument("--size", type=bench.size, default=(320, 180), metavar="WxH", help="of the frames; 320x180")
    parser.add_argument("--page", type=Path, default=PAGE, help="docs/measured/tick.md; its numbers lie beside it")
    parser.add_argument("--into", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    options.command = shlex.join([".venv/bin/python", "-m", "benchmarks.cost.tick", *arguments])
    for name in options.series:
        if name not in tick_cases.SERIES:
            parser.error(f"there is no series {name}; there are {', '.join(tick_cases.SERIES)}")
        if options.case and options.case not in tick_cases.SERIES[name]:
            parser.error(f"{name} has no case {options.case}; it has {', '.join(tick_cases.SERIES[name])}")
    options.series = options.series or list(tick_cases.SERIES)
    return options


def main(arguments):
    options = parse(arguments)
    if options.into:
        return measure_into(options)
    found = {"command": options.command, "commit": commit.current(), "size": options.size, "cases": []}
    numbers = tick_report.numbers_of(options.page)
    numbers.parent.mkdir(parents=True, exist_ok=True)
    for series in options.series:
        for case in [options.case] if options.case else tick_cases.SERIES[series]:
            print(f"{series}: {case}", file=sys.stderr, flush=True)
            entry = measure_apart(series, case, options)
            found["machine"] = entry.pop("machine", found.get("machine"))
            found["cases"].append({"series": series, "case": case} | entry)
            numbers.write_text(json.dumps(found, indent=1) + "\n")
            if "failed" in entry:
                print(f"  failed: {entry['failed']}", file=sys.stderr)
    tick_report.write(options.page)
    print(options.page.read_text())
    return int(any("failed" in entry for entry in found["cases"]))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
