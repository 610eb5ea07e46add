# SPDX-License-Identifier: GPL-3.0-or-later
"""The measures of moving shots: what rides on a surface is no flicker, noise has its variance, switches and trails are
counted."""

import numpy as np
import pytest

from benchmarks.motion import motion, motion_pictures, motion_report
from benchmarks.motion import motion_measures as measures

SIZE = 40, 64
RIGHT, DOWN = 3, 2  # pixels a frame


def surface(size=SIZE, right=0, down=0):
    """One wall that goes so far a frame."""
    plane = np.ones(size)
    vector = np.stack([-right * plane, down * plane] * 2, -1)
    return measures.Surface(vector, 4 * plane, 0.5 * np.ones((*size, 3)), np.broadcast_to([0.0, 0, 1], (*size, 3)))


def moving(frames=6):
    """A texture of random numbers and the tracks of a wall that carries it to the right and down."""
    wide = np.random.default_rng(1).normal(size=(SIZE[0] + DOWN * frames, SIZE[1] + RIGHT * frames, 3))
    shot = np.array([wide[DOWN * (frames - t) :, RIGHT * (frames - t) :][: SIZE[0], : SIZE[1]] for t in range(frames)])
    wall = surface(right=RIGHT, down=DOWN)
    return shot, [measures.track(wall, wall)] * (frames - 1)


def test_an_error_that_rides_on_its_surface_is_no_flicker():
    errors, tracks = moving()
    inside = (SIZE[0] - 2 - DOWN) * (SIZE[1] - 2 - RIGHT)
    assert len(tracks[0].now[0]) == inside
    assert np.all(measures.changes(errors, tracks) == 0)
    still = surface()
    assert measures.changes(errors, [measures.track(still, still)] * 5).min() > 1.5  # as it would be without the motion


def test_noise_of_each_frame_counts_twice_and_the_references_own_is_taken_off():
    errors, tracks = moving(40)
    draw = np.random.default_rng(2).normal
    own = draw(scale=0.3, size=errors.shape)
    halves = draw(scale=0.5, size=(2, *errors.shape))
    found = measures.flicker(errors + own - halves.mean(0), (halves[0] - halves[1]) / 2, tracks)
    assert found.mean() == pytest.approx(2 * 0.3**2, rel=0.02)
    stays = np.broadcast_to(halves[:, :1], halves.shape)  # a reference of one seed, of a still picture
    wall = surface()
    still = [measures.track(wall, wall)] * 39
    found = measures.flicker(own - stays.mean(0), (stays[0] - stays[1]) / 2, still)
    assert found.mean() == pytest.approx(2 * 0.3**2, rel=0.02)


def test_what_was_hidden_is_left_out():
    """A nearer board of the same colour goes ten pixels to the left before a still wall."""

    def frame(left):
        found = surface()
        board = slice(left, left + 20)
        found.depth[:, board] = 3.9  # too little between the two to tell them apart by it
        found.vector[:, board] = (10, 0, 10, 0)
        return found

    seen = np.zeros(SIZE, bool)
    seen[measures.track(frame(30), frame(20)).now] = True
    assert not seen[:, 41:49].any()  # from behind the board
    assert seen[5:-5, 22:38].all()  # on the board
    assert seen[5:-5, 2:18].all() and seen[5:-5, 52:-2].all()
    assert not seen[0].any() and not seen[:, -1].any()


def test_edges_are_left_out():
    wall = surface()
    wall.albedo[:, 30:] = 0.8
    seen = np.zeros(SIZE, bool)
    seen[measures.track(wall, wall).now] = True
    assert not seen[:, 29:31].any() and seen[1:-1, 1:29].all() and seen[1:-1, 31:-1].all()


def test_lag():
    def light(*after):
        return np.array([2.0, 2.0, 2.0, *after])

    assert measures.lag(light(1, 1, 1, 1), 3) == 0
    assert measures.lag(light(1.5, 1.06, 1.04, 1, 1, 1), 3) == 2
    assert measures.lag(light(1.04, 1.2, 1, 1, 1, 1), 3) == 2  # there for good
    slow = light(*(1 + 0.9 ** np.arange(1, 13)))
    assert measures.lag(slow, 3) < 12
    assert measures.lag(slow, 3, settled=1.0) is None  # what is not there yet is no end
    assert measures.lag(light(*(1 + 0.5 ** np.arange(1, 13))), 3, settled=1.0) == 4


