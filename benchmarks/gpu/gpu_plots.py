# SPDX-License-Identifier: GPL-3.0-or-later
"""The plots of docs/measured/speed.md, from the numbers of benchmarks.gpu."""

from statistics import median

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator

from .. import figures

STARTS = {1: "Full", 2: "Half", 4: "Quarter"}


def setting(run):
    """Start resolution and samples, as the paper's table writes them."""
    return f"{STARTS[run['start']]}/{run['samples']}"


def draw(name, found, path):
    """Draw one of PLOTS into a file, with the machine as its title."""
    figure, axes = plt.subplots(figsize=(7, 4.2), dpi=110, layout="constrained")
    PLOTS[name][1](axes, found)
    axes.set_title(found["machine"]["renderer"], fontsize=10)
    figures.save(figure, path, exact=True)


def _passes(axes, found):
    """A bar for each setting of the paper, made of its passes; the aim's floor as a line across its own."""
    names = list(dict.fromkeys(name for run in found["paper"] for name in run["passes"]))
    left = [0.0] * len(found["paper"])
    for name in names:
        widths = [
            1000 * median(run["passes"][name]["seconds"]) if name in run["passes"] else 0.0 for run in found["paper"]
        ]
        axes.barh([setting(run) for run in found["paper"]], widths, left=left, label=name)
        left = [a + b for a, b in zip(left, widths, strict=True)]
    floor = 1000 * sum(stage["seconds"] for stage in found["floor"])
    axes.vlines(floor, -0.4, 0.4, "black", label=f"floor of {setting(found['paper'][0])}")
    axes.invert_yaxis()
    axes.set_xlabel("GPU time, ms")
    axes.legend()


def _pixels(axes, found):
    for name in ("pixels_light", "pixels_heavy"):
        runs = found["growth"][name]
        pixels, times = [run["size"][0] * run["size"][1] / 1e6 for run in runs], _times(runs)
        (line,) = axes.loglog(pixels, times, "o-", label=setting(runs[0]))
        axes.loglog(
            pixels,
            [times[-1] * n / pixels[-1] for n in pixels],
            ":",
            color=line.get_color(),
            label="in proportion to pixels",
        )
    axes.set_xlabel("megapixels")
    _finish(axes, [run["size"][0] * run["size"][1] / 1e6 for run in found["growth"]["pixels_light"]])


def _samples(axes, found):
    runs = found["growth"]["samples"]
    axes.loglog(
        [run["samples"] for run in runs],
        _times(runs),
        "o-",
        label=f"{STARTS[runs[0]['start']]}, radius {runs[0]['radius']}",
    )
    axes.loglog([run["samples"] for run in runs], _gather(runs, found), "s--", label="of it the gather")
    axes.set_xlabel("samples at the finest level")
    _finish(axes, [run["samples"] for run in runs])


def _radius(axes, found):
    runs = found["growth"]["radius"]
    axes.loglog([run["radius"] for run in runs], _times(runs), "o-", label=setting(runs[0]))
    axes.loglog([run["radius"] for run in runs], _gather(runs, found), "s--", label="of it the gather")
    for run, time in zip(runs, _times(runs), strict=True):
        axes.annotate(f"{run['levels']} levels", (run["radius"], time), (0, 6), textcoords="offset points", ha="center")
    axes.margins(0.12, 0.2)
    axes.set_xlabel("radius, texels")
    _finish(axes, [run["radius"] for run in runs])


def _times(runs):
    return [1000 * median(run["gpu"]) for run in runs]


def _gather(runs, found):
    return [1000 * sum(median(run["passes"][name]["seconds"]) for name in found["gather_passes"]) for run in runs]


def _finish(axes, measured_at):
    axes.set_xticks(measured_at, [f"{value:.3g}" if value < 100 else f"{value}" for value in measured_at])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylabel("GPU time, ms")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()


# What each shows, and how it is drawn.
PLOTS = {
    "passes": ("GPU time by pass", _passes),
    "pixels": ("GPU time against pixels", _pixels),
    "samples": ("GPU time against samples", _samples),
    "radius": ("GPU time against radius", _radius),
}
