# SPDX-License-Identifier: GPL-3.0-or-later
"""EEVEE's passes: which ones the gather reads, switching them on, and loading them from a file."""

from typing import Any

import bpy

from .. import gather
from ..host.report import Problem
from . import exr, needs

# What the gather reads: field of gather.Passes, switch (a property of the view layer), pass and channels in the file.
PASSES = (
    ("depth", "use_pass_z", "Depth", "Z"),
    ("normal", "use_pass_normal", "Normal", "XYZ"),
    ("diffuse_color", "use_pass_diffuse_color", "Diffuse Color", "RGB"),
    ("diffuse_direct", "use_pass_diffuse_direct", "Diffuse Direct", "RGB"),
    ("emission", "use_pass_emit", "Emission", "RGB"),
)
# Motion vectors, for averaging over frames. To write them EEVEE also evaluates the frames before and after.
MOTION = ("motion", "use_pass_vector", "Vector", "XY")


def needed(settings) -> tuple[tuple[str, str, str, str], ...]:
    """Those of PASSES and MOTION that these settings need."""
    return (*PASSES, MOTION) if needs.averages_frames(settings) else PASSES


def is_on(layer: bpy.types.ViewLayer, switch: str) -> bool:
    """Whether a view layer renders a pass. switch: path of a property from the view layer."""
    return layer.path_resolve(switch)


def set_enabled(layer: bpy.types.ViewLayer, switch: str, on: bool) -> None:
    """Make a view layer render a pass, or not. switch: path of a property from the view layer."""
    owner, _, name = switch.rpartition(".")
    setattr(layer.path_resolve(owner) if owner else layer, name, on)


def load(path: str, layer: str, window: tuple[int, int, int, int], step: int = 1) -> gather.Passes:
    """gather.Passes of one view layer from a file that frame_store.save() wrote. step: number of frames since the
    previous one.

    window: (x, y, width, height) in pixels from the bottom left, the rendered part of the full frame. A render border
    without crop leaves black around it in the file, which is cut off here. The arrays are mapped from the file, which
    stays in use, removed or not, as long as they exist. Raises Problem if OpenEXR, the file or one of the passes is
    missing."""
    read_channel = exr.read(path, window)
    try:
        arrays: dict[str, Any] = {
            field: tuple(read_channel(f"{layer}.{name}.{axis}") for axis in axes) for field, _, name, axes in PASSES
        }
    except KeyError as error:
        raise Problem(
            "The render has no pass {}. Press Repair in the Indirect Light panel, then render again",
            exr.one_line(error),
        ) from error
    (arrays["depth"],) = arrays["depth"]
    return gather.Passes(**arrays, motion=_motion(read_channel, layer, step))


def _motion(read_channel, layer, step):
    """gather.Passes.motion; None if the view layer has no such pass, or an empty one, as with motion blur."""
    _, _, name, axes = MOTION
    try:
        motion = tuple(read_channel(f"{layer}.{name}.{axis}") for axis in axes)
    except KeyError:
        return None
    return tuple(step * axis for axis in motion) if any(axis.any() for axis in motion) else None
