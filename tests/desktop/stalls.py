# SPDX-License-Identifier: GPL-3.0-or-later
"""The longest stall of the interface by stage of a render: between two turns that Blender's main thread gives to a
timer, and how long of it were calls of ours.

    tools/desktop.sh .venv/bin/python tests/desktop/stalls.py [again] [opengl] [vulkan] [paper] [radiosity]
    [WIDTHxHEIGHT ...]

again: with the shaders that the driver has kept since the last time, as on a computer that has rendered before."""

import shutil
import sys
import time
from itertools import product

import steps
from window import ROOT, Computer, Window

import extension

CALL = "call"  # that the main thread makes for us
# What is watched in the extension, from the outside in: a stall belongs to the innermost that runs.
WATCHED = {
    CALL: ("host.main_thread", "_make_call"),
    "save passes": ("scene.frame_store", "save"),
    "load passes": ("scene.passes", "load"),
    "wait": ("gather.device", "wait"),
    "compile": ("gather.device", "shader"),
    "read back": ("gather.device", "read"),
    "hand back": ("render.engine", "AfterlightEngine", "_hand_back"),
}
OF_METHOD = {
    "PAPER": {name: ("gather.paper", name) for name in ("upload", "pack", "merge", "gather", "upsample", "composite")},
    "RADIOSITY": {
        "place views": ("render.views_engine", "AfterlightViewsEngine", "_place"),
        "save views": ("render.frames", "RenderedFrame", "_save_views"),
    }
    | {"upload": ("gather.records", "upload")}
    | {
        name: ("gather.radiosity", name)
        for name in ("build_records", "pack", "radiate", "emitter_table", "sample_emitters", "composite")
    },
}


def stage_at(moment, spans, begin, end):
    inside = [span for span in spans if span[1] <= moment <= span[2]]
    if inside:
        return max(inside, key=lambda span: span[1])[0]
    first = min((span[1] for span in spans), default=end)
    return "idle" if not begin <= moment <= end else "EEVEE" if moment < first else "between, compositor"


def stalls(window):
    """{stage: (longest gap, longest call of ours, seconds in all)} of one render by F12."""
    before = window.finished_renders()
    window.over("VIEW_3D")
    time.sleep(1)
    window.value("count_ticks(True) and None")
    window.key("F12")
    window.wait(f"happened('render_complete') > {before} and not rendering()", 600)
    time.sleep(0.5)
    spans, ticks = window.value("count_ticks(False)")
    times = window.value("[event[:2] for event in events]")
    begin = [moment for name, moment in times if name == "render_init"][-1]
    end = [moment for name, moment in times if name == "render_complete"][-1]
    calls = [span for span in spans if span[0] == CALL]
    spans = [span for span in spans if span[2] and span[0] != CALL]
    gaps, longest_calls = {}, {}
    for found, pairs in ((gaps, zip(ticks, ticks[1:])), (longest_calls, [call[1:] for call in calls])):
        for earlier, later in pairs:
            # It belongs to the stage that had most of it.
            moments = [earlier + (later - earlier) * (piece + 0.5) / 50 for piece in range(50)]
            pieces = [stage_at(moment, spans, begin, end) for moment in moments]
            stage = max(set(pieces), key=pieces.count)
            found[stage] = max(found.get(stage, 0), later - earlier)
    totals = {}
    for stage, start, stop in spans:
        totals[stage] = totals.get(stage, 0) + stop - start
    return {stage: [found.get(stage, 0) for found in (gaps, longest_calls, totals)] for stage in {**gaps, **totals}}


def main():
    backends = [word for word in sys.argv[1:] if word in ("opengl", "vulkan")] or ["opengl", "vulkan"]
    methods = [word.upper() for word in sys.argv[1:] if word.upper() in OF_METHOD] or list(OF_METHOD)
    sizes = [tuple(map(int, word.split("x"))) for word in sys.argv[1:] if word[0].isdigit()] or [
        (640, 360),
        (1280, 720),
    ]
    for backend in backends:
        folder = ROOT / "build" / "stalls" / backend
        kept = ROOT / "build" / "stalls" / f"{backend}.cache"
        if "again" not in sys.argv:
            shutil.rmtree(kept, ignore_errors=True)
        shutil.rmtree(folder, ignore_errors=True)
        computer = Computer(folder, backend)
        kept.mkdir(parents=True, exist_ok=True)
        (folder / ".cache").symlink_to(kept)
        window = Window(computer)
        try:
            steps.install(window, extension.package())
            steps.new_box(window)
            steps.tick(window)
            for watched in (WATCHED, *OF_METHOD.values()):
                for name, path in watched.items():
                    window.value(f"watch({name!r}, *{path!r})")
            for method, (width, height) in product(methods, sizes):
                window.run(steps.use, method)
                window.run(steps.long_gather, width, height)
                for run in ("first", "second"):
                    print(
                        f"\n{backend}, {method.title()}, {width} x {height}, {run} render: longest stall, longest "
                        "call of ours, "
                        "seconds in all"
                    )
                    for stage, seconds in stalls(window).items():
                        print(f"  {stage:20}", *(f"{each:8.3f}" for each in seconds), flush=True)
        finally:
            window.close()


if __name__ == "__main__":
    main()
