# SPDX-License-Identifier: GPL-3.0-or-later
"""Rung 2: every stage of the shaders against float64, the hierarchical sum against all pairs, and the estimator."""

import numpy as np
import pytest

import light_fixtures as fixtures
import reference
from light_fixtures import light  # noqa: F401  (a fixture)

DEFAULT_RADIUS = 16


def settings(light, **changes):
    return light.Settings(**dict(start=1, samples=0, radius=DEFAULT_RADIUS, seed=0, strength=1.0) | changes)


def base_total(light, passes, camera, chosen):
    """(H, W, 4) at the base: irradiance and form factors, all levels summed, before the furnace's bound."""
    levels = light.pyramid(light.pack(light.upload(passes), camera, chosen.start)[1], chosen.radius)
    total = light.gather(levels[-1], len(levels) - 1, chosen)
    for index in range(len(levels) - 2, -1, -1):
        total = light.upsample(levels[index], light.gather(levels[index], index, chosen), levels[index + 1], total)
    return np.array(total.read(), np.float64)


@pytest.fixture(scope="module", params=["random", "eevee"])
def frame(request, light):
    """(passes, camera): one frame without any order, and one that EEVEE rendered."""
    if request.param == "eevee":
        return fixtures.rendered_box(light)
    turned = np.array([[0, 1, 0], [-0.6, 0, 0.8], [0.8, 0, 0.6]])
    return (fixtures.random_frame(light, 61, 35),
            fixtures.camera_for(light, 61, 35, shift=(0.1, -0.2), rotation=turned))


@pytest.mark.parametrize("start", [1, 2, 4])
def test_every_stage_agrees_with_float64(light, frame, start):
    """Pack, halve, gather, upsample and composite, each fed by the stage before it, to 1e-4 of its largest value."""
    passes, camera = frame
    radius = 8

    def agree(image, expected):
        assert np.abs(np.asarray(image) - expected).max() <= 1e-4 * np.abs(expected).max()

    channels = light.upload(passes)
    guide, base = light.pack(channels, camera, start)
    expected_guide, expected_base = reference.pack(passes, camera, start)
    agree(guide.read(), expected_guide)
    levels = light.pyramid(base, radius)
    expected_levels = reference.pyramid(expected_base, radius)
    assert len(levels) == len(expected_levels) > 2
    for level, expected in zip(levels, expected_levels):
        for name, image in vars(fixtures.level_arrays(level)).items():
            agree(image, getattr(expected, name))

    chosen = settings(light, start=start, radius=radius, strength=0.7)
    total, expected_total = None, None
    for index in range(len(levels) - 1, -1, -1):
        own = light.gather(levels[index], index, chosen)
        expected_own = reference.gather(expected_levels[index], index == 0, radius)
        agree(own.read(), expected_own)
        if total is not None:
            own = light.upsample(levels[index], own, levels[index + 1], total)
            expected_own = reference.upsample(expected_levels[index], expected_own, expected_levels[index + 1],
                                              expected_total)
            agree(own.read(), expected_own)
        total, expected_total = own, expected_own
    picture = light.composite(guide, channels, base, total, camera, chosen).read()
    agree(picture, reference.composite(passes, expected_guide, expected_base, expected_total, camera, start, 0.7))
    assert np.array_equal(np.asarray(picture), light.gather_indirect(passes, camera, chosen))


@pytest.fixture(scope="module")
def all_pairs(light):
    """(passes, camera, guide, base, sums) of the EEVEE frame: the float64 sum over all pairs of its pixels."""
    passes, camera = fixtures.rendered_box(light)
    guide, base = reference.pack(passes, camera, 1)
    return passes, camera, guide, base, reference.all_pairs(base)


@pytest.mark.parametrize("radius, energy, error", [(4, 0.15, 0.50), (8, 0.04, 0.25), (16, 0.02, 0.12), (32, 0.02, 0.06)])
def test_hierarchical_sum_against_all_pairs(light, all_pairs, radius, energy, error):
    """Exhaustive irradiance at the base, before the bound; energy: of the mean, error: RMSE over the mean. Measured
    here -.114, -.018, .003, -.011 and .42, .22, .11, .04. The finished picture by radius: docs/method.md."""
    passes, camera, _, _, sums = all_pairs
    total = base_total(light, passes, camera, settings(light, radius=radius))[..., :3]
    true = sums[..., :3]
    assert total.mean() == pytest.approx(true.mean(), rel=energy)
    assert np.sqrt(((total - true) ** 2).mean()) / true.mean() < error


@pytest.mark.parametrize("start", [1, 2, 4])
def test_picture_against_all_pairs(light, all_pairs, start):
    """The finished indirect light at the default radius keeps its mean whatever the start resolution."""
    passes, camera, guide, base, sums = all_pairs
    true = reference.composite(passes, guide, base, sums, camera, 1, 1.0)[..., :3]
    picture = light.gather_indirect(passes, camera, settings(light, start=start))[..., :3]
    assert picture.mean() == pytest.approx(true.mean(), rel=0.03)


