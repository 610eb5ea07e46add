# SPDX-License-Identifier: GPL-3.0-or-later
"""The light of pictures that stay on the GPU: they are split into the very channels that a render's passes are
uploaded as, small views count as large ones do, and the mean is the mean."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

import gather_fixtures as fixtures
import room_fixtures as rooms

SIZES = [(45, 30), (64, 8)]


@pytest.fixture(scope="module")
def interactive(light):
    return import_module(f"{light.__name__}.interactive")


def cameras(light, size):
    turned = np.array([[0, 1, 0], [-0.6, 0, 0.8], [0.8, 0, 0.6]])
    place = {"position": np.array([3.0, -2.0, 5.0])}
    return [
        replace(fixtures.camera_for(light, *size, shift=(0.1, -0.2), rotation=turned), **place),
        replace(fixtures.camera_for(light, *size, rotation=turned, orthographic_width=4.0), **place),
    ]


def places(frame, camera):
    """(H, W, 3), bottom row first, of a frame; the origin where there is no surface."""
    width, height = frame.size
    i, j = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    depth = frame.depth[::-1].astype(float)
    ray = np.stack([camera.offset[0] + camera.scale[0] * i, camera.offset[1] + camera.scale[1] * j], -1)
    local = np.concatenate([ray * (1 if camera.orthographic else depth[..., None]), -depth[..., None]], -1)
    return np.where((depth < 1e9)[..., None], local @ camera.rotation + camera.position, 0.0)


def picture(light, image):
    """A texture of (H, W, 3), bottom row first."""
    height, width, _ = image.shape
    padded = np.concatenate([image, np.ones((height, width, 1))], -1)
    return light.device.texture(width, height, data=np.ascontiguousarray(padded, np.float32))


def drawn_from(light, interactive, frame, camera):
    """light.GpuPasses of a frame, as if EEVEE had drawn its passes."""
    drawn = light.GpuPasses(frame.size, {})
    interactive.split("position", picture(light, places(frame, camera)), camera, drawn)
    for name in ("normal", "diffuse_color", "diffuse_direct", "emission"):
        interactive.split(name, picture(light, np.stack(getattr(frame, name), -1)[::-1]), None, drawn)
    return drawn


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("kind", [0, 1])
def test_pictures_are_split_into_the_channels_of_passes(light, interactive, size, kind):
    frame, camera = fixtures.random_frame(light, *size), cameras(light, size)[kind]
    drawn, uploaded = drawn_from(light, interactive, frame, camera), light.upload(frame)
    assert drawn.textures.keys() == uploaded.keys()
    for name, texture in uploaded.items():
        found, exact = light.device.read(drawn.textures[name]), light.device.read(texture)
        assert found.shape == exact.shape
        # What fills the rows up is background in both, and need not be the same number.
        np.testing.assert_allclose(
            found.reshape(size[1], -1)[:, : size[0]], exact.reshape(size[1], -1)[:, : size[0]], rtol=2e-6, err_msg=name
        )
    back = interactive.read(drawn)
    np.testing.assert_allclose(back.depth, frame.depth, rtol=2e-6)
    np.testing.assert_array_equal(back.normal, frame.normal)


@pytest.mark.parametrize("kind", [0, 1])
def test_the_depth_range_is_of_all_that_is_shown(light, interactive, kind):
    frame, camera = fixtures.random_frame(light, 45, 30), cameras(light, (45, 30))[kind]
    shown = frame.depth[frame.depth < 1e9]
    assert interactive.depth_range(picture(light, places(frame, camera)), camera) == pytest.approx(
        (shown.min(), shown.max()), rel=1e-5
    )
    assert interactive.depth_range(picture(light, np.zeros((30, 45, 3))), camera) is None


def room(light, size):
    """Three views of a box with a solid in it."""
    solids = [((-0.6, -0.3, -1.0), (-0.2, 0.2, 0.1))]
    seen = [
        rooms.camera_at(light, (0.1, -0.9, 0.17), (0, 1, -0.1), size),
        rooms.camera_at(light, (-0.8, 0.7, 0.6), (1, -0.8, -0.7), size),
        rooms.camera_at(light, (0.9, -0.1, 0.2), (-1, 0.2, -0.3), size),
    ]
    return [rooms.view_of(light, camera, size, solids=solids, radiance=rooms.lamp) for camera in seen]


def test_one_gather_is_that_of_a_render(light, interactive):
    """The same numbers by the same stages, wherever the passes come from; and so for the method Paper."""
    size = 64, 48
    views = room(light, size)
    drawn = [replace(view, source=light.GpuPasses(size, light.upload(view.load_passes()))) for view in views]
    for chosen in (
        light.RadiositySettings(start=1, bounces=2, groups=4),
        light.PaperSettings(start=2, samples=0, radius=8, seed=0, strength=1.0),
    ):
        if isinstance(chosen, light.RadiositySettings):
            exact = light.gather_views(views, chosen)
        else:
            exact = light.gather_indirect(views[0].load_passes(), views[0].camera, chosen)
        found = light.device.read(interactive.indirect(drawn, size, chosen)).reshape(48, -1, 3)[:, :64]
        np.testing.assert_allclose(found, exact, atol=1e-5 * exact.max(), err_msg=str(chosen))


def test_small_views_light_as_large_ones_do(light, interactive, monkeypatch):
    """Views with a pixel for each texel of the depth maps, beside a main view with 3 x 3; and all of them small."""
    monkeypatch.setattr(light.view_layout, "DEPTHS_ACROSS", 48)
    size, chosen = (144, 108), light.RadiositySettings(start=2, bounces=3, groups=16)
    large = room(light, size)
    small = interactive.coarse_size(size)
    assert small == (48, 36)
    coarse = [replace(view, coarse=True) for view in room(light, small)]
    exact = light.gather_views(large, chosen)
    mixed = light.device.read(interactive.indirect([large[0], *coarse[1:]], size, chosen)).reshape(108, -1, 3)[:, :144]
    assert mixed.mean() == pytest.approx(exact.mean(), rel=0.01)
    assert np.abs(mixed - exact).mean() < 0.08 * exact.mean()
    draft = light.device.read(interactive.indirect(coarse, size, replace(chosen, start=1))).reshape(36, -1, 3)[:, :48]
    blocks = exact.reshape(36, 3, 48, 3, 3).mean((1, 3))
    assert draft.mean() == pytest.approx(exact.mean(), rel=0.02)
    assert np.abs(draft - blocks).mean() < 0.12 * exact.mean()


def test_history_calms_what_is_shown(light, interactive):
    size, chosen = (64, 48), light.RadiositySettings(start=2, bounces=1, groups=1, smooth=False)
    views = room(light, size)

    def gathered(history, seed):
        return light.device.read(interactive.indirect(views, size, replace(chosen, seed=seed), history=history))

    history = light.History()
    alone = [gathered(None, seed) for seed in range(8)]
    calm = [gathered(history, seed) for seed in range(16)][8:]
    assert np.var(np.diff(calm, axis=0)) < 0.2 * np.var(np.diff(alone, axis=0))
    assert np.mean(calm) == pytest.approx(np.mean(alone), rel=0.03)


def test_mean(light, interactive):
    size = 7, 5
    rng, mean = np.random.default_rng(0), interactive.Mean()
    pictures = rng.uniform(-1, 1, (3, 5, 8, 3)).astype(np.float32)  # two quads across
    for count in range(1, 4):
        rows = np.ascontiguousarray(pictures[count - 1].reshape(5, 6, 4))
        mean.add(light.device.texture(6, 5, data=rows), size)
        assert mean.count == count
        np.testing.assert_allclose(light.device.read(mean.texture)[..., :3], pictures[:count].mean(0)[:, :7], atol=1e-6)
    mean.clear()
    assert mean.texture is None and mean.count == 0
