# SPDX-License-Identifier: GPL-3.0-or-later
"""The method from top to bottom: upload, pack, pyramid, gather and upsample level by level, composite, read back.

Textures have the bottom row first, except the uploaded passes. Each stage is a function of its own, so that a test
can feed and read any of them; gather_indirect() at the end puts them together. Equations: docs/method.md.
"""

import time
from dataclasses import dataclass

import gpu
import numpy as np

from . import device
from .inputs import Camera, Passes, Settings
from .region import TABLE_WIDTH, level_sizes, offsets, samples_at

Texture = gpu.types.GPUTexture


class Cancelled(Exception):
    """The progress callback asked to stop."""


@dataclass(frozen=True, eq=False)
class Level:
    """One level of the pyramid: three RGBA32F textures of (height, width).

    radiance: rgb, mean over the area, W sr^-1 m^-2. place: xyz, mean view-space point, metres; a, area A, m^2 (0: no
    surface). vector_area: xyz, the sum of A n, m^2.
    """

    radiance: Texture
    place: Texture
    vector_area: Texture

    @property
    def size(self) -> tuple[int, int]:
        return self.place.width, self.place.height

    def as_emitters(self) -> dict[str, Texture]:
        return {"radiance": self.radiance, "place": self.place, "vector_areas": self.vector_area}

    def as_coarse(self, irradiance: Texture) -> dict[str, Texture]:
        return {"coarse": irradiance, "coarse_place": self.place, "coarse_vector_area": self.vector_area}


def upload(passes: Passes) -> dict[str, Texture]:
    """One R32F texture a channel, named as the shaders name them; no copy is made in Python."""
    groups = {device.SURFACE_CHANNELS: (passes.depth, *passes.normal), device.COLOR_CHANNELS: passes.diffuse_color,
              device.LIGHT_CHANNELS: (*passes.diffuse_direct, *passes.emission)}
    return {name: device.texture(*passes.size, 1, array)
            for names, arrays in groups.items() for name, array in zip(names, arrays, strict=True)}


