# SPDX-License-Identifier: GPL-3.0-or-later
"""Many frames in one process: does anything stay behind?

    .venv/bin/python -m benchmarks.soak [--frames 300] [--updates 300] [--output docs/measured/soak.md]

A mix of settings, sizes, compositors and view layers, of frames that are lit, lit again, cancelled and refused, over
and over, with the box ticked and, in a process of its own, never ticked: what Blender itself leaves behind. Prints a
page of Markdown and writes it to docs/measured/soak.md. Exit code 1 where something stays behind. Needs Linux, which
tells a process its memory."""

import argparse
import collections
import ctypes
import json
import os
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from . import commit

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "measured" / "soak.md"
WARM_UP = 2  # times through the mix before memory counts: shaders, caches, Python's own
MOST_GROWTH = 0.02
VIEWS = 2  # at most, further ones of a frame; each keeps a file
CHANNEL = 160 * 90 * 4  # bytes that an update may leave: less than any array or texture of its frame

# One line a frame: picture, compositor of tests/scenes.py ("layered" has two view layers), start, samples, radius and
# what happens.
MIX = (
    ((64, 36), "none", "HALF", 256, 16, "lit"),
    ((64, 36), "none", "FULL", 64, 8, "again"),
    ((96, 54), "none", "QUARTER", 1024, 32, "lit"),
    ((96, 54), "simple", "HALF", 16, 4, "lit"),
    ((96, 54), "simple", "HALF", 128, 16, "cancelled"),
    ((160, 90), "simple", "FULL", 32, 16, "lit"),
    ((160, 90), "nested", "HALF", 256, 16, "lit"),
    ((64, 36), "nested", "HALF", 256, 16, "ray tracing"),
    ((64, 36), "layered", "QUARTER", 64, 16, "lit"),
    ((160, 90), "layered", "FULL", 64, 2, "lit"),
    ((160, 90), "layered", "HALF", 512, 24, "again"),
    ((97, 53), "none", "HALF", 256, 16, "unticked"),
    ((97, 53), "none", "HALF", 100, 16, "lit"),
    ((64, 36), "simple", "FULL", 64, 64, "no GPU"),
    ((160, 90), "layered", "HALF", 64, 16, "cancelled"),
)


class Soak:
    """A scene that goes through the mix, and what it finds in its process."""

    def __init__(self, afterlight, scene, scenes, ticked):
        self.afterlight, self.scene, self.scenes, self.ticked = afterlight.addon, scene, scenes, ticked
        self.kind, self.trees, self.textures = "none", {}, []
        scenes.set_format(scene)
        for kind, make in scenes.TREES.items():
            self.trees[kind] = make(scene)
        scene.view_layers.remove(scene.view_layers[1])
        scene.compositing_node_group = None

    def run(self, frames, updates, folder):
        """Measurements of so many frames, and of the last lit again so many times, as a dictionary of plain values."""
        import bpy

        self._count_textures()
        found = collections.defaultdict(list)
        self._prepare(*MIX[0][:5], "unticked")
        files, before = _files(), self._state()
        for number in range(frames):
            self._frame(MIX[number % len(MIX)], number, folder)
            found["resident"].append(_resident())
            self._look(found)
            if number % len(MIX) == len(MIX) - 1:
                found["in use"].append(_in_use())  # after the same frame each time
            if number + 1 in (len(MIX), frames):
                found["images"].append(sorted(image.name for image in bpy.data.images))
        for number in range(updates):
            self.scene.afterlight.seed = number
            bpy.ops.afterlight.update()
            found["in use by updates"].append(_in_use())
            self._look(found)
        self._prepare(*MIX[0][:5], "unticked")
        found["left over"] = self.scenes.differences(before, self._state())
        bpy.ops.preferences.addon_disable(module=self.afterlight.__package__.removesuffix(".addon"))
        found["files left"] = sorted(_files() - files)
        return found

    def _look(self, found):
        found["textures made"].append(len(self.textures))
        found["textures"].append(self._alive())
        found["descriptors"].append(len(os.listdir("/proc/self/fd")))
        found["files"].append(len([path for path in _files() if path.endswith(".exr")]))

    def _frame(self, line, number, folder):
        import bpy

        *settings, event = line
        self._prepare(*settings, event)
        scene, engine, light = self.scene, self.afterlight.render.engine, self.afterlight.gather
        scene.afterlight.seed, scene.afterlight.strength = number, 0.5 + number % 4
        scene.eevee.use_raytracing = event == "ray tracing"
        gathers = light.gather_indirect, light.gather_views
        if event == "cancelled":  # as Escape does
            engine.AfterlightEngine.test_break = lambda engine: True
        elif event == "no GPU":
            light.gather_indirect = light.gather_views = self._fail
        try:
            if event == "again" and self.ticked:
                bpy.ops.afterlight.update()
            else:
                self.scenes.render(scene, folder / "picture.exr")
        finally:
            light.gather_indirect, light.gather_views = gathers
            if event == "cancelled":
                del engine.AfterlightEngine.test_break
        expected = self.ticked and event in ("ray tracing", "no GPU")
        if bool(scene.afterlight.report) != expected:
            raise AssertionError(f"frame {number}, {line}: {scene.afterlight.report or 'no report'}")

    def _prepare(self, size, kind, start, samples, radius, event):
        """What a person does between two renders, each time a little else."""
        scene, settings = self.scene, self.scene.afterlight
        if kind != self.kind:
            settings.enabled = False
            if self.kind == "layered":
                scene.view_layers.remove(scene.view_layers["Front"])
            scene.compositing_node_group, self.kind = self.trees[kind], kind
            if kind == "layered":
                scene.view_layers.new("Front")
                for node, layer in zip(
                    [node for node in self.trees[kind].nodes if node.bl_idname == "CompositorNodeRLayers"],
                    scene.view_layers,
                ):
                    node.layer = layer.name
        scene.render.resolution_x, scene.render.resolution_y = size
        settings.start, settings.samples, settings.radius = start, samples, radius
        # Both methods, and views that come and go: with few samples Radiosity.
        settings.method, settings.views = ("RADIOSITY", "AUTOMATIC") if samples < 65 else ("PAPER", "CAMERA")
        settings.view_count, settings.draws = VIEWS, 4
        ticked = self.ticked and event != "unticked"
        if settings.enabled != ticked:
            settings.enabled = ticked

    def _fail(self, *_, **__):
        raise self.afterlight.gather.GpuUnavailable("No GPU")

    def _state(self):
        """All that is in the file, but for the images that Blender makes of renders, and what _frame() sets."""
        state = self.scenes.written_down()
        del state["images"]
        for scene in state["scenes"].values():
            del scene["afterlight"]
            del scene["eevee"]
        return state

    def _count_textures(self):
        """Note every texture that the light makes. They know no weak references: one that has but ours left is free."""
        device = self.afterlight.gather.device
        texture = device.texture

        def counted(*arguments, **options):
            self.textures.append(texture(*arguments, **options))
            return self.textures[-1]

        device.texture = counted

    def _alive(self):
        # Three: the list's, the loop's and the call's own.
        self.textures = [each for each in self.textures if sys.getrefcount(each) > 3]
        return len(self.textures)


