# SPDX-License-Identifier: GPL-3.0-or-later
"""The method from top to bottom: upload, pack and merge (the pyramid), gather, upsample, composite, read back.

Textures have the bottom row first, except the uploaded passes. Each stage is a function of its own, so that a test
can feed and read any of them; gather_indirect() at the end puts them together. Equations: docs/method/paper.md.
"""

import time
from dataclasses import dataclass

import numpy as np

from . import device
from .pyramid import TABLE_WIDTH, level_boxes, offsets, samples_at
from .types import Camera, Drawn, Draws, Passes, Settings

Texture = device.Texture
MERGED_AT_ONCE = 3  # levels that one dispatch of merge makes from one


class Cancelled(Exception):
    """The progress callback asked to stop."""


@dataclass(frozen=True, eq=False)
class Pyramid:
    """All levels in one RGBA32UI texture, a surfel a texel (shaders/surfel.glsl), and what shaders must know of them.

    boxes: (x, y, width, height) of each level, finest first. parameters: a Parameters block with the camera in it.
    """

    surfels: Texture
    boxes: list[tuple[int, int, int, int]]
    parameters: np.ndarray

    @property
    def last(self) -> int:
        """The coarsest level."""
        return len(self.boxes) - 1

    def groups(self, level: int) -> int:
        """Work groups that one level takes."""
        across, up = device.groups(*self.boxes[level][2:])
        return across * up


