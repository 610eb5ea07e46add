# SPDX-License-Identifier: GPL-3.0-or-later
"""How calm a shot is, in numbers: flicker along the true motion, lag after a switch, trails. Arithmetic alone.

Pictures are (H, W, 3) linear radiance, rows top first; shots (frames, H, W, 3). Errors are picture minus truth.
"""

from dataclasses import dataclass

import numpy as np

from .steadiness import BLOCK, blocks

SAME_ALBEDO, SAME_DEPTH, SAME_NORMAL = 0.1, 0.05, 0.7  # relative; relative; cosine
ROUND_TRIP = 1.0  # pixels: half of one is lost to whole pixels each way
JUMP = 0.3  # of the light: more within a frame is a switch, no motion
LEVEL = 3  # frames whose mean is the light before, and after
ARRIVED = 0.95


@dataclass
class Surface:
    """What one frame shows. vector: (H, W, 4) as Blender's Vector pass: from here to where it was, and from where it
    will be to here, in pixels, y up. depth: (H, W). albedo, normal: (H, W, 3)."""

    vector: np.ndarray
    depth: np.ndarray
    albedo: np.ndarray
    normal: np.ndarray


@dataclass
class Track:
    """Where the pixels of a frame were in the frame before: rows and columns, (n,) each, now and then."""

    now: tuple
    then: tuple


def alike(a, b, where_a, where_b):
    """Whether two sets of pixels show surfaces that could be one."""
    albedo, other = a.albedo[where_a], b.albedo[where_b]
    depth, far = a.depth[where_a], b.depth[where_b]
    return (
        (np.abs(albedo - other).max(-1) <= SAME_ALBEDO * np.maximum(albedo.max(-1), other.max(-1)))
        & (np.abs(depth - far) <= SAME_DEPTH * np.maximum(depth, far))
        & ((a.normal[where_a] * b.normal[where_b]).sum(-1) >= SAME_NORMAL)
    )


def inner(surface):
    """(H, W) bool: pixels whose eight neighbours are of the same surface. The pixel filter mixes surfaces at their
    edges, and no track is finer than a pixel: there a still error would seem to change."""
    height, width = surface.depth.shape
    rows, columns = np.mgrid[:height, :width]
    found = (surface.depth > 0) & (surface.depth < 1e9)
    found[[0, -1]] = found[:, [0, -1]] = False
    for down in (-1, 0, 1):
        for right in (-1, 0, 1):
            other = (rows + down).clip(0, height - 1), (columns + right).clip(0, width - 1)
            found &= alike(surface, surface, (rows, columns), other)
    return found


def track(before, after):
    """Track of the pixels of Surface `after` that `before` shows too. What was hidden is found by going there and
    back: what hid it goes elsewhere. To whole pixels, since a mean of four would hide three quarters of the noise."""
    height, width = after.depth.shape
    rows, columns = np.mgrid[:height, :width]
    then_row = np.rint(rows - after.vector[..., 1]).astype(int)
    then_column = np.rint(columns + after.vector[..., 0]).astype(int)
    inside = (then_row >= 0) & (then_row < height) & (then_column >= 0) & (then_column < width)
    then = then_row.clip(0, height - 1), then_column.clip(0, width - 1)
    there = before.vector[then]
    back = np.maximum(np.abs(then[0] + there[..., 3] - rows), np.abs(then[1] - there[..., 2] - columns))
    seen = (
        inside & (back <= ROUND_TRIP) & inner(after) & inner(before)[then] & alike(after, before, (rows, columns), then)
    )
    return Track((rows[seen], columns[seen]), (then[0][seen], then[1][seen]))


def changes(errors, tracks):
    """(frames - 1,): mean square of the error's change from frame to frame along the tracks."""
    return np.array(
        [
            np.square(now[each.now] - before[each.then], dtype=np.float64).mean() if each.now[0].size else 0.0
            for before, now, each in zip(errors[:-1], errors[1:], tracks, strict=True)
        ]
    )


def flicker(errors, noise, tracks):
    """(frames - 1,): changes() of errors less what the reference's own noise has in them. noise: half the difference
    of its two halves, which changes as the noise of their mean does, whatever part of it stays from frame to frame."""
    return changes(errors, tracks) - changes(noise, tracks)


def switch(truth):
    """The first frame, from 0, in which the mean light is another than just before; None where there is none."""
    light = truth.mean((1, 2, 3), dtype=float)
    jumps = np.abs(np.diff(light)) > JUMP * np.maximum(light[1:], light[:-1])
    return int(jumps.argmax()) + 1 if jumps.any() else None


def switched(truth, frame):
    """(H, W) bool: pixels of which a switch at `frame` changes the light by half or more."""
    before, after = (
        truth[part].mean((0, 3), dtype=float) for part in (slice(max(frame - LEVEL, 0), frame), slice(frame, None))
    )
    return np.abs(before - after) >= 0.5 * np.maximum(before, after)


def lag(light, frame, settled=None):
    """Frames after a switch at `frame` until ARRIVED of the change is there for good: 0 where the switch's own frame
    has it, None where it does not come. light: (frames,), a way's mean light. settled: what it comes to; its last
    frames' mean without."""
    before = light[max(frame - LEVEL, 0) : frame].mean()
    end = light[-LEVEL:].mean() if settled is None else settled
    late = np.flatnonzero((light[frame:] - before) / (end - before) < ARRIVED)
    first = int(late[-1]) + 1 if late.size else 0
    return first if first < len(light) - frame else None


def trails(with_history, without):
    """(difference, frame from 0, row, column): the block whose mean error history worsens most. Rows and columns in
    pixels."""

    def worst(errors):
        return np.array([np.abs(blocks(each)).mean(-1) for each in errors])

    more = worst(with_history) - worst(without)
    frame, row, column = np.unravel_index(more.argmax(), more.shape)
    return float(more.max()), int(frame), int(row) * BLOCK, int(column) * BLOCK
