# SPDX-License-Identifier: GPL-3.0-or-later
"""The speed of Radiosity alone: counts of the floor, what they take from the scene, a small run, and the page."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))

from benchmarks.gpu import gpu_report, radiosity_rays, radiosity_speed, radiosity_work, repeats, room, speed

RAYS = radiosity_rays.Rays(faced=0.5, facing=0.25, chosen=1.0, blocked=0.5, shown=1.5)
PASSES = (
    "depths emit pack radiate row_sums row_starts table sample_blocks sample_base reproject accumulate smooth composite"
).split()
STANDALONE = """
import json, sys
from benchmarks.gpu import opengl, radiosity_speed, room
light = opengl.start()
settings = light.RadiositySettings(start=2, groups=2, candidates=4, bounces=3)
print(json.dumps(radiosity_speed.with_floor(light, room.views(light, 70, 41, 2), settings, 0.1)))
assert "bpy" not in sys.modules
"""


def test_a_run_adds_up():
    """Of a process without Blender: the history never makes it gather a frame again, and each pass has its floor."""
    done = subprocess.run([sys.executable, "-c", STANDALONE], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    run = json.loads(done.stdout)
    assert (run["size"], run["start"], run["further"], run["bounces"]) == ([70, 41], 1, 2, 3)
    assert len(run["gpu"]) == len(run["wall"]) >= repeats.FEWEST
    by_pass = np.array([entry["seconds"] for entry in run["passes"].values()])
    assert np.allclose(by_pass.sum(0), run["gpu"]) and (by_pass > 0).all()
    assert {name: entry["dispatches"] for name, entry in run["passes"].items()} == dict.fromkeys(PASSES, 1) | {
        "depths": 3,
        "emit": 6,
        "radiate": 3,
        "row_sums": 3,
        "row_starts": 3,
        "table": 3,
        "sample_blocks": 2,
        "smooth": 2,
    }
    assert [stage["stage"] for stage in run["floor"]] == PASSES
    assert all(0 < stage["seconds"] < 1 for stage in run["floor"])


def test_a_tiny_frame_counted_by_hand(light):
    """Two views of 8 x 8 pixels, a texel each: 64 of the base, 128 emitters, 2 receivers. Of 4 candidates one is from
    the neighbourhood; of the bounces' 8 it is two. A free shadow ray has 98 % of 24 steps, each in 1.5 views."""
    settings = light.RadiositySettings(start=4, groups=2, candidates=4, bounces=2)
    shares = radiosity_rays.Shares(0.5, RAYS, RAYS)
    counted = {
        work.stage: (work.read, work.written, work.wide, work.narrow, work.operations)
        for work in radiosity_work.work(light, settings, (8, 8), 2, shares)
    }
    entries = light.radiosity.ENTRIES
    looks = 0.5 * 24 * 0.98 * 1.5 + 0.5 * 2  # of a draw
    expected = {
        "depths": (128 * 16, 128 * 8, 128 * 4, 0, 0),
        "emit": (128 * 52, 130 * 64, 128 * 13 / 4, 64, 64 * 28),
        "pack": (64 * 52, 64 * 16, 64 * 13 / 4, 0, 0),
        "radiate": (2 * (128 * 48 + 2 * 16), 2 * 128 * 16, 2 * 128 * 4, 0, 0),
        "row_sums": (2 * 128 * 16, 2 * 128 * 8, 2 * 128, 0, 0),
        "row_starts": (2 * 8, 2 * 16, 0, 2, 0),
        "table": (2 * (128 * 8 + 16), 2 * 4 * entries, 2 * entries, 2 * entries * 8, 2 * entries * (8 + 8)),
        "sample_blocks": (
            2 * 32 + 128 * 52 + 128 * 4,
            2 * 16,
            2 * 3 + 32 * (6 * 1.75 + 2),
            32 * (6 + looks),
            32 * (8 * 17 + 6 * (0.5 * 3 + 0.25 * 20) + 1.5 * 22 + 10 * looks),
        ),
        "sample_base": (
            64 * 16 + 128 * 52 + 128 * 4,
            64 * 16,
            64 * 2 + 128 * (3 * 1.75 + 1),
            128 * (3 + looks),
            128 * (4 * 17 + 3 * (0.5 * 3 + 0.25 * 20) + 1.5 * 22 + 10 * looks),
        ),
        "reproject": (64 * 64, 64 * 16, 256, 0, 0),
        "accumulate": (64 * 48, 64 * 16, 192, 0, 64 * 25 * 42),
        "smooth": (64 * 64, 2 * 64 * 16, 256, 0, 2 * 64 * 24 * 26),
        "composite": (64 * 28 + 64 * 32, 64 * 12, 64 * 7 / 4 + 128, 0, 0),
    }
    assert counted.keys() == expected.keys()
    for name in expected:
        assert counted[name] == pytest.approx(expected[name]), name


