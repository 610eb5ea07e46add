# SPDX-License-Identifier: GPL-3.0-or-later
"""The specular light of the picture: rays over the lobe of each base texel, marched through the depth maps of all views
to the radiance of the emitters there. docs/method/glossy.md has the formulas and the measurements behind the constants.
"""

from collections.abc import Callable

import numpy as np

from . import device
from .device import Texture
from .shader_interface import SQUARE, SURFACE_CHANNELS
from .stages import Pyramid, Report, composite, read_picture, run_in_bands, upload_color
from .types import FARTHEST, Gloss, RadiositySettings

# Rays of a texel. Mesa's software driver ends the loops of a shader silently after 65,535 rounds in all: the steps of
# so many rays in ten views, half of them with a step to bisect, stay below that.
MAX_RAYS = 32


def gather(
    gloss: Gloss,
    channels: dict[str, Texture],
    base: Pyramid,
    table: np.ndarray,
    settings: RadiositySettings,
    report: Report,
    textures: dict[str, Texture],
) -> np.ndarray:
    """(H, W, 3) float32, as Gloss.picture.

    channels: depth and normal of the picture, uploaded. base: the picture's. table: the VIEWS block. textures:
    "emitters", their "radiance", and "depths".
    """
    surface = surface_of(gloss, settings.start)
    textures = textures | {"surfels": base.surfels, "gloss": device.texture(*base.size, data=surface)}
    reflected = device.texture(*base.size)
    reflect(base, table, settings, textures, reflected, lambda done: report("glossy", done))
    smoothed = device.texture(*base.size)
    device.dispatch(
        "smooth_gloss",
        textures | {"irradiance": reflected, "total_out": smoothed},
        device.groups(*base.size),
        frame=base.frame,
    )
    del reflected, textures
    surfaces = {name: channel for name, channel in channels.items() if name in SURFACE_CHANNELS}
    indirect = composite(surfaces | upload_color(gloss.color), base, smoothed, settings.strength)
    return read_picture(indirect, gloss.roughness.shape[1])


def reflect(
    base: Pyramid,
    table: np.ndarray,
    settings: RadiositySettings,
    textures: dict[str, Texture],
    target: Texture,
    after_band: Callable[[float], None] = lambda done: None,
) -> None:
    """The pass "reflect" over the base, in bands. textures: as in gather(), "surfels" and "gloss" among them."""
    rays = rays_of(settings)
    run_in_bands(
        "reflect",
        SQUARE[0] * SQUARE[1] * rays * int(table["count"]),
        textures,
        target,
        after_band,
        frame=base.frame,
        views=table,
        seed=settings.seed & 0xFFFFFFFF,
        rays=rays,
        reach=reach_of(table, textures["depths"]),
    )


def rays_of(settings: RadiositySettings) -> int:
    """Rays of a texel: more gain next to nothing."""
    return min(max(settings.groups // 2, 1), MAX_RAYS)


def reach_of(table: np.ndarray, depths: Texture) -> float:
    """The length of rays, m: no two surfaces that views show are farther apart."""
    width, height = (int(side) for side in table["depth_size"])
    count = int(table["count"])
    shown = device.read(depths).reshape(count, height * width, -1)[..., 0]
    farthest = np.where(shown < FARTHEST, shown, 0).max(1)
    cameras = table["cameras"][:count]
    scale, offset = cameras["scale"], cameras["offset"]
    corner = np.maximum(np.abs(offset), np.abs(offset + scale * (width, height)))
    away = np.where(
        cameras["is_orthographic"] != 0,
        np.hypot(np.linalg.norm(corner, axis=1), farthest),
        farthest * np.hypot(np.linalg.norm(corner, axis=1), 1),
    )
    return 2 * float((np.linalg.norm(cameras["position"], axis=1) + away).max())


def surface_of(gloss: Gloss, start: int) -> np.ndarray:
    """(up, across, 4) float32 of the base's texels, bottom row first: roughness, the mean weighted by the amount of
    gloss, and that amount, of the brightest channel."""
    amount = np.nan_to_num(np.maximum.reduce(gloss.color), nan=0.0, posinf=0.0, neginf=0.0).clip(0, None)[::-1]
    rough = np.nan_to_num(gloss.roughness, nan=1.0).clip(0, 1)[::-1]
    height, width = amount.shape
    up, across = -(-height // start), -(-width // start)

    def sums(image: np.ndarray) -> np.ndarray:
        padded = np.zeros((up * start, across * start))
        padded[:height, :width] = image
        return padded.reshape(up, start, across, start).sum((1, 3))

    total, surface = sums(amount), np.zeros((up, across, 4), np.float32)
    surface[..., 0] = sums(amount * rough) / np.where(total > 0, total, 1)
    surface[..., 1] = total / start**2
    return surface
