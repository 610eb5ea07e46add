# SPDX-License-Identifier: GPL-3.0-or-later
"""The speed of the light alone: the same light without Blender, honest counts, pages that say what was measured."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))

from benchmarks.cost import constant_cost, cost_report
from benchmarks.gpu import ceilings, fetchless, gpu_report, repeats, room, speed

SIZE = 146, 83  # not a multiple of anything
STANDALONE = f"""
import json, sys
import numpy as np
from benchmarks.gpu import fetchless, opengl, room, speed
light = opengl.start()
frame, settings = room.frame(light, *{SIZE}), speed.settings(light, 2, 64)
gathered = light.gather_indirect(*frame, settings)
with fetchless.without_fetches(light):
    made_up = light.gather_indirect(*frame, settings)
np.savez(sys.argv[1], gathered=gathered, made_up=made_up, after=light.gather_indirect(*frame, settings))
print(json.dumps(speed.run(light, *frame, settings, wall=True)))
assert "bpy" not in sys.modules
"""


@pytest.fixture(scope="module")
def standalone(tmp_path_factory):
    """(pictures, run): what a process without Blender gathers and measures."""
    path = tmp_path_factory.mktemp("standalone") / "pictures.npz"
    run = subprocess.run([sys.executable, "-c", STANDALONE, path], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return np.load(path), json.loads(run.stdout)


def test_the_light_is_the_same_without_blender(light, standalone):
    expected = np.asarray(light.gather_indirect(*room.frame(light, *SIZE), speed.settings(light, 2, 64)))
    assert expected.max() > 0.01
    assert np.abs(standalone[0]["gathered"] - expected).max() <= 1e-5 * expected.max()


def test_without_fetches_only_inside_the_block(standalone):
    pictures, _ = standalone
    assert np.array_equal(pictures["after"], pictures["gathered"])
    assert np.abs(pictures["made_up"] - pictures["gathered"]).max() > 0.1 * pictures["gathered"].max()


def test_a_run_adds_up(standalone):
    _, run = standalone
    assert run["size"] == list(SIZE) and run["levels"] == 4  # 73 x 42, 37 x 21, 19 x 11, 10 x 6: a diagonal under 16
    assert len(run["gpu"]) == len(run["wall"]) == repeats.REPEATS
    by_pass = np.array([entry["seconds"] for entry in run["passes"].values()])
    assert np.allclose(by_pass.sum(0), run["gpu"]) and (by_pass > 0).all()


def test_only_the_gather_loses_its_fetches():
    text = "void main()\n{\n  uvec4 a = texelFetch(surfels, p, 0) + texelFetch( surfels , q(1, 2), 0);\n}"
    changed = fetchless.fetchless(text, {"surfels": "uvec4"})
    assert changed.count("texelFetch(") == 1 and changed.count("made_up_surfels(") == 3
    assert changed.count("void main()") == 1


def test_a_tiny_frame_counted_by_hand(light):
    """4 x 4 pixels make 2 x 2 texels and 1; with radius 2 each of the four sees the three others, the one sees none."""
    chosen = light.PaperSettings(start=2, samples=0, radius=2, seed=0, strength=1.0)
    counted = {
        work.stage: (work.read, work.written, work.fetches, work.samples)
        for work in ceilings.work(light.pyramid, 4, 4, chosen)
    }
    assert counted == {
        "pack": (16 * 13 * 4, 4 * 16, 16 * 13 / 4, 0),
        "pyramid": (4 * 16, 1 * 16, 4, 0),
        "gather": (5 * 16, 5 * 16, 5 + 12, 12),
        "upsample": (5 * 32, 4 * 16, 10, 0),
        "composite": (16 * 7 * 4 + 4 * 32, 16 * 3 * 4, 16 * 7 / 4 + 8, 0),
    }


@pytest.mark.parametrize(
    "rates, expected",
    [((10, 2, 1e9), (30, "bandwidth")), ((1e9, 2, 1e9), (20, "fetches")), ((1e9, 1e9, 0.5), (16, "arithmetic"))],
)
def test_the_slowest_rate_sets_the_floor(rates, expected):
    work = ceilings.Work("gather", 200, 100, 40, 8)
    assert work.floor(dict(zip(("bandwidth", "fetches", "arithmetic"), rates, strict=True))) == expected


def run(start, samples, milliseconds, size=(1280, 720), radius=16):
    """A run whose gather takes three quarters of the time."""
    seconds = milliseconds / 1000
    return {
        "size": size,
        "start": start,
        "samples": samples,
        "radius": radius,
        "levels": 6,
        "gpu": [seconds] * 3,
        "wall": [2 * seconds] * 3,
        "passes": {
            "gather": {"dispatches": 2, "seconds": [0.75 * seconds] * 3},
            "rest": {"dispatches": 3, "seconds": [0.25 * seconds] * 3},
        },
    }


@pytest.fixture
def found(machine):
    """Numbers of a machine that takes 2.8 times its floor of 10 ms."""
    return {
        "machine": machine,
        "command": "python -m benchmarks.gpu",
        "commit": "0123456",
        "quick": False,
        "gather_passes": ["gather"],
        "paper": [run(4, 64, 28), run(4, 256, 51), run(2, 256, 123), run(2, 64, 67)],
        "rates": {
            "bandwidth": 3e9,
            "fetches": 2e9,
            "arithmetic": 1.5e9,
            "frame": 0.028,
            "gather": 0.021,
            "copies": {"R32F 8x8": 3e9},
            "fetch_formats": {"RGBA32UI": 2e9},
        },
        "floor": [
            {
                "stage": "pack",
                "read": 5e6,
                "written": 4e6,
                "fetches": 1e6,
                "samples": 0,
                "seconds": 0.003,
                "limit": "bandwidth",
            },
            {
                "stage": "gather",
                "read": 1e6,
                "written": 1e6,
                "fetches": 11e6,
                "samples": 10.5e6,
                "seconds": 0.007,
                "limit": "arithmetic",
            },
        ],
        "growth": {
            "samples": [run(4, 16, 31, radius=32), run(4, 32, 33, radius=32)],
            "radius": [run(4, 64, 36, radius=4), run(4, 64, 37, radius=8)],
            "pixels_light": [run(4, 64, 14, (640, 360)), run(4, 64, 39)],
            "pixels_heavy": [run(2, 256, 41, (640, 360)), run(2, 256, 141)],
        },
    }


def test_a_kept_and_a_missed_aim_show(found):
    assert gpu_report.verdict(found)[1]
    assert "- Kept: a frame at Quarter/64 takes 28 ms" in gpu_report.text({"a": found}, "speed")
    found["floor"][1]["seconds"] = 0.006  # 28 / 9 = 3.1
    assert not gpu_report.verdict(found)[1]
    assert "- MISSED: a frame at Quarter/64 takes 28 ms on the GPU, 3.11 times its floor of 9 ms" in (
        gpu_report.text({"a": found}, "speed")
    )


def test_the_page_holds_every_number(found):
    page = gpu_report.text({"a-gpu": found}, "speed")
    for line in (
        "| Quarter/64 | gather | 2 | 21 | 21 to 21 |",
        "| Half/256 | rest | 3 | 30.8 | 30.8 to 30.8 |",
        "| Quarter/256 | 5 | 51 | 51 to 51 | 102 | 102 to 102 |",
        "| Half/64 | 34.8 | 10.5 | 67 |",
        "| Half/256 | 110.6 | 32.6 | 123 |",
        "| copy R32F 8x8, read and written | 3 GB/s |",
        "| fetches RGBA32UI, neighbours at a common offset | 2 G/s |",
        "| samples by arithmetic alone | 1.5 G/s |",
        "| gather | 1.00 | 1.00 | 11.00 | 10.50 | 7 | arithmetic |",
        "| **all** |  |  |  |  | 10 |  |",
        "The gather takes 0.5 G samples a second, 0.33 of the 1.5 G",
        "| 32 | 33 | 33 to 33 | 35.8 |",
        "| 8, 6 | 37 | 37 to 37 | 40.1 |",
        "| 640x360 | 14 | 14 to 14 | 60.8 |",
        "| 1280x720 | 141 | 141 to 141 | 153 |",
        "A processor (8 cores)",
        "(speed/a-gpu-pixels.webp)",
    ):
        assert line in page


def test_machines_stand_side_by_side(found, tmp_path):
    (tmp_path / "speed").mkdir()
    for name in ("one", "two"):
        found["machine"]["renderer"] = name
        (tmp_path / "speed" / f"{name}.json").write_text(json.dumps(found))
    gpu_report.write(tmp_path / "speed.md")
    page = (tmp_path / "speed.md").read_text()
    assert page.index("## one") < page.index("## two")
    plots = sorted(tmp_path.glob("speed/*.webp"))
    assert len(plots) == 8 and all(5_000 < plot.stat().st_size < 150_000 for plot in plots)
    assert all(f"(speed/{plot.name})" in page for plot in plots)


def test_files_without_numbers_are_named(tmp_path):
    file = tmp_path / "speed" / "empty.json"
    file.parent.mkdir()
    file.write_text("{}")
    for broken in (file, tmp_path / "missing.json"):
        with pytest.raises(SystemExit, match=f"{broken.name} does not hold the numbers"):
            gpu_report.write(tmp_path / "speed.md", [broken])


@pytest.fixture(scope="module")
def rooms(afterlight):
    return constant_cost.rooms(afterlight, (1_000, 300_000), (1, 64), (160, 90))


def test_rooms_differ_in_what_they_should(rooms):
    assert [(made.polygons, made.lights) for made in rooms] == [(882, 1), (882, 64), (299_538, 1), (299_538, 64)]
    first, lights, polygons, _ = (made.passes for made in rooms)
    assert np.mean(np.isclose(first.depth, polygons.depth, rtol=1e-4)) > 0.99
    assert first.depth.max() < 10  # closed: no background, which would cost less
    assert np.allclose(first.depth, lights.depth)
    assert 0.5 < np.mean(first.diffuse_direct) / np.mean(lights.diffuse_direct) < 2
    assert np.percentile(lights.diffuse_direct, 5) > 0.01  # each light reaches everywhere


def test_polygons_and_lights_change_nothing_that_is_done(light, rooms, monkeypatch):
    """The same dispatches with the same parameters, over textures of the same sizes and formats."""
    plain, work = light.device.dispatch, []

    def dispatch(name, textures, groups, **named):
        work.append(
            (
                name,
                groups,
                *((key, np.asarray(value).tobytes()) for key, value in named.items()),
                *((key, image.width, image.height, image.format) for key, image in textures.items()),
            )
        )
        return plain(name, textures, groups, **named)

    monkeypatch.setattr(light.device, "dispatch", dispatch)
    monkeypatch.setattr(light.device, "wait", lambda target: None)
    monkeypatch.setattr(light.device, "band", lambda _: 1 << 24)
    done = []
    for made in rooms:
        light.gather_indirect(made.passes, made.camera, speed.settings(light, 4, 64))
        done.append(work.copy())
        work.clear()
    assert len(done[0]) >= 4 and done[1:] == done[:1] * 3


def test_polygons_and_lights_cost_no_time(light, rooms):
    """Medians of 60 rounds. On two busy cores, with every core taken several times over, they came within 4 % of 1;
    what 300 times the polygons or 64 times the lights would cost is far more than a tenth."""
    constant_cost.measure(light, rooms, speed.settings(light, 4, 64), 60)
    for made in rooms[1:]:
        assert 0.9 < np.median(made.ratios(rooms[0])) < 1.1


def test_a_cost_that_is_not_constant_shows():
    def made(polygons, lights, *seconds):
        return constant_cost.Room(polygons, lights, None, None, 10.0, list(seconds))

    found = [made(900, 1, 1, 2, 3), made(900, 1000, 1.02, 2.05, 4), made(3_000_000, 1, 1.02, 2.08, 3.3)]
    verdicts = constant_cost.verdicts(found)
    assert [kept for _, kept in verdicts] == [True, False]
    assert "Kept: 900 polygons and 1,000 lights take 1.025 of the time of 900 polygons and 1 light" in verdicts[0][0]
    assert verdicts[1][0].startswith("MISSED: 3,000,000 polygons and 1 light take 1.040")


def test_each_benchmark_writes_its_own_part_of_the_page(tmp_path):
    path = tmp_path / "docs" / "bench.md"
    cost = f"{cost_report.CONSTANT_COST}\n\nfirst\n"
    cost_report.write(path, constant_cost=cost)
    assert path.read_text() == cost
    cost_report.write(path, "# Speed\n\nold\n")
    cost_report.write(path, "# Speed\n\nnew\n")
    assert path.read_text() == f"# Speed\n\nnew\n\n{cost}"
    cost_report.write(path, constant_cost=cost.replace("first", "second"))
    assert path.read_text() == f"# Speed\n\nnew\n\n{cost_report.CONSTANT_COST}\n\nsecond\n"
