# SPDX-License-Identifier: GPL-3.0-or-later
"""What the counts of radiosity_work.py depend on the scene for: how many views hold a point, which emitters face a
receiver, which shadow rays are blocked. Found in float64 numpy, on samples of the room's pixels; no GPU.

It is close to what the shaders do, but not the same: emitters are pixels rather than blocks, none are drawn from the
neighbourhood, light has not bounced yet, a view holds a point if it is in its frame, and the room says exactly what is
blocked. The floor needs shares to a few per cent."""

from dataclasses import dataclass

import numpy as np

from . import room

PIXELS = 1 << 13  # of each view, that emitters are drawn from
RECEIVERS = 1 << 11
MARGIN = 0.01  # of a shadow ray at both ends, that the room is not asked about, as in shadow_ray.glsl
SEED = 1


@dataclass(frozen=True)
class Rays:
    """Means over receivers. faced: share of the candidates that lie in front of the receiver. facing: share that face
    it, too. chosen: shadow rays a draw. blocked: share of these that are. shown: of each position along one that is
    not, the number of views in whose frame it lies."""

    faced: float
    facing: float
    chosen: float
    blocked: float
    shown: float


@dataclass(frozen=True)
class Shares:
    """overlaps: of each pixel of a view, the number of other views in whose frame it lies; a mean. base, blocks: Rays
    of the main view's pixels, and of those of all views."""

    overlaps: float
    base: Rays
    blocks: Rays


@dataclass(frozen=True)
class Surfaces:
    """n points. place, normal: (3, n), m. power: (n,), sum of r, g, b of the radiance. own: (n,), m^2 that a pixel
    stands for, beside those of the other views. overlaps: (n,), the other views in whose frame the point lies."""

    place: np.ndarray
    normal: np.ndarray
    power: np.ndarray
    own: np.ndarray
    overlaps: np.ndarray


def shares(light, views, settings):
    """Shares of [light.View], whose sources are Passes, at RadiositySettings."""
    rng = np.random.default_rng(SEED)
    emitters = [surfaces(views, number, PIXELS, rng) for number in range(len(views))]
    pool = Surfaces(*(np.concatenate(parts, -1) for parts in zip(*(vars(each).values() for each in emitters))))
    every = rng.integers(pool.own.size, size=RECEIVERS)
    main, steps = surfaces(views, 0, RECEIVERS, rng), light.radiosity.SHADOW_STEPS
    by_area, fewer = light.radiosity.BY_AREA, light.radiosity.BOUNCE_CANDIDATES
    return Shares(
        float(pool.overlaps.mean()),
        rays(views, main.place, main.normal, pool, settings.candidates, steps, by_area, rng),
        rays(views, pool.place[:, every], pool.normal[:, every], pool, fewer, steps, by_area, rng),
    )


def surfaces(views, number, count, rng):
    """Surfaces of so many random pixels of a view."""
    passes, camera = views[number].source, views[number].camera
    height, width = passes.depth.shape
    row, column = rng.integers(height, size=count), rng.integers(width, size=count)
    x, y = camera.offset[:, None] + camera.scale[:, None] * (column + 0.5, height - row - 0.5)
    ray = np.stack([x, y, -np.ones(count)])
    place = camera.position[:, None] + camera.rotation.T @ (ray * passes.depth[row, column])
    normal, color, direct, emission = (
        np.stack([channel[row, column] for channel in channels]).astype(float)
        for channels in (passes.normal, passes.diffuse_color, passes.diffuse_direct, passes.emission)
    )
    density, overlaps = np.zeros(count), np.zeros(count)
    for other, view in enumerate(views):
        holds = np.ones(count, bool) if other == number else in_frame(view, place)
        density += holds / shown_area(view.camera, place, normal)
        overlaps += holds & (other != number)
    return Surfaces(place, normal, (direct * color + emission).sum(0), 1 / density, overlaps)


def in_frame(view, place):
    """(n,) bool: does a view have the places (3, n) in its frame, whether something hides them or not?"""
    camera, (width, height) = view.camera, view.source.size
    seen = camera.rotation @ (place - camera.position[:, None])
    depth = np.where(seen[2] < -1e-4, -seen[2], np.nan)
    x, y = (seen[:2] / depth - camera.offset[:, None]) / camera.scale[:, None]
    return (x >= 0) & (y >= 0) & (x < width) & (y < height)  # comparisons with NaN are false


def shown_area(camera, place, normal):
    """(n,) m^2 that a pixel shows of surfaces (3, n): shown_area() of views.glsl, for pixels."""
    path = place - camera.position[:, None]
    distance = np.linalg.norm(path, axis=0)
    depth = np.abs(camera.rotation[2] @ path)
    cosine = np.maximum(np.abs((normal * path).sum(0)) / distance, 0.05)
    return camera.scale.prod() * depth**3 / distance / cosine


def rays(views, place, normal, pool, candidates, steps, by_area, rng):
    """Rays of receivers (3, n). pool: Surfaces that emitters are drawn from, as sample_emitters.glsl does it."""
    bright = pool.power * pool.own
    pdf = by_area * pool.own / pool.own.sum() + (1 - by_area) * bright / bright.sum()
    drawn = np.searchsorted(np.cumsum(pdf) / pdf.sum(), rng.random((place.shape[1], candidates)))
    drawn = np.minimum(drawn, pool.own.size - 1)
    path = pool.place[:, drawn] - place[:, :, None]
    square = np.maximum((path**2).sum(0), 1e-12)
    before = (path * normal[:, :, None]).sum(0)
    towards = -(path * pool.normal[:, drawn]).sum(0)
    form = (
        pool.own[drawn] * np.maximum(before, 0) * np.maximum(towards, 0) / square / (np.pi * square + pool.own[drawn])
    )
    weight = np.cumsum(pool.power[drawn] * form / pdf[drawn], axis=1)
    some = weight[:, -1] > 0
    best = (weight <= rng.random((len(weight), 1)) * weight[:, -1:]).sum(1).clip(max=candidates - 1)[some]
    start, path = place[:, some], path[:, np.nonzero(some)[0], best]
    blocked = room.trace(start + MARGIN * path, (1 - 2 * MARGIN) * path)[0] < 1
    free, along = ~blocked, ((np.arange(steps) + 0.5) / steps)[:, None, None]
    points = (start[:, free] + along * path[:, free]).transpose(1, 0, 2).reshape(3, -1)
    shown = sum(in_frame(view, points).mean() for view in views) if free.any() else 0.0
    return Rays(
        float((before > 0).mean()), float((form > 0).mean()), float(some.mean()), float(blocked.mean()), float(shown)
    )
