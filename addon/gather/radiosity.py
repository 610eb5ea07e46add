# SPDX-License-Identifier: GPL-3.0-or-later
"""The method Radiosity from top to bottom: light between the surfaces of several views, in any number of bounces.

    depth maps of all views                  the visible surface in each direction of each camera
    emitters, receivers                      records of blocks of every view's pixels, in world space
    for each bounce but the last:            every view's receivers gather, and its emitters send that on
    the last one:                            the main view's base gathers; smooth, composite, read back

A surface that several views show counts once, and surfaces between two others block the light between them.
docs/method/radiosity.md has the measurements that decided the constants.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from . import device, glossy
from .device import Texture
from .records import Records, build_records, specular_emitters
from .shader_interface import EMITTER_TABLE_WIDTH, LIGHT_CHANNELS, RECORDS_WIDTH, SQUARE, STRIP
from .stages import (
    Progress,
    Pyramid,
    Report,
    composite,
    pack,
    read_picture,
    reporter,
    run_in_bands,
    stopwatch,
)
from .temporal import SEED_STRIDE, History, accumulate
from .types import Gloss, Passes, RadiositySettings, View
from .view_layout import count_of, has_world, rows_of, start_of, world_power

SHADOW_STEPS = 24  # along a shadow ray
ENTRIES = 1 << 18  # of the table that emitters are sampled from
BY_AREA = 0.5  # share of the table in proportion to area, the rest to power: near emitters count though they are dim
BOUNCE_GROUPS, BOUNCE_CANDIDATES = 16, 8  # of receivers whose light is sent on: many of them average its noise
SMOOTH_STEPS = 1, 2  # texels between the taps of each pass that smooths
UNSMOOTHED = (0,)  # all taps are the texel itself


def gather_views(
    views: list[View],
    settings: RadiositySettings,
    world: np.ndarray | None = None,
    *,
    history: History | None = None,
    progress: Progress = lambda stage, fraction: False,
    timings: dict[str, float] | None = None,
    broken: dict[str, int] | None = None,
    gloss: Gloss | None = None,
) -> np.ndarray:
    """The indirect light of the first view from the surfaces of all, after settings.bounces.

    views: at most MAX_VIEWS, all of one resolution. world: (4, 3), EEVEE's world light on a white surface with normal n
    is world[0] + n @ world[1:], W sr^-1 m^-2; the part of it that surfaces cover is taken away, which needs
    settings.visibility. history: of the frame before, or an empty one; it is averaged with this frame's light, and
    holds the mean afterwards. gloss: of the first view; its picture is filled in, the mean of settings.gathers. Returns
    (H, W, 3) float32, bottom row first: the indirect radiance to add to the picture, W sr^-1 m^-2, below 0 where the
    world's light is covered; 0 on background. progress, timings, broken, GpuUnavailable, Cancelled: as in
    gather_indirect(); broken is of the first view.
    """
    lap, report = stopwatch(timings), reporter(progress)
    main = views[0].camera
    records, channels, passes = build_records(views, settings, world, report=report, broken=broken)
    size, table, motion = passes.size, records.table, passes.motion if isinstance(passes, Passes) else None
    settings = replace(settings, start=start_of(settings, size))
    lap("views", records.receivers)
    base = pack(channels, passes, main, settings)
    for name in LIGHT_CHANNELS:
        del channels[name]
    del passes
    specular, pictures = None, []
    if gloss is not None:
        specular = specular_emitters(views, records)
        lap("glossy", specular)

    def gathers(light: Texture | None, first: int, last: int) -> Texture:
        """The mean of `light`, which is that of gathers up to `first`, and of those up to `last`."""
        for number in range(first, last):
            each = replace(settings, seed=settings.seed + SEED_STRIDE * number)
            gathered, radiance, irradiance = gather(
                each, base, records, lap, lambda stage, fraction: report(stage, (number + fraction) / last)
            )
            light = accumulate(base, light, gathered, 1, number, drift=False) if number else gathered
            if gloss is not None and specular is not None:
                radiance = add_specular(specular, irradiance, radiance, table)
                textures = {"emitters": records.emitters, "radiance": radiance, "depths": records.depths}
                pictures.append(glossy.gather(gloss, channels, base, table, each, report, textures))
                lap("glossy")
                del textures
            del gathered, radiance, irradiance
        assert light is not None
        return light

    light = gathers(None, 0, settings.gathers)
    specular = None  # the gathers for a new history need none
    if history is not None:
        light = history.go_on(base, main, motion, table, light, settings.gathers, gathers)
    if gloss is not None:
        gloss.picture = np.asarray(sum(pictures) / len(pictures))

    report("upsample", 1.0)
    indirect = composite(channels, base, smooth(base, light, table, settings), settings.strength)
    lap("upsample", indirect)
    picture = read_picture(indirect, size[0])
    lap("read_back")
    return picture


def gather(
    settings: RadiositySettings, base: Pyramid, records: Records, lap: Callable[..., None], report: Report
) -> tuple[Texture, Texture, Texture]:
    """(irradiance of the main view's base after all bounces, W m^-2, a texture of its size; radiance of the emitters
    then; irradiance of the receivers that it comes from)."""
    table, emitters = records.table, records.emitters
    irradiance = device.texture(RECORDS_WIDTH, rows_of(table, "receivers"))
    irradiance.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 0.0))
    radiance = radiate(emitters, irradiance, table)
    for bounce in range(1, settings.bounces):
        report("bounces", (bounce - 1) / settings.bounces)
        again = replace(settings, seed=settings.seed + bounce, groups=BOUNCE_GROUPS, candidates=BOUNCE_CANDIDATES)
        sample_emitters("sample_blocks", again, records, radiance, irradiance, {"receivers": records.receivers})
        radiance = radiate(emitters, irradiance, table)
    lap("bounces", radiance)

    gathered = device.texture(*base.size)
    sample_emitters(
        "sample_base",
        settings,
        records,
        radiance,
        gathered,
        {"surfels": base.surfels},
        lambda done: report("gather", done),
        frame=base.frame,
    )
    lap("gather", gathered)
    return gathered, radiance, irradiance


def smooth(base: Pyramid, light: Texture, table: np.ndarray, settings: RadiositySettings) -> Texture:
    """The base's irradiance with less noise, if settings.smooth: a texture of its size."""
    steps = SMOOTH_STEPS if settings.smooth else UNSMOOTHED
    for step in steps:
        total = device.texture(*base.size)
        device.dispatch(
            "smooth",
            {"surfels": base.surfels, "irradiance": light, "total_out": total},
            device.groups(*base.size),
            frame=base.frame,
            views=table,
            step=step,
            is_last=step == steps[-1],
            has_world=has_world(table),
            strength=settings.strength,
        )
        light = total
    return light


