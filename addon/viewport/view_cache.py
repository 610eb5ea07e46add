# SPDX-License-Identifier: GPL-3.0-or-later
"""The views of a viewport: those that the last render placed or the user listed, drawn small and kept on the GPU. When
the scene changes they are drawn again, a few at a time."""

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
    """A view. matrices: (view matrix, window matrix). drawn, camera: gather.GpuPasses and gather.Camera of what was
    drawn. stale: names of the passes that must be drawn again."""

    matrices: tuple
    drawn: gather.GpuPasses
    camera: gather.Camera = None
    stale: tuple = offscreen.ALL_PASSES

    def mark_stale(self, names):
        """These passes must be drawn again."""
        self.stale = tuple(name for name in offscreen.ALL_PASSES if name in (*self.stale, *names))


class ViewCache:
    """The views of one 3D viewport, which may have several regions. offscreen_picture: offscreen.OffscreenPicture of
    their size."""

    def __init__(self):
        self.offscreen_picture, self._views, self._wanted, self._counts = offscreen.OffscreenPicture(), [], None, None
        self._failed_for = None  # the state in which place() found no position

    def follow(self, viewport):
        """Adopt the views that the settings ask for, and mark those stale that show an old state of the scene. Returns
        whether the views themselves have changed."""
        size, pairs = interactive.coarse_size(viewport.size), _matrices(viewport)
        counts = scene_changes.change_counts(viewport.scene)
        wanted = size, viewport.shown_state(), *(tuple(matrix.ravel()) for pair in pairs for matrix in pair)
        if wanted == self._wanted:
            for each in self._views:
                if counts.geometry != self._counts.geometry:
                    each.mark_stale(offscreen.ALL_PASSES)
                elif counts != self._counts:
                    each.mark_stale(offscreen.LIGHT_PASSES)
            self._counts = counts
            return False
        self._wanted, self._counts = wanted, counts
        self._views = [
            CachedView(tuple(Matrix(matrix.tolist()) for matrix in pair), gather.GpuPasses(size, {})) for pair in pairs
        ]
        return True

    def place(self, viewport, drawn, camera):
        """Place views as a render would (render/views_engine.py) if none has done so, by what the viewport shows:
        `drawn`, gather.GpuPasses, seen by gather.Camera. This happens once for each scene, or again after a change if
        nothing lit the image."""
        scene, settings = viewport.scene, viewport.scene.afterlight
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
        geometry = ray_cast.Geometry(viewport.depsgraph)
        main = main_view.MainView(scene, viewport.layer, interactive.read(drawn), camera)
        paths, seen = main.trace_paths(placement.PLACEMENT_PATHS, geometry, rng, settings.bounces)
        if paths is None:  # no surface sends light to what is shown
            self._failed_for = self._wanted, self._counts
            return
        poses = placement.place(paths, seen, geometry.cast, view_cameras.HALF_FIELD, settings.view_count, rng)
        coverage = placement.coverage(paths, seen, geometry.cast, view_cameras.HALF_FIELD, poses)
        view_scenes.store_placement(scene, placement.Placement(poses, coverage, placement.VIEW_CLEARANCE * paths.size))
        report.keep_coverage(scene, coverage, time.perf_counter() - start)
        self.follow(viewport)

    def is_stale(self):
        return any(each.stale for each in self._views)

    def refresh(self, viewport, max_views):
        """Draw at most `max_views` stale views again. Call within offscreen.drawing()."""
        stale_views = [view for view in self._views if view.stale]
        for view in sorted(stale_views, key=lambda view: len(view.stale), reverse=True)[:max_views]:
            camera = self.offscreen_picture.draw(viewport, *view.matrices, view.drawn, view.stale)
            view.camera, view.stale = camera or view.camera, ()

    def views(self):
        """[gather.View] of all views that have been drawn."""
        return [gather.View(each.drawn, each.camera, coarse=True) for each in self._views if each.camera]

    def free(self):
        self.offscreen_picture.free()
        self._views.clear()


def _matrices(viewport):
    """[(view matrix, window matrix)], (4, 4) float64 each, of the views that the scene's settings ask for."""
    scene, settings = viewport.scene, viewport.scene.afterlight
    if not needs.views(scene):
        return []
    if settings.views == "MANUAL":
        cameras = [
            each.camera.evaluated_get(viewport.depsgraph)
            for each in settings.view_cameras
            if each.camera and not view_cameras.unusable(each.camera)
        ][: needs.MAX_VIEWS]
        poses_and_lenses = [
            (np.array(camera.matrix_world.normalized()), view_cameras.lens_of(camera, viewport.depsgraph, scene))
            for camera in cameras
        ]
    else:
        placement_stored = view_scenes.stored_placement(scene) if view_scenes.placement_scene(scene) else None
        clip_end = max(
            viewport.space.clip_end, scene.camera.data.clip_end if scene.camera and scene.camera.type == "CAMERA" else 0
        )
        poses_and_lenses = [
            (np.asarray(pose), view_cameras.wide_lens(scene, placement_stored.clearance / 4, clip_end))
            for pose in (placement_stored.poses[: settings.view_count] if placement_stored else ())
        ]
    return [(np.linalg.inv(pose), view_cameras.window_matrix(lens, scene)) for pose, lens in poses_and_lenses]
