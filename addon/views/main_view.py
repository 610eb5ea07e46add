# SPDX-License-Identifier: GPL-3.0-or-later
"""The main view as EEVEE has it: which of its points get light, and what it knows of the surfaces that send some."""

import numpy as np

from .. import gather
from ..scene import cameras, materials
from . import placement, ray_cast


class MainView:
    """frame: gather.Passes of a view layer of `scene`, seen by gather.Camera."""

    def __init__(self, scene, layer, frame, camera):
        self._passes, self._camera, self._sky = (
            frame,
            camera,
            materials.mean_radiance(layer.world_override or scene.world),
        )
        self._occluder_weight = self._sky if scene.afterlight.use_world_shadow else 0.0

    def receivers(self, count, rng):
        """(places, normals, albedo) of `count` pixels spread over the picture."""
        frame = self._passes
        flat = placement.sample_pixels((frame.depth > 0) & (frame.depth < gather.FARTHEST), count, rng)
        row, column = np.divmod(flat, frame.size[0])
        places = cameras.positions(frame, self._camera, flat)
        normals = np.stack([axis[row, column] for axis in frame.normal], -1).astype(float)
        albedo = np.mean([axis[row, column] for axis in frame.diffuse_color], 0)
        # Off the surface by more than the depth's own precision.
        off = 1e-3 * np.abs(frame.depth[row, column])[:, None]
        return np.nan_to_num(places + off * normals), np.nan_to_num(normals), np.nan_to_num(albedo)

    def find_pixels(self, places, normals):
        """(bool (N,), rows, columns): which of these points of surfaces the picture shows, and where."""
        row, column, depth = cameras.project(places, self._passes.size, self._camera)
        shown = self._passes.depth[row, column]
        toward = self._camera.rotation[2] if self._camera.orthographic else self._camera.position - places
        return (row >= 0) & (depth < 1.01 * shown) & (np.sum(toward * normals, -1) > 0), row, column

    def trace_paths(self, count, geometry, rng, bounces):
        """(placement.Bounces of so many paths, or None, which of their points the picture shows)."""
        found = placement.trace(
            *self.receivers(count, rng), geometry.cast, self.radiance_function(geometry, rng), rng, bounces
        )
        return found, found and self.find_pixels(found.positions, found.normals)[0]

    def radiance_function(self, geometry, rng):
        """What placement.bounces() asks: from the picture where it shows the point, else by the lamps and materials."""

        def radiance(places, normals, things):
            albedo, emission = geometry.albedo_and_emission(things)
            seen, row, column = self.find_pixels(places, normals)
            direct = np.full(len(places), self._sky)
            direct[~seen] += ray_cast.direct_light(geometry, places[~seen], normals[~seen], rng)
            for guess, known in (
                (direct, self._passes.diffuse_direct),
                (albedo, self._passes.diffuse_color),
                (emission, self._passes.emission),
            ):
                shown = np.nan_to_num(np.mean([axis[row, column] for axis in known], 0), posinf=0.0)
                guess[seen] = np.clip(shown[seen], 0, None)
            # What stands before the world takes its light away, and must be seen as much as what sends some.
            return direct, albedo, emission + self._occluder_weight

        return radiance
