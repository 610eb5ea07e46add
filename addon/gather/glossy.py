# SPDX-License-Identifier: GPL-3.0-or-later
"""The last bounce of the light off glossy surfaces: rays over the lobe of each texel, through the depth maps of all
views, to what the emitters there send. docs/method/glossy.md has the formulas, and what decided the numbers.
"""

import numpy as np

from . import device
from .paper import composite
from .types import FARTHEST, Gloss

# Rays of a texel. Mesa's software driver ends the loops of a shader, without a word, after 65,535 rounds in all: ten
# views' steps along so many rays, half of which find a step to halve, stay within it.
MOST_RAYS = 32


def gather(gloss: Gloss, channels: dict, base, table: np.ndarray, settings, report, textures: dict) -> np.ndarray:
    """(H, W, 3) float32, as Gloss.picture.

    channels: depth and normal of the picture, uploaded. base: the Pyramid of it. table: the Views block. report(stage,
    share done): as gather_views() has it. textures: "emitters", what they send ("radiance") and "depths".
    """
    _, _, across, up = base.boxes[0]
    table = table.copy()
    table["draws"][0], table["odds"][3] = rays_of(settings), reach_of(table, textures["depths"])
    surface = surface_of(gloss, settings.start)
    textures = textures | {"surfels": base.surfels, "gloss": device.texture(across, up, data=surface)}
    found = device.texture(across, up)
    reflect(base, table, settings.seed, textures | {"irradiance_out": found}, lambda done: report("glossy", done))
    smoothed = device.texture(across, up)
    device.dispatch(
        "smooth_gloss",
        base.parameters,
        textures | {"irradiance": found, "total_out": smoothed},
        device.groups(across, up),
    )
    del found
    shining = {name: channel for name, channel in channels.items() if name in device.SURFACE_CHANNELS}
    indirect = composite(shining | upload(gloss.color), base, smoothed)
    height, width = gloss.roughness.shape
    return device.read(indirect).reshape(height, -1, 3)[:, :width]


def reflect(base, table, seed, textures, after_band=lambda done: None):
    """The pass "reflect" over the base, some rows of work groups at a time."""
    block = base.parameters.copy()
    block["band"][1] = device.as_int32(seed)
    across, up = device.groups(*base.boxes[0][2:])
    row = across * int(np.prod(device.SQUARE)) * int(table["draws"][0]) * int(table["depths"][3])  # rays times views
    done = 0
    while done < up:
        high = min(max(1, int(device.band("reflect")) // row), up - done)
        block["band"][0] = done * device.SQUARE[1]
        device.run_band("reflect", high * row, block, textures, (across, high), table)
        done += high
        after_band(done / up)


def rays_of(settings) -> int:
    """Rays of a texel: more gain next to nothing."""
    return min(max(settings.groups // 2, 1), MOST_RAYS)


def reach_of(table: np.ndarray, depths) -> float:
    """Metres within which all surfaces lie that any view shows, from any of them: an end for the rays."""
    width, height, _, count = (int(number) for number in table["depths"])
    shown = device.read(depths).reshape(count, height * width, -1)[..., 0]
    farthest = np.where(shown < FARTHEST, shown, 0).max(1)
    scale, offset = table["projection"][:count, :2], table["projection"][:count, 2:]
    corner = np.maximum(np.abs(offset), np.abs(offset + scale * (width, height)))
    parallel = table["eye"][:count, 3] != 0
    away = np.where(
        parallel,
        np.hypot(np.linalg.norm(corner, axis=1), farthest),
        farthest * np.hypot(np.linalg.norm(corner, axis=1), 1),
    )
    return 2 * float((np.linalg.norm(table["eye"][:count, :3], axis=1) + away).max())


def surface_of(gloss: Gloss, start: int) -> np.ndarray:
    """(up, across, 4) float32 of the base's texels, bottom row first: mean roughness of their gloss, and how much they
    have."""
    amount = np.nan_to_num(np.maximum.reduce(gloss.color), nan=0.0, posinf=0.0, neginf=0.0).clip(0, None)[::-1]
    rough = np.nan_to_num(gloss.roughness, nan=1.0).clip(0, 1)[::-1]
    height, width = amount.shape
    up, across = -(-height // start), -(-width // start)

    def sums(image):
        padded = np.zeros((up * start, across * start))
        padded[:height, :width] = image
        return padded.reshape(up, start, across, start).sum((1, 3))

    total, found = sums(amount), np.zeros((up, across, 4), np.float32)
    found[..., 0] = sums(amount * rough) / np.where(total > 0, total, 1)
    found[..., 1] = total / start**2
    return found


def upload(color) -> dict:
    """The three channels of a colour, as pipeline.upload() lays the passes out."""
    height, width = color[0].shape
    plane, found = np.zeros((height, 4 * -(-width // 4)), np.float32), {}
    for name, channel in zip(device.COLOR_CHANNELS, color, strict=True):
        plane[:, :width] = channel
        found[name] = device.texture(plane.shape[1] // 4, height, data=plane)
    return found


def gpu_bytes(base: int, channel: int) -> int:
    """Bytes of textures that gather() adds at its fullest, for a base of so many texels and channels of so many bytes
    each."""
    return max(3 * 16 * base, 2 * 16 * base + 6 * channel)
