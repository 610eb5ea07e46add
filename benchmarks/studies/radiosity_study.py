# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurements that decided the light between several views, printed as the tables of docs/method/radiosity.md.

    .venv/bin/python -m benchmarks.studies.radiosity_study [TABLE ...]    a quarter of an hour for all

Rooms of boxes under a point lamp, traced exactly, without Blender (benchmarks/gpu/opengl.py). The truth is a radiosity
solution of the same number of bounces: all pairs of patches of all surfaces, and of these and pixels of the main view,
in float64, with rays cast against the boxes. Error: relative L1 of the indirect light; beside it its energy over the
true one.

The tables of visibility in docs/method/radiosity.md are of commit 6030fea (25 November 2026), those marked "old
rule" of d122ee4 (25 November) or between; those in docs/method/temporal.md of 126c37a (26 November).
"""

import argparse
import re
import tempfile
import time
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

import room_fixtures as rooms
from reference import radiosity as views_64

from ..gpu import opengl

SIZE, EVERY = (320, 240), 5  # pixels of a view; every how many, on both axes, the truth is known
FIELD_OF_VIEW = 1.75  # radians across
BOUNCES = 4
PAIRS = 1 << 20  # at a time


@dataclass(frozen=True)
class Room:
    """room, solids: boxes, (low, high) in metres. eyes: (place, towards) of the cameras, the main one first. patch:
    metres."""

    name: str
    room: tuple
    solids: tuple
    lamp: tuple
    eyes: tuple
    patch: float

    def albedo(self, place, normal):
        return np.clip(0.6 + 0.25 * normal + 0.1 * np.roll(normal, 1, -1), 0.1, 0.85)

    def direct(self, place, normal):
        """Radiance that the lamp's light makes surfaces send, with hard shadows."""
        path = self.lamp - place
        square = (path**2).sum(-1, keepdims=True)
        lit = ~rooms.is_hidden(place.reshape(-1, 3), np.broadcast_to(self.lamp, (place.size // 3, 3)), self.solids)
        cosine = np.maximum((normal * path).sum(-1, keepdims=True), 0) / np.sqrt(square)
        return self.albedo(place, normal) / np.pi * cosine / square * lit.reshape(square.shape)

    def views(self, light):
        cameras = [rooms.camera_at(light, eye, towards, SIZE, fov=FIELD_OF_VIEW) for eye, towards in self.eyes]
        return [
            rooms.view_of(
                light, camera, SIZE, albedo=self.albedo, radiance=self.direct, room=self.room, solids=self.solids
            )
            for camera in cameras
        ]

    def patches(self, side):
        """(places, normals, areas) of all surfaces, cut along the edges of all solids and every `side` metres."""
        found = []
        corners = np.array([self.room, *self.solids])
        cuts = []
        for axis in range(3):
            low, high = np.array(self.room)[:, axis]
            ends = np.concatenate([np.linspace(low, high, 1 + round((high - low) / side)), corners[..., axis].ravel()])
            cuts.append(np.unique(np.clip(ends, low, high).round(6)))
        for number, (low, high) in enumerate(corners):
            for axis in range(3):
                across = [k for k in range(3) if k != axis]
                edges = [cuts[k][(cuts[k] >= low[k] - 1e-6) & (cuts[k] <= high[k] + 1e-6)] for k in across]
                for end, sign in ((low[axis], -1), (high[axis], 1)):
                    middles = np.meshgrid(*[(edge[1:] + edge[:-1]) / 2 for edge in edges], indexing="ij")
                    place = np.empty((middles[0].size, 3))
                    place[:, axis], place[:, across[0]], place[:, across[1]] = (
                        end,
                        middles[0].ravel(),
                        middles[1].ravel(),
                    )
                    normal = np.zeros_like(place)
                    normal[:, axis] = sign if number else -sign
                    found.append((place, normal, np.outer(*[np.diff(edge) for edge in edges]).ravel()))
        place, normal, area = (np.concatenate(part) for part in zip(*found))
        before = place + 1e-5 * normal
        bare = ((before > self.room[0]) & (before < self.room[1])).all(-1)
        for low, high in self.solids:
            bare &= ~((before > low) & (before < high)).all(-1)
        return place[bare], normal[bare], area[bare]

    def gathered(self, place, normal, patches, sent):
        """(n, 3): the irradiance of places from patches that send (patches, 3)."""
        others, facing, area = patches
        total = np.zeros((len(place), 3))
        step = max(1, PAIRS // len(others))
        for first in range(0, len(place), step):
            here = np.s_[first : first + step]
            form = views_64.form_factor(place[here, None], normal[here, None], others, area, area[:, None] * facing)
            lit, source = np.nonzero(form)
            form[lit, source] *= ~rooms.is_hidden(place[here][lit], others[source], self.solids)
            total[here] = np.pi * form @ sent
        return total

    def solution(self, side):
        """(patches, what they send after all bounces but the last)."""
        patches = self.patches(side)
        place, normal, _ = patches
        direct, albedo = self.direct(place, normal), self.albedo(place, normal)
        sent = direct
        for _ in range(BOUNCES - 1):
            sent = direct + albedo / np.pi * self.gathered(place, normal, patches, sent)
        return patches, sent

    def seen(self, light):
        """(place, normal, column, row) of the main view's pixels where the truth is known, bottom row first."""
        view = self.views(light)[0]
        row, column = (k.ravel() for k in np.mgrid[EVERY // 2 : SIZE[1] : EVERY, EVERY // 2 : SIZE[0] : EVERY])
        _, place, normal = rooms.trace(view.camera, SIZE, self.room, self.solids)
        return place[row, column], normal[row, column], column, row

    def truth(self, light, side):
        """(n, 3) of indirect radiance."""
        place, normal, *_ = self.seen(light)
        coarse, sent = self.solution(side)
        fine = self.patches(side / 2)
        return self.albedo(place, normal) / np.pi * self.gathered(place, normal, fine, self.refined(coarse, sent, fine))

    def refined(self, coarse, sent, fine):
        """What finer patches send: their own direct light, and the bounced light of the coarse patch that is
        nearest."""
        place, normal, _ = fine
        direct = self.direct(place, normal)
        bounced = sent - self.direct(*coarse[:2])
        for axis in range(3):
            for sign in (-1, 1):
                mine, theirs = (np.nonzero(patches[1][:, axis] == sign)[0] for patches in (fine, coarse))
                for first in range(0, len(mine), 256):
                    some = mine[first : first + 256]
                    nearest = ((place[some, None] - coarse[0][theirs]) ** 2).sum(-1).argmin(1)
                    direct[some] += bounced[theirs[nearest]]
        return direct

    def coverage(self, light):
        """Share of all power that leaves patches which some view sees."""
        (place, normal, area), sent = self.solution(self.patch)
        views = self.views(light)
        shown = np.zeros(len(place), bool)
        for eye, view in zip(views_64.cameras_of(views, 1), views):
            origin = views[0].camera.position
            inside = views_64.depth_at(eye, views_64.project(eye, place - origin)) > 0
            front = ((view.camera.position - place) * normal).sum(-1) > 0
            shown |= (
                inside
                & front
                & ~rooms.is_hidden(place, np.broadcast_to(view.camera.position, place.shape), self.solids)
            )
        power = sent.sum(-1) * area
        return power[shown].sum() / power.sum()


def box(x, y, z):
    """(low, high) of a solid from its extents on each axis."""
    return tuple(np.array([x, y, z], float).T)


SOLIDS = Room(
    "solids",
    box((-1, 1), (-1, 1), (-1, 1)),
    (box((-0.6, -0.2), (-0.3, 0.2), (-1, 0.1)), box((0.2, 0.7), (0.3, 0.6), (-1, -0.5))),
    (0.3, -0.2, 0.7),
    (
        ((0.1, -0.9, 0.17), (0, 1, -0.1)),
        ((-0.8, 0.7, 0.6), (1, -0.8, -0.7)),
        ((0.8, 0.8, 0.5), (-1, -1, -0.6)),
        ((-0.8, -0.8, -0.6), (1, 0.7, 0.3)),
        ((0.85, -0.7, -0.7), (-0.6, 1, 0.4)),
        ((0, 0.05, 0.9), (0.05, 0.05, -1)),
        ((0.1, 0, -0.8), (0.05, 0.05, 1)),
    ),
    0.1,
)
WALL = Room(
    "thin wall",
    box((-2, 2), (-2, 2), (-2, 2)),
    (box((-0.01, 0.01), (-2, 2), (-2, 0.5)),),
    (-1.2, 0.5, 0.8),
    (
        ((1.8, -0.1, -0.3), (-1, 0, 0)),
        ((-1.8, 0.1, -0.2), (1, 0, 0)),
        ((-0.2, 0.1, 0.1), (-1, 0.1, 0)),
        ((0.2, -0.1, -0.1), (1, -0.1, 0)),
        ((-1, 0.1, 1.8), (0.05, 0.05, -1)),
        ((1, -0.1, 1.8), (-0.05, 0.05, -1)),
        ((-1, 0.1, -1.8), (0.05, 0.05, 1)),
        ((1, -0.1, -1.8), (-0.05, 0.05, 1)),
    ),
    0.2,
)
DOOR = Room(
    "door",
    box((-3, 3), (-1.5, 1.5), (0, 2.4)),
    (
        box((-0.05, 0.05), (-1.5, -1), (0, 2.4)),
        box((-0.05, 0.05), (-0.1, 1.5), (0, 2.4)),
        box((-0.05, 0.05), (-1, -0.1), (2, 2.4)),
        box((1.4, 2), (0.3, 1.2), (0, 0.7)),
    ),
    (-1.6, 0.4, 1.9),
    (
        ((2.7, -1.2, 1.5), (-1, 0.5, -0.2)),
        ((-2.7, 1.2, 1.4), (1, -0.6, -0.1)),
        ((-0.3, 0.9, 1.5), (-1, -0.7, -0.2)),
        ((0.5, 1.2, 1.6), (0.8, -1, -0.4)),
        ((1, -0.5, 0.5), (1, 0.9, 0.2)),
        ((-1.5, -0.6, 0.4), (0.1, 0.2, 1)),
        ((1.2, -0.9, 2.2), (0.3, 0.5, -1)),
        ((-0.9, -0.6, 1.2), (1, 0, -0.1)),
    ),
    0.2,
)
ROOMS = SOLIDS, WALL, DOOR


PILLARS = Room("pillars", rooms.HALL, rooms.PILLARS, (0.0, 0.0, 0.8), rooms.ALONG, 0.2)  # for slope() alone


@dataclass
class Case:
    room: Room
    light: object

    @cached_property
    def views(self):
        return self.room.views(self.light)

    @cached_property
    def truth(self):
        return self.room.truth(self.light, self.room.patch)

    def gather(self, **settings):
        """The picture."""
        return self.light.gather_views(
            self.views, self.light.RadiositySettings(**dict(start=4, bounces=BOUNCES, seed=0) | settings)
        )

    def seconds(self, **settings):
        """On the GPU; of computing with Mesa's software driver, whose timer queries do not see it."""
        start = time.process_time()
        with opengl.timed(self.light) if opengl.queries_cover_compute() else nullcontext({}) as passes:
            self.gather(**settings)
        return sum(map(sum, passes.values())) or time.process_time() - start

    def measure(self, **settings):
        """(error, energy)"""
        picture = self.gather(**settings)
        *_, column, row = self.room.seen(self.light)
        mine = picture[row, column].astype(float)
        return np.abs(mine - self.truth).sum() / self.truth.sum(), mine.sum() / self.truth.sum()


@contextmanager
def changed(light, **constants):
    """With other values of constants of addon/gather/radiosity.py and view_layout.py, or of the shaders."""
    modules = {
        name: module for module in (light.radiosity, light.view_layout) for name in constants if hasattr(module, name)
    }
    was = {name: getattr(module, name) for name, module in modules.items()}
    folder = light.device.SHADERS
    with tempfile.TemporaryDirectory() as other:
        for file in folder.rglob("*.glsl"):
            text = file.read_text()
            for name in constants.keys() - was.keys():
                text = re.sub(rf"(#define {name} )\S+", rf"\g<1>{constants[name]}", text)
            copy = Path(other) / file.relative_to(folder)
            copy.parent.mkdir(exist_ok=True)
            copy.write_text(text)
        try:
            for name in was:
                setattr(modules[name], name, constants[name])
            if constants.keys() - was.keys():
                light.device.SHADERS = Path(other)
                light.device.release()
            yield
        finally:
            for name, value in was.items():
                setattr(modules[name], name, value)
            light.device.SHADERS = folder
            if constants.keys() - was.keys():
                light.device.release()


def rows(cases, title, configurations):
    """A table: a row for each (label, constants, settings)."""
    print(f"\n| {title} | " + " | ".join(f"{case.room.name}: error, energy" for case in cases) + " |")
    print("|---" * (len(cases) + 1) + "|")
    for label, constants, settings in configurations:
        with changed(cases[0].light, **constants):
            measured = [case.measure(**settings) for case in cases]
        print(
            f"| {label} | " + " | ".join(f"{error:.3f}, {energy:.3f}" for error, energy in measured) + " |", flush=True
        )


def costs(cases):
    """Of the last room; each beside runs at the defaults, the least of two."""
    print("\n| cost of | |\n|---|---|")
    for label, constants, settings in [
        ("64 x 16", {}, dict(groups=64)),
        *(
            (f"`{name}` {value}", {name: value}, {})
            for name, value in (
                ("BOUNCE_GROUPS", 4),
                ("BOUNCE_GROUPS", 8),
                ("BOUNCE_GROUPS", 32),
                ("SHADOW_STEPS", 16),
                ("EMITTER", 4),
                ("RECEIVER", 4),
                ("RECEIVER", 16),
            )
        ),
        ("one bounce", {}, dict(bounces=1)),
        ("no visibility", {}, dict(visibility=False)),
        ("start 2", {}, dict(start=2)),
        ("start 1", {}, dict(start=1)),
    ]:
        spent, usual = [], []
        for _ in range(2):
            usual.append(cases[-1].seconds())
            with changed(cases[0].light, **constants):
                cases[-1].gather(**dict(settings, bounces=2, groups=1))  # compiles what was changed
                spent.append(cases[-1].seconds(**settings))
        print(f"| {label} | {min(spent) / min(usual):.2f} |", flush=True)


def seeds(cases):
    """How far the numbers of one seed are from those of another."""
    print("\n| 8 seeds | " + " | ".join(f"{case.room.name}: error, energy" for case in cases) + " |")
    print("|---" * (len(cases) + 1) + "|")
    found = [np.array([case.measure(seed=1000 * seed) for seed in range(8)]) for case in cases]
    print(
        "| mean +- deviation | "
        + " | ".join(
            "{:.3f} +- {:.3f}, {:.3f} +- {:.3f}".format(*np.stack([some.mean(0), some.std(0, ddof=1)], -1).ravel())
            for some in found
        )
        + " |",
        flush=True,
    )


def constant(name, values):
    return lambda cases: rows(cases, f"`{name}`", [(value, {name: value}, {}) for value in values])


def setup(cases):
    print("| | " + " | ".join(case.room.name for case in cases) + " |\n" + "|---" * (len(cases) + 1) + "|")
    lines = {
        "views": lambda case: len(case.views),
        "share of the light that some view sees": lambda case: f"{case.room.coverage(case.light):.1%}",
        "patches of the truth": lambda case: f"{len(case.room.patches(case.room.patch / 2)[0])}",
        "what patches twice as large change in it": lambda case: (
            f"{np.abs(case.room.truth(case.light, 2 * case.room.patch) / case.truth - 1).mean():.3f}"
        ),
    }
    for name, value in lines.items():
        print(f"| {name} | " + " | ".join(str(value(case)) for case in cases) + " |", flush=True)


def causes(cases):
    many = dict(BOUNCE_GROUPS=64, BOUNCE_CANDIDATES=16)
    rows(
        cases,
        "what",
        [
            ("the defaults", {}, {}),
            ("8 draws for one, bounces 4 for one", many, dict(groups=128)),
            ("and at full resolution", many, dict(groups=64, start=1)),
            ("and no visibility", many, dict(groups=64, start=1, visibility=False)),
            ("defaults, no visibility", {}, dict(visibility=False)),
            ("defaults, one bounce of the four", {}, dict(bounces=1)),
            ("defaults, no emitters drawn from nearby", {"NEAR_SHARE": 0}, {}),
        ],
    )


def draws(cases):
    pairs = [(4, 16), (8, 16), (16, 1), (16, 4), (16, 16), (16, 64), (32, 16), (64, 16)]
    rows(cases, "groups x candidates", [(f"{g} x {c}", {}, dict(groups=g, candidates=c)) for g, c in pairs])


def bounce_draws(cases):
    pairs = [(2, 8), (4, 8), (8, 8), (16, 1), (16, 8), (16, 32), (32, 8), (64, 8)]
    rows(
        cases,
        "`BOUNCE_GROUPS` x `BOUNCE_CANDIDATES`",
        [(f"{g} x {c}", dict(BOUNCE_GROUPS=g, BOUNCE_CANDIDATES=c), {}) for g, c in pairs],
    )


def ways(cases):
    """What the depth maps take for blocked and for free, of ways between patches that face each other."""
    print(
        "\n| `SHADOW_STEPS` | `THICKNESS` | `MAX_GAP_LEFT` | "
        + " | ".join(f"{case.room.name}: false blocked, false free" for case in cases)
        + " |\n"
        + "|---" * (len(cases) + 3)
        + "|"
    )
    usual = views_64.THICKNESS, views_64.MAX_GAP_LEFT
    for steps, *values in [
        (8, *usual),
        (16, *usual),
        (24, *usual),
        (32, *usual),
        (24, 0.0, usual[1]),
        (24, 0.1, usual[1]),
        (24, 1.0, usual[1]),
        (24, usual[0], 0.0),
        (24, usual[0], 0.125),
        (24, usual[0], 0.5),
    ]:
        views_64.THICKNESS, views_64.MAX_GAP_LEFT = values
        found = [misjudged(case, steps) for case in cases]
        print(
            f"| {steps} | {values[0]} | {values[1]} | "
            + " | ".join(f"{blocked:.1%}, {free:.1%}" for blocked, free in found)
            + " |",
            flush=True,
        )
    views_64.THICKNESS, views_64.MAX_GAP_LEFT = usual


def slope(cases):
    """As ways(), for the most that the gap to a surface may change over a step."""
    cases, usual = [*cases, Case(PILLARS, cases[0].light)], views_64.MAX_GAP_SLOPE
    print(
        "\n| `MAX_GAP_SLOPE` | "
        + " | ".join(f"{case.room.name}: false blocked, false free" for case in cases)
        + " |\n"
        + "|---" * (len(cases) + 1)
        + "|"
    )
    for views_64.MAX_GAP_SLOPE in (0.5, 1.0, 2.0, 4.0, 8.0, np.inf):
        print(
            f"| {views_64.MAX_GAP_SLOPE} | "
            + " | ".join("{:.1%}, {:.1%}".format(*misjudged(case, 24)) for case in cases)
            + " |",
            flush=True,
        )
    views_64.MAX_GAP_SLOPE = usual


def misjudged(case, steps, count=20_000):
    """(share of the free segments taken for blocked, share of the blocked ones taken for free)"""
    rng = np.random.default_rng(1)
    place, normal, area = case.room.patches(case.room.patch / 4)
    start, end = rng.choice(len(place), (2, count), p=area / area.sum())
    path = place[end] - place[start]
    facing = ((path * normal[start]).sum(-1) > 1e-6) & ((path * normal[end]).sum(-1) < -1e-6)
    start, end = place[start[facing]], place[end[facing]]
    origin = case.views[0].camera.position
    blocked = views_64.is_blocked(
        views_64.cameras_of(case.views, 1), start - origin, end - origin, rng.random(len(start)), steps
    )
    true = rooms.is_hidden(start, end, case.room.solids)
    return blocked[~true].mean(), 1 - blocked[true].mean()


TABLES = {
    "causes": causes,
    "draws": draws,
    "bounce_draws": bounce_draws,
    "steps": constant("SHADOW_STEPS", (8, 16, 24, 32)),
    "by_area": constant("BY_AREA", (0.1, 0.25, 0.5, 0.75, 1.0)),
    "emitter": constant("EMITTER", (1, 2, 4, 8)),
    "receiver": constant("RECEIVER", (4, 8, 16, 32)),
    "smooth": constant("SMOOTH_STEPS", ((), (1,), (1, 2), (1, 2, 4))),
    "depths": constant("DEPTHS_ACROSS", (80, 160, 320)),
    "margin": constant("MARGIN", (0.0, 0.01, 0.02, 0.05)),
    "thickness": constant("THICKNESS", (0.0, 0.01, 0.03, 0.1, 1.0)),
    "continuous": constant("MAX_GAP_LEFT", (0.1, 0.2, 0.3, 0.5)),
    "near": constant("NEAR_SHARE", (0, 2, 4, 8)),
    "tolerance": constant("FREE_TOLERANCE", (1.0, 1.0005, 1.002, 1.01)),
    "steepest": constant("MAX_REACH", (1.0, 1.05, 1.1, 1.3, 2.0)),
    "ways": ways,
    "slope": slope,
    "setup": setup,
    "seeds": seeds,
    "costs": costs,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", choices=[[], *TABLES], default=[])
    wanted = parser.parse_args().tables or TABLES
    light = opengl.start()
    cases = [Case(room, light) for room in ROOMS]
    for name in wanted:
        TABLES[name](cases)


if __name__ == "__main__":
    main()
