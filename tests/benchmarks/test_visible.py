# SPDX-License-Identifier: GPL-3.0-or-later
"""The measures of visible errors: what each catches, and what it lets pass."""

import numpy as np
import pytest

from benchmarks.accuracy import visible

SIZE = 90, 160


@pytest.fixture
def picture():
    """A wall with a gradient, a dark half, and a window: (H, W, 3), and a mask without the window."""
    height, width = SIZE
    light = np.linspace(0.5, 1.5, width) * np.linspace(1, 0.8, height)[:, None]
    light[:, : width // 2] *= 0.2
    mask = np.ones(SIZE, bool)
    mask[20:50, 100:140] = False
    light[~mask] = 30.0
    return light[..., None] * (1.0, 0.9, 0.8), mask


def stains(picture, across, strength=0.1, seed=0):
    """The picture times 1 + stains about so many pixels across, of this deviation."""
    noise = np.random.default_rng(seed).normal(size=SIZE)
    rows, columns = np.meshgrid(np.fft.fftfreq(SIZE[0]), np.fft.fftfreq(SIZE[1]), indexing="ij")
    frequency = np.hypot(rows, columns) * 2 * across  # 1 where half a period is `across`
    band = np.exp(-((np.log2(np.maximum(frequency, 1e-6))) ** 2) * 4)
    found = np.fft.ifft2(np.fft.fft2(noise) * band).real
    return picture * (1 + strength * found / found.std())[..., None]


def specks(picture, mask, count, strength=1.0, seed=0):
    rng = np.random.default_rng(seed)
    chosen = rng.choice(np.flatnonzero(mask), count, replace=False)
    spotted = picture.copy()
    spotted.reshape(-1, 3)[chosen] *= 1 + strength
    return spotted


def blurred(picture):
    return sum(np.roll(picture, (y, x), (0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)) / 9


def test_equal_pictures_have_no_error(picture):
    light, mask = picture
    assert visible.blotches(light, light, mask) == visible.dots(light, light, mask) == 0
    assert visible.ldr_flip(light.clip(0, 1), light.clip(0, 1)) == 0


@pytest.mark.parametrize("across, share", [(1, 0.35), (8, 1), (12, 1), (70, 0.4)])
def test_blotches_are_those_of_their_band(picture, across, share):
    """Stains of 10 %: nearly all of it in the band, little of grain, and of what changes slowly."""
    light, mask = picture
    found = visible.blotches(stains(light, across), light, mask)
    assert 0.045 < found < 0.11 if share == 1 else found < 0.1 * share


def test_blotches_count_alike_in_the_dark_and_not_beside_a_lamp(picture):
    light, mask = picture
    stained = stains(light, 10)
    dark = np.zeros_like(mask)
    dark[:, : SIZE[1] // 2 - 20] = True
    assert visible.blotches(stained, light, dark) == pytest.approx(visible.blotches(stained, light, mask), rel=0.35)
    lamp = light.copy()
    lamp[~mask] *= 5
    assert visible.blotches(lamp, light, mask) == 0


def test_blotches_let_brightness_and_dots_pass(picture):
    light, mask = picture
    assert visible.blotches(1.2 * light, light, mask) < 0.012
    assert visible.blotches(specks(light, mask, 30), light, mask) < 0.015


def test_the_references_own_stains_are_taken_off(picture):
    light, mask = picture
    halves = [stains(light, 10, 0.1, seed) for seed in (1, 2)]
    mean = (halves[0] + halves[1]) / 2
    with_noise = visible.blotches(light, mean, mask)
    assert with_noise > 0.03 and visible.blotches(light, mean, mask, halves=halves) < 0.5 * with_noise


@pytest.mark.parametrize("strength", [1.0, -0.6])
def test_dots_are_counted(picture, strength):
    light, mask = picture
    found = visible.dots(specks(light, mask, 40, strength), light, mask)
    assert found == pytest.approx(1e6 * 40 / mask.sum(), rel=0.15)


def test_the_references_own_dots_are_taken_off(picture):
    light, mask = picture
    halves = [specks(light, mask, 400, 2.0, seed) for seed in (1, 2)]
    mean = (halves[0] + halves[1]) / 2
    alone = visible.dots(light, mean, mask)
    assert alone > 5e4 and visible.dots(light, mean, mask, halves=halves) < 0.05 * alone
    spotted = specks(light, mask, 400, 2.0, 3)
    assert visible.dots(spotted, mean, mask, halves=halves) == pytest.approx(1e6 * 400 / mask.sum(), rel=0.25)


def test_dots_let_blotches_blur_and_brightness_pass(picture):
    light, mask = picture
    assert visible.dots(stains(light, 10), light, mask) == 0
    assert visible.dots(1.3 * light, light, mask) == 0
    smooth = mask.copy()  # but for the edges of the light itself
    smooth[[0, -1]] = smooth[:, [0, -1]] = smooth[:, SIZE[1] // 2 - 2 : SIZE[1] // 2 + 2] = False
    smooth[18:52, 98:142] = False
    assert visible.dots(blurred(light), light, smooth) == 0
    assert visible.dots(specks(light, mask, 40, 0.1), light, mask) == 0


def test_flip_sees_brightness_blur_and_stains(picture):
    light, mask = picture
    shown = (light / 2).clip(0, 1) ** (1 / 2.2)
    assert visible.ldr_flip((light / 1.6).clip(0, 1) ** (1 / 2.2), shown) > 0.02
    assert visible.ldr_flip((stains(light, 10) / 2).clip(0, 1) ** (1 / 2.2), shown) > 0.01
    assert visible.ldr_flip(blurred(shown), shown) > 0.003
    corner = shown.copy()
    corner[:8, :8] = 1 - corner[:8, :8]
    errors = visible.flip_map(corner, shown)
    assert errors[:8, :8].mean() > 0.1 and errors[-8:, -8:].max() == 0


def test_nothing_to_measure_is_none(picture):
    light, mask = picture
    for measure in (visible.blotches, visible.dots):
        assert measure(light, light, np.zeros_like(mask)) is None and measure(light, 0 * light, mask) is None


def test_the_reachable_picture_keeps_what_is_eevees(picture):
    light, _ = picture
    assert np.allclose(visible.reachable(light, 0.2 * light, 0.5 * light), 1.3 * light)


def test_displayed_is_what_blender_shows(fresh):
    ramp = np.repeat(np.linspace(0, 4, 64, dtype=np.float32)[None, :, None], 8, 0) * np.ones(3, np.float32)
    fresh.view_settings.view_transform = "Standard"
    shown = visible.displayed(fresh, ramp)
    linear = ramp.clip(0, 1)
    expected = np.where(linear < 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    assert np.abs(shown - expected).max() < 2e-3 and fresh.render.image_settings.file_format == "PNG"
    fresh.view_settings.view_transform = "AgX"
    assert visible.displayed(fresh, ramp)[0, -1, 0] < 1 and visible.displayed(fresh, ramp, 2)[0, 8, 0] > shown[0, 8, 0]


def test_errors_count_by_the_brightness_of_the_picture_that_shows_them(picture):
    """Where a lamp outshines the indirect light three to one, its blotches are a quarter of what they are alone, and
    specks of half of it are none."""
    light, mask = picture
    stained, spotted = stains(light, 10), specks(light, mask, 40, 0.5)
    alone = visible.blotches(stained, light, mask)
    assert visible.blotches(stained, light, mask, 4 * light) == pytest.approx(alone / 4, rel=1e-6)
    assert visible.dots(spotted, light, mask) > 0 == visible.dots(spotted, light, mask, 4 * light)
