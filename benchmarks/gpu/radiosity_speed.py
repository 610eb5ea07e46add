# SPDX-License-Identifier: GPL-3.0-or-later
"""Radiosity pass by pass: the presets Draft and Production, their floors, and growth. Part of python -m benchmarks.gpu.

A frame is one in the middle of an animation, as the presets have it: its light is averaged with that of the frame
before, whose surfaces it shows. The room is closed, so the world lights nothing; no Glossy Light, no Vector pass."""

import ast
from functools import partial
from statistics import median

from . import opengl, radiosity_rays, radiosity_work, repeats, room

PRESETS = "draft", "production"
SIZE, QUICK_SIZE = (1280, 720), (640, 360)
GROWTH = "draft"  # the preset that growth is measured from, one setting at a time
DRAWS = 4, 8, 16, 32, 64
VIEWS = 1, 2, 4, 7, 9  # further ones
BOUNCES = 1, 2, 3, 4, 8
SIZES = (320, 180), (640, 360), (1280, 720), (1920, 1080), (2560, 1440)
PATIENCE = 14.0  # seconds, as repeats.PATIENCE; frames take seconds in software, and 9 views take longer to trace
STARTS = {"FULL": 1, "HALF": 2, "QUARTER": 4}


def measure(light, quick=False):
    """The part of Radiosity in the numbers of one machine: {"presets": [run and its floor], "growth": {what: [run]}}.
    Seconds; lists hold one number a frame."""
    size = QUICK_SIZE if quick else SIZE
    patience = PATIENCE / 3 if quick else PATIENCE
    room_of = _Rooms(light)
    presets = []
    for name in PRESETS[:1] if quick else PRESETS:
        settings, further = preset(light, name)
        views = room_of.views(size, further)
        presets.append(with_floor(light, views, settings, patience) | {"name": name.capitalize()})
    settings, further = preset(light, GROWTH)
    usual = {"size": size, "draws": settings.groups, "further": further, "bounces": settings.bounces}
    known = {tuple(usual.values()): presets[PRESETS.index(GROWTH)]}

    def case(**changed):
        """A case of repeats.series() that differs from the preset."""
        chosen = usual | changed
        key = tuple(chosen.values())

        def measured():
            if key not in known:
                views = room_of.views(chosen["size"], chosen["further"])
                known[key] = run(light, views, _changed(light, settings, chosen), patience / 2)
            return slim(known[key])

        # Guessed, so that cases that are far too slow are left out; their least part does not depend on draws.
        cost = (1 + chosen["further"]) * (8 + chosen["draws"] + chosen["bounces"]) * (4e5 + size_of(chosen))
        return _words(chosen), cost, measured, key in known

    every = {
        "draws": [case(draws=count) for count in (DRAWS[:3] if quick else DRAWS)],
        "views": [case(further=count) for count in (VIEWS[:3] if quick else VIEWS)],
        "bounces": [case(bounces=count) for count in (BOUNCES[:3] if quick else BOUNCES)],
        "size": [case(size=each) for each in (SIZES[:2] if quick else SIZES)],
    }
    return {"presets": presets, "growth": {name: repeats.series(cases, patience) for name, cases in every.items()}}


def preset(light, name):
    """(RadiositySettings, number of further views) of one of the add-on's presets."""
    text = (opengl.ADDON / "presets" / "afterlight" / f"{name}.py").read_text()
    values = {
        node.targets[0].attr: ast.literal_eval(node.value)
        for node in ast.parse(text).body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
    }
    settings = light.RadiositySettings(
        start=STARTS[values["start"]],
        groups=values["draws"],
        bounces=values["bounces"],
        visibility=values["use_visibility"],
        gathers=values["accumulate"],
        smooth=values["denoise"] == "SMOOTH",
    )
    return settings, values["view_count"]


def run(light, views, settings, patience=repeats.PATIENCE, wall=False, between=lambda: None):
    """Frames of some views and settings: the GPU's seconds by pass and in all, and, where asked for, those on the clock
    for the whole of gather_views() from arrays to an array, in frames of their own without timers."""
    found = {
        "size": views[0].source.size,
        "start": light.view_layout.start_of(settings, views[0].source.size),
        "draws": settings.groups,
        "further": len(views) - 1,
        "bounces": settings.bounces,
    }
    repeats.say(_words(found))
    history = _following(light)
    # One bounce of one draw is history enough, and two compile all passes.
    light.gather_views(views, _changed(light, settings, {"draws": 1, "bounces": 2}), history=history)
    gather = partial(light.gather_views, views, settings, history=history)
    return repeats.frames(light, gather, found, patience, wall, between)


def with_floor(light, views, settings, patience=repeats.PATIENCE):
    """run() on the clock, too; "rates" and "floor": what the machine can do, measured in turn with the frames, and what
    it must do at the least, by pass. "shares": what the counts depend on the scene for."""
    probes = radiosity_work.probes()
    seconds = {key: [] for key in probes}

    def between():
        for key, (_, probe) in probes.items():
            seconds[key].append(probe())

    between()  # compiles
    for measured in seconds.values():
        measured.clear()
    found = run(light, views, settings, patience, wall=True, between=between)
    amounts = {key: amount for key, (amount, _) in probes.items()}
    rates = radiosity_work.rates(amounts, {key: median(measured) for key, measured in seconds.items()})
    shares = radiosity_rays.shares(light, views, settings)
    floor = []
    for work in radiosity_work.work(light, settings, views[0].source.size, len(views), shares):
        least, limit = work.floor(rates)
        floor.append(vars(work) | {"seconds": least, "limit": limit})
    return found | {
        "rates": rates,
        "floor": floor,
        "shares": {"overlaps": shares.overlaps, "base": vars(shares.base), "blocks": vars(shares.blocks)},
    }


def slim(found):
    """A run without its floor, as growth shows it."""
    return {name: value for name, value in found.items() if name not in ("rates", "floor", "shares", "wall", "name")}


def size_of(chosen):
    """Pixels of a view."""
    return chosen["size"][0] * chosen["size"][1]


def _changed(light, settings, chosen):
    values = vars(settings) | {"groups": chosen["draws"], "bounces": chosen["bounces"]}
    return light.RadiositySettings(**values)


def _following(light):
    """A light.History of a frame that follows on others: the first is not gathered nine times for it."""

    class Following(light.History):
        def go_on(self, base, camera, motion, views, light, gathers, more=None):
            return super().go_on(base, camera, motion, views, light, gathers)

    return Following()


class _Rooms:
    """Views of the room, of the size asked for last; each takes a second to trace."""

    def __init__(self, light):
        self.light, self.size, self.made = light, None, []

    def views(self, size, further):
        if size != self.size:
            self.size, self.made = size, [self.light.View(*room.frame(self.light, *size))]
        self.made += [room.view(self.light, *size, number) for number in range(len(self.made) - 1, further)]
        return self.made[: 1 + further]


def _words(chosen):
    """A case, for people who wait."""
    width, height = chosen["size"]
    return (
        f"Radiosity {width}x{height}, further views: {chosen['further']}, draws: {chosen['draws']}, "
        f"bounces: {chosen['bounces']}"
    )