def _files():
    """All that lies in Blender's temporary folder, folders as well."""
    import bpy

    return {
        os.path.join(folder, name) for folder, folders, files in os.walk(bpy.app.tempdir) for name in (*folders, *files)
    }


def _resident():
    """Bytes of memory that this process has in use now."""
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def _in_use():
    """The same without what was freed and lies ready for the next that asks: it comes and goes with EEVEE's frames, and
    would hide a leak until it is full."""
    ctypes.CDLL(None).malloc_trim(0)
    return _resident()


def rounds(memory):
    """The median of each time through the mix, whose frames differ in size."""
    return [
        statistics.median(memory[first : first + len(MIX)]) for first in range(0, len(memory) - len(MIX) + 1, len(MIX))
    ]


def growth(values):
    """(Share by which a list grows over its length, growth from entry to entry), from the medians of its first and its
    last third."""
    third = -(-len(values) // 3)
    before, after = statistics.median(values[:third]), statistics.median(values[-third:])
    each = (after - before) / max(1, len(values) - third)
    return each * len(values) / before, each


def faults(found):
    """What stays behind, a sentence each; empty where nothing does."""
    warm, last = slice(0, WARM_UP * len(MIX)), slice(-len(MIX), None)
    settled = found["in use"][WARM_UP:]
    if settled and growth(settled)[0] > MOST_GROWTH:
        yield f"memory grew by {growth(settled)[0]:.1%}"
    if (updates := found.get("in use by updates")) and growth(updates)[1] > CHANNEL:
        yield f"memory grew by {growth(updates)[1] / 1000:.0f} kB each time the light was updated"
    if any(found["textures"]):
        yield f"{max(found['textures'])} textures stayed alive after a frame"
    if max(found["files"]) > 1 + VIEWS:
        yield f"{max(found['files'])} files of passes lay in the temporary folder at once"
    if found["files left"]:
        yield f"left in the temporary folder: {', '.join(found['files left'])}"
    if found["left over"]:
        yield f"left in the file: {'; '.join(found['left over'])}"
    if found["images"][0] != found["images"][-1]:
        yield f"images left in the file: {found['images'][0]}, then {found['images'][-1]}"
    if max(found["descriptors"][last]) > max(found["descriptors"][warm]):
        yield f"open files: {max(found['descriptors'][warm])}, then {max(found['descriptors'][last])}"
    if found["exit code"]:  # textures that outlive Blender's GPU crash it
        yield f"the process ended with exit code {found['exit code']}"


def child(frames, updates, ticked, output):
    """Soak in this process, and write what was found to a file."""
    sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests")]
    import extension

    afterlight = extension.start()
    import bpy

    import scenes

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    start = time.perf_counter()
    scene = scenes.box(bpy.context.scene, samples=1)
    scene.eevee.use_shadows = False  # their buffers come and go, hundreds of megabytes that would hide a leak of ours
    found = Soak(afterlight, scene, scenes, ticked).run(frames, updates if ticked else 0, Path(output).parent)
    Path(output).write_text(json.dumps({**found, "seconds": time.perf_counter() - start}))


def measure(frames, updates, ticked, folder):
    """What a process of its own finds, and how it ends. CalledProcessError, with its output, where that is too soon."""
    output = Path(folder) / f"{'ticked' if ticked else 'unticked'}.json"
    command = [
        sys.executable,
        "-m",
        "benchmarks.soak",
        "--child",
        str(output),
        "--frames",
        str(frames),
        "--updates",
        str(updates),
        *([] if ticked else ["--unticked"]),
    ]
    run = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if not output.exists():
        print(run.stdout, file=sys.stderr)
        run.check_returncode()
    return {**json.loads(output.read_text()), "exit code": run.returncode}


def page(ticked, unticked, command):
    """What was found, as Markdown."""

    def megabytes(memory):
        return f"{memory / 1e6:.0f}"

    def row(name, found):
        memory = [
            f"{megabytes(settled[0])} | {megabytes(settled[-1])} | {growth(settled)[0]:+.1%}"
            for settled in (found["in use"][WARM_UP:], rounds(found["resident"])[WARM_UP:])
        ]
        counts = (
            max(found["textures"]),
            len(found["left over"]),
            len(found["files left"]),
            max(found["descriptors"][-len(MIX) :]) - found["descriptors"][0],
        )
        return f"| {name} | {found['seconds'] / 60:.0f} | {' | '.join(map(str, (*memory, *counts)))} |"

    updates = ticked["in use by updates"]
    missed = list(faults(ticked))
    return "\n".join(
        [
            "# Does anything stay behind?",
            "",
            f"Measured at commit {commit.current()} by `{command}` (`make soak`) "
            "on software OpenGL, where the process's memory is the GPU's as well.",
            "",
            f"{len(ticked['resident'])} frames in one process: {len(MIX)} different ones over and over (`MIX` in",
            "[benchmarks/soak.py](../../benchmarks/soak.py)). Sizes, settings, compositors, one view layer and two;",
            "ticked and unticked, lit, lit again without EEVEE, cancelled, refused for ray tracing, and without "
            "a GPU. The",
            "other process renders the same with the box never ticked: what grows there is Blender's.",
            "",
            "In use is the memory that is resident when all that was freed has been given back, after the last "
            "frame of",
            f"each time through the mix; resident the median of each time as it is. The first {WARM_UP} are warm-up.",
            "Growth is that over all others, by the medians of their first and last third.",
            "",
            "| process | minutes | MB in use after warm-up | at the end | growth | MB resident after warm-up | "
            "at the end "
            "| growth | textures alive after a frame | datablocks left | files left | open files more |",
            "|---" * 12 + "|",
            row("ticked", ticked),
            row("never ticked", unticked),
            "",
            *(
                f"MB in use, each time through the mix, {name}: {', '.join(map(megabytes, found['in use']))}\n"
                for name, found in (("ticked", ticked), ("never ticked", unticked))
            ),
            f"Then the light of the last frame is updated {len(updates)} times, without EEVEE and what its memory "
            "does:",
            f"{growth(updates)[1] / 1000:.1f} kB more with each. A channel of that frame is {CHANNEL / 1000:.0f} kB.",
            "",
            *(f"**Missed:** {fault}." for fault in missed),
            *([] if missed else ["Nothing stays behind."]),
            "",
        ]
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--updates", type=int, default=300, help="times that the last frame is lit again after them")
    parser.add_argument("--output", type=Path, default=PAGE)
    parser.add_argument("--child", help=argparse.SUPPRESS)
    parser.add_argument("--unticked", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        child(arguments.frames, arguments.updates, not arguments.unticked, arguments.child)
        return
    if arguments.frames < len(MIX) * (WARM_UP + 2):
        parser.error(f"fewer than {len(MIX) * (WARM_UP + 2)} frames say nothing about memory")
    with tempfile.TemporaryDirectory() as folder:
        ticked, unticked = (measure(arguments.frames, arguments.updates, each, folder) for each in (True, False))
    text = page(ticked, unticked, shlex.join(["python", "-m", "benchmarks.soak", *sys.argv[1:]]))
    print(text)
    arguments.output.write_text(text)
    sys.exit(any(faults(ticked)))


if __name__ == "__main__":
    main()
