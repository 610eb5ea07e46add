# SPDX-License-Identifier: GPL-3.0-or-later
"""What Afterlight costs: each stage's time beside EEVEE's own, and memory.

    .venv/bin/python -m benchmarks.cost [FILE.blend] [--size 1280x720] [--samples 16] [--presets draft,paper]

Prints a page of Markdown and writes it to docs/measured/bench.md (or --output). Exit code 1 where a promised bound is
missed."""

import argparse
import os
import resource
import shlex
import subprocess
import sys
import time
from pathlib import Path

import session

from .. import ROOT, commit
from . import cost_report

PAGE = ROOT / "docs" / "measured" / "bench.md"
PRESETS = ("draft", "paper", "production", "reference")
OWN_FRAMES = 7  # for Afterlight's own time, at one EEVEE sample each: it does not depend on them
MEMORY_SIZE = 1920, 1080
MEMORY_FRAMES = 3
MEMORY_VIEWS = 7  # of Radiosity: its default at most


def open_scene(path, size, afterlight):
    """The scene of a .blend file as EEVEE alone renders it at `size`: unticked, no compositor, no ray tracing. The
    passes that Afterlight reads are on, and stay on whether it is ticked or not."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False)
    scene = bpy.context.scene
    scene.afterlight.enabled = False
    scene.compositing_node_group = None
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.eevee.use_raytracing = False
    for _, switch, _, _ in afterlight.addon.scene.passes.PASSES:
        setattr(scene.view_layers[0], switch, True)
    return scene


def render(scene, samples=1):
    """Render one frame as F12 does, without writing it; return its cost_report.Frame. SystemExit where it was not
    lit."""
    import bpy

    scene.eevee.taa_render_samples = samples
    wall, cpu = time.perf_counter(), time.process_time()
    bpy.ops.render.render(scene=scene.name)
    frame = cost_report.Frame(time.perf_counter() - wall, time.process_time() - cpu)
    if scene.afterlight.enabled and scene.afterlight.report:
        sys.exit(f"The frame was not lit: {scene.afterlight.report}")
    return frame


def use_preset(name, afterlight):
    """Run a preset for the scene in context, as choosing it in the panel does."""
    import bpy

    bpy.ops.afterlight.preset(filepath=str(afterlight.addon.ui.operators.PRESETS / f"{name}.py"))


def measure_own(scene, stages_of):
    """Frames with the box unticked and ticked in turn, the first pair apart: it compiles EEVEE's shaders and ours."""
    scene.afterlight.property_unset("radius")
    scene.afterlight.method = "PAPER"
    scene.afterlight.start, scene.afterlight.samples = "QUARTER", 64
    plain, lit, stages = [], [], []
    for _ in range(1 + OWN_FRAMES):
        scene.afterlight.enabled = False
        plain.append(render(scene))
        scene.afterlight.enabled = True
        lit.append(render(scene))
        stages.append(stages_of(scene))
    return {
        "radius": scene.afterlight.radius,
        "first": stages[0],
        "stages": stages[1:],
        "plain": plain[1:],
        "lit": lit[1:],
    }


def measure_presets(scene, names, afterlight, stages_of):
    """{name: cost_report.Preset}; the shaders must have been compiled."""
    found, settings = {}, scene.afterlight
    settings.enabled = True
    for name in names:
        use_preset(name, afterlight)
        render(scene)
        frame = render(scene)
        samples = settings.samples if settings.method == "PAPER" else settings.draws
        found[name] = cost_report.Preset(
            settings.method.title(), settings.start.title(), samples, stages_of(scene), frame.wall
        )
    return found


def measure_ray_tracing(scene, samples, rounds):
    """Frames of EEVEE without and with its own ray tracing in turn, after a short pair that compiles its shaders."""
    scene.afterlight.enabled = False
    untraced, traced = [], []
    for count in (1, *[samples] * rounds):
        for use, frames in ((False, untraced), (True, traced)):
            scene.eevee.use_raytracing = use
            frames.append(render(scene, count))
    scene.eevee.use_raytracing = False
    return {"samples": samples, "untraced": untraced[1:], "traced": traced[1:]}


