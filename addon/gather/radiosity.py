# SPDX-License-Identifier: GPL-3.0-or-later
"""The light between the surfaces of several views, in as many bounces as are asked for, from top to bottom.

    depth maps of all views                  what each camera sees of any place
    emitters, receivers                      blocks of every view's pixels, in world space
    for each bounce but the last:            every view's receivers gather, and its emitters pass it on
    the last one:                            the main view's base gathers; smooth, composite, read back

A surface that several views show counts once, and what stands between two surfaces hides them from each other. The
sizes below are for frames of any resolution: the cost of views and bounces is the same for all.
docs/method/radiosity.md has what decided them.
"""

from dataclasses import replace

import numpy as np

from . import device, glossy
from .paper import Cancelled, composite, pack, stopwatch, upload
from .temporal import STRIDE, History, accumulate
from .types import Draws, Gloss, View

DEPTHS_ACROSS = 320  # least texels along a depth map's longer side, and emitters along the main view's
EMITTER, RECEIVER = 1, 8  # texels of the depth map along the side of another view's emitters, of any view's receivers
STEPS = 24  # of the way to an emitter at which it is asked whether something stands there
ENTRIES = 1 << 18  # of the table that emitters are drawn from
BY_AREA = 0.5  # share of the draws that goes by area, the rest by power: where the light is dim, near it counts
BOUNCE_GROUPS, BOUNCE_CANDIDATES = 16, 8  # of receivers whose light is passed on: many of them share its noise
SMOOTH_STEPS = 1, 2  # texels between the taps of each pass that smooths
UNSMOOTHED = (0,)  # all taps are the texel itself
KINDS = "emitters", "receivers"


def gather_views(
    views: list[View],
    settings: Draws,
    world: np.ndarray | None = None,
    *,
    history: History | None = None,
    progress=lambda stage, fraction: False,
    timings: dict[str, float] | None = None,
    broken: dict[str, int] | None = None,
    gloss: Gloss | None = None,
) -> np.ndarray:
    """The indirect light of the first view from the surfaces of all, after settings.bounces.

    views: at most device.MOST_VIEWS, all of one resolution. world: (4, 3), by how much EEVEE's world lights a white
    surface with normal n, world[0] + n @ world[1:], W sr^-1 m^-2; what surfaces cover of it is taken away, which needs
    settings.visibility. history: what the frame before left, averaged with this one, which is left there in its place;
    an empty one where there is none before. gloss: of the first view; its picture is filled in, the mean of
    settings.gathers. Returns (H, W, 3) float32, bottom row first: the indirect radiance to add to the picture, W sr^-1
    m^-2, below 0 where the world's light goes; 0 on background. progress, timings, broken, GpuUnavailable, Cancelled:
    as gather_indirect() has them; broken speaks of the first view.
    """
    lap = stopwatch(timings)

    def report(stage, fraction):
        if progress(stage, fraction):
            raise Cancelled

    main, size = views[0].camera, views[0].passes.size
    table = view_table(views, size, settings, world)
    settings = replace(settings, start=start_of(settings, size))
    depths, emitters, receivers, channels = look(views, table, report, broken)
    lap("views", receivers)
    base = pack(channels, views[0].passes, main, settings)
    for name in device.LIGHT_CHANNELS:
        del channels[name]

    shown = []

    def gathers(light, first, last):
        """The mean of `light`, that of the first gathers, and of more."""
        for number in range(first, last):
            each = replace(settings, seed=settings.seed + STRIDE * number)
            gathered, sent, irradiance = gather(
                each,
                table,
                base,
                depths,
                emitters,
                receivers,
                lap,
                lambda stage, fraction: report(stage, (number + fraction) / last),
            )
            light = accumulate(base, light, gathered, 1, number, drift=False) if number else gathered
            if gloss is not None and number < settings.gathers:
                textures = {
                    "emitters": emitters,
                    "radiance": shining(views, table, depths, irradiance, sent),
                    "depths": depths,
                }
                shown.append(glossy.gather(gloss, channels, base, table, each, report, textures))
                lap("glossy")
                del textures
            del gathered, sent, irradiance
        return light

    light = gathers(None, 0, settings.gathers)
    if history:
        light = history.go_on(base, main, views[0].passes.motion, table, light, settings.gathers, gathers)
    if gloss is not None:
        gloss.picture = sum(shown) / len(shown)

    report("upsample", 1.0)
    indirect = composite(channels, base, smooth(base, light, table, SMOOTH_STEPS if settings.smooth else UNSMOOTHED))
    lap("upsample", indirect)
    width, height = size
    picture = device.read(indirect).reshape(height, -1, 3)[:, :width]
    lap("read_back")
    return picture


