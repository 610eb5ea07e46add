# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold whatever comes in: the white furnace, NaN, empty and odd frames, cancelling, refusals."""

import numpy as np
import pytest
from test_gather_sums import base_total, settings

import gather_fixtures as fixtures


@pytest.mark.parametrize("samples", [0, 16, 64])
@pytest.mark.parametrize("scene", ["box", "random"])
def test_white_furnace(light, scene, samples):
    """Every surface sends L: no point receives more than pi L, however surfaces overlap and samples scatter. The
    bound acts: unbounded, the noisy sums do go above pi L."""
    radiance, albedo = 3.0, 0.7
    if scene == "box":
        passes, camera = fixtures.box_frame(light, 96, 72, radiance=radiance, albedo=albedo)
    else:
        camera = fixtures.camera_for(light, 64, 48)
        passes = fixtures.random_frame(light, 64, 48)
        for color, direct, emission in zip(passes.diffuse_color, passes.diffuse_direct, passes.emission):
            color[:], direct[:], emission[:] = albedo, 0, radiance
    for radius in (4, 16):
        chosen = settings(light, samples=samples, radius=radius)
        picture = light.gather_indirect(passes, camera, chosen)
        assert picture[..., :3].max() <= albedo * radiance * (1 + 1e-5)
    if samples == 16:
        assert base_total(light, passes, camera, chosen)[..., :3].max() > np.pi * radiance


def test_the_bound_costs_little_energy(light):
    """Dividing a noisy sum by max(1, F) loses light where F is near 1: under 1.5 % of the mean at 64 samples in a
    closed box (docs/method/paper.md)."""
    passes, camera = fixtures.box_frame(light, 160, 120, radiance=1.0)
    noisy = np.mean(
        [
            light.gather_indirect(passes, camera, settings(light, samples=64, seed=seed))[..., :3].mean()
            for seed in range(8)
        ]
    )
    assert noisy == pytest.approx(light.gather_indirect(passes, camera, settings(light))[..., :3].mean(), rel=0.015)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_broken_pixels_do_not_spread(light, value):
    """A broken channel of any pass: that pixel sends nothing, and receives nothing where depth, normal or colour is
    broken; every other pixel gets what it gets when the broken pixel is background."""
    camera = fixtures.camera_for(light, 33, 21)
    places = [(3, 4), (0, 0), (20, 32), (10, 16), (11, 7)]
    names = ["depth", "normal", "diffuse_color", "diffuse_direct", "emission"]
    broken, absent = (fixtures.random_frame(light, 33, 21, holes=0) for _ in range(2))
    for number, (place, name) in enumerate(zip(places, names)):
        broken.channels()[name][number % len(broken.channels()[name])][place] = value
        absent.depth[place] = fixtures.BACKGROUND
    assert broken.broken() == dict.fromkeys(names, 1)
    assert absent.broken() == {}
    for start in (1, 2, 4):
        chosen = settings(light, start=start, radius=8)
        picture = light.gather_indirect(broken, camera, chosen)
        assert np.isfinite(picture).all()
        expected = light.gather_indirect(absent, camera, chosen)
        for (row, column), name in zip(places, names):
            assert picture[20 - row, column].any() == (name in ("diffuse_direct", "emission") and start > 1)
            picture[20 - row, column] = expected[20 - row, column]
        assert np.array_equal(picture, expected)


def test_values_that_overflow_do_not_spread(light):
    """Finite channels whose product is not: 1e30 * 1e30."""
    camera = fixtures.camera_for(light, 16, 9)
    passes = fixtures.random_frame(light, 16, 9, holes=0)
    passes.diffuse_color[0][4, 5] = passes.diffuse_direct[0][4, 5] = 1e30
    assert passes.broken() == {}
    picture = light.gather_indirect(passes, camera, settings(light, radius=4))
    assert np.isfinite(picture).all() and not picture[4, 5].any() and picture.any()


@pytest.mark.parametrize("width, height", [(1, 1), (1, 7), (2, 2), (8192, 16), (5, 300)])
@pytest.mark.parametrize("start", [1, 4])
def test_frames_of_any_shape(light, width, height, start):
    camera = fixtures.camera_for(light, width, height)
    picture = light.gather_indirect(
        fixtures.random_frame(light, width, height, holes=0), camera, settings(light, start=start, samples=16)
    )
    assert picture.shape == (height, width, 3) and picture.dtype == np.float32
    assert np.isfinite(picture).all()
    if width * height == 1:
        assert not picture[..., :3].any()