def upload(passes: Passes | Drawn, broken: dict[str, int] | None = None, light: bool = True) -> dict[str, Texture]:
    """One texture a channel, named as the shaders name them, with four neighbouring pixels of a row in each texel; rows
    are filled up with background. broken: filled with Passes.broken(). light: or only depth and normal."""
    if isinstance(passes, Drawn):
        return dict(passes.textures)
    groups = {device.SURFACE_CHANNELS: (passes.depth, *passes.normal)}
    if light:
        groups |= {
            device.COLOR_CHANNELS: passes.diffuse_color,
            device.LIGHT_CHANNELS: (*passes.diffuse_direct, *passes.emission),
        }
    width, height = passes.size
    quads = -(-width // 4)
    plane = np.zeros((height, 4 * quads), np.float32)  # one for all: new memory for each takes longer than the copy
    textures, sound = {}, True
    for names, arrays in groups.items():
        for name, array in zip(names, arrays, strict=True):
            plane[:, :width] = array
            # A sum of squares is finite exactly when each of its terms is, but for terms above 1e19: broken() decides.
            sound = sound and np.isfinite(np.vdot(plane, plane))
            textures[name] = device.texture(quads, height, data=plane)
    if broken is not None and not sound:
        broken |= passes.broken()
    return textures


def pack(channels: dict[str, Texture], passes: Passes | Drawn, camera: Camera, settings: Settings | Draws) -> Pyramid:
    """The pyramid's base, from the passes' uploaded channels; its coarser levels have their place, and are empty. Draws
    need none."""
    width, height = passes.size
    base = -(-width // settings.start), -(-height // settings.start)
    boxes = level_boxes(*base, settings.radius) if isinstance(settings, Settings) else [(0, 0, *base)]
    surfels = device.texture(
        max(x + w for x, _, w, _ in boxes), max(y + h for _, y, _, h in boxes), device.SURFEL_FORMAT
    )
    block = device.parameters(
        rotation=camera.rotation,
        projection=(*camera.scale, *camera.offset),
        levels=boxes,
        frame=(width, height, settings.start, int(camera.orthographic)),
        span=(0, len(boxes) - 1),
        output_scale=(settings.strength,),
    )
    device.dispatch(
        "pack_with_normals" if passes.lacks_normals() else "pack",
        block,
        channels | {"surfels_out": surfels},
        device.groups(-(-width // 4), boxes[0][3], device.STRIP),
    )
    return Pyramid(surfels, boxes, block)


def merge(pyramid: Pyramid) -> None:
    """Fill the coarser levels, by sums over the finer ones."""
    block = pyramid.parameters.copy()
    for finer in range(0, pyramid.last, MERGED_AT_ONCE):
        last = min(finer + MERGED_AT_ONCE, pyramid.last)
        block["span"][:2] = finer, last
        device.dispatch(
            "merge",
            block,
            {"surfels_out": pyramid.surfels},
            (sum(pyramid.groups(level) for level in range(finer + 1, last + 1)), 1),
        )


def gather(pyramid: Pyramid, settings: Settings, after_band=lambda done: None) -> Texture:
    """What each texel of each level receives from its region, laid out as the pyramid is.

    rgb: irradiance E, W m^-2, the sum of pi L times the form factor; a: the sum F of the form factors, the share of
    the hemisphere that sends light. Both unbiased for the sum over the whole region, and not yet bounded.

    Long ones run in bands of device.band() samples, each waited for, with after_band(share done) after each: no
    driver's watchdog fires, the interface gets its turns, and the render can be cancelled.
    """
    disk, ring = offsets(settings.radius, finest=True), offsets(settings.radius, finest=False)
    block = pyramid.parameters.copy()
    costs = []  # samples of each work group, in the order in which the shader takes them: coarsest level first
    for level in range(pyramid.last, -1, -1):
        region, first = (ring, len(disk)) if level else (disk, 0)
        samples = samples_at(level, settings.samples, len(region))
        block["regions"].view(np.uint32)[level] = samples, first, len(region), (len(region) << 16) // samples
        costs.append(np.full(pyramid.groups(level), device.SQUARE[0] * device.SQUARE[1] * samples))
    block["band"][1] = device.as_int32(settings.seed)
    done = np.cumsum(np.concatenate(costs))
    irradiance = device.texture(pyramid.surfels.width, pyramid.surfels.height)
    textures = {"surfels": pyramid.surfels, "offsets": _table(disk, ring), "irradiance_out": irradiance}
    first = 0
    while first < len(done):
        before = done[first - 1] if first else 0
        end = max(first + 1, int(np.searchsorted(done, before + device.band("gather"), side="right")))
        block["band"][0] = first
        device.run_band("gather", int(done[end - 1] - before), block, textures, (end - first, 1))
        after_band(done[end - 1] / done[-1])
        first = end
    return irradiance


def upsample(pyramid: Pyramid, irradiance: Texture) -> Texture:
    """What each texel of the base receives in all: every level's light, coarser ones interpolated along the surface."""
    _, _, width, height = pyramid.boxes[0]
    total = device.texture(width, height)
    device.dispatch(
        "upsample",
        pyramid.parameters,
        {"surfels": pyramid.surfels, "irradiance": irradiance, "total_out": total},
        device.groups(width, height),
    )
    return total


def composite(channels: dict[str, Texture], pyramid: Pyramid, total: Texture) -> Texture:
    """Indirect radiance at full resolution, strength * albedo / pi * E / max(1, F), as rows of r g b r g b ..., with
    four numbers of them in a texel. 0 where there is no surface."""
    quads, height = channels["depth_pass"].width, channels["depth_pass"].height
    indirect = device.texture(3 * quads, height)
    device.dispatch(
        "composite",
        pyramid.parameters,
        channels | {"surfels": pyramid.surfels, "total": total, "indirect_out": indirect},
        device.groups(quads, height, device.STRIP),
    )
    return indirect


def gather_indirect(
    passes: Passes,
    camera: Camera,
    settings: Settings,
    *,
    progress=lambda stage, fraction: False,
    timings: dict[str, float] | None = None,
    broken: dict[str, int] | None = None,
) -> np.ndarray:
    """One bounce of indirect light between the surfaces that the passes show.

    Returns (H, W, 3) float32, bottom row first: the indirect radiance to add to the picture, W sr^-1 m^-2; 0 on
    background. Pixels that hold NaN or infinity in any pass send nothing, and get 0 where it is in depth, normal or
    colour.

    progress(stage, fraction): called between stages and bands with the share of all work done; a true answer raises
    Cancelled. timings: filled with seconds for upload, pyramid, gather, upsample (composite included) and read_back;
    asking for them waits for the GPU after every stage. broken: filled with Passes.broken().
    Raises GpuUnavailable where the GPU cannot do it.
    """
    lap = stopwatch(timings)

    def report(stage, fraction):
        if progress(stage, fraction):
            raise Cancelled

    report("upload", 0.0)
    channels = upload(passes, broken)
    lap("upload", channels["emission_b"])

    report("pyramid", 0.0)
    pyramid = pack(channels, passes, camera, settings)
    for name in device.LIGHT_CHANNELS:
        del channels[name]
    merge(pyramid)
    lap("pyramid", pyramid.surfels)

    report("gather", 0.0)
    irradiance = gather(pyramid, settings, lambda done: report("gather", done))
    lap("gather", irradiance)

    report("upsample", 1.0)
    indirect = composite(channels, pyramid, upsample(pyramid, irradiance))
    lap("upsample", indirect)
    del channels, pyramid, irradiance
    width, height = passes.size
    picture = device.read(indirect).reshape(height, -1, 3)[:, :width]
    lap("read_back")
    return picture


def _table(*regions: np.ndarray) -> Texture:
    entries = np.concatenate(regions)
    rows = -(-len(entries) // TABLE_WIDTH)
    table = np.zeros((rows * TABLE_WIDTH, 2), np.float32)
    table[: len(entries)] = entries
    return device.texture(TABLE_WIDTH, rows, "RG32F", table)


def stopwatch(timings: dict[str, float] | None):
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