def gather(settings, table, base, depths, emitters, receivers, lap, report):
    """(what the main view's base receives after all bounces, W m^-2: a texture of its size; what emitters send by
    then; what receivers had gathered for that)."""
    irradiance = device.texture(device.RECORDS_WIDTH, rows_of(table["receivers"]))
    irradiance.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 0.0))
    sent = radiate(emitters, irradiance, table)
    for bounce in range(1, settings.bounces):
        report("bounces", (bounce - 1) / settings.bounces)
        draws = draw_table(sent, table, settings.seed + bounce)
        table["draws"][:2] = BOUNCE_GROUPS, BOUNCE_CANDIDATES
        draw(
            "draw_blocks",
            settings.seed + bounce,
            table,
            irradiance,
            {"receivers": receivers, "emitters": emitters, "radiance": sent, "table": draws, "depths": depths},
        )
        sent = radiate(emitters, irradiance, table)
    lap("bounces", sent)

    draws = draw_table(sent, table, settings.seed)
    table["draws"][:2] = settings.groups, settings.candidates
    *_, across, up = base.boxes[0]
    gathered = device.texture(across, up)
    draw(
        "draw_base",
        settings.seed,
        table,
        gathered,
        {"surfels": base.surfels, "emitters": emitters, "radiance": sent, "table": draws, "depths": depths},
        base.parameters,
        lambda done: report("gather", done),
    )
    lap("gather", gathered)
    return gathered, sent, irradiance


def smooth(base, light, table, steps=SMOOTH_STEPS):
    """The base's irradiance with less noise: a texture of its size."""
    *_, across, up = base.boxes[0]
    block = base.parameters.copy()
    for step in steps:
        block["span"][:2] = step, step == steps[-1]
        total = device.texture(across, up)
        device.dispatch(
            "smooth",
            block,
            {"surfels": base.surfels, "irradiance": light, "total_out": total},
            device.groups(across, up),
            table,
        )
        light = total
    return light


def look(views, table, report=lambda stage, fraction: None, broken=None):
    """(depth maps, emitters, receivers, channels of the main view) of all views. One view's passes are held at a
    time."""
    depths = device.texture(*table["depths"][:2] * (1, len(views)), "RG32F")
    for index, view in enumerate(views):
        report("views", index / len(views) / 2)
        shown = view.passes
        channels = upload(shown, light=False)
        device.dispatch(
            "depths",
            camera_block(view, index, shown.size),
            channels | {"depths_out": depths},
            device.groups(*table["depths"][:2]),
            own_table(view, table),
        )
        del shown  # the next one is loaded before its name is given on
    targets = {kind: device.texture(4 * device.RECORDS_WIDTH, rows_of(table[kind])) for kind in KINDS}
    for index in reversed(range(len(views))):  # the main one last: its channels are needed again
        report("views", 1 - (index + 1) / len(views) / 2)
        channels, shown = None, views[index].passes  # none of two views at a time
        channels = upload(shown, None if index else broken)
        name = "emit_with_normals" if shown.lacks_normals() else "emit"
        for kind, target in targets.items():
            block = camera_block(views[index], index, shown.size)
            block["span"][1] = kind == "receivers"
            device.dispatch(
                name,
                block,
                channels | {"depths": depths, "records_out": target},
                device.groups(*table[kind][index][1:3]),
                own_table(views[index], table),
            )
    return depths, *targets.values(), channels


