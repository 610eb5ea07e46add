# SPDX-License-Identifier: GPL-3.0-or-later
"""The levels of the pyramid, and the regions that their texels gather from, as tables of offsets.

Levels must tile the image: the finest takes the disk 0 < r < R around the receiver, every coarser one the ring from
about R/2 to R of its own texels, which is where the finer one stopped. The coarsest is so small that its ring holds
everything left.
"""

from functools import cache

import numpy as np

OFFSETS_WIDTH = 256  # entries in a row of the texture that holds a table of offsets
MAX_LEVELS = 16  # of a frame: 16384 pixels across at the smallest radius have 15
MAX_RADIUS = 140  # keeps a table below the 65,535 entries that the shader's random index can reach


@cache
def offsets(radius: int, finest: bool) -> np.ndarray:
    """(n, 2) int32, read-only: the offsets (x, y) of a region of `radius` texels, along a Z-order curve.

    Stratified sampling needs the order: a part of the table is a compact patch of the region.
    """
    side = np.arange(-radius, radius + 1)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    square = x * x + y * y
    inside = (square < radius * radius) & (square > (0 if finest else hole(radius)))
    x, y = x[inside], y[inside]
    order = np.argsort(_z_order(x + radius, y + radius))
    table = np.stack([x[order], y[order]], axis=-1).astype(np.int32)
    table.setflags(write=False)
    return table


def hole(radius: int) -> int:
    """Largest squared distance that a ring leaves to the finer level: the one whose texels, four times as large,
    come nearest in area to the disk of `radius`.

    R/2 itself is not good enough: of the points of a grid, 4 x 9 lie within 2 and 45 within 4, so that at R = 4 a
    fifth of the disk would be counted twice (at R = 8 7 %, at R = 16 3 %).
    """
    side = np.arange(1 - radius, radius)
    squares = np.add.outer(side**2, side**2).ravel()
    squares = np.sort(squares[squares < radius * radius])
    candidates = np.unique(squares)
    left_out = 4 * np.searchsorted(squares, candidates, side="right")
    return int(candidates[np.abs(left_out - squares.size).argmin()])


def level_sizes(width: int, height: int, radius: int) -> list[tuple[int, int]]:
    """(width, height) of each level from the base on, halved until the diagonal fits into the radius."""
    sizes = [(width, height)]
    while np.hypot(*sizes[-1]) > radius and sizes[-1] != (1, 1):
        width, height = sizes[-1]
        sizes.append(((width + 1) // 2, (height + 1) // 2))
    return sizes


def level_boxes(width: int, height: int, radius: int) -> list[tuple[int, int, int, int]]:
    """(x, y, width, height) of each level in the one texture that holds all: the finest at the origin, the others in a
    row along its longer side."""
    (first, *coarser), along = level_sizes(width, height, radius), 0
    boxes = [(0, 0, *first)]
    for size in coarser:
        boxes.append((along, height, *size) if width >= height else (width, along, *size))
        along += size[width < height]
    return boxes


def samples_at(level: int, samples: int, texels: int) -> int:
    """Samples a receiver of `level` takes from a region of `texels`: `samples` at the finest level (0: all of the
    region), doubled from level to level, never more than the region has.

    A coarse texel's noise spreads over all it is upsampled to, and a level has a quarter of the texels of the one
    before: doubling costs at most half as much again in all and cuts the noise 1.4 to 7 times (docs/method/paper.md).
    """
    return min(samples << level, texels) if samples else texels


def _z_order(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The bits of x and y, interleaved."""
    code = np.zeros_like(x)
    for bit in range(16):
        code |= (((x >> bit) & 1) << (2 * bit)) | (((y >> bit) & 1) << (2 * bit + 1))
    return code
