# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of what ticking costs: its page from made-up numbers, its scenes, one small still and failures."""

import json
import sys
from pathlib import Path

import pytest

import extension

sys.path.append(str(Path(__file__).resolve().parents[2]))

from benchmarks.cost import tick, tick_cases, tick_report

SIZE = 64, 36


def made_up(seconds, gpu, evaluations, peak, **more):
    return {"seconds": seconds, "gpu": gpu, "evaluations": evaluations, "peak": peak} | more


@pytest.fixture
def case():
    """A plain frame of 2 s, of which 1.5 s are the graphics card's; each further sample takes half a second; ticking
    adds 6 s, of which 4 s are the graphics card's, and 2 s where the views are kept."""
    return {
        "series": "objects",
        "case": "1,000",
        "plain": made_up(2.0, 1.5, 1, 400),
        "plain, 9 samples": made_up(6.0, 5.5, 1, 500),
        "anew": made_up(8.0, 5.5, 6, 750, stages={"place views": 1.0, "gather": 3.0}),
        "kept": made_up(4.0, 3.0, 5, 750, stages={"gather": 2.0}),
    }


def test_what_ticking_adds_is_told_in_plain_frames(case):
    anew, kept = tick_report.rows(case)
    assert (anew["added"], anew["in_t1"], anew["host"], anew["rest"]) == pytest.approx((6, 3, 1, 2))
    assert anew["t64"] == pytest.approx(2 + 63 * 0.5) and anew["in_t64"] == pytest.approx(6 / 33.5)
    assert (anew["memory"], anew["ratio"], anew["evaluations"]) == (250, 1.5, (1, 6))
    assert (kept["way"], kept["added"], kept["rest"]) == ("kept", 2, 0)


def test_the_page_has_a_row_a_case_and_names_those_that_failed(case, tmp_path):
    page, failed = tmp_path / "tick.md", {"series": "objects", "case": "2,000", "failed": "out of memory"}
    found = {"command": "a command", "commit": "1a2b3c4", "size": SIZE, "cases": [case, failed]}
    tick_report.numbers_of(page).write_text(json.dumps(found))
    tick_report.main([str(page)])
    lines = page.read_text().splitlines()
    assert "| 1,000 | placed anew | 2.00 | 33.50 | 6.00 | 3.00 | 0.18 | 1.00 | 1 / 6 | 250 | 1.50 |" in lines
    assert "measured at commit 1a2b3c4" in page.read_text().lower()
    assert any(line.startswith("| 2,000 | failed: out of memory |") for line in lines)
    assert (tmp_path / "tick.webp").stat().st_size > 1000


def test_a_case_that_fails_is_named_and_the_others_are_measured(case, tmp_path, monkeypatch, capsys):
    def measure_apart(series, name, options):
        return {"failed": "no memory"} if name == "50" else {key: case[key] for key in case if key not in found}

    found = ("series", "case")
    monkeypatch.setattr(tick, "measure_apart", measure_apart)
    page = tmp_path / "tick.md"
    assert tick.main(["objects", "--page", str(page)]) == 1
    assert "failed: no memory" in capsys.readouterr().err and page.read_text().count("placed anew |") == 6
    with pytest.raises(SystemExit):
        tick.main(["objects", "--case", "3"])
    assert "it has 1, 50, 500, 2,000" in capsys.readouterr().err


def test_an_error_of_blenders_is_told_and_no_traceback(tmp_path, monkeypatch):
    into = tmp_path / "case.json"
    monkeypatch.setattr(tick, "measure", lambda *_: (_ for _ in ()).throw(RuntimeError("The frame was not lit")))
    options = tick.parse(["objects", "--case", "1", "--into", str(into)])
    assert tick.measure_into(options) == 1 and json.loads(into.read_text()) == {"failed": "The frame was not lit"}


@pytest.mark.parametrize("series", ["polygons, as mesh", "polygons, by modifiers", "polygons, by instances"])
@pytest.mark.parametrize("number", [1_000, 30_000])
def test_rooms_have_the_polygons_that_they_are_named_for(fresh, series, number):
    _, polygons = tick_cases.build(series, f"{number:,}", SIZE)
    assert polygons == pytest.approx(number, rel=0.3)


def test_rooms_have_the_objects_textures_lamps_and_views_that_they_are_named_for(fresh):
    import bpy

    tick_cases.build("objects", "50", SIZE)
    assert sum(thing.name.startswith("Block") for thing in bpy.data.objects) == 50
    tick_cases.build("textures", "10", SIZE)
    assert len(bpy.data.images) == 10 and tuple(bpy.data.images[0].size) == (2048, 2048)
    tick_cases.build("lamps", "10", SIZE)
    assert len(bpy.data.lights) == 10 and sum(light.energy for light in bpy.data.lights) == pytest.approx(400)
    scene, _ = tick_cases.build("views", "3", SIZE)
    assert len(scene.afterlight.view_cameras) == 3
    scene, _ = tick_cases.build("animation", "lamp", SIZE)
    moved = [thing.name for thing in scene.objects if thing.animation_data]
    assert moved == ["Lamp"] and scene.frame_end == tick_cases.FRAMES


def test_a_still_is_measured(fresh):
    """A plain frame evaluates the scene once, the lit one again for its views; ticking takes longer and shows it."""
    scene, _ = tick_cases.build("polygons, as mesh", "1,000", SIZE)
    scene.render.compositor_device = "CPU"  # as tests/scenes.py has it
    scene.afterlight.view_count = 1
    found = tick.measure_still(scene, sys.modules[extension.MODULE])
    plain, anew, kept = (found[name] for name in ("plain", "anew", "kept"))
    assert plain["evaluations"] == 1 < kept["evaluations"] <= anew["evaluations"]
    assert plain["seconds"] < anew["seconds"] and 0 < plain["gpu"] < plain["seconds"]
    assert "place views" in anew["stages"] and sum(anew["stages"].values()) < anew["seconds"]
    assert plain["peak"] is None or 0 < plain["peak"] <= anew["peak"]


def test_an_animation_is_measured_and_stays_what_it_is(fresh):
    """Where nothing moves the views are rendered once: the benchmark's own handlers must not look like scripts."""
    scene, _ = tick_cases.build("animation", "nothing", SIZE)
    scene.render.compositor_device = "CPU"
    scene.afterlight.view_count, scene.frame_end = 1, 3
    scene.eevee.taa_render_samples = 1
    package = sys.modules[extension.MODULE]
    tick.animation(scene, package)
    plain = tick.animation(scene, package)
    scene.afterlight.enabled = True
    lit = tick.animation(scene, package)
    assert 0 < plain["gpu"] < plain["seconds"] < lit["seconds"] and plain["evaluations"] == 0
    assert lit["evaluations"] <= 2 and lit["stages"]["EEVEE, views"] < 0.5 * plain["seconds"]
