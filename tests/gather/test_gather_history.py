# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean over gathers and frames: against float64, how much calmer it is, and that what changes does not trail."""

import numpy as np
import pytest

import gather_fixtures as fixtures
import room_fixtures as rooms
from reference import temporal as history_64

SIZE, START = (48, 36), 2
SOLID = ((-0.2, -0.3, -1.0), (0.3, 0.2, 0.1))
EYE = np.array((-0.8, -0.7, 0.2))


def camera(light, step=0.0, across=None):
    """One that looks into a corner, and moves and turns from step to step."""
    return rooms.camera_at(
        light, EYE + step * np.array((0.05, -0.02, 0.03)), (1, 0.8 + 0.15 * step, -0.3), SIZE, across=across
    )


def base_of(light, view):
    """(Pyramid, reference.Level) of a view."""
    settings = light.RadiositySettings(start=START)
    base = light.pack(light.upload(view.load_passes()), view.load_passes(), view.camera, settings)
    return base, fixtures.level_arrays(base, view.camera, START)[0]


def remembered(light, view, lit):
    """(light.History, reference.Level) of a frame with that light, (h, w, 4)."""
    base, level = base_of(light, view)
    return light.History(base, light.device.texture(*lit.shape[1::-1], data=lit), view.camera), level


def noise(seed, shape=(SIZE[1] // START, SIZE[0] // START)):
    made = np.random.default_rng(seed).random((*shape, 4)).astype(np.float32)
    made[..., 3] = np.ceil(5 * made[..., 3])
    return made


def history_of(light, past, view, base):
    table = light.view_layout.view_table([view], SIZE, light.RadiositySettings(start=START))
    return light.device.read(light.temporal.reproject(past, base, view.camera, view.load_passes().motion, table))


# Against float64


@pytest.mark.parametrize("across", [None, 2.5])
def test_the_history_agrees_with_float64(light, across):
    """Of a corner with a solid before it, seen from a place and in a direction that have changed."""
    before, after = (rooms.view_of(light, camera(light, step, across), SIZE, solids=[SOLID]) for step in (0, 1))
    past, past_level = remembered(light, before, noise(1))
    base, level = base_of(light, after)
    found = history_of(light, past, after, base)
    expected = history_64.reproject(level, after.camera, past_level, before.camera, noise(1), START)
    assert 0.7 < (found[..., 3] > 0).mean() < 0.999, (
        "most has a history, and not the surfaces that were hidden or out of the picture"
    )
    near = np.abs(found - expected).max(-1) < 2e-3
    assert near.mean() > 0.995, "a texel on the edge of two may fall to either"


def test_what_moves_is_looked_up_where_it_was(light):
    """The solid moves, the camera stays. Its motion is in a pass; without it surfaces that moved sideways
    have no history."""
    still = camera(light)
    shift = np.array((0.1, 0.05, 0.0))
    before = rooms.view_of(light, still, SIZE, solids=[tuple(np.array(SOLID) - shift)])
    after = rooms.view_of(light, still, SIZE, solids=[SOLID])
    depth, place, _ = rooms.trace(still, SIZE, solids=[SOLID])
    moved = depth < rooms.trace(still, SIZE)[0] - 1e-6

    def pixel(places):
        seen = (places - still.position) @ still.rotation.T
        return (seen[..., :2] / -seen[..., 2:] - still.offset) / still.scale

    motion = np.where(moved[..., None], pixel(place - shift) - pixel(place), 0).astype(np.float32)
    after.load_passes().motion = tuple(np.ascontiguousarray(motion[::-1, :, axis]) for axis in range(2))
    past, past_level = remembered(light, before, noise(2))
    base, level = base_of(light, after)
    found = history_of(light, past, after, base)
    rows, columns = (np.arange(START // 2, side, START) for side in motion.shape[:2])
    expected = history_64.reproject(
        level, still, past_level, still, noise(2), START, motion[np.ix_(rows, columns)] / START
    )
    assert (np.abs(found - expected).max(-1) < 2e-3).mean() > 0.99
    inside = moved[::START, ::START] & moved[1::START, 1::START] & moved[::START, 1::START] & moved[1::START, ::START]
    assert (found[inside, 3] > 0).mean() > 0.8


@pytest.mark.parametrize("allows_drift", [False, True])
def test_the_mean_agrees_with_float64(light, allows_drift):
    view = rooms.view_of(light, camera(light), SIZE, solids=[SOLID])
    base, level = base_of(light, view)
    history, now = noise(3), noise(4)
    history[..., :3] += np.array((0.0, 0.8, -0.1), np.float32)  # no drift, one that is sure, one that may be
    history[:, :5, 3], history[:3, :, 3] = 0, -1
    texture = [light.device.texture(*history.shape[1::-1], data=each) for each in (history, now)]
    found = light.device.read(light.temporal.accumulate(base, *texture, 2, 3, drift=allows_drift))
    expected = history_64.accumulate(level, history, now[..., :3], 2, 3, allows_drift)
    assert np.abs(found - expected).max() < 2e-3
    assert history_64.kept(level, history, now[..., :3]).min() < 0.5
    sure = history_64.drift(level, history, now[..., :3])
    assert np.abs(sure).mean((0, 1))[1] > 0.2 > 10 * np.abs(sure).mean((0, 1))[0]


# What it is for


def shot(light, step, radiance=rooms.lamp, solids=()):
    """A camera that moves in a closed box, all of which further views see: its light is the same in every frame."""
    main = rooms.view_of(light, camera(light, step), SIZE, radiance=radiance, solids=solids)
    return [main, *rooms.box_views(light, SIZE, radiance=radiance, solids=solids)]


def radiosity(light, seed=0, **changes):
    return light.RadiositySettings(
        **dict(start=START, bounces=1, groups=4, candidates=4, visibility=False, seed=seed) | changes
    )


def lit(history):
    """(h, w, 3) of irradiance, as it goes on into the next frame."""
    return np.array(history.light.read())[..., :3].astype(float)


def gathers(history):
    return np.array(history.light.read())[..., 3]


def run(light, seed, frames, **changes):
    """light.History after so many frames of a sequence, the camera at rest in the last two."""
    past = light.History()
    for frame in range(frames):
        light.gather_views(
            shot(light, min(frame, frames - 2)), radiosity(light, 1000 * seed + 7919 * frame, **changes), history=past
        )
    return past


def test_gathers_of_one_frame_are_averaged(light):
    """The noise of six is a sixth, and the mean the same."""
    views = shot(light, 0)
    ones, sixes = (
        [light.gather_views(views, radiosity(light, 1000 * seed, gathers=count)) for seed in range(12)]
        for count in (1, 6)
    )
    share = np.var(sixes, axis=0).mean() / np.var(ones, axis=0).mean()
    assert share == pytest.approx(1 / 6, rel=0.25)
    assert np.mean(sixes) == pytest.approx(np.mean(ones), rel=0.01)
    assert np.array_equal(
        light.gather_views(views, radiosity(light, gathers=1)), light.gather_views(views, radiosity(light))
    )


def test_noise_falls_eightfold_and_nothing_else_changes(light):
    """A sequence's last frame against single ones, over eight sequences."""
    frames = 7
    held = [run(light, seed, frames, groups=12, candidates=8) for seed in range(8)]
    known = np.min([gathers(each) for each in held], axis=0) >= 5
    assert known.mean() > 0.8
    raw = []
    for seed in range(8):
        past = light.History()
        light.gather_views(
            shot(light, frames - 2),
            radiosity(light, 1000 * seed + 7919 * (frames - 1), groups=12, candidates=8),
            history=past,
        )
        raw.append(lit(past))  # nine gathers
    nine = np.var(raw, axis=0)[known].mean()
    after = np.var([lit(each) for each in held], axis=0)[known].mean()
    assert 0.6 * nine < after < 1.3 * nine, "as calm after seven frames of one gather as with nine of one frame"
    assert np.mean([lit(each)[known] for each in held]) == pytest.approx(
        np.mean([each[known] for each in raw]), rel=0.01
    )


def test_a_frame_without_a_history_makes_up_for_it(light):
    first = light.History()
    light.gather_views(shot(light, 0), radiosity(light), history=first)
    assert (gathers(first) == light.temporal.REBUILT).all()
    light.gather_views(shot(light, 0), radiosity(light, 7919, groups=12, candidates=8), history=first)
    assert (gathers(first) == light.temporal.FRAMES).mean() > 0.99, "noise passes for change hardly ever"
    turned = [
        light.View(view.load_passes(), view.camera) for view in shot(light, 0)[1:]
    ]  # a cut to what was out of the picture
    light.gather_views(turned[1:2] + turned, radiosity(light, 2), history=first)
    assert (gathers(first) == light.temporal.REBUILT).all()


def test_what_comes_into_sight_begins_anew(light):
    """A solid leaves; the wall behind it has a history of one gather alone, and holds nothing of the solid's light."""
    past = light.History()
    for frame in range(3):
        light.gather_views(shot(light, 0, solids=[SOLID]), radiosity(light, frame), history=past)
    hidden = rooms.trace(camera(light), SIZE, solids=[SOLID])[0] < rooms.trace(camera(light), SIZE)[0] - 0.05
    light.gather_views(shot(light, 0), radiosity(light, 9), history=past)
    fresh = gathers(past)[hidden]
    assert hidden.sum() > 100 and (fresh == 1).mean() > 0.85 and (gathers(past) > 1).mean() > 0.6


@pytest.mark.parametrize("factor", [0.2, 3.0])
def test_a_lamp_that_is_switched_arrives(light, factor):
    """95 % of the change of the mean within four frames, at the noise of few groups."""

    def switched(place, normal):
        return factor * rooms.lamp(place, normal)

    past = run(light, 3, 5, groups=8)
    before = lit(past).mean()
    after = np.mean([lit(run_once(light, switched, seed)).mean() for seed in range(3)])
    arrived = []
    for frame in range(4):
        light.gather_views(shot(light, 3, switched), radiosity(light, 50_000 + frame, groups=8), history=past)
        arrived.append((lit(past).mean() - before) / (after - before))
        assert (gathers(past) > 4).mean() > 0.98, "where much changes as much is gathered anew: it is as calm as before"
    assert arrived[0] > 0.95 and max(arrived) < 1.02, arrived


def test_small_things_do_not_hold_old_light(light):
    """Pillars of a few texels, none of which has eight of its own surface around it, in a room whose lamp is switched
    off."""
    small = [((x, y, -1.0), (x + 0.03, y + 0.03, 0.5)) for x, y in ((0.1, -0.2), (0.3, 0.1), (-0.1, 0.2))]
    past = light.History()
    for frame in range(4):
        light.gather_views(shot(light, 0, solids=small), radiosity(light, frame, groups=8), history=past)
    thin = rooms.trace(camera(light), SIZE, solids=small)[0] < rooms.trace(camera(light), SIZE)[0] - 0.05
    before = lit(past)[thin].mean()
    light.gather_views(
        shot(light, 0, lambda place, normal: 0.01 * rooms.lamp(place, normal), small),
        radiosity(light, 9, groups=8),
        history=past,
    )
    assert thin.sum() > 20 and lit(past)[thin].mean() < 0.05 * before


def run_once(light, radiance, seed):
    past = light.History()
    light.gather_views(shot(light, 3, radiance), radiosity(light, 999 + seed, groups=8), history=past)
    return past


def test_what_can_not_be_looked_up_is_left(light):
    """Another resolution or another kind of camera makes a new history, without an error."""
    past = light.History()
    light.gather_views(shot(light, 0), radiosity(light), history=past)
    for size, across in (((40, 30), None), ((40, 30), 2.0)):
        other = rooms.camera_at(light, EYE, (1, 0.8, -0.3), size, across=across)
        light.gather_views([rooms.view_of(light, other, size)], radiosity(light), history=past)
        assert gathers(past).shape == size[::-1] and (gathers(past) == light.temporal.REBUILT).all()
