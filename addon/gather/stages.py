# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages that both methods share: upload, pack, passes in bands, composite, read back.

Textures have the bottom row first, except uploaded passes.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import device
from .device import Texture
from .pyramid import level_boxes
from .shader_interface import (
    COLOR_CHANNELS,
    FRAME,
    LEVEL,
    LIGHT_CHANNELS,
    SQUARE,
    STRIP,
    SURFACE_CHANNELS,
    SURFEL_FORMAT,
)
from .types import Camera, GpuPasses, PaperSettings, Passes, RadiositySettings, Triple

Progress = Callable[[str, float], bool]
Report = Callable[[str, float], None]


class Cancelled(Exception):
    """The progress callback asked to stop."""


def reporter(progress: Progress) -> Report:
    """progress(stage, fraction) as a function that raises Cancelled at a true answer."""

    def report(stage: str, fraction: float) -> None:
        if progress(stage, fraction):
            raise Cancelled

    return report


@dataclass(frozen=True, eq=False)
class Pyramid:
    """All levels in one RGBA32UI texture, a surfel a texel (shaders/common/surfel.glsl).

    boxes: (x, y, width, height) of each level in the texture, finest first. frame: the FRAME block of the picture.
    """

    surfels: Texture
    boxes: list[tuple[int, int, int, int]]
    frame: np.ndarray

    @property
    def last(self) -> int:
        """The coarsest level."""
        return len(self.boxes) - 1

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the base in texels."""
        return self.boxes[0][2:]

    def groups(self, level: int) -> int:
        """Work groups that one level takes."""
        across, up = device.groups(*self.boxes[level][2:])
        return across * up


def frame_block(
    camera: Camera, size: tuple[int, int], start: int = 1, boxes: list[tuple[int, int, int, int]] | None = None
) -> np.ndarray:
    """A FRAME block. size: (width, height) in pixels. boxes: Pyramid.boxes, for passes that read a pyramid."""
    levels = np.zeros(len(boxes or []), LEVEL.dtype)
    if boxes:
        levels["origin"], levels["size"] = np.split(np.array(boxes), 2, axis=1)
    rotation = np.zeros((3, 4))
    rotation[:, :3] = camera.rotation
    return FRAME.filled(
        rotation=rotation,
        scale=camera.scale,
        offset=camera.offset,
        size=size,
        start=start,
        is_orthographic=camera.orthographic,
        levels=levels,
    )


def upload(passes: Passes | GpuPasses, broken: dict[str, int] | None = None, light: bool = True) -> dict[str, Texture]:
    """One texture a channel, by their names in the shaders, with four neighbouring pixels of a row in each texel; rows
    are padded with 0. broken: filled with Passes.broken(). light: or else only depth and normal."""
    if isinstance(passes, GpuPasses):
        return dict(passes.textures)
    channels = dict(zip(SURFACE_CHANNELS, (passes.depth, *passes.normal), strict=True))
    if light:
        channels |= zip(COLOR_CHANNELS, passes.diffuse_color, strict=True)
        channels |= zip(LIGHT_CHANNELS, (*passes.diffuse_direct, *passes.emission), strict=True)
    textures, is_sound = _textures(channels)
    if broken is not None and not is_sound:
        broken |= passes.broken()
    return textures


def upload_color(color: Triple) -> dict[str, Texture]:
    """The three channels of a colour, in the layout of upload()."""
    return _textures(dict(zip(COLOR_CHANNELS, color, strict=True)))[0]


def _textures(channels: dict[str, np.ndarray]) -> tuple[dict[str, Texture], bool]:
    """(texture of each channel, whether all numbers are finite)."""
    height, width = next(iter(channels.values())).shape
    quads = -(-width // 4)
    plane = np.zeros((height, 4 * quads), np.float32)  # one for all: new memory for each takes longer than the copy
    textures, is_sound = {}, True
    for name, array in channels.items():
        plane[:, :width] = array
        # A sum of squares is finite exactly when each of its terms is, but for terms above 1e19: broken() decides.
        is_sound = is_sound and bool(np.isfinite(np.vdot(plane, plane)))
        textures[name] = device.texture(quads, height, data=plane)
    return textures, is_sound


def pack(
    channels: dict[str, Texture],
    passes: Passes | GpuPasses,
    camera: Camera,
    settings: PaperSettings | RadiositySettings,
) -> Pyramid:
    """The pyramid's base, from the passes' uploaded channels. Its coarser levels are still empty; Radiosity needs
    none."""
    width, height = passes.size
    base = -(-width // settings.start), -(-height // settings.start)
    boxes = level_boxes(*base, settings.radius) if isinstance(settings, PaperSettings) else [(0, 0, *base)]
    surfels = device.texture(max(x + w for x, _, w, _ in boxes), max(y + h for _, y, _, h in boxes), SURFEL_FORMAT)
    frame = frame_block(camera, (width, height), settings.start, boxes)
    device.dispatch(
        "pack_with_normals" if passes.lacks_normals() else "pack",
        channels | {"surfels_out": surfels},
        device.groups(-(-width // 4), boxes[0][3], STRIP),
        frame=frame,
    )
    return Pyramid(surfels, boxes, frame)


def run_in_bands(
    name: str,
    cost: int,
    textures: dict[str, Texture],
    target: Texture,
    after_band: Callable[[float], None],
    /,
    **named: Any,
) -> None:
    """Run a pass with first_row and first_column over "irradiance_out", some work groups at a time: whole rows of them,
    or a part of one where a row alone would take too long. cost: samples of a work group. after_band(share done)."""
    across, up = device.groups(target.width, target.height)
    done = 0
    while done < across * up:
        row, column = divmod(done, across)
        fitting = max(1, int(device.band(name)) // cost)
        wide, high = min(fitting, across - column), 1
        if wide == across:
            high = min(fitting // across, up - row)
        device.run_band(
            name,
            wide * high * cost,
            textures | {"irradiance_out": target},
            (wide, high),
            first_row=row * SQUARE[1],
            first_column=column * SQUARE[0],
            **named,
        )
        done += wide * high
        after_band(done / (across * up))


def composite(channels: dict[str, Texture], pyramid: Pyramid, total: Texture, strength: float) -> Texture:
    """Indirect radiance at full resolution, strength * albedo / pi * E / max(1, F), as rows of r g b r g b ..., with
    four numbers of them in a texel. 0 where there is no surface. total: E and F of the base's texels."""
    quads, height = channels["depth_pass"].width, channels["depth_pass"].height
    indirect = device.texture(3 * quads, height)
    device.dispatch(
        "composite",
        channels | {"surfels": pyramid.surfels, "total": total, "indirect_out": indirect},
        device.groups(quads, height, STRIP),
        frame=pyramid.frame,
        strength=strength,
    )
    return indirect


def read_picture(indirect: Texture, width: int) -> np.ndarray:
    """(H, W, 3) float32, bottom row first, of a texture that composite() made."""
    return device.read(indirect).reshape(indirect.height, -1, 3)[:, :width]


def stopwatch(timings: dict[str, float] | None) -> Callable[..., None]:
    """A function lap(stage, texture) that waits for the texture and adds the time since the last lap to timings."""
    if timings is None:
        return lambda stage, target=None: None
    last = time.perf_counter()

    def lap(stage: str, target: Texture | None = None) -> None:
        nonlocal last
        if target is not None:
            device.wait(target)
        now = time.perf_counter()
        timings[stage] = timings.get(stage, 0.0) + now - last
        last = now

    return lap