def shining(views, table, depths, irradiance, sent):
    """As radiate() gives `sent`, with what the gloss of emitters sends, as if it went into all directions alike:
    Glossy Color times what lamps and world make of it in their view, and the light that their receivers have
    gathered."""
    target, size = device.texture(4 * device.RECORDS_WIDTH, rows_of(table["emitters"])), views[0].passes.size
    target.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 0.0))
    for index, view in enumerate(views):
        shown = view.shine()
        if shown is not None:
            device.dispatch(
                "emit_with_normals" if shown.lacks_normals() else "emit",
                camera_block(view, index, size),
                upload(shown) | {"depths": depths, "records_out": target},
                device.groups(*table["emitters"][index][1:3]),
                table,
            )
    more = device.read(radiate(target, irradiance, table)).copy()
    more[..., 3] = 0  # the area, which both have
    return device.texture(sent.width, sent.height, data=device.read(sent) + more)


def start_of(settings, size):
    """Pixels along a base texel: those asked for, but no coarser than the depth maps. Small pictures cost little
    enough."""
    return max(start for start in (1, 2, 4) if start <= min(settings.start, step_of(size)))


def step_of(size):
    """Pixels along a texel of a depth map."""
    return max(1, max(size) // DEPTHS_ACROSS)


def view_table(
    views: list[View], size: tuple[int, int], settings: Draws, world: np.ndarray | None = None
) -> np.ndarray:
    """A Views block: cameras, and which records are whose. size: (width, height) of the views in pixels. world: as
    gather_views() has it."""
    table, origin = layout(len(views), size), np.asarray(views[0].camera.position, float)
    if world is not None and settings.visibility:
        table["world"][:, :3] = world
    table["draws"][2:] = ENTRIES, STEPS if settings.visibility else 0
    for index, view in enumerate(views):
        camera = view.camera
        eye = np.asarray(camera.position, float) - origin
        table["rotation"][index] = np.concatenate([camera.rotation, -(camera.rotation @ eye)[:, None]], axis=1)
        table["projection"][index] = *(np.asarray(camera.scale) * (1 if view.coarse else step_of(size))), *camera.offset
        table["eye"][index] = *eye, camera.orthographic
    return table


def own_table(view: View, table: np.ndarray) -> np.ndarray:
    """The Views block for passes that read the picture of this view, whose pixels it counts in."""
    if not view.coarse:
        return table
    own = table.copy()
    for sides in (own["depths"][2:3], *(own[kind][:, 3] for kind in KINDS)):
        sides //= table["depths"][2]
    return own


def layout(count: int, size: tuple[int, int]) -> np.ndarray:
    """A Views block of so many views, with the sizes in it: depth maps, and which records are whose."""
    width, height = size
    step, table, first = step_of(size), np.zeros((), device.VIEWS), dict.fromkeys(KINDS, 0)
    table["depths"] = -(-width // step), -(-height // step), step, count
    for index in range(count):
        for name, side in zip(KINDS, (step * (EMITTER if index else 1), step * RECEIVER)):
            across, up = -(-width // side), -(-height // side)
            table[name][index] = first[name], across, up, side
            first[name] += across * up
    return table


def camera_block(view: View, index: int, size: tuple[int, int]) -> np.ndarray:
    """A Parameters block with the camera of one view, for passes that read its channels."""
    camera = view.camera
    return device.parameters(
        rotation=camera.rotation,
        projection=(*camera.scale, *camera.offset),
        span=(index,),
        frame=(*size, 1, int(camera.orthographic)),
    )


def radiate(emitters, irradiance, table):
    """(rows, RECORDS_WIDTH) texture: radiance and area of every emitter, given what the receivers have gathered."""
    sent = device.texture(device.RECORDS_WIDTH, rows_of(table["emitters"]))
    device.dispatch(
        "radiate",
        device.parameters(),
        {"emitters": emitters, "irradiance": irradiance, "radiance_out": sent},
        device.groups(sent.width, sent.height),
        table,
    )
    return sent


def draw_table(sent, table, seed):
    """The table that emitters are drawn from, each as often as its share of all power and of all area; table["odds"]
    gets the factors that give those shares."""
    light = device.read(sent).reshape(-1, 4)[: count_of(table["emitters"])].astype(np.float64)
    area, world = light[:, 3], np.abs(table["world"][0]).sum()
    power = np.abs(light[:, :3]).sum(-1) + world
    whole, bright = area.sum(), (power * area).sum()
    by_area = BY_AREA if bright > 0 else 1.0
    table["odds"][:3] = (1 - by_area) / bright if bright > 0 else 0.0, by_area / whole if whole > 0 else 0.0, world
    chances = np.cumsum((table["odds"][0] * power + table["odds"][1]) * area)
    at = (np.arange(ENTRIES) + np.random.default_rng(seed & 0xFFFFFFFF).random(ENTRIES)) / ENTRIES * chances[-1]
    numbers = np.minimum(np.searchsorted(chances, at), len(chances) - 1).astype(np.float32)
    return device.texture(device.DRAWS_WIDTH, ENTRIES // device.DRAWS_WIDTH, "R32F", numbers)


def draw(name, seed, table, target, textures, block=None, after_band=lambda done: None):
    """Gather into `target` by one of the passes "draw_...", some work groups at a time: whole rows of them, or a part
    of one where a row alone would take too long."""
    block = device.parameters() if block is None else block.copy()
    block["band"][1] = device.as_int32(seed)
    across, up = device.groups(target.width, target.height)
    each = int(np.prod(device.SQUARE) * np.prod(table["draws"][:2]))  # candidates of a work group
    done = 0
    while done < across * up:
        row, column = divmod(done, across)
        fitting = max(1, int(device.band(name)) // each)
        wide, high = min(fitting, across - column), 1
        if wide == across:
            high = min(fitting // across, up - row)
        block["band"][[0, 2]] = row * device.SQUARE[1], column * device.SQUARE[0]
        device.run_band(name, wide * high * each, block, textures | {"irradiance_out": target}, (wide, high), table)
        done += wide * high
        after_band(done / (across * up))


def gpu_bytes(width: int, height: int, settings: Draws, further: int, shines: bool, averages: bool) -> int:
    """As memory.gpu_bytes()."""
    table = layout(1 + further, (width, height))
    depths = 8 * int(table["depths"][0] * table["depths"][1]) * (1 + further)
    emitters, receivers = (device.RECORDS_WIDTH * rows_of(table[kind]) for kind in KINDS)
    start = start_of(settings, (width, height))
    base = -(-width // start) * -(-height // start)
    channel = -(-width // 4) * height * 16
    past = 2 * 16 * base if averages else 0  # surfels and light of the frame before
    rebuilt = 3 * 16 * base if averages else 0  # what is known of it, the first gathers, and the mean of all
    known = 16 * base if averages else 0
    mean = 16 * base if settings.gathers > 1 else 0
    records = depths + 64 * (emitters + receivers)
    packed = records + 16 * base + 7 * channel
    gathering = packed + past + mean + 16 * (receivers + emitters)
    most = packed + past + max(mean, rebuilt) + 16 * (receivers + emitters)
    steps = [
        packed + 6 * channel + past,
        most + max(4 * ENTRIES + 16 * max(emitters, base), 8 * ENTRIES),  # bounces, then the base
        packed + known + 16 * 3 * base,  # smoothed twice
        packed + known + 16 * 2 * base + 3 * channel,
    ]  # composited
    if mean or rebuilt:
        steps.append(most + 16 * 2 * base)
    if shines:
        gathered = gathering + 16 * base
        steps += [
            gathered + 64 * emitters + max(13 * channel, 16 * emitters),
            gathered + 16 * emitters + glossy.gpu_bytes(base, channel),
        ]
    return max(steps)


def count_of(grids):
    """Records of all views."""
    first, across, up, _ = grids[np.argmax(grids[:, 0])]
    return int(first + across * up)


def rows_of(grids):
    """Rows of RECORDS_WIDTH that they fill."""
    return -(-count_of(grids) // device.RECORDS_WIDTH)
