# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of the light that a picture's surfaces send comes through what lies in front of them, to the camera.

EEVEE's passes of surfaces hold them as if there were no volumes and no Blended materials. Combined C has both, and the
passes Volume Direct V and Transparent (B, and the opacity A of what is Blended) say what came on top:

    C = T S + (1 - A) V + B,   S = Diffuse Direct * Diffuse Color + Glossy Direct * Glossy Color + Emission +
    Environment

Grease Pencil is drawn over that, and a pass of its own has its strokes: it counts as Blended. T follows by division
wherever a surface is brighter than the rounding of these passes. Where it is not, in shadow, the extinction on the way
there is taken from what is seen nearby at a like distance, and then from further off.
"""

import bpy
import numpy as np

from . import exr, media, roughness

VOLUME = "eevee.use_pass_volume_direct", "Volume Direct"
TRANSPARENT = "eevee.use_pass_transparent", "Transparent"
ENVIRONMENT = "use_pass_environment", "Environment"
STROKES = "use_pass_grease_pencil", "Grease Pencil"
# Beside passes.PASSES: the view layer's switch, and the pass.
PASSES = (roughness.COLOR, roughness.DIRECT, ENVIRONMENT, TRANSPARENT, VOLUME, STROKES)

ROUNDING_ERROR = (
    4e-3  # of the brightness of a pixel: passes are halves, and Combined weighs its samples by their brightness
)
MIN_RADIANCE = 1e-6  # W sr^-1 m^-2, below which nothing is told by division
MAX_RADIANCE = 1e15  # whose square is still a float32
LAYERS_PER_DOUBLING = 2  # of cells of the grid of extinctions, from one distance to twice that
MAX_OPTICAL_DEPTH = 12.0  # optical depth that a cell can tell
BLUR_CELL_FACTOR = 4  # times a cell's side where Combined is blurred
MIN_CELL = 4  # pixels along a cell's side, at least


def needed(scene: bpy.types.Scene) -> tuple[tuple[str, str], ...]:
    """(switch, pass) of what load() reads of a view layer, beside passes.needed(): nothing where nothing can be in
    front."""
    return PASSES if media.present(scene) else ()


def load(path: str, layer: str, window: tuple[int, int, int, int], cell: int, blurred: bool) -> np.ndarray | None:
    """(H, W, 3) float32 in 0..1, rows bottom first as the light is handed back: through() of a view layer from a file
    that frame_store.save() wrote; None where it lacks a pass. path, layer, window, Problem: as passes.load() has
    them."""
    cut = exr.read(path, window)

    def color(name):
        return _finite(np.stack([cut(f"{layer}.{name}.{axis}") for axis in "RGB"], -1))

    try:
        surface = (
            color("Diffuse Direct") * color("Diffuse Color")
            + color(roughness.DIRECT[1]) * color(roughness.COLOR[1])
            + color("Emission")
            + color(ENVIRONMENT[1])
        )
        blended, opacity = color(TRANSPARENT[1]), _finite(cut(f"{layer}.{TRANSPARENT[1]}.A"))
        rest = color("Combined"), surface, color(VOLUME[1])
    except KeyError:
        return None
    try:
        strokes, clear = color(STROKES[1]), 1 - np.clip(_finite(cut(f"{layer}.{STROKES[1]}.A")), 0, 1)
        blended, opacity = strokes + clear[..., None] * blended, 1 - clear * (1 - opacity)
    except KeyError:  # Blender has no such pass where nothing is drawn
        pass
    return transmitted_share(*rest, blended, opacity, cut(f"{layer}.Depth.Z"), cell, blurred)[::-1]


def transmitted_share(
    combined: np.ndarray,
    surface: np.ndarray,
    volume: np.ndarray,
    blended: np.ndarray,
    opacity: np.ndarray,
    depth: np.ndarray,
    cell: int,
    blurred: bool = False,
) -> np.ndarray:
    """(H, W, 3), 0..1: the share of the surfaces' light that reaches the camera.

    combined, surface, volume, blended: (H, W, 3), W sr^-1 m^-2, C, S, V and B above; opacity, depth: (H, W), A, and
    the distance along the camera's axis in metres. cell: pixels along the side of a cell of EEVEE's own grid of
    volumes, finer than which nothing is known of them. blurred: whether depth of field or motion blur lie in C, which
    EEVEE puts into no other pass: what a pixel holds is then not the light of its own surface, but that of many pixels
    together still is theirs."""
    clear = 1 - np.clip(opacity, 0, 1)[..., None]
    passed = combined - blended - clear * volume
    noise = ROUNDING_ERROR * (np.abs(combined) + np.abs(blended) + np.abs(volume)) + MIN_RADIANCE
    cell = max(MIN_CELL, cell) * (BLUR_CELL_FACTOR if blurred else 1)
    likely = clear * _nearby(passed, clear * surface, noise, depth, cell, everywhere=blurred)
    if blurred:
        return np.clip(likely, 0, 1)
    found = (passed * surface + noise**2 * likely) / (surface**2 + noise**2)  # the least squares of both
    return np.clip(found, 0, 1)


def _nearby(passed, lit, noise, depth, cell, everywhere):
    """(H, W, 3): how much comes through volumes to each pixel by what cells of pixels near it tell. 1 where `lit`
    itself tells, unless wanted everywhere."""
    far = np.isfinite(depth) & (depth > 0) & (depth < 1e9)
    wanted = (far if everywhere else far & (noise > 0.01 * np.abs(lit)).any(-1)).nonzero()
    found = np.ones_like(lit)
    if not wanted[0].size:
        return found
    layer = LAYERS_PER_DOUBLING * np.log2(np.where(far, depth, 1.0))
    layer = np.where(far, layer - layer[far].min(), 0.0)
    size = *(-(-side // cell) for side in depth.shape), int(layer.max()) + 1
    rows, columns = far.nonzero()
    index = np.ravel_multi_index((rows // cell, columns // cell, layer[far].astype(int)), size)

    def summed(values):
        return np.bincount(index, values[far], np.prod(size)).reshape(size)

    def of_channels(values):
        return np.stack([summed(values[..., channel]) for channel in range(3)], -1)

    light, rounding, away = (
        of_channels(lit),
        of_channels(noise),
        summed(depth) / np.maximum(summed(far.astype(float)), 1),
    )
    weight = light**2 / (light**2 + rounding**2 + MIN_RADIANCE**2)
    share = np.maximum(of_channels(passed), 0) / np.where(light > 0, light, 1)
    extinction = (
        -np.log(np.clip(share, np.exp(-MAX_OPTICAL_DEPTH), np.exp(MAX_OPTICAL_DEPTH)))
        / np.maximum(away, 1e-6)[..., None]
    )
    grid = _filled(extinction, np.where(light > 0, weight, 0))
    at = [(wanted[0] + 0.5) / cell - 0.5, (wanted[1] + 0.5) / cell - 0.5, layer[wanted] - 0.5]
    found[wanted] = np.exp(
        np.clip(-_interpolated(grid, at) * depth[wanted][:, None], -MAX_OPTICAL_DEPTH, MAX_OPTICAL_DEPTH)
    )
    return found


def _filled(values, weights):
    """(rows, columns, layers, 3) values, and where they have less than full weight those of larger and larger cells:
    first of the same distance, then of others. Zero where nothing has any."""
    if weights.shape[:3] == (1, 1, 1):
        return np.where(weights > 0, values, 0)
    by = (2, 2, 1) if max(weights.shape[:2]) > 1 else (1, 1, 2)
    total = _merged(weights, by)
    coarse = _filled(_merged(values * weights, by) / np.where(total > 0, total, 1), np.minimum(total, 1))
    for axis in range(3):
        coarse = np.repeat(coarse, by[axis], axis)
    rows, columns, layers, _ = values.shape
    return weights * values + (1 - weights) * coarse[:rows, :columns, :layers]


def _merged(values, by):
    """Sums of blocks of `by` (rows, columns, layers) cells."""
    padded = np.pad(values, [(0, -side % step) for side, step in zip(values.shape, by)] + [(0, 0)])
    rows, columns, layers = (side // step for side, step in zip(padded.shape, by))
    return padded.reshape(rows, by[0], columns, by[1], layers, by[2], 3).sum((1, 3, 5))


def _interpolated(grid, at):
    """(N, 3) of a grid (rows, columns, layers, 3) at places given in cells, linearly between their middles."""
    low, share = [], []
    for place, side in zip(at, grid.shape):
        place = np.clip(place, 0, side - 1).astype(np.float32)
        low.append(np.minimum(place.astype(np.int32), max(side - 2, 0)))
        share.append(place - low[-1])
    flat, total = grid.reshape(-1, 3).astype(np.float32), np.zeros((low[0].size, 3), np.float32)
    for corner in np.ndindex(2, 2, 2):
        index, weight = np.zeros_like(low[0]), np.ones_like(share[0])
        for axis, step in enumerate(corner):
            side = grid.shape[axis]
            index = index * side + (np.minimum(low[axis] + 1, side - 1) if step else low[axis])
            weight = weight * (share[axis] if step else 1 - share[axis])
        total += weight[:, None] * flat[index]
    return total


def _finite(values):
    return np.clip(np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0), -MAX_RADIANCE, MAX_RADIANCE)
