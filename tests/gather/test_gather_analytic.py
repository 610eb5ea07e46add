# SPDX-License-Identifier: GPL-3.0-or-later
"""Rung 1: the shaders as they run in Blender against geometry that has a closed form."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

import gather_fixtures as fixtures
from reference import paper as reference

EXHAUSTIVE = dict(start=1, samples=0, seed=0, strength=1.0)
few = hypothesis_settings(
    max_examples=12, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def plane_passes(light, camera, width, height, normal, distance):
    """Every pixel sees the plane normal . p = -distance (view space; the normal faces the camera)."""
    centres = reference.pixel_centres(height, width)
    ray = np.asarray(camera.offset) + np.asarray(camera.scale) * centres
    if camera.orthographic:
        depth = (ray @ normal[:2] + distance) / normal[2]
    else:
        depth = -distance / (ray @ normal[:2] - normal[2])
    assert (depth > 0).all()
    grey = np.full((height, width, 3), 0.5)
    world = np.broadcast_to(normal @ camera.rotation, grey.shape)
    return fixtures.passes_from(light, depth, world, grey, grey, grey)


def polygon_area(camera, width, height, normal, distance):
    """True area of the part of the plane that the whole frame sees, by its four corners."""
    corners = np.array([(0, 0), (width, 0), (width, height), (0, height)], float)
    ray = np.asarray(camera.offset) + np.asarray(camera.scale) * corners
    if camera.orthographic:
        depth = (ray @ normal[:2] + distance) / normal[2]
    else:
        depth = -distance / (ray @ normal[:2] - normal[2])
    place = reference.view_position(camera, corners, depth)
    return 0.5 * abs(np.cross(place[2] - place[0], place[3] - place[1]) @ normal)


@few
@given(
    tilt=st.floats(0, 0.5),
    turn=st.floats(0, 6.28),
    shift=st.floats(-0.3, 0.3),
    distance=st.floats(0.01, 1000),
    orthographic=st.booleans(),
    start=st.sampled_from([1, 2, 4]),
)
def test_texel_areas_add_up_to_the_plane(light, tilt, turn, shift, distance, orthographic, start):
    """Tilted planes at any distance, with lens shift, in perspective and orthographic: sum of A to 1e-4, and the
    vector area is that area times the normal."""
    width, height = 96, 54
    turned = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    shift *= distance if orthographic else 1
    camera = fixtures.camera_for(
        light,
        width,
        height,
        fov_x=0.9,
        shift=(shift, -shift / 2),
        rotation=turned,
        orthographic_width=distance if orthographic else None,
    )
    normal = np.array([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    passes = plane_passes(light, camera, width, height, normal, distance)
    chosen = light.PaperSettings(**EXHAUSTIVE | {"start": start}, radius=8)
    base = fixtures.level_arrays(fixtures.pyramid_of(light, passes, camera, chosen), camera, start)[0]
    true = polygon_area(camera, width, height, normal, distance)
    assert base.area.sum() == pytest.approx(true, rel=1e-4)
    # All pixels have one normal here, and so one error of its steps.
    assert base.vector_area.sum((0, 1)) == pytest.approx(true * normal, rel=1e-3, abs=1e-3 * true)


def test_merging_keeps_area_power_and_moment(light):
    """What adds up, adds up: every level of an odd-sized frame has the same sums, to the steps of a surfel. Those of a
    place are a share of its texel."""
    passes = fixtures.random_frame(light, 37, 23)
    camera = fixtures.camera_for(light, 37, 23)
    levels = fixtures.level_arrays(
        fixtures.pyramid_of(light, passes, camera, light.PaperSettings(**EXHAUSTIVE, radius=4)), camera, 1
    )

    def sums(level):
        weight = level.area[..., None]
        return (
            level.area.sum(),
            (weight * level.radiance).sum((0, 1)),
            level.vector_area.sum((0, 1)),
            (weight * level.position).sum((0, 1)),
        )

    area, power, vector_area, moment = sums(levels[0])
    assert len(levels) == 5
    for index, level in enumerate(levels[1:], 1):
        area_, power_, vector_area_, moment_ = sums(level)
        assert area_ == pytest.approx(area, rel=1e-3)
        assert power_ == pytest.approx(power, rel=1e-3)
        assert vector_area_ == pytest.approx(vector_area, abs=1e-3 * area)
        texel = camera.scale[0] * 2**index * -level.position[..., 2].min()
        assert moment_ == pytest.approx(moment, abs=area * (texel / 128 + 1e-3))


def polygon_form_factor(receiver, normal, corners):
    """Lambert's closed form: from a point to a polygon wholly above its horizon."""
    edges = reference.direction(np.asarray(corners, float) - receiver)
    following = np.roll(edges, -1, axis=0)
    cross = np.cross(edges, following)
    angle = np.arctan2(np.linalg.norm(cross, axis=-1), (edges * following).sum(-1))
    return abs((angle[:, None] * reference.direction(cross)).sum(0) @ normal) / (2 * np.pi)


