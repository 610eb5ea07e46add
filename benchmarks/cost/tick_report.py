# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of benchmarks.cost.tick as a page of Markdown and a plot. No Blender is needed here.

.venv/bin/python -m benchmarks.cost.tick_report [PAGE]      the page again, from the numbers beside it"""

import json
import sys
from pathlib import Path

from .. import ROOT, figures
from .cost_report import table

PAGE = ROOT / "docs" / "measured" / "tick.md"
USUAL = 64  # EEVEE's samples by Blender's default
WAYS = {"anew": "placed anew", "kept": "kept", "lit": ""}
MARKERS = "osD^vPX"
HEAD = (
    "case",
    "views",
    "T1, s",
    "T64, s",
    "added, s",
    "added, T1",
    "added, T64",
    "on the host, T1",
    "evaluations",
    "memory above, MB",
    "memory, ratio",
)


def numbers_of(page):
    """Where the numbers of a page lie."""
    return page.with_suffix(".json")


def write(page):
    """The page, and its plot beside it, from the numbers."""
    found = json.loads(numbers_of(page).read_text())
    picture = page.with_suffix(".webp")
    plot(found["cases"], picture)
    page.write_text(text(found, picture.name))


def rows(case):
    """[{"way", "t1", "t64", "added", "in_t1", "in_t64", "host", "evaluations", "memory", "ratio", "stages", "rest"}]:
    what ticking adds in one case, by whether the views are placed anew or kept. Seconds and MB; host: seconds that are
    not the graphics card's, in T1; evaluations: (plain, lit)."""
    one = case["plain"]
    name, many = next((name, each) for name, each in case.items() if name.startswith("plain, "))
    samples = int(name.split()[1])
    usual = one["seconds"] + (USUAL - 1) * max(many["seconds"] - one["seconds"], 0) / (samples - 1)
    found = []
    for way in [way for way in WAYS if way in case]:
        lit = case[way]
        added = lit["seconds"] - one["seconds"]
        host = added - (lit["gpu"] - one["gpu"])
        memory = None if lit["peak"] is None else lit["peak"] - many["peak"]
        found.append(
            {
                "way": WAYS[way],
                "t1": one["seconds"],
                "t64": usual,
                "added": added,
                "in_t1": added / one["seconds"],
                "in_t64": added / usual,
                "host": host / one["seconds"],
                "evaluations": (one["evaluations"], lit["evaluations"]),
                "memory": memory,
                "ratio": None if memory is None else lit["peak"] / many["peak"],
                "stages": lit["stages"],
                "rest": added - sum(lit["stages"].values()),
            }
        )
    return found


def by_series(cases):
    """{series: [case]}, in their order."""
    found = {}
    for case in cases:
        found.setdefault(case["series"], []).append(case)
    return found


def text(found, picture):
    """The page. picture: of the plot, seen from the page."""
    parts = [
        "# The cost of the tick",
        f"What ticking Indirect Light adds to a frame at the default settings, by what the scene weighs, at "
        f"{found['size'][0]} x {found['size'][1]}. Measured at commit {found['commit']} on {found.get('machine')} by",
        f"    {found['command']}",
        "- *T1*: the plain frame with one EEVEE sample. *T64*: the same with 64, Blender's default, from T1 and a "
        "frame of 9 samples, as if each sample took the same. Times are of single frames, all shaders compiled.\n"
        "- *Added*: the lit frame of one sample less T1. *On the host*: of that, what is not EEVEE's drawing and not "
        "the gather: evaluation, placing, files. On a software graphics card the rest is processor time as well.\n"
        "- *Placed anew*: views are placed in that very frame. *Kept*: the frame after it, whose views stay where "
        "they are. With manual views nothing is placed.\n"
        "- *Evaluations*: how often a dependency graph evaluates the scene's geometry, in the plain and in the lit "
        "frame: counted.\n"
        "- *Memory*: most resident memory of the process, above that of the plain frames, and over it.\n"
        "- An animation's row is a frame of six, the mean of all but the first.",
        f"![What ticking adds]({picture})",
    ]
    for series, cases in by_series(found["cases"]).items():
        parts += [f"## By {series}" if series != "animation" else "## In an animation", *series_parts(cases)]
    return "\n\n".join(parts) + "\n"


def series_parts(cases):
    """A table of costs and one of stages."""
    lines, stages = [], []
    for case in cases:
        if "failed" in case:
            lines.append((case["case"], f"failed: {case['failed']}", *[""] * (len(HEAD) - 2)))
            continue
        for row in rows(case):
            lines.append(cells(case["case"], row))
            stages.append((case["case"], row))
    names = list(dict.fromkeys(name for _, row in stages for name in row["stages"]))
    return [
        table(HEAD, lines, text=2),
        "Stages, in seconds; *rest*: what the frame takes longer beyond them.",
        table(
            ("case", "views", *names, "rest"),
            [
                (name, row["way"], *(f"{row['stages'].get(stage, 0):.2f}" for stage in names), f"{row['rest']:.2f}")
                for name, row in stages
            ],
            text=2,
        ),
    ]


def cells(name, row):
    return (
        name,
        row["way"],
        *(f"{row[key]:.2f}" for key in ("t1", "t64", "added", "in_t1", "in_t64", "host")),
        " / ".join(f"{count:.3g}" for count in row["evaluations"]),
        "–" if row["memory"] is None else f"{row['memory']:.0f}",
        "–" if row["ratio"] is None else f"{row['ratio']:.2f}",
    )


def plot(cases, path):
    """What ticking adds in T1 by what grows, a line a series, views placed anew and kept."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    growing = {name: own for name, own in by_series(cases).items() if name != "animation"}
    kinds = "polygons", "objects", "textures", "lamps", "views"
    figure, axes = pyplot.subplots(1, len(kinds), figsize=(15, 4), dpi=110, layout="constrained", sharey=True)
    for one, kind in zip(axes, kinds, strict=True):
        lines = [(name, own) for name, own in growing.items() if name.startswith(kind)]
        for (name, own), marker in zip(lines, MARKERS, strict=False):
            for way, style in (("placed anew", "-"), ("kept", ":")):
                places = [
                    (float(case["case"].replace(",", "")), row["in_t1"])
                    for case in own
                    if "failed" not in case
                    for row in rows(case)
                    if row["way"] == way
                ]
                label = f"{name.removeprefix(kind).removeprefix(', ')} {way}".strip()
                if places:
                    one.plot(*zip(*places, strict=True), style, marker=marker, label=label, markersize=5)
        one.set_xscale("symlog" if kind in ("textures", "views") else "log")
        one.set_xlabel(kind)
        one.grid(True, alpha=0.2)
        if lines:
            one.legend(fontsize=7)
    axes[0].set_ylabel("added, in plain frames of one sample (T1)")
    axes[0].set_ylim(bottom=0)
    figures.save(figure, path, exact=True)


def main(arguments):
    page = Path(arguments[0]) if arguments else PAGE
    if not numbers_of(page).is_file():
        sys.exit(f"There is no {numbers_of(page)}; '.venv/bin/python -m benchmarks.cost.tick' measures some.")
    write(page)


if __name__ == "__main__":
    main(sys.argv[1:])