def measure_memory(path, names):
    """{case: peak in MB}, each in a process of its own, because the peak of a process never falls."""

    def peak(case):
        command = sys.executable, "-m", "benchmarks.cost", str(path), "--peak-of", case
        run = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
        if run.returncode:
            sys.exit(f"The memory of '{case}' could not be measured; the lines above say why.")
        return float(run.stdout.splitlines()[-1])

    return {case: peak(case) for case in ("plain", "compositor", *names)}


def print_peak(path, case):
    """Render `path` in this process: by EEVEE alone ("plain"), with a compositor that only passes the picture on
    ("compositor"), or lit by a preset, with as many views as automatic ones can be by default. Prints the most memory
    that it has taken, in MB."""
    afterlight = session.enable_afterlight()
    import bpy

    scene = open_scene(path, MEMORY_SIZE, afterlight)
    if case == "compositor":
        scene.compositing_node_group = tree = bpy.data.node_groups.new(case, "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        picture, output = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("NodeGroupOutput")
        picture.scene = scene
        tree.links.new(picture.outputs["Image"], output.inputs[0])
    elif case != "plain":
        use_preset(case, afterlight)
        if scene.afterlight.method == "RADIOSITY":
            scene.afterlight.views = "MANUAL"
            for _ in range(MEMORY_VIEWS):
                scene.afterlight.view_cameras.add().camera = scene.camera
        scene.afterlight.enabled = True
    for _ in range(MEMORY_FRAMES):
        render(scene)
    unit = 1 if sys.platform == "darwin" else 1024  # macOS counts bytes, Linux kilobytes
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6)


def machine():
    """What the numbers were measured on, in a sentence."""
    import bpy
    import gpu

    return (
        f"{cost_report.processor()} ({os.cpu_count()} cores), GPU {gpu.platform.renderer_get()} "
        f"({gpu.platform.backend_type_get()}), Blender {bpy.app.version_string}"
    )


def measure(path, options, names):
    """The whole benchmark; returns cost_report.Measured."""
    # First, while this process is small: Linux hands the peak of a parent on to its children.
    memory = measure_memory(path, names)
    afterlight = session.enable_afterlight()
    scene = open_scene(path, options.size, afterlight)
    status = afterlight.addon.host.report
    status.wants_stages = True
    own = measure_own(scene, status.stages)
    presets = measure_presets(scene, names, afterlight, status.stages)
    tracing = measure_ray_tracing(scene, options.samples, options.rounds)
    return cost_report.Measured(
        title=path.name,
        size=options.size,
        machine=machine(),
        commit=commit.current(),
        memory=memory,
        memory_size=MEMORY_SIZE,
        presets=presets,
        command=shlex.join([".venv/bin/python", "-m", "benchmarks.cost", *session.arguments()]),
        **own,
        **tracing,
    )


def size(text):
    """(width, height) from a command line's WxH."""
    width, height = map(int, text.split("x"))
    return width, height


def main():
    parser = argparse.ArgumentParser(description="Afterlight's time and memory beside EEVEE's.")
    parser.add_argument(
        "blend",
        nargs="?",
        type=Path,
        default=ROOT / "sample_blends" / "cornell_box.blend",
        help="the scene to render; the Cornell box",
    )
    parser.add_argument("--size", type=size, default=(1280, 720), metavar="WxH", help="of the timed frames; 1280x720")
    parser.add_argument("--samples", type=int, default=16, help="EEVEE's, for the cost of its ray tracing; 16")
    parser.add_argument("--rounds", type=int, default=3, help="frames with and without ray tracing; 3 of each")
    parser.add_argument("--presets", default=",".join(PRESETS), help="those to measure as well; all of them")
    parser.add_argument("--output", type=Path, default=PAGE, help="docs/measured/bench.md")
    parser.add_argument("--peak-of", help=argparse.SUPPRESS)
    options = parser.parse_args(session.arguments())
    path, names = options.blend.resolve(), [name for name in options.presets.split(",") if name]
    if not path.exists():
        parser.error(f"there is no {path}; 'make samples' writes the sample scenes")
    if options.peak_of:
        return print_peak(path, options.peak_of)
    if unknown := [name for name in names if name not in PRESETS]:
        parser.error(f"there is no preset {unknown[0]}; there are {', '.join(PRESETS)}")

    measured = measure(path, options, names)
    page = cost_report.page(measured)
    cost_report.write(options.output, page)
    print(page)
    return int(not all(kept for _, kept in cost_report.verdicts(measured)))