def test_one_bounce_has_no_blocks_and_free_sight_no_steps(light):
    settings = light.RadiositySettings(start=4, groups=2, candidates=4, bounces=1, visibility=False, smooth=False)
    found = {w.stage: w for w in radiosity_work.work(light, settings, (8, 8), 2, radiosity_rays.Shares(0, RAYS, RAYS))}
    assert "sample_blocks" not in found and "smooth" not in found
    assert found["sample_base"].narrow == 128 * 3  # the table


@pytest.mark.parametrize(
    "rates, expected",
    [
        ((10, 4, 8, 1e9), (30, "bandwidth")),
        ((1e9, 4, 8, 1e9), (15, "fetches")),
        ((1e9, 1e9, 1e9, 5), (12, "arithmetic")),
    ],
)
def test_the_slowest_rate_sets_the_floor(rates, expected):
    work = radiosity_work.Work("sample_base", 200, 100, 40, 40, 60)
    assert work.floor(dict(zip(("bandwidth", "wide", "narrow", "operations"), rates, strict=True))) == expected


def test_the_fastest_of_a_kind_is_the_rate():
    amounts = {("wide", "a"): 6, ("wide", "b"): 6, ("narrow", "a"): 4}
    seconds = {("wide", "a"): 3, ("wide", "b"): 2, ("narrow", "a"): 1}
    assert radiosity_work.rates(amounts, seconds) == {"wide": 3, "narrow": 4}


def test_the_same_camera_twice_sees_all_of_it(light):
    view = room.views(light, 64, 36, 0)[0]
    shares = radiosity_rays.shares(light, [view, view], light.RadiositySettings(start=2))
    assert shares.overlaps == 1
    assert shares.base.shown == pytest.approx(2)  # a frustum is convex
    assert 0 < shares.base.facing < shares.base.faced < 1 and 0 < shares.base.blocked < 0.5


def test_further_views_show_the_same_room(light):
    """Each point that one shows is the first thing, or behind it, on the way there from the main camera."""
    views = room.views(light, 96, 54, len(room.EYES))
    rng = np.random.default_rng(1)
    for number in range(1, len(views)):
        seen = radiosity_rays.surfaces(views, number, 500, rng)
        ahead = seen.place[2] < -0.1
        first = room.trace(np.zeros((3, 1)), seen.place[:, ahead])[0]
        assert (first < 1 + 1e-4).all()
        assert (seen.own > 0).all() and np.isfinite(seen.own).all()
        np.testing.assert_allclose(np.linalg.norm(seen.normal, axis=0), 1, rtol=1e-5)


def test_settings_are_those_of_the_presets(light):
    draft, few = radiosity_speed.preset(light, "draft")
    production, many = radiosity_speed.preset(light, "production")
    assert (draft.start, draft.groups, draft.bounces, few) == (4, 8, 3, 4)
    assert (production.start, production.groups, production.bounces, many) == (2, 16, 4, 7)
    assert draft.smooth and draft.visibility and draft.gathers == 1


def run(milliseconds, size=(1280, 720), draws=8, further=4, bounces=3):
    """A run whose draws take three quarters of the time."""
    seconds = milliseconds / 1000
    return {
        "size": size,
        "start": 4,
        "draws": draws,
        "further": further,
        "bounces": bounces,
        "gpu": [seconds] * 3,
        "wall": [2 * seconds] * 3,
        "passes": {
            "emit": {"dispatches": 10, "seconds": [0.25 * seconds] * 3},
            "sample_base": {"dispatches": 3, "seconds": [0.75 * seconds] * 3},
        },
    }


