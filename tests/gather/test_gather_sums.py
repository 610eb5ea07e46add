# SPDX-License-Identifier: GPL-3.0-or-later
"""Rung 2: every stage of the shaders against float64, the hierarchical sum against all pairs, and the estimator."""

import numpy as np
import pytest

import gather_fixtures as fixtures
from reference import paper as reference

DEFAULT_RADIUS = 16


def settings(light, **changes):
    return light.PaperSettings(**dict(start=1, samples=0, radius=DEFAULT_RADIUS, seed=0, strength=1.0) | changes)


def base_total(light, passes, camera, chosen):
    """(H, W, 4) at the base: irradiance and form factors, all levels summed, before the furnace's bound."""
    pyramid = fixtures.pyramid_of(light, passes, camera, chosen)
    return np.array(light.upsample(pyramid, light.gather(pyramid, chosen)).read(), np.float64)


@pytest.fixture(scope="module", params=["random", "eevee"])
def frame(request, light):
    """(passes, camera): one frame without any order, and one that EEVEE rendered."""
    if request.param == "eevee":
        return fixtures.rendered_box(light)
    turned = np.array([[0, 1, 0], [-0.6, 0, 0.8], [0.8, 0, 0.6]])
    return (
        fixtures.random_frame(light, 61, 35),
        fixtures.camera_for(light, 61, 35, shift=(0.1, -0.2), rotation=turned),
    )


def agree(image, expected, relative=1e-4):
    assert np.abs(np.asarray(image) - expected).max() <= relative * np.abs(expected).max()


@pytest.mark.parametrize("start", [1, 2, 4])
def test_every_stage_agrees_with_float64(light, frame, start):
    """Gather, upsample and composite, each fed by the stage before it, to 1e-4 of its largest value."""
    passes, camera = frame
    chosen = settings(light, start=start, radius=8, strength=0.7)
    channels = light.upload(passes)
    pyramid = light.pack(channels, passes, camera, chosen)
    light.merge(pyramid)
    levels = fixtures.level_arrays(pyramid, camera, start)
    assert len(levels) > 2

    irradiance = light.gather(pyramid, chosen)
    gathered = np.array(irradiance.read(), np.float64)
    own = [fixtures.level_of(gathered, pyramid, index) for index in range(len(levels))]
    for index, level in enumerate(levels):
        agree(own[index], reference.gather(level, index == 0, 8))
    total = light.upsample(pyramid, irradiance)
    agree(total.read(), reference.upsample(levels, own))
    guide, _ = reference.pack(passes, camera, start)
    picture = light.gather_indirect(passes, camera, chosen)
    agree(picture, reference.composite(passes, guide, levels[0], np.float64(total.read()), camera, start, 0.7))
    composited = np.asarray(light.composite(channels, pyramid, total, 0.7).read()).reshape(picture.shape[0], -1, 3)
    assert np.array_equal(composited[:, : picture.shape[1]], picture)


def within_steps(level, exact, camera, step):
    """Is a Level what is left of an exact one, by the steps in which a surfel is stored? Depth 2^-15, area 2^-14,
    place 1/256 of a texel, directions and radiance half of 1/1023 (z and blue: 1/511), of a power of two above it."""
    surface = exact.area > 0
    assert np.array_equal(level.area > 0, surface)
    exact, level = (
        [image[surface] for image in (a.position, a.area, a.vector_area, a.radiance)] for a in (exact, level)
    )
    (place, area, vector_area, radiance), (place_, area_, vector_area_, radiance_) = exact, level
    slack = 1 + 1e-3  # of the steps, for float32
    assert (np.abs(place_[:, 2] / place[:, 2] - 1) <= slack * 2.0**-15).all()
    ray, ray_ = (p[:, :2] / (1 if camera.orthographic else -p[:, 2:]) for p in (place, place_))
    # The last step of an axis stands for the rest of the texel as well.
    assert (np.abs(ray_ - ray) <= slack * (1 / 128) * np.abs(camera.scale) * step).all()
    assert np.quantile(np.abs(ray_ - ray) / (np.abs(camera.scale) * step), 0.9) <= slack / 256
    # A step of depth moves the footprint by twice as much.
    unit, unit_ = (a / reference.footprint(camera, -p[:, 2], step) for a, p in ((area, place), (area_, place_)))
    assert (np.abs(unit_ / unit - 1) <= slack * 2.0**-14 + 4 * 2.0**-15).all()
    turned = np.abs(vector_area_ / area_[:, None] - vector_area / area[:, None])
    assert (turned <= slack * 0.5 / reference.DIRECTION_STEPS + 1e-6).all()
    # The largest channel is half of that power of two or more; the last step stands for what rounds above it, too.
    largest = np.abs(radiance).max(-1, keepdims=True)
    assert (np.abs(radiance_ - radiance) <= 2 * slack / reference.RADIANCE_STEPS * largest).all()


