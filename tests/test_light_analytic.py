# SPDX-License-Identifier: GPL-3.0-or-later
"""Rung 1: the shaders as they run in Blender against geometry that has a closed form."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings as hypothesis_settings, strategies as st

import light_fixtures as fixtures
import reference
from light_fixtures import light  # noqa: F401  (a fixture)

EXHAUSTIVE = dict(start=1, samples=0, seed=0, strength=1.0)
few = hypothesis_settings(max_examples=12, deadline=None, derandomize=True,
                          suppress_health_check=[HealthCheck.function_scoped_fixture])


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
    place = reference.view_place(camera, corners, depth)
    return 0.5 * abs(np.cross(place[2] - place[0], place[3] - place[1]) @ normal)


@few
@given(tilt=st.floats(0, 0.5), turn=st.floats(0, 6.28), shift=st.floats(-0.3, 0.3), distance=st.floats(0.01, 1000),
       orthographic=st.booleans(), start=st.sampled_from([1, 2, 4]))
def test_texel_areas_add_up_to_the_plane(light, tilt, turn, shift, distance, orthographic, start):
    """Tilted planes at any distance, with lens shift, in perspective and orthographic: sum of A to 1e-4, and the
    vector area is that area times the normal."""
    width, height = 96, 54
    turned = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    shift *= distance if orthographic else 1
    camera = fixtures.camera_for(light, width, height, fov_x=0.9, shift=(shift, -shift / 2), rotation=turned,
                                 orthographic_width=distance if orthographic else None)
    normal = np.array([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    passes = plane_passes(light, camera, width, height, normal, distance)
    base = fixtures.level_arrays(light.pack(light.upload(passes), camera, start)[1])
    true = polygon_area(camera, width, height, normal, distance)
    assert base.area.sum() == pytest.approx(true, rel=1e-4)
    assert base.vector_area.sum((0, 1)) == pytest.approx(true * normal, rel=1e-4, abs=1e-4 * true)


def test_halving_keeps_area_power_and_moment(light):
    """What adds up, adds up: every level of an odd-sized frame has the same sums."""
    passes = fixtures.random_frame(light, 37, 23)
    camera = fixtures.camera_for(light, 37, 23)
    levels = light.pyramid(light.pack(light.upload(passes), camera, 1)[1], 8)
    sums = []
    for level in map(fixtures.level_arrays, levels):
        weight = level.area[..., None]
        sums.append(np.concatenate([[level.area.sum()], (weight * level.radiance).sum((0, 1)),
                                    (weight * level.place).sum((0, 1)), level.vector_area.sum((0, 1))]))
    assert len(levels) == 4
    for coarse in sums[1:]:
        assert coarse == pytest.approx(sums[0], rel=1e-5, abs=1e-5 * sums[0][0])


def polygon_form_factor(receiver, normal, corners):
    """Lambert's closed form: from a point to a polygon wholly above its horizon."""
    edges = reference.direction(np.asarray(corners, float) - receiver)
    following = np.roll(edges, -1, axis=0)
    cross = np.cross(edges, following)
    angle = np.arctan2(np.linalg.norm(cross, axis=-1), (edges * following).sum(-1))
    return abs((angle[:, None] * reference.direction(cross)).sum(0) @ normal) / (2 * np.pi)


def square_texels(origin, side_u, side_v, count):
    """(places, normal, corners, area of one) of a square cut into count x count texels."""
    origin, side_u, side_v = (np.asarray(v, float) for v in (origin, side_u, side_v))
    step = (np.arange(count) + 0.5) / count
    places = (origin + step[:, None, None] * side_u + step[None, :, None] * side_v).reshape(-1, 3)
    across = np.cross(side_u, side_v)
    corners = [origin, origin + side_u, origin + side_u + side_v, origin + side_v]
    return places, reference.direction(across), corners, np.linalg.norm(across) / count ** 2


