# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of benchmarks.gpu as a page of Markdown, one part a machine, and whether the aim is kept.

    .venv/bin/python -m benchmarks.gpu.gpu_report [FILE.json ...] [--out docs/measured/speed.md]

Without files: all that lie in docs/measured/speed/. The plots go there as well."""

import argparse
import json
import sys
from pathlib import Path
from statistics import median

from ..cost.cost_report import table
from . import radiosity_plots, radiosity_report
from .gpu_plots import PLOTS, STARTS, draw, setting
from .page_numbers import ms, span, three

AIM = 3.0  # GPU time of a frame at quarter/64 over its floor
PAPER = {(4, 64): (13.9, 4.6), (4, 256): (33.6, 11.2), (2, 256): (110.6, 32.6), (2, 64): (34.8, 10.5)}  # ms: (a), (b)


INTRODUCTION = (
    "# Speed of the light alone",
    "The methods Paper and Radiosity: the add-on's own code and shader files on a bare OpenGL context, without "
    "Blender, on frames made by numpy (`benchmarks/gpu/room.py`). Times are medians. What a frame costs inside "
    "Blender is in [bench.md](bench.md). The numbers of this machine, the page and the plots are written by",
    "    .venv/bin/python -m benchmarks.gpu",
    "With `--method paper` or `--method radiosity` only the numbers of that one are measured, and the others stay. It "
    "needs an OpenGL 4.3 driver with EGL and a Python with numpy, moderngl and matplotlib, on a machine with or "
    "without a display. The numbers of every machine lie in `docs/measured/speed/`; a file put there from another "
    "machine gets its part of this page by `python -m benchmarks.gpu.gpu_report`.",
)


def folder_of(page):
    """Where the numbers and plots of a page lie."""
    return page.with_suffix("")


def samples_a_second(found):
    """(samples inside the picture a second of the gather at quarter/64, the most that the machine's rates allow)."""
    samples, rates = sum(stage["samples"] for stage in found["floor"]), found["rates"]
    return samples / rates["gather"], min(rates["fetches"], rates["arithmetic"])


def verdict(found):
    """(sentence, whether the aim is kept)."""
    seconds, floor = found["rates"]["frame"], sum(stage["seconds"] for stage in found["floor"])
    ratio = seconds / floor
    return (
        f"{'Kept' if ratio <= AIM else 'MISSED'}: a frame at {setting(_frame(found))} takes {ms(seconds)} ms on "
        f"the GPU, {ratio:.2f} times its floor of {ms(floor)} ms. Aim: at most {AIM:g} times.",
        ratio <= AIM,
    )


def sentences(found):
    """What was found of each method, in a sentence."""
    return [
        *([verdict(found)[0]] if "paper" in found else []),
        *([radiosity_report.sentence(found["radiosity"])] if "radiosity" in found else []),
    ]


def write(page, files=()):
    """Write the page and its plots from JSON files, or from all in its folder."""
    folder = folder_of(page)
    folder.mkdir(parents=True, exist_ok=True)
    parts = {}
    for file in files or sorted(folder.glob("*.json")):
        parts[file.stem] = found = read(file)
        for plots, one, has in _plots(found):
            for name in plots if has else ():
                one(name, found, folder / f"{file.stem}-{name}.webp")
    page.write_text(text(parts, folder.name))


def read(file):
    """The numbers of one machine. SystemExit where the file does not hold any."""
    try:
        found = json.loads(file.read_text())
        if not sentences(found):
            raise LookupError("no method")
    except (OSError, ValueError, LookupError, TypeError) as error:
        sys.exit(
            f"{file} does not hold the numbers of a machine ({type(error).__name__}: {error}). Write it again by "
            "'python -m benchmarks.gpu' there."
        )
    return found


def text(parts, folder):
    """The whole page. parts: {name of a file: its numbers}; folder: of the plots, as seen from the page."""
    return "\n\n".join([*INTRODUCTION, *(part(found, f"{folder}/{name}") for name, found in parts.items())]) + "\n"


def part(found, plots):
    """The part of one machine. plots: path of its plots without their names."""
    machine = found["machine"]
    return "\n\n".join(
        [
            f"## {machine['renderer']}",
            f"{machine['vendor']}, OpenGL {machine['version']}; processor {machine['processor']} ({machine['cores']} "
            f"cores). GPU times are from {machine['timer']}.",
            "\n".join(f"- {sentence}" for sentence in sentences(found)),
            *(_paper_chapter(found, plots) if "paper" in found else []),
            *(_radiosity_chapter(found, plots) if "radiosity" in found else []),
        ]
    )


def _paper_chapter(found, plots):
    return [
        "### Paper",
        f"Measured at commit {found.get('commit', 'unknown')} by `{found['command']}`.",
        *(["With `--quick`: few and small frames."] if found["quick"] else []),
        "#### Pass by pass",
        *_passes(found),
        _picture(PLOTS, plots, "passes"),
        "#### The paper's table",
        *_paper(found),
        "#### What the machine can do, and the floor of a frame",
        *_floor(found),
        "#### Growth",
        *_growth(found),
        *(_picture(PLOTS, plots, name) for name in PLOTS if name != "passes"),
    ]


def _radiosity_chapter(found, plots):
    return [
        *radiosity_report.chapter(found["radiosity"]),
        *(_picture(radiosity_plots.PLOTS, plots, name) for name in radiosity_plots.PLOTS),
    ]


def _frame(found):
    """The run that the aim is about."""
    return next(run for run in found["paper"] if (run["start"], run["samples"]) == (4, 64))


def _passes(found):
    rows = [
        (setting(run), name, entry["dispatches"], ms(median(entry["seconds"])), span(entry["seconds"]))
        for run in found["paper"]
        for name, entry in run["passes"].items()
    ]
    frame = _frame(found)
    return [
        f"{_size(frame)}, radius {frame['radius']}; {len(frame['gpu'])} frames of each setting, after one to warm up.",
        table(("setting", "pass", "dispatches", "median, ms", "smallest to largest, ms"), rows, text=2),
        "All passes, and the whole of `gather_indirect()` on the clock, arrays in and an array out: that adds "
        "the transfers to and from the GPU and the host's own work.",
        table(
            (
                "setting",
                "dispatches",
                "GPU, median, ms",
                "smallest to largest, ms",
                "clock, median, ms",
                "smallest to largest, ms",
            ),
            [
                (
                    setting(run),
                    sum(entry["dispatches"] for entry in run["passes"].values()),
                    ms(median(run["gpu"])),
                    span(run["gpu"]),
                    ms(median(run["wall"])),
                    span(run["wall"]),
                )
                for run in found["paper"]
            ],
        ),
    ]


def _paper(found):
    rows = [
        (setting(run), *(f"{ms:.1f}" for ms in PAPER[run["start"], run["samples"]]), ms(median(run["gpu"])))
        for run in found["paper"]
    ]
    return [
        "Figure 2 of the paper: 1280x720, in ms, on cards of 2008. It gives a total time without saying what is in "
        "it: whether the G-buffers, their mipmaps or the final composite count is left open, as are the radius and "
        "the number of levels. Ours is the sum of all passes, from the finished passes of a render to the light "
        "that is added, without transfers to and from the host; and it doubles the samples from level to level, "
        "where the paper takes the same number at each.",
        table(("setting", "8800 GTS", "GTX 260", "this machine"), rows),
    ]


def _floor(found):
    rates = found["rates"]
    reached, possible = samples_a_second(found)
    seconds = sum(stage["seconds"] for stage in found["floor"])
    copies = [(name, f"{three(rate / 1e9)} GB/s") for name, rate in rates["copies"].items()]
    fetches = [
        (f"{name}, neighbours at a common offset", f"{three(rate / 1e9)} G/s")
        for name, rate in rates["fetch_formats"].items()
    ]
    stages = [
        (
            stage["stage"],
            f"{stage['read'] / 1e6:.2f}",
            f"{stage['written'] / 1e6:.2f}",
            f"{stage['fetches'] / 1e6:.2f}",
            f"{stage['samples'] / 1e6:.2f}",
            ms(stage["seconds"]),
            stage["limit"],
        )
        for stage in found["floor"]
    ]
    return [
        table(
            ("measured here", "rate"),
            [
                *((f"copy {name}, read and written", rate) for name, rate in copies),
                *((f"fetches {name}", rate) for name, rate in fetches),
                ("samples by arithmetic alone", f"{three(rates['arithmetic'] / 1e9)} G/s"),
            ],
        ),
        "All measured in turn with the frames that the floor is held against, since a machine may be slower at one "
        "time than at another. Copies are from texture to texture by a compute shader. Fetches are of 16 bytes. "
        "Arithmetic is the gather's own shader, whose fetches are replaced by numbers already in registers.",
        "    floor = sum over stages of max(bytes / bandwidth, fetches / fetch rate, samples / arithmetic rate)",
        "with the fastest of each. Counted is what the method needs, however it is laid out "
        "(`benchmarks/gpu/ceilings.py`): each number of the input read once, each result written once, one fetch of "
        "one record a sample that falls inside the picture, one fetch for every 16 bytes otherwise. Of the "
        "arithmetic only the gather's is counted.",
        table(
            ("stage", "read, MB", "written, MB", "fetches, million", "samples, million", "floor, ms", "set by"),
            [*stages, ("**all**", "", "", "", "", ms(seconds), "")],
        ),
        f"The gather takes {three(reached / 1e9)} G samples a second, {reached / possible:.2f} of the "
        f"{three(possible / 1e9)} G that fetches or arithmetic alone would allow.",
    ]


def _growth(found):
    parts = []
    for name, runs in found["growth"].items():
        first = runs[0]
        fixed, what, cell = {
            "pixels_light": (setting(first), "size", _size),
            "pixels_heavy": (setting(first), "size", _size),
            "samples": (f"{_size(first)}, {STARTS[first['start']]}", "samples", lambda run: run["samples"]),
            "radius": (
                f"{_size(first)}, {setting(first)}",
                "radius, levels",
                lambda run: f"{run['radius']}, {run['levels']}",
            ),
        }[name]
        radius = "" if name == "radius" else f", radius {first['radius']}"
        rows = [
            (
                cell(run),
                ms(median(run["gpu"])),
                span(run["gpu"]),
                three(median(run["gpu"]) / (run["size"][0] * run["size"][1]) * 1e9),
            )
            for run in runs
        ]
        parts += [f"{fixed}{radius}:", table((what, "median, ms", "smallest to largest, ms", "ns a pixel"), rows)]
    return ["GPU time of a whole frame. Cases that would take too long for a few frames are left out.", *parts]


def _size(run):
    return "x".join(map(str, run["size"]))


def _plots(found):
    """(names of plots, function that draws one, whether there are numbers for them) of each method."""
    yield PLOTS, draw, "paper" in found
    yield radiosity_plots.PLOTS, radiosity_plots.draw, "radiosity" in found


def _picture(titles, plots, name):
    return f"![{titles[name][0]}]({plots}-{name}.webp)"


def main():
    parser = argparse.ArgumentParser(description="The page and plots of measured speeds.")
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE.json", help="numbers; all beside the page")
    parser.add_argument(
        "--out", type=Path, default=Path("docs/measured/speed.md"), help="the page; docs/measured/speed.md"
    )
    options = parser.parse_args()
    if not options.files and not any(folder_of(options.out).glob("*.json")):
        parser.error(f"there are no numbers in {folder_of(options.out)}; 'python -m benchmarks.gpu' measures some")
    write(options.out, options.files)


if __name__ == "__main__":
    sys.exit(main())