def test_a_switch_is_found_and_what_it_lights():
    truth = np.ones((8, *SIZE, 3))
    truth[:5, :, :32] = 4
    assert measures.switch(truth) == 5
    assert np.array_equal(measures.switched(truth, 5), np.arange(SIZE[1]) < np.full((SIZE[0], 1), 32))
    assert measures.switch(np.linspace(1, 2, 8)[:, None, None, None] * truth[:1]) is None


def test_trails_are_where_history_is_worse():
    without = np.full((3, *SIZE, 3), 0.1)
    with_history = without * 0.5
    with_history[2, 8:16, 24:32] = -0.6
    assert measures.trails(with_history, without) == (pytest.approx(0.5), 2, 8, 24)


def test_rows():
    """A lamp goes out at frame 7 of 5 to 12. History arrives late at what is shown without, and leaves a trail of
    it."""
    draw = np.random.default_rng(3).normal
    truth = np.where(np.arange(8) < 2, 4.0, 1.0)[:, None, None, None] * np.ones((8, *SIZE, 3))
    halves = truth + draw(scale=0.2, size=(2, *truth.shape))
    wall = surface()
    pictures = motion_pictures.Pictures(halves.mean(0) / 8, halves / 8, halves / 8)
    shot = motion_report.Shot("shot", 5, halves, halves, [measures.track(wall, wall)] * 7, pictures)
    shown = 0.9 * truth + draw(scale=0.1, size=truth.shape)
    late = 0.9 * truth
    late[2] += 0.7
    shot.add("EEVEE", np.zeros_like(truth), truth, 8)
    shot.add("without", shown, truth, 16)
    shot.add("with", late, truth, 24, "without")
    shot.failures["other"] = "no reason"
    rows = {
        cells[1]: cells[2:]
        for cells in ([cell.strip() for cell in row.strip("|").split("|")] for row in shot.rows()[0])
    }
    mean = 1.75
    assert (
        rows["EEVEE"][:2] == ["0.000", "1.000"] and abs(float(rows["EEVEE"][3].split()[0])) < 0.001
    )  # a switch is no flicker
    energy, error, flicker, variance, lag, trails = rows["without"]
    assert (energy, lag, trails) == ("0.900", "0", "–")
    variance, spread = (float(part) for part in variance.split(" ± "))
    assert 0 < spread < 0.05 * variance
    assert variance == pytest.approx(0.02 / mean**2, rel=0.1) and float(flicker) == pytest.approx(
        variance**0.5, rel=0.01
    )
    energy, error, flicker, variance, lag, trails = rows["with"]
    assert float(error) == pytest.approx((2 * 0.4 + 0.6 + 5 * 0.1) / 8 / mean, rel=0.05) and lag == "1"
    assert "(frame 7, " in trails and float(trails.split()[0]) == pytest.approx(0.5 / mean, rel=0.15)
    assert rows["other"][0] == "failed: no reason"
    assert float(rows["*Cycles' own noise, taken off above*"][3]) == pytest.approx(0.04 / mean**2, rel=0.05)


@pytest.fixture
def options(tmp_path):
    return motion.parse(["pillars", "--size", "64x36", "--samples", "1", "--frames", "5-6"])


def test_a_shot_is_rendered_in_one_job_and_its_tracks_are_true(afterlight, options):
    """Along the tracks of a camera that goes past pillars lie the same places of the world."""
    scene = motion.opened(options.paths[0], options, afterlight)
    scene.view_layers[0].use_pass_vector = scene.view_layers[0].use_pass_position = True
    _, frames = motion.job(scene, layers=True)
    assert len(frames) == 2
    before, after = frames
    track = measures.track(*map(motion.surface, frames))
    apart = np.linalg.norm(after["Position"][track.now] - before["Position"][track.then], axis=-1)
    pixel = after["Depth"][track.now][..., 0] * 36 / 20 / 64  # the lens of 20 mm on 36
    assert len(apart) > 400 and np.percentile(apart / pixel, 90) < 2
    unmoved = np.linalg.norm(after["Position"] - before["Position"], axis=-1)[track.now]
    assert np.median(unmoved) > 2 * np.median(apart)


def test_history_that_is_not_there_is_said(afterlight, options):
    scene = motion.opened(options.paths[0], options, afterlight)
    way = motion.lit(afterlight, "draft+history")
    if hasattr(scene.afterlight, "use_history"):
        with way.mode(scene):
            assert scene.afterlight.use_history and scene.afterlight.use_animated_seed
    else:
        with pytest.raises(motion.candidates.Unmeasurable, match="use_history"):
            with way.mode(scene):
                pass