@pytest.mark.parametrize("origin, side_u, side_v", [
    pytest.param((-.5, -.5, 1), (0, 1, 0), (1, 0, 0), id="parallel"),
    pytest.param((1, -.5, .5), (0, 0, 1), (0, 1, 0), id="perpendicular"),
    pytest.param((.2, .1, 1), (0, 1, .5), (1, -.1, .6), id="tilted"),
])
def test_form_factor_of_a_square(light, origin, side_u, side_v):
    """A point at the origin with normal +z, and a unit square: the sum over 64 x 64 texels to 1e-4."""
    places, normal, corners, area = square_texels(origin, side_u, side_v, 64)
    if -normal @ (places[0]) < 0:
        normal = -normal
    texels = fixtures.level_textures(light, reference.Level(
        np.ones((65, 64, 3)), *fixtures.in_rows(65, 64, [(np.zeros(3), [0, 0, 1], 1e-9)] +
                                                [(place, normal, area) for place in places])))
    result = np.asarray(light.gather(texels, 0, light.Settings(**EXHAUSTIVE, radius=92)).read())[0, 0]
    true = polygon_form_factor(np.zeros(3), np.array([0, 0, 1.0]), corners)
    assert true > 0.02
    assert result[3] == pytest.approx(true, rel=1e-4)
    assert result[:3] == pytest.approx(np.pi * true, rel=1e-4)


def test_form_factor_between_opposite_faces_of_a_cube(light):
    """Area to area: 0.199825 for unit squares at unit distance (Howell, A catalog of radiation, C-11)."""
    count = 48
    lower = square_texels((0, 0, 0), (1, 0, 0), (0, 1, 0), count)
    upper = square_texels((0, 0, 1), (0, 1, 0), (1, 0, 0), count)
    rows = [(place, face[1], face[3]) for face in (lower, upper) for place in face[0]]
    texels = fixtures.level_textures(light, reference.Level(
        np.ones((2 * count, count, 3)), *fixtures.in_rows(2 * count, count, rows)))
    result = np.asarray(light.gather(texels, 0, light.Settings(**EXHAUSTIVE, radius=108)).read())
    assert result[..., 3].mean() == pytest.approx(0.199825, abs=1e-4)


def test_form_factor_never_exceeds_one(light):
    """Facing disks: A / (pi r^2 + A), exact far away and bounded when touching."""
    distances = np.array([1e-3, 0.1, 1, 10, 1000])
    for distance in distances:
        texels = fixtures.level_textures(light, reference.Level(
            np.ones((1, 2, 3)), *fixtures.in_rows(1, 2, [((0, 0, 0), (0, 0, 1), 1), ((0, 0, distance), (0, 0, -1), 1)])))
        form = np.asarray(light.gather(texels, 0, light.Settings(**EXHAUSTIVE, radius=4)).read())[0, 0, 3]
        assert form == pytest.approx(1 / (np.pi * distance ** 2 + 1), rel=1e-5)
        assert form <= 1


def test_missing_normals_come_from_depth(light):
    """Pure emission writes the normal (0, 0, 0): a tilted plane gets its own normal back, also at the frame's edge
    and beside background."""
    camera = fixtures.camera_for(light, 32, 18)
    normal = reference.direction(np.array([0.3, -0.2, 1]))
    passes = plane_passes(light, camera, 32, 18, normal, 4)
    passes.depth[5:8, 10:20] = fixtures.BACKGROUND
    for channel in passes.normal:
        channel[:] = 0
    guide = np.asarray(light.pack(light.upload(passes), camera, 1)[0].read())
    surface = guide[..., 3] > 0
    assert surface.sum() == 32 * 18 - 30
    assert np.abs(guide[surface][:, :3] - normal).max() < 2e-3  # differences of float32 depths


def test_a_lone_pixel_without_normal_faces_the_camera(light):
    camera = fixtures.camera_for(light, 1, 1)
    passes = fixtures.passes_from(light, np.full((1, 1), 2.0), *[np.zeros((1, 1, 3))] * 4)
    guide = np.asarray(light.pack(light.upload(passes), camera, 1)[0].read())
    assert guide[0, 0] == pytest.approx([0, 0, 1, 2])
