# SPDX-License-Identifier: GPL-3.0-or-later
"""The share of the surfaces' light that reaches the camera through whatever lies in front of them.

EEVEE's surface passes ignore volumes and Blended materials. Combined C includes both, and the passes Volume Direct V
and Transparent (B, and the opacity A of what is Blended) tell what was added:

    C = T S + (1 - A) V + B,   S = Diffuse Direct * Diffuse Color + Glossy Direct * Glossy Color + Emission +
    Environment

Grease Pencil is drawn on top, and its strokes have a pass of their own: they count as Blended. T follows by division
wherever a surface is brighter than the rounding error of these passes. Elsewhere, in shadow, the extinction along the
ray is taken from nearby pixels at a similar depth, then from farther away.
"""

import bpy
import numpy as np

from . import exr, media, roughness

VOLUME = "eevee.use_pass_volume_direct", "Volume Direct"
TRANSPARENT = "eevee.use_pass_transparent", "Transparent"
ENVIRONMENT = "use_pass_environment", "Environment"
STROKES = "use_pass_grease_pencil", "Grease Pencil"
# (switch, pass) besides passes.PASSES. switch: path of a property from the view layer.
PASSES = (roughness.COLOR, roughness.DIRECT, ENVIRONMENT, TRANSPARENT, VOLUME, STROKES)

ROUNDING_ERROR = 4e-3  # share of a pixel's radiance: passes are half floats, and Combined weights samples by brightness
MIN_RADIANCE = 1e-6  # W sr^-1 m^-2; below it division tells nothing
MAX_RADIANCE = 1e15  # its square is still a float32
LAYERS_PER_DOUBLING = 2  # layers of the grid of extinctions from one depth to twice that depth
MAX_OPTICAL_DEPTH = 12.0  # that can be estimated for a cell
BLUR_CELL_FACTOR = 4  # on a cell's side if Combined is blurred
MIN_CELL = 4  # pixels along a cell's side


def needed(scene: bpy.types.Scene) -> tuple[tuple[str, str], ...]:
    """(switch, pass) of each pass that load() reads besides passes.needed(); none if nothing can be in front of
    surfaces."""
    return PASSES if media.present(scene) else ()