def radiate(emitters: Texture, irradiance: Texture, table: np.ndarray) -> Texture:
    """(rows, RECORDS_WIDTH) texture: radiance and area of every emitter, given the receivers' irradiance."""
    return _radiate("radiate", {"emitters": emitters, "irradiance": irradiance}, table)


def add_specular(specular: Texture, irradiance: Texture, radiance: Texture, table: np.ndarray) -> Texture:
    """A texture that radiate() made, with the specular light of the emitters added, as if it were diffuse: Glossy Color
    times that of lamps and world, and of the irradiance of the receivers."""
    textures = {"emitters": specular, "irradiance": irradiance, "diffuse_radiance": radiance}
    return _radiate("radiate_specular", textures, table)


def _radiate(name: str, textures: dict[str, Texture], table: np.ndarray) -> Texture:
    radiance = device.texture(RECORDS_WIDTH, rows_of(table, "emitters"))
    device.dispatch(
        name,
        textures | {"radiance_out": radiance},
        device.groups(radiance.width, radiance.height),
        views=table,
    )
    return radiance


def emitter_table(radiance: Texture, table: np.ndarray, seed: int) -> dict[str, Texture]:
    """The table that emitters are sampled from, each in proportion to its share of all power and of all area, and
    "starts", from which the passes "sample_..." have its pdf."""
    rows, count, entries = rows_of(table, "emitters"), count_of(table, "emitters"), ENTRIES
    sums, starts = device.texture(RECORDS_WIDTH, rows, "RG32F"), device.texture(rows, 1)
    made = device.texture(EMITTER_TABLE_WIDTH, entries // EMITTER_TABLE_WIDTH, "R32F")
    by_row = device.groups(rows, 1, STRIP)
    device.dispatch(
        "row_sums",
        {"radiance": radiance, "sums_out": sums},
        by_row,
        views=table,
        count=count,
        world_power=world_power(table),
    )
    device.dispatch("row_starts", {"sums": sums, "starts_out": starts}, by_row, entries=entries, by_area=BY_AREA)
    device.dispatch(
        "table",
        {"sums": sums, "starts": starts, "table_out": made},
        device.groups(made.width, made.height),
        count=count,
        entries=entries,
        seed=seed & 0xFFFFFFFF,
    )
    return {"table": made, "starts": starts}


def sample_emitters(
    name: str,
    settings: RadiositySettings,
    records: Records,
    radiance: Texture,
    target: Texture,
    receivers: dict[str, Texture],
    after_band: Callable[[float], None] = lambda done: None,
    **named: Any,
) -> None:
    """Gather into `target` by one of the passes "sample_...". radiance: of the emitters. receivers: the texture that
    holds them."""
    sampled = emitter_table(radiance, records.table, settings.seed)
    run_in_bands(
        name,
        SQUARE[0] * SQUARE[1] * settings.groups * settings.candidates,
        receivers | sampled | {"emitters": records.emitters, "radiance": radiance, "depths": records.depths},
        target,
        after_band,
        views=records.table,
        seed=settings.seed & 0xFFFFFFFF,
        groups=settings.groups,
        candidates=settings.candidates,
        entries=ENTRIES,
        shadow_steps=SHADOW_STEPS if settings.visibility else 0,
        world_power=world_power(records.table),
        **named,
    )