def look(light, camera, width, height, patches):
    """Passes of a frame in which rectangles of pixels see planes, and the corners of what they see.

    patches: ((first column, first row, columns, rows), unit normal n, p): the plane n . x = n . p, in view space, of
    radiance 1. The normal need not face the camera: this is geometry for the sums, not a picture."""
    depth = np.full((height, width), 1e10)
    normals = np.zeros((height, width, 3))
    corners = []
    for (column, row, columns, rows), normal, point in patches:

        def place(pixel):
            ray = np.concatenate(
                [np.asarray(camera.offset) + np.asarray(camera.scale) * pixel, np.full((*pixel.shape[:-1], 1), -1.0)],
                -1,
            )
            if camera.orthographic:
                distance = (np.dot(normal, point) - ray[..., :2] @ normal[:2]) / -normal[2]
                return np.concatenate([ray[..., :2], -distance[..., None]], -1)
            return ray * (np.dot(normal, point) / (ray @ normal))[..., None]

        here = slice(row, row + rows), slice(column, column + columns)
        depth[here] = -place(reference.pixel_centres(rows, columns) + (column, row))[..., 2]
        normals[here] = normal
        corners.append(
            place(
                np.array(
                    [(column, row), (column + columns, row), (column + columns, row + rows), (column, row + rows)],
                    float,
                )
            )
        )
    assert (depth > 0).all()
    black, white = np.zeros((height, width, 3)), np.ones((height, width, 3))
    return fixtures.passes_from(light, depth, normals @ camera.rotation, black, black, white), corners


@pytest.mark.parametrize("orthographic", [False, True])
@pytest.mark.parametrize(
    "facing, normal, point",
    [
        pytest.param((0, 0, 1), (0, 0, -1), (0, 0, -1), id="parallel"),
        pytest.param((0, 1, 0.2), (-1, 0.2, -1), (0.5, 0, -1.5), id="perpendicular"),
        pytest.param((0.2, 0.6, 1), (-0.3, -0.4, -1), (0.5, 0.3, -1.5), id="tilted"),
    ],
)
def test_form_factor_of_a_square(light, facing, normal, point, orthographic):
    """A pixel's patch, and 64 x 64 pixels of a plane before it or beside it: their sum is Lambert's form factor to
    1e-3, what a surfel's steps leave of directions."""
    camera = fixtures.camera_for(light, 96, 65, fov_x=0.8, orthographic_width=2.5 if orthographic else None)
    facing, normal = (reference.direction(np.array(vector, float)) for vector in (facing, normal))
    at_three_metres = reference.view_position(camera, np.array([3.5, 0.5]), np.array(3.0))
    passes, (patch, polygon) = look(
        light, camera, 96, 65, [((3, 0, 1, 1), facing, at_three_metres), ((32, 1, 64, 64), normal, np.array(point))]
    )
    receiver = patch.mean(0)
    assert ((polygon - receiver) @ facing > 0).all() and ((receiver - polygon) @ normal > 0).all()
    chosen = light.PaperSettings(**EXHAUSTIVE, radius=120)
    pyramid = fixtures.pyramid_of(light, passes, camera, chosen)
    assert len(pyramid.boxes) == 1
    result = np.asarray(light.gather(pyramid, chosen).read())[0, 3]
    true = polygon_form_factor(receiver, facing, polygon)
    assert true > 0.005
    assert result[3] == pytest.approx(true, rel=1e-3)
    assert result[:3] == pytest.approx(np.pi * true, rel=1e-3)


