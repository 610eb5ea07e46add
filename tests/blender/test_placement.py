# SPDX-License-Identifier: GPL-3.0-or-later
"""Placing views in rooms made of boxes: how much of the light they see, and where they stand. Nothing is rendered."""

import numpy as np
import pytest


@pytest.fixture
def placement(afterlight):
    return afterlight.addon.views.placement


def room(*boxes):
    """A cast() for the inside of the first box, (low, high), and the outside of the others."""
    boxes = [np.array(box, float) for box in boxes]

    def cast(origins, directions, limits, nearest=True):
        best, normal = np.full(len(origins), np.inf), np.zeros((len(origins), 3))
        for index, (low, high) in enumerate(boxes):
            with np.errstate(divide="ignore", invalid="ignore"):
                sides = np.stack([(low - origins) / directions, (high - origins) / directions])
            enter, leave = np.fmin(*sides), np.fmax(*sides)
            if index:
                axis, far = enter.argmax(1), enter.max(1)
                hit = (far <= leave.min(1)) & (far > 0)
            else:
                axis, far = leave.argmin(1), leave.min(1)
                hit = far > 0
            hit &= (far <= limits) & (far < best)
            best[hit] = far[hit]
            normal[hit] = np.eye(3)[axis[hit]]
        return best, normal, np.zeros(len(origins), int)

    return cast


def floor(low, high, count=1000):
    """Pixels of an image that shows the middle of a room's floor: (positions, normals, albedo)."""
    across = np.linspace(0.4, 0.6, int(count**0.5))
    x, y = np.meshgrid(*[low[axis] + across * (high[axis] - low[axis]) for axis in (0, 1)])
    positions = np.stack([x.ravel(), y.ravel(), np.full(x.size, low[2])], -1)
    up = np.tile((0.0, 0, 1), (len(positions), 1))
    return positions + 1e-4 * (high[2] - low[2]) * up, up, np.full(len(positions), 0.8)


def evenly(positions, _normals, _things):
    return np.ones(len(positions)), np.full(len(positions), 0.5), np.zeros(len(positions))


@pytest.mark.parametrize("scale", [1e-3, 1, 1e4])
def test_views_see_nearly_all_that_lights_the_picture_at_any_scale(placement, scale):
    low, high = np.array((-2, -3, 0)) * scale, np.array((2, 3, 2.5)) * scale
    pillar = np.array((0.9, -3, 0)) * scale, np.array((1.2, 2, 2.5)) * scale  # a corner behind it
    cast, rng = room((low, high), pillar), np.random.default_rng(0)
    paths = placement.trace(*floor(low, high), cast, evenly, rng)
    assert abs(paths.weights.sum() - 1) < 1e-9
    unseen = np.zeros(len(paths.positions), bool)
    half = np.tan(np.radians(50)) * np.array((1, 9 / 16))
    poses = placement.place(paths, unseen, cast, half, 7, rng)
    coverage = placement.coverage(paths, unseen, cast, half, poses)
    assert coverage[0] == 0 and coverage[-1] > 0.97 and 2 <= len(poses) <= 7
    clearance = placement.VIEW_CLEARANCE * paths.size
    for pose in poses:
        assert np.allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3)) and np.linalg.det(pose[:3, :3]) > 0
        assert np.all(pose[:3, 3] - low > clearance) and np.all(high - pose[:3, 3] > clearance)
    again = np.random.default_rng(0)
    same = placement.place(placement.trace(*floor(low, high), cast, evenly, again), unseen, cast, half, 7, again)
    assert np.array_equal(same, poses)


def test_views_taken_back_and_set_anew_see_more(placement, monkeypatch):
    """The views chosen first see most by themselves; beside the later ones others may see more."""
    low, high = np.array((-2.0, -3, 0)), np.array((2.0, 3, 2.5))
    pillar = np.array((0.9, -3, 0)), np.array((1.2, 2, 2.5))
    cast, half = room((low, high), pillar), np.tan(np.radians(30)) * np.array((1, 9 / 16))
    paths = placement.trace(*floor(low, high), cast, evenly, np.random.default_rng(0))
    unseen, gains = np.zeros(len(paths.positions), bool), []
    for seed in range(4):
        shares = []
        for rounds in (0, 3):
            monkeypatch.setattr(placement, "MAX_EXCHANGE_ROUNDS", rounds)
            poses = placement.place(paths, unseen, cast, half, 4, np.random.default_rng(seed))
            seen = [
                placement.in_frame(pose, half, paths, placement.visible(pose[:3, 3], paths, cast)) for pose in poses
            ]
            shares.append(paths.weights @ np.any(seen, 0))
        gains.append(shares[1] - shares[0])
    assert min(gains) > -0.001 and max(gains) > 0.003, gains


