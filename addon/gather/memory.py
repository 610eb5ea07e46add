# SPDX-License-Identifier: GPL-3.0-or-later
"""The GPU memory of a frame, from its size and settings alone."""

from .pyramid import OFFSETS_WIDTH, level_boxes, offsets
from .radiosity import ENTRIES
from .shader_interface import ALL_CHANNELS, LIGHT_CHANNELS, RECORDS_WIDTH
from .types import PaperSettings, RadiositySettings
from .view_layout import KINDS, layout, rows_of, start_of

TEXEL = 16  # bytes of RGBA32F and RGBA32UI
CHANNELS, LIGHT = len(ALL_CHANNELS), len(LIGHT_CHANNELS)  # uploaded; of these, freed once the surfels are packed


def gpu_bytes(
    width: int,
    height: int,
    settings: PaperSettings | RadiositySettings,
    further: int = 0,
    *,
    shines: bool = False,
    averages: bool = False,
) -> int:
    """The most bytes of textures that gather_indirect(), or gather_views() with so many further views, has on the GPU
    at a time, for a frame of width x height pixels. shines, averages: with Gloss, with a History of the frame
    before."""
    if isinstance(settings, RadiositySettings):
        return _radiosity_bytes(width, height, settings, further, shines, averages)
    channel = -(-width // 4) * height * TEXEL
    boxes = level_boxes(-(-width // settings.start), -(-height // settings.start), settings.radius)
    pyramid = max(x + w for x, _, w, _ in boxes) * max(y + h for _, y, _, h in boxes) * TEXEL
    base = boxes[0][2] * boxes[0][3] * TEXEL
    entries = len(offsets(settings.radius, finest=True)) + len(offsets(settings.radius, finest=False))
    table = -(-entries // OFFSETS_WIDTH) * OFFSETS_WIDTH * 8
    packing = CHANNELS * channel + pyramid
    lit = (CHANNELS - LIGHT) * channel + 2 * pyramid  # surfels and irradiance
    return max(packing, lit + table, lit + base + 3 * channel)


def _radiosity_bytes(
    width: int, height: int, settings: RadiositySettings, further: int, shines: bool, averages: bool
) -> int:
    table = layout(1 + further, (width, height))
    depths = 8 * int(table["depth_size"].prod()) * (1 + further)
    emitters, receivers = (TEXEL * RECORDS_WIDTH * rows_of(table, kind) for kind in KINDS)  # a texel of each record
    start = start_of(settings, (width, height))
    base = TEXEL * -(-width // start) * -(-height // start)
    channel = TEXEL * -(-width // 4) * height
    past = 2 * base if averages else 0  # surfels and light of the frame before
    packed = depths + 4 * (emitters + receivers) + base + (CHANNELS - LIGHT) * channel
    history = base if averages else 0
    mean = base if settings.gathers > 1 else 0
    specular = 4 * emitters if shines else 0
    # The gathers: radiance and irradiance, then a bounce, or the base and the table of emitters with its sums.
    sums = emitters // 2 + TEXEL * rows_of(table, "emitters")
    sampling = packed + past + emitters + receivers + max(emitters, 4 * ENTRIES + sums + base)
    averaging = packed + past + emitters + receivers + 2 * base
    steps = [
        packed + past + LIGHT * channel,
        sampling + mean + specular,
        packed + history + 3 * base,  # smoothed twice
        packed + history + 2 * base + 3 * channel,  # composited
    ]
    if mean:
        steps.append(averaging + mean + specular)
    if averages:  # a new history: reprojected history, the first gathers and their mean with later ones
        steps += [sampling + 3 * base, averaging + 3 * base]
    if shines:
        lit = packed + past + mean + specular + emitters + receivers + base
        steps += [
            packed + past + specular + CHANNELS * channel,
            lit + max(emitters, 3 * base, base + 6 * channel),  # specular light added, reflected, composited
        ]
    return max(steps)


def is_exact(settings: PaperSettings | RadiositySettings) -> bool:
    """Whether every texel gathers from all of its region, so that there is no noise and the seed has no effect."""
    if isinstance(settings, RadiositySettings):
        return False
    disk, ring = (len(offsets(settings.radius, finest)) for finest in (True, False))
    return not settings.samples or settings.samples >= disk and 2 * settings.samples >= ring