@pytest.mark.parametrize("start", [1, 2, 4])
def test_the_pyramid_agrees_with_float64(light, frame, start):
    """The base from the passes, and each coarser level from the one that it is merged from, within the steps of the
    format; as bits, what the reference packs, but for values that lie on the edge of a step."""
    passes, camera = frame
    pyramid = fixtures.pyramid_of(light, passes, camera, settings(light, start=start, radius=8))
    levels = fixtures.level_arrays(pyramid, camera, start)
    exact = [reference.pack(passes, camera, start)[1]]
    at_once = light.paper.MERGED_AT_ONCE
    for index in range(1, len(levels)):
        finer = (index - 1) // at_once * at_once
        exact.append(reference.merge(levels[finer], 2 ** (index - finer)))
    assert len(levels) > at_once - (start == 4)
    stored = fixtures.bits_of(pyramid.surfels)
    for index in range(len(levels)):
        within_steps(levels[index], exact[index], camera, start << index)
        bits = fixtures.level_of(stored, pyramid, index)
        assert np.mean(bits == reference.pack_surfel(exact[index], camera, start << index)) > 0.9


@pytest.fixture(scope="module")
def all_pairs(light):
    """(passes, camera, guide, base, sums) of the EEVEE frame: the float64 sum over all pairs of its pixels."""
    passes, camera = fixtures.rendered_box(light)
    guide, base = reference.pack(passes, camera, 1)
    return passes, camera, guide, base, reference.all_pairs(base)


@pytest.mark.parametrize(
    "radius, energy, error", [(4, 0.15, 0.50), (8, 0.04, 0.25), (16, 0.02, 0.12), (32, 0.02, 0.06)]
)
def test_hierarchical_sum_against_all_pairs(light, all_pairs, radius, energy, error):
    """Exhaustive irradiance at the base, before the bound; energy: of the mean, error: RMSE over the mean. Measured
    here -.114, -.018, .003, -.011 and .42, .22, .11, .04. The finished picture by radius: docs/method/paper.md."""
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
    means = [light.gather_indirect(passes, camera, settings(light, start=start))[..., :3].mean() for start in (1, 2, 4)]
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
    runs = np.array(
        [
            base_total(light, passes, camera, settings(light, samples=samples, radius=radius, seed=seed))
            for seed in range(64)
        ]
    )
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
    pictures = [
        light.gather_indirect(passes, camera, settings(light, samples=samples, seed=seed, radius=8))
        for samples, seed in ((0, 1), (1024, 2), (1 << 20, 3))
    ]
    assert np.array_equal(pictures[0], pictures[1]) and np.array_equal(pictures[0], pictures[2])


@pytest.mark.parametrize("radius", [3, 4, 5, 8, 12, 16, 32, 100])
def test_regions_tile_the_plane(light, radius):
    """A ring leaves out what the finer level took, to the texels nearest in number; no offset comes twice."""
    disk, ring = (light.paper.offsets(radius, finest) for finest in (True, False))
    for region in (disk, ring):
        assert len(np.unique(region, axis=0)) == len(region)
        assert (np.hypot(*region.T) < radius).all() and (np.hypot(*region.T) > 0).all()
    taken = len(disk) + 1
    left_out = 4 * (taken - len(ring))
    assert left_out == pytest.approx(taken, abs=24)  # points of a grid come in rings of 4 to 12
    assert np.hypot(*ring.T).min() == pytest.approx(radius / 2, abs=1)


def test_samples_double_from_level_to_level(light):
    """Up to the whole region; 0 asks for the whole region at once."""
    samples_at = light.paper.samples_at
    assert [samples_at(level, 64, 600) for level in range(5)] == [64, 128, 256, 512, 600]
    assert samples_at(0, 0, 600) == samples_at(0, 1024, 600) == 600


def test_the_same_seed_is_the_same_picture(light):
    passes, camera = fixtures.rendered_box(light)

    def picture(seed):
        return light.gather_indirect(passes, camera, settings(light, samples=16, seed=seed))

    first = picture(7)
    assert np.array_equal(first, picture(7))
    other = picture(8)
    assert np.mean(np.any(first != other, axis=-1)[first.any(-1)]) > 0.9
    assert np.array_equal(picture(7 + (1 << 32)), first) and np.isfinite(picture(-1)).all()


def test_strength_scales_and_nothing_else(light):
    passes, camera = fixtures.random_frame(light, 24, 16), fixtures.camera_for(light, 24, 16)
    one, half = (light.gather_indirect(passes, camera, settings(light, strength=s)) for s in (1.0, 0.5))
    assert np.array_equal(half, one * np.float32(0.5))


def test_scenes_of_any_scale_look_alike(light):
    """All lengths times 1024 or a 1024th, the same bits in a surfel but for exponents: the same light to float32."""
    camera = fixtures.camera_for(light, 48, 27)
    pictures = []
    for scale in (2.0**-10, 1, 2.0**10):
        passes = fixtures.random_frame(light, 48, 27, holes=0)
        passes.depth *= np.float32(scale)
        pictures.append(light.gather_indirect(passes, camera, settings(light, radius=8)))
    for other in (pictures[0], pictures[2]):
        assert np.abs(other - pictures[1]).max() < 1e-5 * pictures[1].max()