def test_form_factor_between_opposite_squares(light):
    """Area to area, in orthographic view of two parallel unit squares, each looking at the other: one at depth 1, one
    at 2, side by side. Contour integral in closed form for aligned rectangles (Howell, A catalog of radiation, C-13),
    by Lambert's formula averaged over one of them here."""
    count = 40
    camera = fixtures.camera_for(light, 2 * count, count, orthographic_width=2.0)
    toward, away = np.array([0, 0, 1.0]), np.array([0, 0, -1.0])
    passes, (lower, upper) = look(
        light,
        camera,
        2 * count,
        count,
        [((0, 0, count, count), toward, -2 * toward), ((count, 0, count, count), away, -toward)],
    )
    chosen = light.PaperSettings(**EXHAUSTIVE, radius=100)
    result = np.asarray(light.gather(fixtures.pyramid_of(light, passes, camera, chosen), chosen).read())[..., 3]
    places = (
        lower[0]
        + ((np.arange(count) + 0.5) / count)[:, None, None] * (lower[1] - lower[0])
        + ((np.arange(count) + 0.5) / count)[None, :, None] * (lower[3] - lower[0])
    )
    true = np.mean([polygon_form_factor(place, toward, upper) for place in places.reshape(-1, 3)])
    assert result[:, :count].mean() == pytest.approx(true, rel=1e-3)
    assert result[:, count:].mean() == pytest.approx(true, rel=1e-3)  # reciprocity: equal areas


@pytest.mark.parametrize("distance", [1e-3, 0.1, 1, 10, 1000])
def test_form_factor_never_exceeds_one(light, distance):
    """Facing disks: A / (pi r^2 + A), exact far away and bounded when touching. Two pixels of an orthographic view
    1 m apart, turned so that they face each other along the line between them."""
    side = 2.0
    camera = fixtures.camera_for(light, 2, 1, orthographic_width=2 * side)
    path = reference.direction(np.array([side, 0, -distance]))
    passes, _ = look(
        light,
        camera,
        2,
        1,
        [
            ((0, 0, 1, 1), path, np.array([-side / 2, 0, -5.0])),
            ((1, 0, 1, 1), -path, np.array([side / 2, 0, -5.0 - distance])),
        ],
    )
    chosen = light.PaperSettings(**EXHAUSTIVE, radius=4)
    pyramid = fixtures.pyramid_of(light, passes, camera, chosen)
    form = np.asarray(light.gather(pyramid, chosen).read())[0, 0, 3]
    area = side**2 / max(abs(path[2]), reference.COSINE_FLOOR)
    assert form == pytest.approx(area / (np.pi * (side**2 + distance**2) + area), rel=3e-3)
    assert form <= 1


def base_of(light, passes, camera):
    chosen = light.PaperSettings(**EXHAUSTIVE, radius=8)
    return fixtures.level_arrays(fixtures.pyramid_of(light, passes, camera, chosen), camera, 1)[0]


def test_missing_normals_come_from_depth(light):
    """Pure emission writes the normal (0, 0, 0): a tilted plane gets its own normal back, also at the frame's edge
    and beside background."""
    camera = fixtures.camera_for(light, 32, 18)
    normal = reference.direction(np.array([0.3, -0.2, 1]))
    passes = plane_passes(light, camera, 32, 18, normal, 4)
    passes.depth[5:8, 10:20] = fixtures.BACKGROUND
    for channel in passes.normal:
        channel[:] = 0
    base = base_of(light, passes, camera)
    surface = base.area > 0
    assert surface.sum() == 32 * 18 - 30
    # Differences of float32 depths, and a surfel's steps.
    assert np.abs(reference.direction(base.vector_area)[surface] - normal).max() < 3e-3


def test_a_lone_pixel_without_normal_faces_the_camera(light):
    camera = fixtures.camera_for(light, 1, 1)
    passes = fixtures.passes_from(light, np.full((1, 1), 2.0), *[np.zeros((1, 1, 3))] * 4)
    base = base_of(light, passes, camera)
    assert reference.direction(base.vector_area)[0, 0] == pytest.approx([0, 0, 1], abs=2e-3)
    assert base.position[0, 0] == pytest.approx([0, 0, -2], abs=1e-4)