def test_start_resolution_keeps_the_mean(light):
    passes, camera = fixtures.rendered_box(light)
    means = [light.gather_indirect(passes, camera, settings(light, start=start))[..., :3].mean()
             for start in (1, 2, 4)]
    assert max(means) / min(means) < 1.05


@pytest.mark.parametrize("samples, radius", [(16, 16), (64, 16), (5, 3), (64, 40)])
def test_monte_carlo_is_unbiased(light, samples, radius):
    """The sum before the furnace's bound, over 64 seeds: its mean over blocks of the frame lies within 3 standard
    errors of the exhaustive sum (of 30 blocks x 4 channels, up to 2 may be between 3 and 4.5), and so does the
    whole frame's."""
    passes, camera = fixtures.box_frame(light, 96, 80)

    def blocks(image):
        return image.reshape(5, 16, 6, 16, 4).mean((1, 3))

    exhaustive = base_total(light, passes, camera, settings(light, radius=radius))
    runs = np.array([base_total(light, passes, camera, settings(light, samples=samples, radius=radius, seed=seed))
                     for seed in range(64)])
    for reduce, allowed in ((lambda image: image.mean((0, 1)), 0), (blocks, 2)):
        values = np.array([reduce(run) for run in runs])
        standard_error = values.std(0, ddof=1) / np.sqrt(len(values))
        # 1e-5: what float32 sums of ten thousand terms may differ by
        deviation = np.abs(values.mean(0) - reduce(exhaustive)) / np.maximum(standard_error, 1e-5 * values.mean(0))
        assert (deviation > 3).sum() <= allowed
        assert deviation.max() < 4.5


def test_as_many_samples_as_texels_is_the_exhaustive_sum(light):
    """One code path: with N = |O| the strata hold one texel each, so the seed no longer matters."""
    passes, camera = fixtures.random_frame(light, 40, 30), fixtures.camera_for(light, 40, 30)
    pictures = [light.gather_indirect(passes, camera, settings(light, samples=samples, seed=seed, radius=8))
                for samples, seed in ((0, 1), (1024, 2), (1 << 20, 3))]
    assert np.array_equal(pictures[0], pictures[1]) and np.array_equal(pictures[0], pictures[2])


@pytest.mark.parametrize("radius", [3, 4, 5, 8, 12, 16, 32, 100])
def test_regions_tile_the_plane(light, radius):
    """A ring leaves out what the finer level took, to the texels nearest in number; no offset comes twice."""
    disk, ring = (light.pipeline.offsets(radius, finest) for finest in (True, False))
    for region in (disk, ring):
        assert len(np.unique(region, axis=0)) == len(region)
        assert (np.hypot(*region.T) < radius).all() and (np.hypot(*region.T) > 0).all()
    taken = len(disk) + 1
    left_out = 4 * (taken - len(ring))
    assert left_out == pytest.approx(taken, abs=24)  # points of a grid come in rings of 4 to 12
    assert np.hypot(*ring.T).min() == pytest.approx(radius / 2, abs=1)


def test_samples_double_from_level_to_level(light):
    """Up to the whole region; 0 asks for the whole region at once."""
    samples_at = light.pipeline.samples_at
    assert [samples_at(level, 64, 600) for level in range(5)] == [64, 128, 256, 512, 600]
    assert samples_at(0, 0, 600) == samples_at(0, 1024, 600) == 600


def test_the_same_seed_is_the_same_picture(light):
    passes, camera = fixtures.rendered_box(light)
    def picture(seed):
        return light.gather_indirect(passes, camera, settings(light, samples=16, seed=seed))

    first = picture(7)
    assert np.array_equal(first, picture(7))
    other = picture(8)
    assert np.mean(np.any(first != other, axis=-1)[first[..., 3] > 0]) > 0.9
    assert np.array_equal(picture(7 + (1 << 32)), first) and np.isfinite(picture(-1)).all()


def test_strength_scales_and_nothing_else(light):
    passes, camera = fixtures.random_frame(light, 24, 16), fixtures.camera_for(light, 24, 16)
    one, half = (light.gather_indirect(passes, camera, settings(light, strength=s)) for s in (1.0, 0.5))
    assert np.array_equal(half[..., :3], one[..., :3] * np.float32(0.5))
    assert np.array_equal(half[..., 3], one[..., 3])


def test_scenes_of_any_scale_look_alike(light):
    """All lengths times 1000 or a thousandth: the same light to float32."""
    camera = fixtures.camera_for(light, 48, 27)
    pictures = []
    for scale in (1e-3, 1, 1e3):
        passes = fixtures.random_frame(light, 48, 27, holes=0)
        passes.depth *= np.float32(scale)
        pictures.append(light.gather_indirect(passes, camera, settings(light, radius=8)))
    for other in (pictures[0], pictures[2]):
        assert np.abs(other - pictures[1]).max() < 1e-5 * pictures[1].max()
