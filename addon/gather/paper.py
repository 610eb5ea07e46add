# SPDX-License-Identifier: GPL-3.0-or-later
"""The method Paper from top to bottom: upload, pack and merge (the pyramid), gather, upsample, composite, read back.

Each stage is a function of its own, so that tests can feed and read it; gather_indirect() at the end calls them in
order. Equations: docs/method/paper.md.
"""

from collections.abc import Callable

import numpy as np

from . import device
from .device import Texture
from .pyramid import OFFSETS_WIDTH, offsets, samples_at
from .shader_interface import LIGHT_CHANNELS, REGION, SQUARE
from .stages import Progress, Pyramid, composite, pack, read_picture, reporter, stopwatch, upload
from .types import Camera, PaperSettings, Passes

MERGED_AT_ONCE = 3  # levels that one dispatch of merge makes from one


def merge(pyramid: Pyramid) -> None:
    """Fill the coarser levels, by sums over the finer ones."""
    for finer in range(0, pyramid.last, MERGED_AT_ONCE):
        last = min(finer + MERGED_AT_ONCE, pyramid.last)
        device.dispatch(
            "merge",
            {"surfels_out": pyramid.surfels},
            (sum(pyramid.groups(level) for level in range(finer + 1, last + 1)), 1),
            frame=pyramid.frame,
            finer_level=finer,
            last_level=last,
        )


def gather(
    pyramid: Pyramid, settings: PaperSettings, after_band: Callable[[float], None] = lambda done: None
) -> Texture:
    """The irradiance of each texel of each level from its region, laid out as the pyramid is.

    rgb: irradiance E, W m^-2, the sum of pi L times the form factor; a: the sum F of the form factors, the share of
    the hemisphere that sends light. Both unbiased for the sum over the whole region, and not yet bounded.

    Long gathers run in bands of device.band() samples, with a wait and after_band(share done) after each: no driver's
    watchdog fires, the interface gets its turns, and the render can be cancelled.
    """
    disk, ring = offsets(settings.radius, finest=True), offsets(settings.radius, finest=False)
    regions = np.zeros(len(pyramid.boxes), REGION.dtype)
    costs = []  # samples of each work group, in the order of the shader: coarsest level first
    for level in range(pyramid.last, -1, -1):
        region, first = (ring, len(disk)) if level else (disk, 0)
        samples = samples_at(level, settings.samples, len(region))
        regions[level] = samples, first, len(region), (len(region) << 16) // samples
        costs.append(np.full(pyramid.groups(level), SQUARE[0] * SQUARE[1] * samples))
    done = np.cumsum(np.concatenate(costs))
    irradiance = device.texture(pyramid.surfels.width, pyramid.surfels.height)
    textures = {"surfels": pyramid.surfels, "offsets": _offsets_texture(disk, ring), "irradiance_out": irradiance}
    first = 0
    while first < len(done):
        before = done[first - 1] if first else 0
        end = max(first + 1, int(np.searchsorted(done, before + device.band("gather"), side="right")))
        device.run_band(
            "gather",
            int(done[end - 1] - before),
            textures,
            (end - first, 1),
            frame=pyramid.frame,
            last_level=pyramid.last,
            first_group=first,
            seed=settings.seed & 0xFFFFFFFF,
            regions=regions,
        )
        after_band(done[end - 1] / done[-1])
        first = end
    return irradiance


def upsample(pyramid: Pyramid, irradiance: Texture) -> Texture:
    """The irradiance of each texel of the base from all levels, coarser ones interpolated along the surface."""
    total = device.texture(*pyramid.size)
    device.dispatch(
        "upsample",
        {"surfels": pyramid.surfels, "irradiance": irradiance, "total_out": total},
        device.groups(*pyramid.size),
        frame=pyramid.frame,
        last_level=pyramid.last,
    )
    return total


def gather_indirect(
    passes: Passes,
    camera: Camera,
    settings: PaperSettings,
    *,
    progress: Progress = lambda stage, fraction: False,
    timings: dict[str, float] | None = None,
    broken: dict[str, int] | None = None,
) -> np.ndarray:
    """One bounce of indirect light between the surfaces that the passes show.

    Returns (H, W, 3) float32, bottom row first: the indirect radiance to add to the picture, W sr^-1 m^-2; 0 on
    background. Pixels with NaN or infinity in any pass send nothing, and get 0 where it is in depth, normal or colour.

    progress(stage, fraction): called between stages and bands with the share of all work done; a true answer raises
    Cancelled. timings: filled with seconds for upload, pyramid, gather, upsample (composite included) and read_back;
    this waits for the GPU after every stage. broken: filled with Passes.broken().
    Raises GpuUnavailable where the GPU cannot do it.
    """
    lap, report = stopwatch(timings), reporter(progress)
    report("upload", 0.0)
    channels = upload(passes, broken)
    lap("upload", channels["emission_b"])

    report("pyramid", 0.0)
    pyramid = pack(channels, passes, camera, settings)
    for name in LIGHT_CHANNELS:
        del channels[name]
    merge(pyramid)
    lap("pyramid", pyramid.surfels)

    report("gather", 0.0)
    irradiance = gather(pyramid, settings, lambda done: report("gather", done))
    lap("gather", irradiance)

    report("upsample", 1.0)
    indirect = composite(channels, pyramid, upsample(pyramid, irradiance), settings.strength)
    lap("upsample", indirect)
    del channels, pyramid, irradiance
    picture = read_picture(indirect, passes.size[0])
    lap("read_back")
    return picture


def _offsets_texture(*regions: np.ndarray) -> Texture:
    entries = np.concatenate(regions)
    rows = -(-len(entries) // OFFSETS_WIDTH)
    table = np.zeros((rows * OFFSETS_WIDTH, 2), np.float32)
    table[: len(entries)] = entries
    return device.texture(OFFSETS_WIDTH, rows, "RG32F", table)