def pack(channels: dict[str, Texture], camera: Camera, start: int) -> tuple[Texture, Level]:
    """The full-resolution guide (view normal xyz, depth; 0 where there is no surface) and the pyramid's base."""
    width, height = channels["depth_pass"].width, channels["depth_pass"].height
    guide, base = device.texture(width, height), _new_level(-(-width // start), -(-height // start))
    device.dispatch("pack", _camera_block(camera, width, height, start), channels | {
        "guide": guide, "base_radiance": base.radiance, "base_place": base.place,
        "base_vector_area": base.vector_area})
    return guide, base


def pyramid(base: Level, radius: int) -> list[Level]:
    """The levels, finest first, halved by exact sums until the whole image lies within the radius."""
    levels = [base]
    for size in level_sizes(*base.size, radius)[1:]:
        coarse = _new_level(*size)
        device.dispatch("halve", device.parameters(), levels[-1].as_emitters() | {
            "coarse_radiance": coarse.radiance, "coarse_place": coarse.place,
            "coarse_vector_area": coarse.vector_area})
        levels.append(coarse)
    return levels


def gather(level: Level, index: int, settings: Settings, after_band=lambda done: None) -> Texture:
    """What each texel of level `index` (0: finest) receives from its region.

    rgb: irradiance E, W m^-2, the sum of pi L times the form factor; a: the sum F of the form factors, the share of
    the hemisphere that sends light. Both unbiased for the sum over the whole region, and not yet bounded.
    """
    region = offsets(settings.radius, finest=index == 0)
    samples = samples_at(index, settings.samples, len(region))
    irradiance = device.texture(*level.size)
    block = device.parameters(sampling=(samples, len(region), index, _as_int32(settings.seed)))
    device.dispatch("gather", block, level.as_emitters() | {"offsets": _table(region), "irradiance": irradiance},
                    level.size[0] * samples, after_band)
    return irradiance


def upsample(fine: Level, own: Texture, coarse: Level, coarse_total: Texture) -> Texture:
    """own + coarse_total at the fine level's resolution, by bilateral interpolation along the fine surface."""
    total = device.texture(*fine.size)
    device.dispatch("upsample", device.parameters(), coarse.as_coarse(coarse_total) | {
        "place": fine.place, "vector_areas": fine.vector_area, "own": own, "total": total})
    return total


def composite(guide: Texture, channels: dict[str, Texture], base: Level, total: Texture, camera: Camera,
              settings: Settings) -> Texture:
    """Indirect radiance at full resolution: strength * albedo / pi * E / max(1, F); alpha 1 on every sound surface."""
    indirect = device.texture(guide.width, guide.height)
    block = _camera_block(camera, guide.width, guide.height, settings.start)
    block["output_scale"][0] = settings.strength
    device.dispatch("composite", block, base.as_coarse(total) | {
        "guide": guide, "indirect": indirect, **{name: channels[name] for name in device.COLOR_CHANNELS}})
    return indirect


def gather_indirect(passes: Passes, camera: Camera, settings: Settings, *, progress=lambda stage, fraction: False,
                    timings: dict[str, float] | None = None) -> np.ndarray:
    """One bounce of indirect light between the surfaces that the passes show.

    Returns (H, W, 4) float32, bottom row first: rgb the indirect radiance to add to the picture, W sr^-1 m^-2; alpha 1
    on surfaces, 0 on background and on pixels that hold NaN or infinity in any pass (their rgb is 0).

    progress(stage, fraction): called between stages and bands with the share of all work done; a true answer raises
    Cancelled. timings: filled with seconds for upload, pyramid (pack included), gather, upsample (composite
    included) and read_back; asking for them waits for the GPU after every stage.
    Raises GpuUnavailable where the GPU cannot do it.
    """
    lap = _stopwatch(timings)

    def report(stage, fraction):
        if progress(stage, fraction):
            raise Cancelled

    report("upload", 0.0)
    channels = upload(passes)
    lap("upload", channels["emission_b"])

    report("pyramid", 0.0)
    guide, base = pack(channels, camera, settings.start)
    for name in device.LIGHT_CHANNELS + device.SURFACE_CHANNELS:
        del channels[name]
    levels = pyramid(base, settings.radius)
    lap("pyramid", levels[-1].place)

    texels = [width * height for width, height in (level.size for level in levels)]
    done, total = 0, None
    while levels:
        level, index = levels.pop(), len(levels)
        report("gather", done / sum(texels))
        irradiance = gather(level, index, settings,
                            lambda rows: report("gather", (done + rows * texels[index]) / sum(texels)))
        done += texels[index]
        lap("gather", irradiance)
        total = irradiance if total is None else upsample(level, irradiance, coarser, total)
        lap("upsample", total)
        coarser = level

    report("upsample", 1.0)
    indirect = composite(guide, channels, base, total, camera, settings)
    lap("upsample", indirect)
    del guide, channels, base, level, coarser, irradiance, total
    picture = device.read(indirect)
    lap("read_back")
    return picture


def _new_level(width: int, height: int) -> Level:
    return Level(*(device.texture(width, height) for _ in range(3)))


def _camera_block(camera: Camera, width: int, height: int, start: int) -> np.ndarray:
    return device.parameters(rotation=camera.rotation, projection=(*camera.scale, *camera.offset),
                             frame=(width, height, start, int(camera.orthographic)))


def _table(region: np.ndarray) -> Texture:
    rows = -(-len(region) // TABLE_WIDTH)
    table = np.zeros((rows * TABLE_WIDTH, 2), np.float32)
    table[:len(region)] = region
    return device.texture(TABLE_WIDTH, rows, 2, table)


def _as_int32(seed: int) -> int:
    """The lowest 32 bits of any integer, as the signed number of the same bits."""
    return (seed & 0xFFFFFFFF) - ((seed & 0x80000000) << 1)


def _stopwatch(timings: dict[str, float] | None):
    """A function lap(stage, texture) that adds the time since the last lap once `texture` is there; free if unused."""
    if timings is None:
        return lambda stage, target=None: None
    last = time.perf_counter()

    def lap(stage, target=None):
        nonlocal last
        if target is not None:
            device.wait(target)
        now = time.perf_counter()
        timings[stage] = timings.get(stage, 0.0) + now - last
        last = now

    return lap
