# SPDX-License-Identifier: GPL-3.0-or-later
"""The main view's finished passes: points on surfaces that receive light, and what the image tells of those that send
it."""

import numpy as np

from .. import gather
from ..scene import cameras, materials
from . import placement, ray_cast

DEPTH_TOLERANCE = 1.01  # factor on a pixel's depth, up to which a point counts as visible; chosen by eye
SURFACE_OFFSET = 1e-3  # of a point off its surface, as a share of its depth: above the depth's precision; chosen by eye


class MainView:
    """passes: gather.Passes of a view layer of `scene`, as seen by gather.Camera."""

    def __init__(self, scene, layer, passes, camera):
        self._passes, self._camera = passes, camera
        self._sky = materials.mean_radiance(layer.world_override or scene.world)
        self._occluder_weight = self._sky if scene.afterlight.use_world_shadow else 0.0

    def receivers(self, count, rng):
        """(positions (N, 3), normals (N, 3), albedo (N,)) of at most `count` pixels spread over the image."""
        passes = self._passes
        pixels = placement.sample_pixels((passes.depth > 0) & (passes.depth < gather.FARTHEST), count, rng)
        row, column = np.divmod(pixels, passes.size[0])
        positions = cameras.positions(passes, self._camera, pixels)
        normals = np.stack([axis[row, column] for axis in passes.normal], -1).astype(float)
        albedo = np.mean([axis[row, column] for axis in passes.diffuse_color], 0)
        offset = SURFACE_OFFSET * np.abs(passes.depth[row, column])[:, None]
        return np.nan_to_num(positions + offset * normals), np.nan_to_num(normals), np.nan_to_num(albedo)

    def find_pixels(self, positions, normals):
        """(bool (N,), rows, columns): which of these points on surfaces the image shows, and at which pixels."""
        row, column, depth = cameras.project(positions, self._passes.size, self._camera)
        depth_there = self._passes.depth[row, column]
        to_camera = self._camera.rotation[2] if self._camera.orthographic else self._camera.position - positions
        return (row >= 0) & (depth < DEPTH_TOLERANCE * depth_there) & (np.sum(to_camera * normals, -1) > 0), row, column

    def trace_paths(self, count, geometry, rng, bounces):
        """(placement.LightPaths of `count` paths, or None if there is no light; bool (N,), which of their points the
        image shows)."""
        light_paths = placement.trace(
            *self.receivers(count, rng), geometry.cast, self.radiance_function(geometry, rng), rng, bounces
        )
        return light_paths, light_paths and self.find_pixels(light_paths.positions, light_paths.normals)[0]

    def radiance_function(self, geometry, rng):
        """The radiance() that placement.trace() calls: read from the image where it shows the point, else estimated
        from lamps and materials."""

        def radiance(positions, normals, hit_materials):
            albedo, emission = geometry.albedo_and_emission(hit_materials)
            is_shown, row, column = self.find_pixels(positions, normals)
            direct = np.full(len(positions), self._sky)
            direct[~is_shown] += ray_cast.direct_light(geometry, positions[~is_shown], normals[~is_shown], rng)
            for values, rendered in (
                (direct, self._passes.diffuse_direct),
                (albedo, self._passes.diffuse_color),
                (emission, self._passes.emission),
            ):
                pixel_values = np.nan_to_num(np.mean([axis[row, column] for axis in rendered], 0), posinf=0.0)
                values[is_shown] = np.clip(pixel_values[is_shown], 0, None)
            # Occluders of the world take its light away: views must see them as well as they see emitters.
            return direct, albedo, emission + self._occluder_weight

        return radiance
