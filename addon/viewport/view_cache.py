# SPDX-License-Identifier: GPL-3.0-or-later
"""The further views of a viewport: those that the last render placed, or the user listed, drawn small and kept on the
GPU. When something in the scene changes they are drawn again, a few at a time."""

import time
from dataclasses import dataclass

import numpy as np
from mathutils import Matrix

from .. import gather
from ..compositor import view_scenes
from ..gather import interactive
from ..host import report
from ..scene import needs, view_cameras
from ..views import main_view, placement, ray_cast
from . import offscreen, scene_changes


@dataclass(eq=False)
class CachedView:
    """A view: its (view matrix, window matrix), what was drawn, gather.Drawn and gather.Camera, and the passes that
    are to be drawn again."""

    matrices: tuple
    drawn: gather.Drawn
    camera: gather.Camera = None
    stale: tuple = offscreen.ALL_PASSES

    def mark_stale(self, names):
        """These passes show the scene as it was."""
        self.stale = tuple(name for name in offscreen.ALL_PASSES if name in (*self.stale, *names))


class ViewCache:
    """Those of one 3D viewport, which may have several regions. film: eevee.Film for pictures of their size."""

    def __init__(self):
        self.offscreen_picture, self._views, self._wanted, self._counts = offscreen.OffscreenPicture(), [], None, None
        self._failed_for = None  # what place() saw where it found no place

    def follow(self, stage):
        """Be the views that the settings ask for, and know which of them show the scene as it was. Returns whether
        they are others."""
        size, pairs, stamps = (
            interactive.coarse_size(stage.size),
            _matrices(stage),
            scene_changes.change_counts(stage.scene),
        )
        wanted = size, stage.shown_state(), *(tuple(matrix.ravel()) for pair in pairs for matrix in pair)
        if wanted == self._wanted:
            for each in self._views:
                each.mark_stale(
                    offscreen.ALL_PASSES
                    if stamps.geometry != self._counts.geometry
                    else offscreen.LIGHT_PASSES
                    if stamps != self._counts
                    else ()
                )
            self._counts = stamps
            return False
        self._wanted, self._counts = wanted, stamps
        self._views = [
            CachedView(tuple(Matrix(matrix.tolist()) for matrix in pair), gather.Drawn(size, {})) for pair in pairs
        ]
        return True

    def place(self, stage, drawn, camera):
        """Where no render has placed views yet, do as the scout of a render would (render/views_engine.py), by what
        the viewport shows: gather.Drawn through gather.Camera. Once for each scene, or again when it has changed where
        there was nothing to light it."""
        scene, settings = stage.scene, stage.scene.afterlight
        if (
            not needs.views(scene)
            or settings.views != "AUTOMATIC"
            or not view_scenes.placement_scene(scene)
            or view_scenes.stored_placement(scene)
        ):
            return
        if self._failed_for == (self._wanted, self._counts):
            return
        start, rng = time.perf_counter(), np.random.default_rng(settings.seed)
        geometry = ray_cast.Geometry(stage.depsgraph)
        shown = main_view.MainView(scene, stage.layer, interactive.read(drawn), camera)
        bounces, seen = shown.trace_paths(placement.PLACEMENT_PATHS, geometry, rng, settings.bounces)
        if bounces is None:  # no surface lights what is shown
            self._failed_for = self._wanted, self._counts
            return
        poses = placement.place(bounces, seen, geometry.cast, view_cameras.HALF_FIELD, settings.view_count, rng)
        shares = placement.coverage(bounces, seen, geometry.cast, view_cameras.HALF_FIELD, poses)
        view_scenes.store_placement(scene, placement.Placement(poses, shares, placement.VIEW_CLEARANCE * bounces.size))
        report.keep_coverage(scene, shares, time.perf_counter() - start)
        self.follow(stage)

    def is_stale(self):
        return any(each.stale for each in self._views)

    def refresh(self, stage, most):
        """Draw at most so many views again. Within eevee.drawing()."""
        for each in sorted(
            [each for each in self._views if each.stale], key=lambda each: len(each.stale), reverse=True
        )[:most]:
            camera = self.offscreen_picture.draw(stage, *each.matrices, each.drawn, each.stale)
            each.camera, each.stale = camera or each.camera, ()

    def views(self):
        """[gather.View] of all that have been drawn."""
        return [gather.View(each.drawn, each.camera, coarse=True) for each in self._views if each.camera]

    def free(self):
        self.offscreen_picture.free()
        self._views.clear()


def _matrices(stage):
    """[(view matrix, window matrix)], (4, 4) float64 each, of the views that the scene's settings ask for."""
    scene, settings = stage.scene, stage.scene.afterlight
    if not needs.views(scene):
        return []
    if settings.views == "MANUAL":
        cameras = [
            each.camera.evaluated_get(stage.depsgraph)
            for each in settings.view_cameras
            if each.camera and not view_scenes.unusable(each.camera)
        ][: needs.MAX_VIEWS]
        found = [
            (np.array(camera.matrix_world.normalized()), view_cameras.lens_of(camera, stage.depsgraph, scene))
            for camera in cameras
        ]
    else:
        placed = view_scenes.stored_placement(scene) if view_scenes.placement_scene(scene) else None
        far = max(
            stage.space.clip_end, scene.camera.data.clip_end if scene.camera and scene.camera.type == "CAMERA" else 0
        )
        found = [
            (np.asarray(pose), view_cameras.wide_lens(scene, placed.clearance / 4, far))
            for pose in (placed.poses[: settings.view_count] if placed else ())
        ]
    return [(np.linalg.inv(pose), view_cameras.window_matrix(lens, scene)) for pose, lens in found]
