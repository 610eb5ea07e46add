# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole pictures of moving shots, and Cycles with a denoiser among the ways: what the measures catch, what they let
pass, and one run for real."""

from functools import partial

import numpy as np
import pytest

from benchmarks.accuracy import visible
from benchmarks.motion import motion, motion_pictures, motion_report
from benchmarks.motion import motion_measures as measures

SIZE = 40, 64
FRAMES = 8


def still():
    """The tracks of a wall that stays."""
    away = np.array([0.0, 0, 1])
    wall = measures.Surface(
        np.zeros((*SIZE, 4)), np.full(SIZE, 4.0), np.full((*SIZE, 3), 0.5), np.broadcast_to(away, (*SIZE, 3))
    )
    return [measures.track(wall, wall)] * (FRAMES - 1)


def bent(light):
    """A view transform, of a kind: it clips, and lifts the dark."""
    return np.clip(light, 0, 1) ** (1 / 2.2)


def draw(seed, *size, scale=1.0):
    return np.random.default_rng(seed).normal(scale=scale, size=(*size, FRAMES, *SIZE, 3))


@pytest.fixture
def shot():
    """(light, its two noisy halves, Pictures of them): half as bright on the left, nothing moves."""
    light = np.where(np.arange(SIZE[1]) < 32, 0.15, 0.3)[:, None] * np.ones((FRAMES, *SIZE, 3))
    halves = light + draw(1, 2, scale=0.03)
    return light, halves, motion_pictures.Pictures(bent(halves.mean(0)), bent(halves), bent(halves))


def test_a_still_error_does_not_flicker_on_the_screen_and_noise_does(shot):
    """The reference's own noise is taken off, though the view transform bends it."""
    light, halves, pictures = shot
    pictures.add("dark", bent(0.5 * light))
    pictures.add("grainy", bent(light) + draw(2, scale=0.02))
    assert abs(pictures.flicker("dark", still()).mean()) < 0.05 * pictures.own_flicker(still()).mean()
    assert pictures.flicker("grainy", still()).mean() == pytest.approx(2 * 0.02**2, rel=0.1)


def test_much_noise_of_the_reference_is_taken_off_too():
    """As much noise as light: the displayed mean of the halves is far from the mean of the displayed halves."""
    light = np.full((FRAMES, *SIZE, 3), 0.1)
    halves = light + np.random.default_rng(1).exponential(size=(2, *light.shape)) * 0.2 - 0.2
    pictures = motion_pictures.Pictures(bent(halves.mean(0)), bent(halves), bent(halves))
    pictures.add("true", bent(light))
    assert abs(pictures.flicker("true", still()).mean()) < 0.05 * pictures.own_flicker(still()).mean()


def test_noise_that_a_picture_shares_with_the_reference_is_not_taken_off(shot):
    light, halves, pictures = shot
    pictures.add("reachable", bent(halves.mean(0)), bent(halves))
    assert not pictures.flicker("reachable", still()).any() and pictures.flip("reachable") == 0
    apart = halves + draw(2, scale=0.02)
    pictures.add("other direct light", bent(apart.mean(0)), bent(apart))
    expected = measures.changes(bent(light + draw(2, scale=0.02)) - bent(light), still()).mean()
    assert pictures.flicker("other direct light", still()).mean() == pytest.approx(expected, rel=0.1)


