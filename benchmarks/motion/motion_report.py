# SPDX-License-Identifier: GPL-3.0-or-later
"""What `python -m benchmarks.motion` says of a shot: its rows of the page, and a contact sheet of one frame."""

from dataclasses import dataclass, field

import numpy as np

from .. import commit, figures
from ..accuracy import metrics
from . import motion_measures as measures

HEAD = (
    "| shot | way | energy | error | flicker | variance | lag | trails | seconds a frame |\n"
    "|---|---|---:|---:|---:|---:|---:|---|---:|"
)


@dataclass
class Shot:
    """One shot. first: number of its first frame. truth, noise: (frames, H, W, 3), the mean of the reference's halves
    and half their difference. tracks: [Track] of each frame but the first."""

    name: str
    first: int
    truth: np.ndarray
    noise: np.ndarray
    tracks: list
    light: dict = field(default_factory=dict)  # by way: (frames, H, W, 3)
    seconds: dict = field(default_factory=dict)  # by way: of its job
    without: dict = field(default_factory=dict)  # by way: the same without history
    failures: dict = field(default_factory=dict)  # by way: why it was not rendered

    def add(self, name, light, seconds, without=""):
        self.light[name], self.seconds[name] = light, seconds
        if without:
            self.without[name] = without

    @property
    def mean(self):
        """The mean indirect light of the shot, the unit of all that is told."""
        return float(self.truth.mean(dtype=float))

    @property
    def steady(self):
        """Indices of all changes but that of a switch: it is seen as one, and what it leaves behind is lag and
        trails."""
        switch = measures.switch(self.truth)
        return np.array([index for index in range(len(self.tracks)) if index + 1 != switch])

    def errors(self, name):
        return self.light[name] - self.truth

    def error(self, name):
        """Relative L1 error over all frames, without the reference's noise."""
        width = self.truth.shape[2]
        picture, *halves = (
            each.reshape(-1, width, 3) for each in (self.light[name], self.truth + self.noise, self.truth - self.noise)
        )
        return metrics.l1_without_noise(picture, *halves, np.ones(picture.shape[:2], bool))

    def rows(self):
        """Markdown, a row a way, the reference's own noise last."""
        return (
            [self.row(name) for name in self.light]
            + [f"| {self.name} | {name} | failed: {reason} | | | | | | |" for name, reason in self.failures.items()]
            + [self.row_of_noise()]
        )

    def row(self, name):
        light = self.light[name]
        by_frame = measures.flicker(self.errors(name), self.noise, self.tracks)[self.steady] / self.mean**2
        variance, spread = by_frame.mean(), by_frame.std() / np.sqrt(max(len(by_frame) - 1, 1))
        return (
            f"| {self.name} | {name} | {light.mean(dtype=float) / self.mean:.3f} | {self.error(name):.3f} "
            f"| {np.sqrt(max(variance, 0)):.4f} | {variance:.6f} ± {spread:.6f} | {self.lag(name)} | "
            f"{self.trails(name)} "
            f"| {self.seconds[name] / len(light):.1f} |"
        )

    def row_of_noise(self):
        own = measures.changes(self.noise, self.tracks)[self.steady].mean() / self.mean**2
        return (
            f"| {self.name} | *Cycles' own noise, taken off above* | | "
            f"{np.abs(self.noise).mean(dtype=float) / self.mean:.3f} "
            f"| {np.sqrt(own):.4f} | {own:.6f} | | | |"
        )

    def lag(self, name):
        """Frames that a switch takes to arrive; a way with history has to arrive at what it shows without."""
        frame = measures.switch(self.truth)
        if frame is None or frame >= len(self.truth) - measures.LEVEL or name == "EEVEE":
            return "–"
        lit = measures.switched(self.truth, frame)
        settled = self.light.get(self.without.get(name))
        found = measures.lag(
            self.light[name][:, lit].mean((1, 2), dtype=float),
            frame,
            None if settled is None else settled[-measures.LEVEL :, lit].mean(dtype=float),
        )
        return "never" if found is None else str(found)

    def trails(self, name):
        without = self.without.get(name)
        if without not in self.light:
            return "–"
        more, frame, row, column = measures.trails(self.errors(name), self.errors(without))
        return f"{more / self.mean:.3f} (frame {self.first + frame}, row {row}, column {column})"

    def sheet(self, path, number=None):
        """WebP: for one frame the light by each way, its error, and the error's change from the frame before where that
        shows the same surface."""
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot

        after = (measures.switch(self.truth) or len(self.truth) // 2 - 1) + 1
        frame = after if number is None else number - self.first
        frame = min(max(frame, 1), len(self.truth) - 1)  # the first has none before it
        names, track = list(self.light), self.tracks[frame - 1]
        figure, axes = pyplot.subplots(
            3, len(names) + 1, figsize=(2.9 * (len(names) + 1), 5.4), layout="constrained", squeeze=False
        )
        white = np.percentile(self.truth[frame], 99)
        titles = ["Cycles", *names]
        for column, name in enumerate(titles):
            light = self.truth if name == "Cycles" else self.light[name]
            axes[0, column].imshow((light[frame] / white).clip(0, 1) ** (1 / 2.2))
            axes[0, column].set_title(name, fontsize=8)
            errors, kind = (self.noise, "its own noise") if name == "Cycles" else (self.errors(name), "error")
            change = np.full(self.truth.shape[1:3], np.nan)
            change[track.now] = (errors[frame][track.now] - errors[frame - 1][track.then]).mean(-1)
            pictures = (kind, errors[frame].mean(-1), 0.5), (f"{kind}: change from the frame before", change, 0.2)
            for row, (title, picture, reach) in enumerate(pictures, 1):
                shown = axes[row, column].imshow(picture / self.mean, cmap="RdBu_r", vmin=-reach, vmax=reach)
                axes[row, column].set_title(title, fontsize=7)
                if column == len(titles) - 1:
                    bar = figure.colorbar(shown, ax=axes[row, :], shrink=0.8)
                    bar.set_label("of the shot's mean light", fontsize=7)
                    bar.ax.tick_params(labelsize=7)
        for each in axes.flat:
            each.set_xticks([])
            each.set_yticks([])
            each.set_facecolor("0.8")
        figure.suptitle(f"{self.name}, frame {self.first + frame}", fontsize=9)
        figures.save(figure, path, dpi=110)


def page(options, rows):
    """The page in Markdown: the command, and what its columns say."""
    width, height = options.size
    return "\n".join(
        [
            "# Moving shots",
            "",
            f"Measured at commit {commit.current()} by",
            "",
            f"`{options.command}`",
            "",
            f"{width} x {height}, EEVEE with {options.samples} samples, Cycles with {2 * options.truth_samples} "
            "and four diffuse bounces. "
            "All is over the mean indirect light of the shot. Energy: the mean light. Error: relative L1, the "
            "reference's noise taken off. "
            "Flicker: root mean square change of the error between frames, along the true motion, where both "
            "frames show the surface and "
            "no edge is within a pixel, but for the frame of a switch; that noise taken off, too. Variance: its "
            "square, and the standard "
            "error of that over the frames. EEVEE alone, whose error is all of the light, shows what the truth's "
            "own change and tracks of "
            "whole pixels come to; a way that errs less has less of both. Lag: frames after a switch until 95 % "
            "of the change has arrived. "
            "Trails: where history worsens the mean error of 8 x 8 pixels most.",
            "",
            HEAD,
            *rows,
            "",
        ]
    )
