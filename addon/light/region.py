# SPDX-License-Identifier: GPL-3.0-or-later
"""The texels that one level gathers from, as tables of offsets.

Levels must tile the image: the finest takes the disk 0 < r < R around the receiver, every coarser one the ring
R/2 <= r < R of its own texels, which is where the finer one stopped. The coarsest is so small that its ring holds
everything left.
"""

import numpy as np

TABLE_WIDTH = 256          # texels in a row of the table's texture; the shader is compiled with it
LARGEST_RADIUS = 140       # keeps a table under the 65,535 entries that the shader's random index can reach


def offsets(radius: int, finest: bool) -> np.ndarray:
    """(n, 2) int32: the offsets (x, y) of a region of `radius` texels, along a Z-order curve.

    The order is what stratified sampling lives from: a part of the table is a compact patch of the region.
    Raises ValueError for a radius outside 2..LARGEST_RADIUS.
    """
    if not 2 <= radius <= LARGEST_RADIUS:
        raise ValueError(f"The radius must be 2 to {LARGEST_RADIUS} texels, not {radius}")
    side = np.arange(-radius, radius + 1)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    square = x * x + y * y
    inside = (square < radius * radius) & (square > 0 if finest else 4 * square >= radius * radius)
    x, y = x[inside], y[inside]
    order = np.argsort(_z_order(x + radius, y + radius))
    return np.stack([x[order], y[order]], axis=-1).astype(np.int32)


def level_sizes(width: int, height: int, radius: int) -> list[tuple[int, int]]:
    """(width, height) of each level from the base on, halved until the diagonal fits into the radius."""
    sizes = [(width, height)]
    while np.hypot(*sizes[-1]) > radius:
        width, height = sizes[-1]
        sizes.append(((width + 1) // 2, (height + 1) // 2))
    return sizes


def samples_at(level: int, samples: int, texels: int) -> int:
    """Samples a receiver of `level` takes from a region of `texels`: `samples` at the finest level (0: all of the
    region), doubled from level to level, never more than the region has.

    A coarse texel's noise spreads over all it is upsampled to, and a level has a quarter of the texels of the one
    before: doubling costs half as much again in all and quarters the error (docs/method.md).
    """
    return min(samples << level, texels) if samples else texels


def _z_order(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The bits of x and y, interleaved."""
    return sum((((x >> bit) & 1) << (2 * bit)) | (((y >> bit) & 1) << (2 * bit + 1)) for bit in range(16))