def test_flip_is_the_mean_over_all_frames(shot):
    light, halves, pictures = shot
    early = pictures.truth.copy()
    early[: FRAMES // 2] = bent(0.5 * light)[: FRAMES // 2]
    pictures.add("same", pictures.truth)
    pictures.add("early", early)
    expected = visible.ldr_flip(early[0], pictures.truth[0])
    assert pictures.flip("same") == 0
    assert expected > 0.1 and pictures.flip("early") == pytest.approx(expected / 2, rel=0.05)


def test_flip_of_the_references_noise_is_what_it_does_to_a_true_picture(shot):
    light, halves, pictures = shot
    pictures.add("true", bent(light))
    assert pictures.own_flip() == pytest.approx(pictures.flip("true"), rel=0.05) and pictures.own_flip() > 0.02


def report(shot):
    """A Shot whose whole pictures are the light and as much direct light, with a noise of its own."""
    light, halves, pictures = shot
    return motion_report.Shot("shot", 5, halves, halves + light + draw(3, 2, scale=0.05), still(), pictures)


def test_the_whole_error_of_a_picture_counts_as_its_lights(shot):
    """It is too bright by two fifths of the light, and all of that error is the light's; the noise of the reference's
    whole picture, greater than its light's, is taken off."""
    light = shot[0]
    found = report(shot)
    found.add("whole", None, 2.4 * light + draw(4, scale=0.01), 24)
    found.add("light", 1.4 * light + draw(4, scale=0.01), 2.4 * light, 24)
    assert found.light["whole"].mean() / found.mean == pytest.approx(1.4, abs=0.002)
    assert found.error("whole") == pytest.approx(found.error("light"), rel=0.03)
    for name in ("whole", "light"):
        flicker = measures.flicker(found.errors(name), found.noises[name], found.tracks).mean()
        assert flicker == pytest.approx(2 * 0.01**2, rel=0.25), name
    assert measures.changes(found.noises["whole"], found.tracks).mean() > 2 * 0.03**2


def test_page_has_a_row_a_way_in_both_tables(shot):
    light, halves, pictures = shot
    found = report(shot)
    found.add("EEVEE", 0 * light, light, 4)
    found.add("Cycles", None, 2 * light, 20)
    found.failures["other"] = "no reason"
    for name in found.light:
        pictures.add(name, bent(0.5 * light))
    pictures.add(motion_report.REACHABLE, bent(halves.mean(0)), bent(halves))
    rows = found.rows()
    text = motion_report.page(motion.parse(["pillars"]), [rows, rows])
    for head in (motion_report.LIGHT_HEAD, motion_report.PICTURE_HEAD):
        assert text.count(head) == 1
        listed = text.partition(head + "\n")[2].partition("\n\n")[0].splitlines()
        assert all(row.count("|") == head.splitlines()[1].count("|") for row in listed)
        names = [row.split("|")[2].strip() for row in listed]
        assert names[: len(names) // 2] == names[len(names) // 2 :]  # both shots
        assert {"EEVEE", "Cycles", "other"} <= set(names) and "own noise" in names[-1]
    assert f"| shot | {motion_report.REACHABLE} | 0.0000 | 0.00000 |  |" in text
    assert [row.split("|")[-2].strip() for row in rows[1]] == ["0.5", "2.5", "", "", ""]  # seconds a frame


def test_the_ways_that_are_measured_unless_told():
    ways = motion.parse([]).ways
    assert ways == "eevee tracing-best production production+history cycles-1 cycles-4 cycles-16".split()
    named = motion.ways_of([way for way in ways if way.startswith("cycles")], None)
    assert [way.name for way in named] == [
        f"Cycles, {count}, denoised" for count in ("1 sample", "4 samples", "16 samples")
    ]
    assert all(way.whole and not way.traced for way in named)
    assert motion.parse(["--ways", "tracing,cycles-4,draft"]).ways == ["tracing", "cycles-4", "draft"]
    with pytest.raises(SystemExit):
        motion.parse(["--ways", "cycles-3"])


def test_cycles_with_a_denoiser_in_a_shot(afterlight, tmp_path, monkeypatch):
    """Three frames of a shot in which nothing moves: denoised, other noise in each, and the file as before."""
    monkeypatch.setattr(motion.references, "Truth", partial(motion.references.Truth, folder=tmp_path))
    options = motion.parse(
        "lamp_switched --size 64x36 --samples 1 --frames 5-7 --truth-samples 2 --ways eevee,cycles-1".split()
    )
    denoised = []

    def job(scene, layers=False):
        if scene.render.engine == "CYCLES":
            cycles = scene.cycles
            denoised.append((cycles.samples, cycles.use_denoising, cycles.denoising_input_passes))
            assert cycles.use_animated_seed
        return plain_job(scene, layers)

    plain_job = motion.job
    monkeypatch.setattr(motion, "job", job)
    shot = motion.measure(options.paths[0], options, afterlight)
    assert denoised == [(1, True, "RGB_ALBEDO_NORMAL")] and not shot.failures
    name = "Cycles, 1 sample, denoised"
    assert list(shot.light) == ["EEVEE", name]
    assert list(shot.pictures.shown) == ["EEVEE", name, motion_report.REACHABLE]
    assert not shot.light["EEVEE"].any() and 0.8 < shot.light[name].mean() / shot.mean < 1.2
    whole = shot.light[name] - shot.truth + shot.wholes.mean(0)
    apart = np.abs(np.diff(whole, axis=0)).mean((1, 2, 3)) / whole.mean()
    assert np.all(apart > 0.02)  # with one seed for all frames it would be a still
    step = np.abs(np.diff(whole[0], axis=1)).mean() / np.abs(np.diff(shot.wholes[0, 0], axis=1)).mean()
    assert step < 0.5  # from pixel to pixel, beside twice the samples without a denoiser
    assert 0 < shot.pictures.flip(name) < shot.pictures.flip("EEVEE")
    assert shot.pictures.flip(motion_report.REACHABLE) < shot.pictures.flip(name)
    shot.sheet(tmp_path / "sheet.webp")
    assert (tmp_path / "sheet.webp").stat().st_size > 1000
