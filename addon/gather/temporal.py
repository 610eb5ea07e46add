# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean over gathers: of one frame, and of the frames before it as far as they show the same surfaces.

    reproject     what the frame before knew of the light on the surfaces of this one
    accumulate    the mean of that and of what is gathered now, less what surely changed

An exponential mean: what is known weighs as much as FRAMES - 1 frames at most. Its variance is then that of 2 FRAMES -
1 gathers, and so many are made of a frame that knows nothing, or too little: a sequence begins with the noise that it
goes on with, wherever it begins. docs/method/temporal.md has the mathematics and the measurements.
"""

from dataclasses import dataclass

import numpy as np

from . import device
from .paper import Pyramid, Texture
from .types import Camera

FRAMES = 5
REBUILT = 2 * FRAMES - 1  # gathers of a frame without a history
LEAST_KNOWN = 0.5  # share of the picture's surfaces whose light must be known from the frames before
STRIDE = 101  # between the seeds of two gathers of a frame: each uses a few of its own for bounces


@dataclass(eq=False)
class History:
    """What a frame leaves to the next. base: its surfaces. light: (h, w) texture, rgb the irradiance of each base
    texel, a the number of gathers. camera: the main one. Empty before the first frame."""

    base: Pyramid | None = None
    light: Texture | None = None
    camera: Camera | None = None

    def go_on(self, base, camera, motion, views, light, gathers, more=None) -> Texture:
        """The mean of `light`, that of so many gathers of a frame, and of what is known; which is kept for the next
        frame.

        base, camera: of the frame. motion: gather.Passes.motion. views: the Views block. more(light, first, last): the
        mean of `light`, which is that of gathers up to `first`, and of those up to `last`; without it no frame is
        gathered more than once."""
        known, earlier = reproject(self, base, camera, motion, views), (FRAMES - 1) * gathers
        mean = accumulate(base, known, light, gathers, earlier, drift=True)
        if more and gathers < REBUILT and is_new(mean, gathers):
            del mean
            light = more(light, gathers, REBUILT)
            mean = accumulate(base, known, light, REBUILT, earlier, drift=True)
        self.base, self.light, self.camera = base, mean, camera
        return mean

    def fits(self, base: Pyramid, camera: Camera) -> bool:
        """Whether its frame can be looked up from one with this base."""
        return (
            self.light is not None
            and self.base.boxes[0] == base.boxes[0]
            and self.camera.orthographic == camera.orthographic
        )


def reproject(history: History, base: Pyramid, camera: Camera, motion, views: np.ndarray) -> Texture | None:
    """What the history knows of the base's texels, as History.light has it, with a = 0 where it knows nothing and -1
    where there is no surface. motion: gather.Passes.motion. views: the Views block. None where it can't be looked
    up."""
    if not history.fits(base, camera):
        return None
    start = int(base.parameters["frame"][2])
    views["past"] = past_rows(history.camera, camera.position, start)
    block = base.parameters.copy()
    block["span"][0] = motion is not None
    *_, across, up = base.boxes[0]
    known = device.texture(across, up)
    device.dispatch(
        "reproject",
        block,
        {
            "surfels": base.surfels,
            "past_surfels": history.base.surfels,
            "past_light": history.light,
            "motion": _motion_texture(motion, start, across, up),
            "known_out": known,
        },
        device.groups(across, up),
        views,
    )
    return known


def accumulate(
    base: Pyramid, known: Texture | None, irradiance: Texture, gathers: int, earlier: int, *, drift: bool
) -> Texture:
    """The mean of `known`, as reproject() gives it, which weighs `earlier` gathers at most, and of `irradiance`, which
    is that of `gathers`. drift: whether the light may have changed in between."""
    *_, across, up = base.boxes[0]
    if known is None:
        known = device.texture(across, up)
        known.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 0.0))
    light = device.texture(across, up)
    block = base.parameters.copy()
    block["span"][:3] = gathers, earlier, drift
    device.dispatch(
        "accumulate",
        block,
        {"surfels": base.surfels, "irradiance": irradiance, "known": known, "light_out": light},
        device.groups(across, up),
    )
    return light


def is_new(light: Texture, gathers: int) -> bool:
    """Whether of a frame's surfaces less than LEAST_KNOWN have more to their light than so many gathers of this
    frame."""
    counts = device.read(light)[..., 3]
    return np.count_nonzero(counts > gathers) <= LEAST_KNOWN * np.count_nonzero(counts >= 0)


def past_rows(past: Camera, origin, start: int) -> np.ndarray:
    """The field "past" of a Views block whose world has its origin at `origin`."""
    rows = np.zeros((4, 4), np.float32)
    rows[:3, :3] = past.rotation
    rows[:3, 3] = past.rotation @ (np.asarray(origin, float) - np.asarray(past.position, float))
    rows[3] = *(np.asarray(past.scale) * start), *past.offset
    return rows


def _motion_texture(motion, start, across, up):
    """(up, across), bottom row first: motion of the pixel in each base texel's middle, in base texels."""
    plane = np.zeros((up, across, 4), np.float32)
    if motion is not None:
        height, width = motion[0].shape
        rows, columns = (
            np.minimum(np.arange(count) * start + start // 2, side - 1)
            for count, side in ((up, height), (across, width))
        )
        for axis, pixels in enumerate(motion):
            plane[..., axis] = pixels[::-1][np.ix_(rows, columns)] / start
    return device.texture(across, up, data=plane)
