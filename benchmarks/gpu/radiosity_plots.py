# SPDX-License-Identifier: GPL-3.0-or-later
"""The plots of Radiosity in docs/measured/speed.md."""

from statistics import median

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt

from .. import figures
from .radiosity_report import GROWTH, draws_of

SMALL = 0.02  # of a frame: passes below share a colour


def draw(name, found, path):
    """Draw one of PLOTS into a file, with the machine as its title."""
    figure = plt.figure(figsize=(7, 4.6 if name == "radiosity_growth" else 3), dpi=110, layout="constrained")
    PLOTS[name][1](figure, found["radiosity"])
    figure.suptitle(found["machine"]["renderer"], fontsize=10)
    figures.save(figure, path, exact=True)


def _passes(figure, part):
    """A bar for each preset, of its passes, as shares of its frame; beside it that of its floor."""
    axes = figure.subplots()
    bars, names = {}, {}
    for run in part["presets"]:
        whole = median(run["gpu"])
        bars[run["name"]] = {name: median(entry["seconds"]) / whole for name, entry in run["passes"].items()}
        bars[f"{run['name']}, floor"] = {stage["stage"]: stage["seconds"] / whole for stage in run["floor"]}
        names |= {name: None for name, share in bars[run["name"]].items() if share >= SMALL}
    left = dict.fromkeys(bars, 0.0)
    for name in (*names, "others"):
        widths = [
            sum(value for key, value in bar.items() if key not in names) if name == "others" else bar.get(name, 0.0)
            for bar in bars.values()
        ]
        axes.barh(list(bars), widths, left=list(left.values()), label=name)
        left = {key: before + width for (key, before), width in zip(left.items(), widths, strict=True)}
    axes.invert_yaxis()
    axes.set_xlabel("GPU time, share of the preset's frame")
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))


def _growth(figure, part):
    for axes, (name, runs) in zip(figure.subplots(2, 2).ravel(), part["growth"].items(), strict=False):
        heading, cell = GROWTH[name]
        at = [run["size"][0] * run["size"][1] / 1e6 if name == "size" else cell(run) for run in runs]
        axes.plot(at, [1000 * median(run["gpu"]) for run in runs], "o-", label="all passes")
        axes.plot(at, [1000 * draws_of(run) for run in runs], "s--", label="of it the draws")
        axes.set_xlabel("megapixels of a view" if name == "size" else heading)
        axes.set_ylabel("GPU time, ms")
        axes.set_ylim(bottom=0)
        axes.grid(True, alpha=0.3)
        axes.legend(fontsize=8)


# What each shows, and how it is drawn.
PLOTS = {
    "radiosity_passes": ("GPU time of Radiosity by pass", _passes),
    "radiosity_growth": ("GPU time of Radiosity against draws, views, bounces and size", _growth),
}