def test_what_is_seen_along_it_is_not_seen(placement):
    """A view close to a wall of a white box used to count the wall as seen, and up to 12 % of the first bounce was
    lost."""
    low, high = np.array((-2.0, -3, 0)), np.array((2.0, 3, 2.5))
    cast = room((low, high))
    paths = placement.trace(*floor(low, high), cast, evenly, np.random.default_rng(0))
    low_down = placement.visible(np.array((0, 0, 0.02)), paths, cast)
    near, floor_places = np.linalg.norm(paths.positions[:, :2], axis=1) < 0.15, paths.positions[:, 2] < 1e-6
    assert low_down[floor_places & near].any()
    assert not low_down[floor_places & ~near & (np.linalg.norm(paths.positions[:, :2], axis=1) > 0.25)].any()
    assert low_down[~floor_places].mean() > 0.9


def test_views_look_where_the_light_comes_from(placement):
    """Only one wall is lit: the first view must look at it."""
    low, high = np.array((-2.0, -3, 0)), np.array((2.0, 3, 2.5))

    def one_wall(positions, normals, things):
        return np.where(positions[:, 0] > 1.999, 100.0, 0), np.full(len(positions), 0.5), np.zeros(len(positions))

    cast, rng = room((low, high)), np.random.default_rng(1)
    paths = placement.trace(*floor(low, high), cast, one_wall, rng)
    poses = placement.place(paths, np.zeros(len(paths.positions), bool), cast, (1.2, 0.7), 1, rng)
    assert -poses[0][0, 2] > 0.5


def test_light_arrives_only_by_way_of_what_is_seen(placement):
    """A wall that emits 40 % itself, and reflects 60 % from one behind a corner: seeing only the far one brings
    nothing."""
    points = np.zeros((2, 3))
    paths = placement.LightPaths(
        points, points, points, np.array((-1, 0)), np.array((0.4, 0.6)), np.array((1.0, 0.6)) / 1.6, 1.0
    )
    arrived = [
        paths.arriving_share(np.array(seen)) for seen in ((True, True), (True, False), (False, True), (False, False))
    ]
    assert arrived == pytest.approx([1, 0.4, 0, 0])


def test_views_go_where_light_comes_from_round_a_corner(placement):
    """Only a wall behind the pillar is lit, which hardly any pixel faces: most light is reflected twice or more."""
    low, high = np.array((-2.0, -3, 0)), np.array((2.0, 3, 2.5))

    def far_wall(positions, normals, things):
        return np.where(positions[:, 0] > 1.999, 1.0, 0), np.full(len(positions), 0.7), np.zeros(len(positions))

    cast, rng = room((low, high), (np.array((0.9, -3, 0)), np.array((1.2, 2, 2.5)))), np.random.default_rng(0)
    paths = placement.trace(*floor(low, high), cast, far_wall, rng)
    at_once = paths.parents < 0
    assert paths.contributions.sum() == pytest.approx(1) and paths.contributions[at_once].sum() < 0.4
    assert paths.weights[at_once].sum() * paths.weights.size > at_once.sum(), "all that goes on passes them"
    unseen, half = np.zeros(len(paths.positions), bool), np.tan(np.radians(50)) * np.array((1, 9 / 16))
    poses = placement.place(paths, unseen, cast, half, 7, rng)
    assert placement.coverage(paths, unseen, cast, half, poses)[-1] > 0.9
    assert any(pose[0, 3] > 1.2 or (pose[1, 3] > 2 and -pose[0, 2] > 0) for pose in poses), "one looks behind it"


def test_nothing_to_see_and_nowhere_to_stand(placement):
    low, high, rng = np.array((-5.0, -5, 0)), np.array((5.0, 5, 0.05)), np.random.default_rng(0)

    def nothing(origins, directions, limits, nearest=True):
        return np.full(len(origins), np.inf), np.zeros((len(origins), 3)), np.full(len(origins), -1)

    assert placement.trace(*floor(low, high), nothing, evenly, rng) is None
    assert placement.trace(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), nothing, evenly, rng) is None
    assert len(placement.sample_pixels(np.zeros((4, 4), bool), 100, rng)) == 0
    cast = room((low, high))
    paths = placement.trace(*floor(low, high), cast, evenly, rng)
    seen = np.arange(len(paths.positions)) % 2 == 0
    assert placement.place(paths, seen, cast, (1, 1), 7, rng) == []
    assert placement.coverage(paths, seen, cast, (1, 1), []) == [pytest.approx(paths.arriving_share(seen))]


def test_poses_are_upright_in_every_direction(placement):
    for direction in placement.DIRECTIONS:
        pose = placement.pose_looking(np.array((1.0, 2, 3)), direction)
        assert np.allclose(-pose[:3, 2], direction) and pose[2, 1] > -1e-9