def with_floor(name, run):
    """A run with a floor of 10 ms."""
    work = {"read": 5e6, "written": 4e6, "wide": 1e6, "narrow": 2e6, "operations": 3e6}
    return run | {
        "name": name,
        "rates": {"bandwidth": 3e9, "wide": 2e9, "narrow": 4e9, "operations": 5e10},
        "shares": {"overlaps": 3.25, "base": vars(RAYS), "blocks": vars(RAYS)},
        "floor": [
            work | {"stage": "emit", "seconds": 0.003, "limit": "bandwidth"},
            work | {"stage": "sample_base", "seconds": 0.007, "limit": "fetches"},
        ],
    }


@pytest.fixture
def found(machine):
    """Numbers of a machine of Radiosity alone."""
    return {
        "machine": machine,
        "radiosity": {
            "command": "python -m benchmarks.gpu --method radiosity",
            "commit": "0123456",
            "quick": False,
            "presets": [with_floor("Draft", run(28)), with_floor("Production", run(80, (1280, 720), 16, 7, 4))],
            "growth": {
                "draws": [run(20, draws=4), run(28)],
                "views": [run(9, further=1), run(28)],
                "bounces": [run(15, bounces=1), run(28)],
                "size": [run(23, (640, 360)), run(28)],
            },
        },
    }


def test_the_page_holds_every_number(found):
    page = gpu_report.text({"a-gpu": found}, "speed")
    for line in (
        "- Radiosity at Draft takes 28 ms on the GPU, 2.80 times its floor of 10 ms. Radiosity at Production",
        "| Draft | 1280x720 | Quarter | 8 | 3 | 4 |",
        "| Draft | sample_base | 3 | 21 | 21 to 21 | 7 | fetches | 3.00 |",
        "| Production | emit | 10 | 20 | 20 to 20 | 3 | bandwidth | 6.67 |",
        "| Production | 13 | 80 | 80 to 80 | 10 | 8.00 | 160 | 160 to 160 |",
        "| Draft | emit | 5.00 | 4.00 | 1.00 | 2.00 | 3.00 |",
        "| pixel: other views that have it in frame | 3.25 | 3.25 |",
        "| operations (multiply-adds), G/s | 50 | 50 |",
        "1280x720, 4 further views, 3 bounces:",
        "| 4 | 20 | 20 to 20 | 15 |",
        "| 640x360 | 23 | 23 to 23 | 17.2 |",
        "at commit 0123456",
        "(speed/a-gpu-radiosity_growth.webp)",
    ):
        assert line in page, line
    assert "The paper's table" not in page


def test_numbers_of_one_method_make_a_page(found, tmp_path):
    (tmp_path / "speed").mkdir()
    (tmp_path / "speed" / "one.json").write_text(json.dumps(found))
    gpu_report.write(tmp_path / "speed.md")
    page, plots = (tmp_path / "speed.md").read_text(), sorted(tmp_path.glob("speed/*.webp"))
    assert [plot.stem for plot in plots] == ["one-radiosity_growth", "one-radiosity_passes"]
    assert all(5_000 < plot.stat().st_size < 150_000 and f"(speed/{plot.name})" in page for plot in plots)


def test_the_other_method_keeps_its_numbers(found):
    before = {"machine": "old", "paper": "its own", "commit": "of before", "radiosity": "old"}
    kept = speed.keep_others(found, before)
    assert kept == found | {"paper": "its own", "commit": "of before"}


def test_slow_cases_are_left_out():
    def case(cost, seconds, is_known=False):
        return str(cost), cost, lambda: {"gpu": [seconds]}, is_known

    cases = [case(1, 1), case(2, 2), case(4, 4), case(8, 8)]
    assert len(repeats.series(cases, patience=9)) == 2
    cases[2] = case(4, 4, is_known=True)
    assert len(repeats.series(cases, patience=9)) == 3
