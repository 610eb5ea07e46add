# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of Radiosity on one machine as Markdown: a part of gpu_report's page."""

from statistics import median

from ..cost.cost_report import table
from .gpu_plots import STARTS
from .page_numbers import ms, span, three

GROWTH = {
    "draws": ("draws", lambda run: run["draws"]),
    "views": ("further views", lambda run: run["further"]),
    "bounces": ("bounces", lambda run: run["bounces"]),
    "size": ("size", lambda run: "x".join(map(str, run["size"]))),
}
FIXED = {
    "size": lambda run: "x".join(map(str, run["size"])),
    "draws": lambda run: _count(run["draws"], "draw"),
    "views": lambda run: _count(run["further"], "further view"),
    "bounces": lambda run: _count(run["bounces"], "bounce"),
}


def sentence(part):
    """Of both presets: seconds and ratio to the floor. part: the numbers of radiosity_speed.measure()."""
    return " ".join(
        f"Radiosity at {run['name']} takes {ms(median(run['gpu']))} ms on the GPU, {ratio(run):.2f} times its floor of "
        f"{ms(floor_of(run))} ms."
        for run in part["presets"]
    )


def floor_of(run):
    """Seconds of a whole frame."""
    return sum(stage["seconds"] for stage in run["floor"])


def ratio(run):
    """The median GPU time over the floor."""
    return median(run["gpu"]) / floor_of(run)


def chapter(part):
    """[Markdown] without the plots."""
    first = part["presets"][0]
    names = " and ".join(f"the preset {run['name']}" for run in part["presets"])
    return [
        "### Radiosity",
        f"`gather_views()` on the room of `benchmarks/gpu/room.py`, seen by several cameras, at the settings of "
        f"{names}: a frame in the middle of an animation, whose light is averaged with that of the frame "
        "before. The world lights nothing here, since the room is closed; there is no Glossy Light and no Vector "
        f"pass. Measured at commit {part['commit']} by `{part['command']}`.",
        *(["With `--quick`: few and small frames."] if part["quick"] else []),
        table(
            ("preset", "size", "start", "draws", "bounces", "further views"),
            [
                (run["name"], FIXED["size"](run), STARTS[run["start"]], run["draws"], run["bounces"], run["further"])
                for run in part["presets"]
            ],
            text=3,
        ),
        "#### Pass by pass, and the floor",
        f"Medians of {_frames(part['presets'])} after one to warm up.",
        table(
            ("preset", "pass", "dispatches", "median, ms", "smallest to largest, ms", "floor, ms", "set by", "ratio"),
            [row for run in part["presets"] for row in _passes(run)],
            text=2,
        ),
        "All passes, and the whole of `gather_views()` on the clock, arrays in and an array out: that adds the "
        "transfers to and from the GPU.",
        table(
            (
                "preset",
                "dispatches",
                "GPU, median, ms",
                "smallest to largest, ms",
                "floor, ms",
                "ratio",
                "clock, median, ms",
                "smallest to largest, ms",
            ),
            [_whole(run) for run in part["presets"]],
        ),
        "    floor = sum over passes of max(bytes / bandwidth, fetches / fetch rate, operations / arithmetic rate)",
        "Counted is what [radiosity.md](../method/radiosity.md) asks for, however it is laid out "
        "(`benchmarks/gpu/radiosity_work.py` says where each count comes from): numbers that are read in order are "
        "read once, results are written once, and what is drawn at random is fetched where it is drawn. For each draw "
        "that is the table's entry and the record of each candidate, as far as it is needed, and for each step of its "
        "shadow ray the depth map of each view that has it in frame. There is no aim for the ratio, since this "
        "floor is a loose one: the fetch rate is that of neighbours, while draws lie apart, and the arithmetic is that "
        "of the formulas alone, without indices, unpacking, loops and branches that differ from thread to thread.",
        table(
            (
                "preset",
                "pass",
                "read, MB",
                "written, MB",
                "fetches of 16 bytes, million",
                "of 8, million",
                "operations, million",
            ),
            [_counts(run, stage) for run in part["presets"] for stage in run["floor"]],
            text=2,
        ),
        "How often views, emitters and shadow rays meet, from samples of the room in float64 "
        "(`benchmarks/gpu/radiosity_rays.py`), for the last bounce; and what the machine can do, measured in turn with "
        "these frames:",
        table(("of each", *(run["name"] for run in part["presets"])), _shares(part["presets"])),
        "#### Growth",
        f"GPU time of a whole frame at the settings of {first['name']}, but for what is named. Cases that would take "
        "too long for a few frames are left out.",
        *_growth(part),
    ]


def _passes(run):
    floors = {stage["stage"]: stage for stage in run["floor"]}
    for name, entry in run["passes"].items():
        least, middle = floors.get(name), median(entry["seconds"])
        rest = (ms(least["seconds"]), least["limit"], f"{middle / least['seconds']:.2f}") if least else ("", "", "")
        yield run["name"], name, entry["dispatches"], ms(middle), span(entry["seconds"]), *rest


def _whole(run):
    return (
        run["name"],
        sum(entry["dispatches"] for entry in run["passes"].values()),
        ms(median(run["gpu"])),
        span(run["gpu"]),
        ms(floor_of(run)),
        f"{ratio(run):.2f}",
        ms(median(run["wall"])),
        span(run["wall"]),
    )


def _counts(run, stage):
    amounts = (stage[name] / 1e6 for name in ("read", "written", "wide", "narrow", "operations"))
    return run["name"], stage["stage"], *(f"{amount:.2f}" for amount in amounts)


def _shares(presets):
    rows = {
        "pixel: other views that have it in frame": lambda run: f"{run['shares']['overlaps']:.2f}",
        "candidate: share before the receiver": lambda run: f"{run['shares']['base']['faced']:.2f}",
        "candidate: share that faces it, too": lambda run: f"{run['shares']['base']['facing']:.2f}",
        "draw: shadow rays": lambda run: f"{run['shares']['base']['chosen']:.2f}",
        "shadow ray: share that is blocked": lambda run: f"{run['shares']['base']['blocked']:.2f}",
        "step of one that is not: views that have it in frame": lambda run: f"{run['shares']['base']['shown']:.2f}",
        "bandwidth, GB/s": lambda run: three(run["rates"]["bandwidth"] / 1e9),
        "fetches of 16 bytes, G/s": lambda run: three(run["rates"]["wide"] / 1e9),
        "fetches of 8 bytes, G/s": lambda run: three(run["rates"]["narrow"] / 1e9),
        "operations (multiply-adds), G/s": lambda run: three(run["rates"]["operations"] / 1e9),
    }
    return [(what, *(value(run) for run in presets)) for what, value in rows.items()]


def _growth(part):
    for name, runs in part["growth"].items():
        heading, cell = GROWTH[name]
        others = ", ".join(value(runs[0]) for other, value in FIXED.items() if other != name)
        yield f"{others}:"
        yield table(
            (heading, "median, ms", "smallest to largest, ms", "of it the draws, ms"),
            [(cell(run), ms(median(run["gpu"])), span(run["gpu"]), ms(draws_of(run))) for run in runs],
        )


def draws_of(run):
    """Seconds of the passes that draw emitters, of a frame."""
    return sum(median(entry["seconds"]) for name, entry in run["passes"].items() if name.startswith("sample_"))


def _frames(presets):
    counts = sorted({len(run["gpu"]) for run in presets})
    return f"{' to '.join(map(str, counts))} frames"


def _count(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"