def load(path: str, layer: str, window: tuple[int, int, int, int], cell: int, blurred: bool) -> np.ndarray | None:
    """transmitted_share() of a view layer from a file that frame_store.save() wrote: (H, W, 3) float32 in 0..1, bottom
    row first as the light is handed back; None if the file lacks a pass. window: (x, y, width, height) in pixels from
    the bottom left. cell, blurred: as for transmitted_share(). Raises Problem if the file can't be read."""
    read_channel = exr.read(path, window)

    def color(name):
        return _finite(np.stack([read_channel(f"{layer}.{name}.{axis}") for axis in "RGB"], -1))

    try:
        surface = (
            color("Diffuse Direct") * color("Diffuse Color")
            + color(roughness.DIRECT[1]) * color(roughness.COLOR[1])
            + color("Emission")
            + color(ENVIRONMENT[1])
        )
        blended, opacity = color(TRANSPARENT[1]), _finite(read_channel(f"{layer}.{TRANSPARENT[1]}.A"))
        rest = color("Combined"), surface, color(VOLUME[1])
    except KeyError:
        return None
    try:
        strokes, clear = color(STROKES[1]), 1 - np.clip(_finite(read_channel(f"{layer}.{STROKES[1]}.A")), 0, 1)
        blended, opacity = strokes + clear[..., None] * blended, 1 - clear * (1 - opacity)
    except KeyError:  # Blender writes no such pass if nothing is drawn
        pass
    return transmitted_share(*rest, blended, opacity, read_channel(f"{layer}.Depth.Z"), cell, blurred)[::-1]


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

    combined, surface, volume, blended: (H, W, 3), W sr^-1 m^-2: C, S, V and B of the module's docstring. opacity: (H,
    W), A. depth: (H, W), along the camera's axis, metres. cell: side in pixels of a cell of EEVEE's volume grid;
    nothing finer is known of volumes. blurred: whether C includes depth of field or motion blur, which EEVEE puts into
    no other pass: then a pixel of C does not hold the light of its own surface, but the sum over many pixels still
    holds that of theirs."""
    clear = 1 - np.clip(opacity, 0, 1)[..., None]
    passed = combined - blended - clear * volume
    noise = ROUNDING_ERROR * (np.abs(combined) + np.abs(blended) + np.abs(volume)) + MIN_RADIANCE
    cell = max(MIN_CELL, cell) * (BLUR_CELL_FACTOR if blurred else 1)
    likely = clear * _nearby(passed, clear * surface, noise, depth, cell, everywhere=blurred)
    if blurred:
        return np.clip(likely, 0, 1)
    share = (passed * surface + noise**2 * likely) / (surface**2 + noise**2)  # least squares of both estimates
    return np.clip(share, 0, 1)


def _nearby(passed, lit, noise, depth, cell, everywhere):
    """(H, W, 3): the transmittance at each pixel as estimated from cells of nearby pixels; 1 where `lit` itself is
    bright enough, unless everywhere."""
    is_surface = np.isfinite(depth) & (depth > 0) & (depth < 1e9)
    pixels = (is_surface if everywhere else is_surface & (noise > 0.01 * np.abs(lit)).any(-1)).nonzero()
    result = np.ones_like(lit)
    if not pixels[0].size:
        return result
    layer = LAYERS_PER_DOUBLING * np.log2(np.where(is_surface, depth, 1.0))
    layer = np.where(is_surface, layer - layer[is_surface].min(), 0.0)
    size = *(-(-side // cell) for side in depth.shape), int(layer.max()) + 1
    rows, columns = is_surface.nonzero()
    index = np.ravel_multi_index((rows // cell, columns // cell, layer[is_surface].astype(int)), size)

    def summed(values):
        return np.bincount(index, values[is_surface], np.prod(size)).reshape(size)

    def of_channels(values):
        return np.stack([summed(values[..., channel]) for channel in range(3)], -1)

    light, rounding = of_channels(lit), of_channels(noise)
    mean_depth = summed(depth) / np.maximum(summed(is_surface.astype(float)), 1)
    weight = light**2 / (light**2 + rounding**2 + MIN_RADIANCE**2)
    share = np.maximum(of_channels(passed), 0) / np.where(light > 0, light, 1)
    optical_depth = -np.log(np.clip(share, np.exp(-MAX_OPTICAL_DEPTH), np.exp(MAX_OPTICAL_DEPTH)))
    extinction = optical_depth / np.maximum(mean_depth, 1e-6)[..., None]
    grid = _filled(extinction, np.where(light > 0, weight, 0))
    coordinates = [(pixels[0] + 0.5) / cell - 0.5, (pixels[1] + 0.5) / cell - 0.5, layer[pixels] - 0.5]
    result[pixels] = np.exp(
        np.clip(-_interpolated(grid, coordinates) * depth[pixels][:, None], -MAX_OPTICAL_DEPTH, MAX_OPTICAL_DEPTH)
    )
    return result


def _filled(values, weights):
    """(rows, columns, layers, 3) values; where their weight is below 1, blended with the values of larger and larger
    cells, first at the same depth, then at others. Zero if no cell has any weight."""
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
    """Sums over blocks of `by` (rows, columns, layers) cells."""
    padded = np.pad(values, [(0, -side % step) for side, step in zip(values.shape, by)] + [(0, 0)])
    rows, columns, layers = (side // step for side, step in zip(padded.shape, by))
    return padded.reshape(rows, by[0], columns, by[1], layers, by[2], 3).sum((1, 3, 5))


def _interpolated(grid, coordinates):
    """(N, 3) values of a grid (rows, columns, layers, 3) at coordinates in cells, linear between cell centres."""
    low, share = [], []
    for position, side in zip(coordinates, grid.shape):
        position = np.clip(position, 0, side - 1).astype(np.float32)
        low.append(np.minimum(position.astype(np.int32), max(side - 2, 0)))
        share.append(position - low[-1])
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
