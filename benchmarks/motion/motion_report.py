# SPDX-License-Identifier: GPL-3.0-or-later
"""What `python -m benchmarks.motion` says of a shot: its rows of both tables, and a contact sheet of one frame."""

from dataclasses import dataclass, field

import numpy as np

from .. import commit, figures
from ..accuracy import metrics
from . import motion_measures as measures
from .motion_pictures import Pictures

LIGHT_HEAD = (
    "| shot | way | energy | error | flicker | variance | lag | trails |\n|---|---|---:|---:|---:|---:|---:|---|"
)
PICTURE_HEAD = "| shot | way | LDR-FLIP | flicker | seconds a frame |\n|---|---|---:|---:|---:|"
REACHABLE = "*reachable: EEVEE with Cycles' indirect light*"


@dataclass
class Shot:
    """One shot. first: number of its first frame. halves, wholes: (2, frames, H, W, 3), the reference's indirect light
    and its whole picture. tracks: [Track] of each frame but the first. pictures: what the screen shows."""

    name: str
    first: int
    halves: np.ndarray
    wholes: np.ndarray
    tracks: list
    pictures: Pictures
    light: dict = field(default_factory=dict)  # by way: (frames, H, W, 3)
    noises: dict = field(default_factory=dict)  # by way: the noise in its error
    seconds: dict = field(default_factory=dict)  # by way: of its job
    without: dict = field(default_factory=dict)  # by way: the same without history
    failures: dict = field(default_factory=dict)  # by way: why it was not rendered

    def __post_init__(self):
        self.truth, self.noise = self.halves.mean(0), (self.halves[0] - self.halves[1]) / 2

    def add(self, name, light, whole, seconds, without=""):
        """One way's shot, (frames, H, W, 3) both. light: None where it has none by itself, so that the error of its
        whole picture counts as the light's; the noise in it is that of the reference's whole picture."""
        self.light[name], self.noises[name], self.seconds[name] = light, self.noise, seconds
        if light is None:
            self.light[name] = whole - self.wholes.mean(0) + self.truth
            self.noises[name] = (self.wholes[0] - self.wholes[1]) / 2
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
        noise = self.noises[name]
        picture, *halves = (
            each.reshape(-1, width, 3) for each in (self.light[name], self.truth + noise, self.truth - noise)
        )
        return metrics.l1_without_noise(picture, *halves, np.ones(picture.shape[:2], bool))

    def rows(self):
        """(Markdown of the light, of the pictures): lists, a row a way, the reference's own noise last."""
        failed = [f"| {self.name} | {name} | failed: {reason} |" for name, reason in self.failures.items()]
        return (
            [*map(self.row, self.light), *(each + " |" * 5 for each in failed), self.row_of_noise()],
            [
                *map(self.picture_row, self.pictures.shown),
                *(each + " |" * 2 for each in failed),
                self.picture_row_of_noise(),
            ],
        )

    def row(self, name):
        light = self.light[name]
        by_frame = measures.flicker(self.errors(name), self.noises[name], self.tracks)[self.steady] / self.mean**2
        variance, spread = by_frame.mean(), by_frame.std() / np.sqrt(max(len(by_frame) - 1, 1))
        return (
            f"| {self.name} | {name} | {light.mean(dtype=float) / self.mean:.3f} | {self.error(name):.3f} "
            f"| {np.sqrt(max(variance, 0)):.4f} | {variance:.6f} ± {spread:.6f} | {self.lag(name)} "
            f"| {self.trails(name)} |"
        )

    def row_of_noise(self):
        own = measures.changes(self.noise, self.tracks)[self.steady].mean() / self.mean**2
        return (
            f"| {self.name} | *Cycles' own noise, taken off above* | | "
            f"{np.abs(self.noise).mean(dtype=float) / self.mean:.3f} "
            f"| {np.sqrt(own):.4f} | {own:.6f} | | |"
        )

    def picture_row(self, name):
        change = max(self.pictures.flicker(name, self.tracks)[self.steady].mean(), 0)
        seconds = f"{self.seconds[name] / len(self.truth):.1f}" if name in self.seconds else ""
        return f"| {self.name} | {name} | {self.pictures.flip(name):.4f} | {np.sqrt(change):.5f} | {seconds} |"

    def picture_row_of_noise(self):
        own = self.pictures.own_flicker(self.tracks)[self.steady].mean()
        return (
            f"| {self.name} | *Cycles' own noise, taken off the flicker above* | {self.pictures.own_flip():.4f} "
            f"| {np.sqrt(own):.5f} | |"
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
        """WebP: for one frame the whole picture by each way, its light, the light's error, and the error's change from
        the frame before where that shows the same surface."""
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot

        after = (measures.switch(self.truth) or len(self.truth) // 2 - 1) + 1
        frame = after if number is None else number - self.first
        frame = min(max(frame, 1), len(self.truth) - 1)  # the first has none before it
        titles, track = ["Cycles", *self.light], self.tracks[frame - 1]
        figure, axes = pyplot.subplots(
            4, len(titles), figsize=(2.9 * len(titles), 7.1), layout="constrained", squeeze=False
        )
        white = np.percentile(self.truth[frame], 99)
        for column, name in enumerate(titles):
            cycles = name == "Cycles"
            whole = self.pictures.truth if cycles else self.pictures.shown[name]
            light = self.truth if cycles else self.light[name]
            axes[0, column].imshow(whole[frame].clip(0, 1))
            axes[0, column].set_title(name, fontsize=8)
            axes[1, column].imshow((light[frame] / white).clip(0, 1) ** (1 / 2.2))
            axes[1, column].set_title("indirect light", fontsize=7)
            errors, kind = (self.noise, "its own noise") if cycles else (self.errors(name), "error")
            change = np.full(self.truth.shape[1:3], np.nan)
            change[track.now] = (errors[frame][track.now] - errors[frame - 1][track.then]).mean(-1)
            pictures = (kind, errors[frame].mean(-1), 0.5), (f"{kind}: change from the frame before", change, 0.2)
            for row, (title, picture, reach) in enumerate(pictures, 2):
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
    """The page in Markdown: the command, both tables, and what their columns say. rows: [Shot.rows()]."""
    width, height = options.size
    light, pictures = ([row for shot in rows for row in shot[table]] for table in range(2))
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
            "The rivals, *Cycles, ... denoised*, have those bounces too, Blender's denoiser as it comes "
            "(OpenImageDenoise with albedo and "
            "normal) and other noise in each frame; as in the reference, nothing is clamped and all pixels get all "
            "samples.",
            "",
            "## The indirect light",
            "",
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
            "A denoiser works on the whole picture, so the rivals have no indirect light by itself: their picture's "
            "whole error counts here as the "
            "light's, direct light, reflections and edges included, and the noise that is taken off is that of the "
            "reference's whole picture. Of EEVEE's and Afterlight's ways only the error of the light counts. "
            "What else parts EEVEE from Cycles, the softness of shadows above all, is left out for them, so this "
            "table favours them over the rivals.",
            "",
            LIGHT_HEAD,
            *light,
            "",
            "## The picture on the screen",
            "",
            "The whole picture through the scene's view transform against Cycles', on equal terms: all errors of all "
            "ways count. EEVEE's direct light differs from Cycles', and no indirect light puts that right: the row "
            "*reachable*, EEVEE's picture with Cycles' indirect light, shows what of LDR-FLIP and flicker Afterlight "
            "cannot take away. LDR-FLIP: mean over all pixels and frames, against the reference as Blender's denoiser "
            "leaves it; the last row has what is left of its noise, which may be in all the others. Flicker: as above, "
            "of the displayed picture's error, over the screen's white; the surfaces' inner pixels alone, and the "
            "reference's noise taken off. "
            "Seconds a frame: the whole job on the clock over its frames, with all that a job does once, as "
            "compiling shaders, most of which the first EEVEE job of a run pays for. They are this "
            "machine's, for pictures of this size; not all ways grow alike with the pixels.",
            "",
            PICTURE_HEAD,
            *pictures,
            "",
        ]
    )
