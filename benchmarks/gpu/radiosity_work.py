# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame of Radiosity must do at the least, pass by pass: its floor.

    floor = sum over passes of max(bytes / bandwidth,
                                   fetches of 16 bytes / their rate + fetches of at most 8 bytes / their rate,
                                   operations / their rate)

work() counts what docs/method/radiosity.md asks for, whatever the shaders do: each number of the input is read once and
each result written once; what is drawn at random is fetched where it is drawn. rates() measures what this machine can
do. An operation is a multiplication with an addition, or any one other step of arithmetic. Of these the ones below are
counted; what a layout costs (unpacking, indices, loops) is not, nor is the arithmetic of passes that only stream."""

import re
from dataclasses import dataclass
from functools import cache
from math import log2

from . import ceilings

NUMBER = 4  # bytes
RECORD = 16  # bytes of a texel: of four float32, or a surfel
ACCUMULATORS, ROUNDS = 8, 512  # vectors of a thread, and rounds over them, in the measurement of arithmetic

CANDIDATE = 17  # a random number 8, the path to the emitter 3, its square 3, the receiver's cosine 3
HASH = 8  # a random number
FACED = 3  # of candidates before the receiver: the emitter's cosine
FACING = 20  # of those that face it: form factor 4, power 3, pdf 2, weight 2, sum 1, another random number 8
RAY = 22  # each view: both ends projected, by 9 multiply-adds and the lens, 2
STEP = 10  # position and depth 3, perspective 3, whole texel 2, gap 1, its sign 1
OVERLAP = 28  # another view that holds a pixel: projection 14, path to its camera 3, cosine 3, area 7, sum 1
TAP = 26  # of smooth: path 3, height 3, cosine 3, its 8th power 3, flatness 4, weight 2, sum 4, brightest 4
TAPS = 24  # 5 x 5 without the middle
DRIFT_TAP = 42  # of accumulate: path, height and cosine 9, weight 7, two tallies of 13


@dataclass(frozen=True)
class Work:
    """What one pass must do in a frame. read, written: bytes. wide, narrow: fetches of 16 bytes, of at most 8."""

    stage: str
    read: float
    written: float
    wide: float
    narrow: float = 0
    operations: float = 0

    def floor(self, rates):
        """Seconds, and which of the rates sets them. rates: as rates() returns them."""
        bounds = {
            "bandwidth": (self.read + self.written) / rates["bandwidth"],
            "fetches": self.wide / rates["wide"] + self.narrow / rates["narrow"],
            "arithmetic": self.operations / rates["operations"],
        }
        limit = max(bounds, key=bounds.get)
        return bounds[limit], limit


def work(light, settings, size, count, shares):
    """[Work] of a frame in the middle of an animation, without Glossy Light.

    settings: RadiositySettings of one gather a frame. size: (width, height) of every view, pixels. count: views, the
    main one among them. shares: as radiosity_rays.shares() finds them.

    depths      a texel of each view's map: depth and normal of a pixel, 4 numbers; 2 written. 4 fetches.
    emit        all 13 numbers of all pixels of all views, four pixels a fetch; for a pixel and each other view that
                holds it, one fetch of that view's depth map, for the shares of a surface seen by several. Records of 4
                texels of emitters and receivers.
    pack        as in ceilings.py, of the main view.
    radiate     once a bounce: radiance, albedo and area of each emitter, and the irradiance of its receiver.
    row_sums    before each of those gathers: radiance and area of each emitter; two sums written.
    row_starts  for each row of emitters the sums of all rows, and of those before it.
    table       for each entry a search among the rows, and one within a row.
    sample_...  see _sample(). Blocks: all receivers, in each bounce but the last. Base: the last.
    reproject   surfels, those of the frame before, its light, and motion: a texel each.
    accumulate  surfels, irradiance, history; 5 x 5 taps of arithmetic.
    smooth      twice: surfels and irradiance; 5 x 5 taps of arithmetic.
    composite   as in ceilings.py."""
    layout = light.view_layout
    table, start = layout.layout(count, size), layout.start_of(settings, size)
    pixels, texels = size[0] * size[1], count * int(table["depth_size"].prod())
    base = -(-size[0] // start) * -(-size[1] // start)
    emitters, receivers = (layout.count_of(table, kind) for kind in layout.KINDS)
    bounce = {"groups": light.radiosity.BOUNCE_GROUPS, "candidates": light.radiosity.BOUNCE_CANDIDATES}
    scene = {"emitters": emitters, "texels": texels, "count": count, "light": light, "visibility": settings.visibility}
    drift = (2 * define(light, "temporal/accumulate", "DRIFT_RADIUS") + 1) ** 2
    image = ceilings.CHANNELS_IN * NUMBER * pixels
    finish = pixels * ceilings.CHANNELS_LEFT * NUMBER + 2 * RECORD * base

    def streams(stage, read, written, operations=0, narrow=0):
        return Work(stage, read, written, read / RECORD, narrow, operations)

    found = [
        Work("depths", 4 * NUMBER * texels, 2 * NUMBER * texels, 4 * texels),
        streams(
            "emit",
            count * image,
            4 * RECORD * (emitters + receivers),
            OVERLAP * count * pixels * shares.overlaps,
            count * pixels * shares.overlaps,
        ),
        streams("pack", image, RECORD * base),
        Work(
            "radiate",
            settings.bounces * RECORD * (3 * emitters + receivers),
            settings.bounces * RECORD * emitters,
            settings.bounces * 4 * emitters,
        ),
        *_table(light, settings.bounces, emitters),
        _sample("sample_blocks", settings.bounces - 1, receivers, 2, shares.blocks, **bounce, **scene),
        _sample("sample_base", 1, base, 1, shares.base, settings.groups, settings.candidates, **scene),
        streams("reproject", 4 * RECORD * base, RECORD * base),
        streams("accumulate", 3 * RECORD * base, RECORD * base, drift * DRIFT_TAP * base),
        streams("smooth", 4 * RECORD * base, 2 * RECORD * base, 2 * TAPS * TAP * base),
        streams("composite", finish, pixels * ceilings.CHANNELS_OUT * NUMBER),
    ]
    if not settings.smooth:
        found = [each for each in found if each.stage != "smooth"]
    return [each for each in found if each.read]


def _table(light, times, emitters):
    """Works of the table of emitters, made `times` times."""
    width, entries = light.shader_interface.RECORDS_WIDTH, light.radiosity.ENTRIES
    rows = -(-emitters // width)
    fetched, sums = rows * (rows + (rows - 1) / 2), 2 * NUMBER
    searched = entries * log2(rows * width)
    return [
        Work("row_sums", times * RECORD * emitters, times * sums * emitters, times * emitters),
        Work("row_starts", times * sums * rows, times * RECORD * rows, 0, times * fetched),
        Work(
            "table",
            times * (sums * emitters + RECORD * rows),
            times * NUMBER * entries,
            times * entries * (log2(rows) + 1),
            times * entries * log2(width),
            times * (searched + HASH * entries),
        ),
    ]


def _sample(stage, times, receivers, own, rays, groups, candidates, *, emitters, texels, count, light, visibility):
    """Work of `times` gathers. own: texels of a receiver. rays: radiosity_rays.Rays.

    A draw, one of `groups`, weighs `candidates` emitters: one entry of the table for each that is not from the
    neighbourhood, and its record as far as it is needed: position; normal, if it lies before the receiver; radiance, if
    it faces it. Of those from the neighbourhood the position is counted alone, since most lie in the receiver's plane.

    Then a shadow ray: at each step along it, less MARGIN at both ends, a fetch of the depth map of each view in whose
    frame that position is. A ray that is blocked shows that by two steps in one view, and no more is counted."""
    near = candidates * define(light, "radiosity/sample_emitters", "NEAR_SHARE") // 16
    draws = times * receivers * groups
    drawn, beside = draws * (candidates - near), draws * near
    steps = light.radiosity.SHADOW_STEPS if visibility else 0
    counted = steps * (1 - 2 * define(light, "radiosity/shadow_ray", "MARGIN"))
    shadows = draws * rays.chosen
    looks = shadows * ((1 - rays.blocked) * counted * rays.shown + rays.blocked * min(2, steps))
    views = ((1 - rays.blocked) * count + rays.blocked) if visibility else 0
    unique = min(emitters * times, drawn)
    read = times * receivers * own * RECORD + unique * (3 * RECORD + NUMBER) + NUMBER * min(times * texels, looks)
    return Work(
        stage,
        read,
        times * receivers * RECORD,
        times * receivers * (own + 1) + drawn * (1 + rays.faced + rays.facing) + beside,
        drawn + looks,
        draws * candidates * CANDIDATE
        + drawn * (rays.faced * FACED + rays.facing * FACING)
        + shadows * views * RAY
        + looks * STEP,
    )


@cache
def define(light, file, name):
    """The number that a shader file defines."""
    text = (light.device.SHADERS / f"{file}.glsl").read_text()
    value = float(re.search(rf"#define {name} (\S+)", text)[1])
    return int(value) if value == int(value) else value


def probes():
    """{(kind, name): (amount, function that runs it and returns seconds)} of what this machine can do."""
    size = 320, 180  # small enough for caches
    found = {("wide", format): ceilings.fetches(format, size) for format in ("RGBA32F", "RGBA32UI")}
    found |= {("narrow", format): ceilings.fetches(format, size) for format in ("R32F", "RG32F")}
    found |= {
        ("bandwidth", f"{format} {across}x{up}"): ceilings.copy(format, (across, up))
        for format in ("R32F", "RGBA32F")
        for across, up in ((1280, 720), (2048, 2048))
    }
    found["operations", "multiply-adds"] = _arithmetic(size)
    return found


def _arithmetic(size):
    """Multiply-adds of vectors that do not wait for one another: (operations, function)."""
    threads = [-(-extent // ceilings.GROUP) * ceilings.GROUP for extent in size]
    names = [f"v{k}" for k in range(ACCUMULATORS)]
    start = " ".join(
        f"vec4 {name} = texelFetch(source, p % ivec2({size[0]}, {size[1]}), 0) + {k}.0;" for k, name in enumerate(names)
    )
    rounds = " ".join(f"{name} = {name} * factor + 0.5;" for name in names)
    run = ceilings.probe(
        "RGBA32F",
        size,
        f"""void main() {{
        ivec2 p = ivec2(gl_GlobalInvocationID.xy);
        {start}
        vec4 factor = v0 * 0.001 + 0.5;
        for (int k = 0; k < {ROUNDS}; k++) {{ {rounds} }}
        if (p.x < {size[0]} && p.y < {size[1]}) {{ imageStore(target, p, {" + ".join(names)}); }}
    }}""",
    )
    return threads[0] * threads[1] * 4 * ACCUMULATORS * ROUNDS, run


def rates(amounts, seconds):
    """{"bandwidth": bytes a second, "wide", "narrow": fetches a second, "operations": a second}, the fastest of each
    kind. amounts, seconds: {(kind, name): ...}."""
    found = {}
    for kind, name in amounts:
        found[kind] = max(found.get(kind, 0.0), amounts[kind, name] / seconds[kind, name])
    return found
