# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole pictures of a shot as the screen shows them: how far each way's are from Cycles', and how they flicker.

Pictures are (H, W, 3) float32 in 0..1, encoded for the screen, rows top first; shots (frames, H, W, 3)."""

from dataclasses import dataclass, field

import numpy as np

from ..accuracy import visible
from . import motion_measures as measures


@dataclass
class Pictures:
    """A shot as displayed. truth: (frames, H, W, 3), the reference as Blender's denoiser leaves it, for LDR-FLIP, which
    sees noise in every pixel; clean: (2, frames, H, W, 3), its halves likewise. halves: (2, frames, H, W, 3), with
    their noise. Flicker is told against the mean of these, since then its noise is half their difference, however much
    of that there is."""

    truth: np.ndarray
    halves: np.ndarray
    clean: np.ndarray
    shown: dict = field(default_factory=dict)  # by way: (frames, H, W, 3)
    errors: dict = field(default_factory=dict)  # by way: (frames, H, W, 3), from the mean of the halves
    noises: dict = field(default_factory=dict)  # by way: the reference's noise in that

    def add(self, name, shown, halves=None):
        """One way's shot. halves: (2, frames, H, W, 3) where the way's picture is made of the reference's light: it by
        each half. What both share of the noise is in no error."""
        first, second = (shown if halves is None else halves) - self.halves
        self.shown[name], self.errors[name], self.noises[name] = shown, (first + second) / 2, (first - second) / 2

    @property
    def noise(self):
        """(frames, H, W, 3): the reference's own."""
        return (self.halves[0] - self.halves[1]) / 2

    def flip(self, name):
        """LDR-FLIP, mean over all pixels and frames. It holds what own_flip() tells."""
        return float(np.mean([visible.ldr_flip(*pair) for pair in zip(self.shown[name], self.truth, strict=True)]))

    def own_flip(self):
        """LDR-FLIP of the reference by what is left of its noise, mean over all frames."""
        return float(np.mean([visible.flip_of_noise(halves) for halves in self.clean.swapaxes(0, 1)]))

    def flicker(self, name, tracks):
        """(frames - 1,): mean square change of the error along the tracks, the reference's noise taken off."""
        return measures.flicker(self.errors[name], self.noises[name], tracks)

    def own_flicker(self, tracks):
        """(frames - 1,): what is taken off."""
        return measures.changes(self.noise, tracks)


def displayed(scene, pictures):
    """Pictures (..., H, W, 3) in linear radiance as the scene's view transform shows them."""
    scene.render.image_settings.media_type = "IMAGE"  # a job with all passes leaves another, which has no PNG
    shape = pictures.shape
    return np.array([visible.displayed(scene, each) for each in pictures.reshape(-1, *shape[-3:])]).reshape(shape)