@pytest.mark.parametrize("depth", [1e10, 0.0, -1.0, 2e9])
def test_nothing_but_background(light, depth):
    passes = fixtures.random_frame(light, 20, 10)
    passes.depth[:] = depth
    picture = light.gather_indirect(passes, fixtures.camera_for(light, 20, 10), settings(light))
    assert not picture.any()


def test_a_flat_plane_lights_nothing(light):
    """No point of a plane sees another: exactly 0 up to float32 rounding of its places."""
    grey = np.full((36, 64, 3), 0.5)
    normal = np.broadcast_to([0.0, 0.0, 1.0], grey.shape)
    passes = fixtures.passes_from(light, np.full((36, 64), 5.0), normal, grey, grey, grey)
    assert light.gather_indirect(passes, fixtures.camera_for(light, 64, 36), settings(light))[..., :3].max() < 1e-6


def test_rows_come_back_bottom_first(light):
    """An emitter that faces down, in the upper half of the picture, lights the floor below it, not above."""
    passes, camera = fixtures.box_frame(light, 48, 36)
    for direct, emission in zip(passes.diffuse_direct, passes.emission):
        direct[:] = 0
        emission[:12] = np.where(passes.normal[1][:12] < -0.5, 1, 0)  # rows top first: the ceiling
    picture = light.gather_indirect(passes, camera, settings(light, radius=32))[..., :3]
    assert picture[:12].sum() > 2 * picture[-8:].sum() > 0


def test_progress_and_cancel(light, monkeypatch):
    """Stages come in order with a share that never falls; bands report in between; a true answer cancels at once."""
    passes, camera = fixtures.box_frame(light, 96, 72)
    monkeypatch.setattr(light.device, "band", lambda _: 96 * 16 * 8)
    calls = []
    banded = light.gather_indirect(
        passes, camera, settings(light, samples=16), progress=lambda *call: bool(calls.append(call))
    )
    assert [stage for k, (stage, _) in enumerate(calls) if k == 0 or calls[k - 1][0] != stage] == [
        "upload",
        "pyramid",
        "gather",
        "upsample",
    ]
    shares = [share for _, share in calls]
    assert shares == sorted(shares) and shares[0] == 0 and shares[-1] == pytest.approx(1) and len(calls) > 12
    monkeypatch.undo()
    assert np.array_equal(banded, light.gather_indirect(passes, camera, settings(light, samples=16)))
    for stop_at in range(len(calls)):
        count = iter(range(stop_at + 1))
        with pytest.raises(light.Cancelled):
            monkeypatch.setattr(light.device, "band", lambda _: 96 * 16 * 8)
            light.gather_indirect(
                passes, camera, settings(light, samples=16), progress=lambda *_: next(count) == stop_at
            )


def test_timings_name_every_stage(light):
    timings = {}
    passes, camera = fixtures.box_frame(light, 48, 36)
    light.gather_indirect(passes, camera, settings(light, samples=16), timings=timings)
    assert list(timings) == ["upload", "pyramid", "gather", "upsample", "read_back"]
    assert all(seconds >= 0 for seconds in timings.values())


def test_a_frame_beyond_the_gpu_is_refused_by_name(light):
    with pytest.raises(light.GpuUnavailable, match=r"20000 x 2.*Lower the render resolution"):
        light.gather_indirect(
            fixtures.random_frame(light, 20000, 1), fixtures.camera_for(light, 20000, 1), settings(light)
        )


def test_a_shader_that_does_not_compile_is_named(light, monkeypatch, tmp_path):
    for file in light.device.SHADERS.rglob("*.glsl"):
        copy = tmp_path / file.relative_to(light.device.SHADERS)
        copy.parent.mkdir(exist_ok=True)
        copy.write_text(file.read_text().replace("void main()", "void main("))
    monkeypatch.setattr(light.device, "SHADERS", tmp_path)
    light.release()
    with pytest.raises(light.GpuUnavailable, match="'pack'.*Update the graphics driver"):
        light.gather_indirect(fixtures.random_frame(light, 4, 4), fixtures.camera_for(light, 4, 4), settings(light))
    monkeypatch.undo()
    light.release()
    assert light.gather_indirect(
        fixtures.random_frame(light, 4, 4), fixtures.camera_for(light, 4, 4), settings(light)
    ).any()


@pytest.mark.parametrize("changes", [dict(start=3), dict(start=0), dict(samples=-1), dict(radius=1), dict(radius=141)])
def test_settings_out_of_range_are_refused(light, changes):
    with pytest.raises(ValueError):
        settings(light, **changes)
