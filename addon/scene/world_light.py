# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's light as EEVEE has it in Diffuse Direct: the same for all surfaces that face one way, whatever stands
before them. EEVEE keeps no more of a world than its mean and the way it leans (the first order of spherical
harmonics)."""

import bpy
import numpy as np

from ..gather import images
from . import materials

IMAGE_ROWS = 512  # that a picture of the surroundings is read as, and twice as many columns


def read(depsgraph: bpy.types.Depsgraph, known: dict) -> np.ndarray | None:
    """(4, 3), as gather.gather_views() wants it, of the world of a depsgraph's view layer: one of a single colour, or
    of a picture all around. None where there is no light, or where other nodes decide it.

    known: {}, filled with what pictures give: kept by the caller for as long as no picture changes."""
    world = depsgraph.view_layer.world_override or depsgraph.scene.world
    if world is None:
        return None
    world = world.evaluated_get(depsgraph)
    sky = materials.world_sky(world)
    if sky is None:
        return None
    found = np.zeros((4, 3))
    if sky.image is None:
        found[0] = sky.color
    else:
        found = _of_image(sky, world.sun_threshold, known)
        if found is None:
            return None
    return found if found.any() else None


def _of_image(sky, sun_threshold, known):
    """harmonics() of a sky's picture, turned as it is; None where its colours can't be told."""
    image = sky.image
    key = image.session_uid, *image.size, image.filepath, image.colorspace_settings.name, *sky.color, sun_threshold
    if key not in known:
        # EEVEE makes a sun of what is brighter than its threshold, which then casts shadows and is none of ours.
        found = images.means(image, 2 * IMAGE_ROWS, IMAGE_ROWS, sky.color, sun_threshold)
        known[key] = None if found is None else harmonics(found[..., :3])
    if known[key] is None:
        return None
    mean, lean = known[key][:1], known[key][1:]
    return np.concatenate([mean, sky.to_world @ lean])


def harmonics(radiance: np.ndarray) -> np.ndarray:
    """(4, 3) float64: by how much surroundings light a white surface with normal n, found[0] + n @ found[1:], as
    radiance.

    radiance: (rows, columns, 3), W sr^-1 m^-2, equirectangular, the lowest row first. A lobe of cosines keeps all of
    the mean, and 2/3 of the first order."""
    rows, columns = radiance.shape[:2]
    up = (np.arange(rows) + 0.5) / rows * np.pi - np.pi / 2
    around = np.pi - (np.arange(columns) + 0.5) / columns * 2 * np.pi
    share = np.cos(up) / (np.cos(up).sum() * columns)  # of the sphere, of a pixel in each row
    in_rows = np.einsum("r,rcx->rx", share, radiance)
    leaning = [np.einsum("r,rcx,c->x", share * np.cos(up), radiance, turn(around)) for turn in (np.cos, np.sin)]
    return np.array([in_rows.sum(0), *(2 * each for each in leaning), 2 * np.sin(up) @ in_rows])
