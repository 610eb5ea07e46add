# SPDX-License-Identifier: GPL-3.0-or-later
"""EEVEE's passes: which the gather reads, how a view layer is told to render them, and out of a file into arrays."""

from typing import Any

import bpy

from .. import gather
from ..host.report import Problem
from . import exr, needs

# What the gather reads: gather.Passes' field, the view layer's switch, the pass and its channels in the file.
PASSES = (
    ("depth", "use_pass_z", "Depth", "Z"),
    ("normal", "use_pass_normal", "Normal", "XYZ"),
    ("diffuse_color", "use_pass_diffuse_color", "Diffuse Color", "RGB"),
    ("diffuse_direct", "use_pass_diffuse_direct", "Diffuse Direct", "RGB"),
    ("emission", "use_pass_emit", "Emission", "RGB"),
)
# Where things come from that move: for the average over frames. It costs EEVEE a look at the frames before and after.
MOTION = ("motion", "use_pass_vector", "Vector", "XY")


def needed(settings) -> tuple[tuple[str, str, str, str], ...]:
    """Of PASSES and MOTION, what a scene with these settings needs."""
    return (*PASSES, MOTION) if needs.averages_frames(settings) else PASSES


def is_on(layer: bpy.types.ViewLayer, switch: str) -> bool:
    """Whether a view layer renders a pass. switch: the path of a property from the view layer."""
    return layer.path_resolve(switch)


def set_enabled(layer: bpy.types.ViewLayer, switch: str, on: bool) -> None:
    """Let a view layer render a pass, or not. switch: as is_on() has it."""
    owner, _, name = switch.rpartition(".")
    setattr(layer.path_resolve(owner) if owner else layer, name, on)


def load(path: str, layer: str, window: tuple[int, int, int, int], step: int = 1) -> gather.Passes:
    """The passes of one view layer from a file that save() wrote. step: frames from the one before to this.

    window: (x, y, width, height) in pixels, from the bottom left: the part of the full frame that is rendered. A
    render border without crop leaves black around it in the file; it is cut off here.
    Returns gather.Passes, whose arrays are the file's own memory: it stays in use, removed or not, as long as they do.
    Raises Problem where OpenEXR, the file or one of the passes can't be had.
    """
    cut = exr.read(path, window)
    try:
        found: dict[str, Any] = {
            field: tuple(cut(f"{layer}.{name}.{axis}") for axis in axes) for field, _, name, axes in PASSES
        }
    except KeyError as error:
        raise Problem(
            "The render has no pass {}. Press Repair in the Indirect Light panel, then render again",
            exr.one_line(error),
        ) from error
    (found["depth"],) = found["depth"]
    return gather.Passes(**found, motion=_motion(cut, layer, step))


def _motion(cut, layer, step):
    """gather.Passes.motion: None where the view layer has no such pass, and where it is empty, as with motion blur."""
    _, _, name, axes = MOTION
    try:
        motion = tuple(cut(f"{layer}.{name}.{axis}") for axis in axes)
    except KeyError:
        return None
    return tuple(step * axis for axis in motion) if any(axis.any() for axis in motion) else None
