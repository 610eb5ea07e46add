# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's light as EEVEE includes it in Diffuse Direct: without shadows, so that it depends on the normal only.
EEVEE keeps only the mean of a world and its first-order spherical harmonics."""

import bpy
import numpy as np

from ..gather import images
from . import materials

IMAGE_ROWS = 512  # rows that an environment texture is reduced to, with twice as many columns


def read(depsgraph: bpy.types.Depsgraph, cache: dict) -> np.ndarray | None:
    """(4, 3), as gather.gather_views() takes it: harmonics() of the world of a depsgraph's view layer, if it is of one
    colour or an environment texture. None if there is no light, or other nodes decide it.

    cache: a dict, {} at first, filled with the results of images; the caller keeps it for as long as no image
    changes."""
    world = depsgraph.view_layer.world_override or depsgraph.scene.world
    if world is None:
        return None
    world = world.evaluated_get(depsgraph)
    sky = materials.world_sky(world)
    if sky is None:
        return None
    result = np.zeros((4, 3))
    if sky.image is None:
        result[0] = sky.color
    else:
        result = _of_image(sky, world.sun_threshold, cache)
        if result is None:
            return None
    return result if result.any() else None


def _of_image(sky, sun_threshold, cache):
    """harmonics() of a sky's image, rotated like the sky; None if its pixels can't be read."""
    image = sky.image
    key = image.session_uid, *image.size, image.filepath, image.colorspace_settings.name, *sky.color, sun_threshold
    if key not in cache:
        # EEVEE turns what is brighter than its threshold into a sun, which casts shadows and is not included here.
        pixels = images.means(image, 2 * IMAGE_ROWS, IMAGE_ROWS, sky.color, sun_threshold)
        cache[key] = None if pixels is None else harmonics(pixels[..., :3])
    if cache[key] is None:
        return None
    mean, lean = cache[key][:1], cache[key][1:]
    return np.concatenate([mean, sky.to_world @ lean])


def harmonics(radiance: np.ndarray) -> np.ndarray:
    """(4, 3) float64, result: the surroundings light a white diffuse surface with normal n to a radiance of result[0] +
    n @ result[1:].

    radiance: (rows, columns, 3), W sr^-1 m^-2, equirectangular, bottom row first. A cosine lobe keeps all of the mean,
    and 2/3 of the first order."""
    rows, columns = radiance.shape[:2]
    up = (np.arange(rows) + 0.5) / rows * np.pi - np.pi / 2
    around = np.pi - (np.arange(columns) + 0.5) / columns * 2 * np.pi
    share = np.cos(up) / (np.cos(up).sum() * columns)  # of the sphere, of a pixel in each row
    in_rows = np.einsum("r,rcx->rx", share, radiance)
    leaning = [np.einsum("r,rcx,c->x", share * np.cos(up), radiance, function(around)) for function in (np.cos, np.sin)]
    return np.array([in_rows.sum(0), *(2 * each for each in leaning), 2 * np.sin(up) @ in_rows])
