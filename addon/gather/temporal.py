# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean over gathers: of one frame, and of the frames before it where they show the same surfaces.

    reproject     the history of this frame's surfaces, from the frame before
    accumulate    the mean of the history, less what has changed, and of this frame's irradiance

An exponential mean: the history weighs FRAMES - 1 frames at most. Its variance is then that of 2 FRAMES - 1 gathers. A
frame with no history, or too little, is gathered that often, so that a sequence has the same noise from its first frame
on. docs/method/temporal.md has the mathematics and the measurements.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import device
from .device import Texture
from .stages import Pyramid
from .types import Camera

Motion = tuple[np.ndarray, np.ndarray]

FRAMES = 5
REBUILT = 2 * FRAMES - 1  # gathers of a frame without a history
MIN_KNOWN = 0.5  # share of the picture's surfaces that must have a history
SEED_STRIDE = 101  # between the seeds of two gathers of a frame: each takes some more, one a bounce


@dataclass(eq=False)
class History:
    """The light that a frame leaves to the next. base: its surfaces. light: (h, w) texture, rgb the irradiance of each
    base texel, a the number of gathers that it is the mean of. camera: the main one. Empty before the first frame."""

    base: Pyramid | None = None
    light: Texture | None = None
    camera: Camera | None = None

    def go_on(
        self,
        base: Pyramid,
        camera: Camera,
        motion: Motion | None,
        views: np.ndarray,
        light: Texture,
        gathers: int,
        more: Callable[[Texture, int, int], Texture] | None = None,
    ) -> Texture:
        """The mean of the history and of `light`, that of so many gathers of a frame; it becomes the history.

        base, camera: of the frame. motion: of gather.Passes. views: the VIEWS block. more(light, first, last): the mean
        of `light`, which is that of gathers up to `first`, and of those up to `last`; without it a frame is not
        gathered again where its history is too little."""
        history, earlier = reproject(self, base, camera, motion, views), (FRAMES - 1) * gathers
        mean = accumulate(base, history, light, gathers, earlier, drift=True)
        if more and gathers < REBUILT and is_new(mean, gathers):
            del mean
            light = more(light, gathers, REBUILT)
            mean = accumulate(base, history, light, REBUILT, earlier, drift=True)
        self.base, self.light, self.camera = base, mean, camera
        return mean

    def fits(self, base: Pyramid, camera: Camera) -> bool:
        """Whether a frame with this base and camera can use it."""
        return (
            self.base is not None
            and self.camera is not None
            and self.base.size == base.size
            and self.camera.orthographic == camera.orthographic
        )


def reproject(
    history: History, base: Pyramid, camera: Camera, motion: Motion | None, views: np.ndarray
) -> Texture | None:
    """The history of the base's texels, as History.light, with a = 0 where it shows nothing of the surface and -1 where
    there is no surface. motion: of gather.Passes. views: the VIEWS block. None where the history does not fit."""
    if history.base is None or history.light is None or history.camera is None or not history.fits(base, camera):
        return None
    start, past = int(base.frame["start"]), history.camera
    reprojected = device.texture(*base.size)
    device.dispatch(
        "reproject",
        {
            "surfels": base.surfels,
            "past_surfels": history.base.surfels,
            "past_light": history.light,
            "motion": _motion_texture(motion, start, *base.size),
            "history_out": reprojected,
        },
        device.groups(*base.size),
        frame=base.frame,
        views=views,
        has_motion=motion is not None,
        past_scale=np.asarray(past.scale) * start,
        past_offset=past.offset,
        past_rotation=past_rotation(past, camera.position),
    )
    return reprojected


def accumulate(
    base: Pyramid, history: Texture | None, irradiance: Texture, gathers: int, earlier: int, *, drift: bool
) -> Texture:
    """The mean of the history, from reproject(), which weighs `earlier` gathers at most, and of the irradiance, which
    is that of `gathers`. drift: whether the light may have changed in between."""
    if history is None:
        history = device.texture(*base.size)
        history.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 0.0))
    light = device.texture(*base.size)
    device.dispatch(
        "accumulate",
        {"surfels": base.surfels, "irradiance": irradiance, "history": history, "light_out": light},
        device.groups(*base.size),
        frame=base.frame,
        gathers=gathers,
        earlier_gathers=earlier,
        allows_drift=drift,
    )
    return light


def is_new(light: Texture, gathers: int) -> bool:
    """Whether less than MIN_KNOWN of a frame's surfaces have a mean over more than so many gathers, this frame's."""
    counts = device.read(light)[..., 3]
    return bool(np.count_nonzero(counts > gathers) <= MIN_KNOWN * np.count_nonzero(counts >= 0))


def past_rotation(past: Camera, origin: np.ndarray) -> np.ndarray:
    """(3, 4) rows: from the world with its origin at `origin` to a camera's view."""
    rows = np.zeros((3, 4), np.float32)
    rows[:, :3] = past.rotation
    rows[:, 3] = past.rotation @ (np.asarray(origin, float) - np.asarray(past.position, float))
    return rows


def _motion_texture(motion: Motion | None, start: int, across: int, up: int) -> Texture:
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
