# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine of the scene that comes before the views: Blender calls it when EEVEE has finished the lit scene, and
what it does to the cameras of the views holds for the same frame. What it needs of the scene evaluated.py has read."""

import time

import bpy
import numpy as np

from ..compositor import view_scenes
from ..diagnosis import checks
from ..host import engines, main_thread, report, roles
from ..scene import cameras, passes, view_cameras
from ..translations import say
from ..views import main_view, placement
from . import job as jobs


class AfterlightViewsEngine(report.Reporter, bpy.types.RenderEngine):
    bl_idname = engines.VIEWS
    bl_label = "Afterlight's views (used by its helper scenes)"
    bl_use_postprocess = True  # without it Blender does not ask engines in Python for scenes of the compositor

    def render(self, depsgraph):
        """Pose the views, or leave them out. There is no picture."""
        scene = roles.lit_scene(depsgraph.scene)
        if scene is None or not scene.afterlight.enabled:
            return
        job, start = jobs.current(scene), time.perf_counter()
        if not job.renders(scene):
            return
        # Without views the main view is still lit.
        with self.failures_of(scene, self._warn), main_thread.cancel_when(self.test_break):
            job.reuse.begin_frame()
            main_thread.run(lambda: view_scenes.prepare(scene))
            # The views of a kept frame are used again; what keeps all light out, the engine of the light says.
            if job.replayed or any(finding.fatal for finding in checks.findings(scene)):
                return
            self._place(job, scene, depsgraph)
        job.views_placed(scene, time.perf_counter() - start + job.evaluated.seconds)

    def _place(self, job, scene, depsgraph):
        start, evaluated = time.perf_counter(), job.evaluated
        if evaluated.error:
            raise evaluated.error
        if evaluated.geometry is None:  # Afterlight was enabled after the frame had begun
            return
        by_hand = scene.afterlight.views == "MANUAL"
        if by_hand:
            main_thread.run(lambda: self._pose_by_hand(scene, evaluated))
        layer = cameras.first_layer(scene)
        frame = passes.load(job.passes_file(scene), layer.name, cameras.window(scene)[0])
        main = main_view.MainView(scene, layer, frame, evaluated.camera)
        rng, cast = np.random.default_rng(scene.afterlight.seed), evaluated.geometry.cast

        def look(count):
            return main.trace_paths(count, evaluated.geometry, rng, scene.afterlight.bounces)

        paths, seen = look(placement.SCORING_PATHS)
        if paths is None:
            if not by_hand:
                self._warn(scene, say("No views were placed, because no surface adds light to what the camera sees"))
            return
        if by_hand:
            shares = self._score(scene, depsgraph, paths, seen, cast)
        else:
            shares = self._choose(scene, paths, seen, cast, look, rng)
        if evaluated.is_still:
            main_thread.run(lambda: self._leave_out_still(job, scene))
        report.keep_coverage(scene, shares, time.perf_counter() - start + evaluated.seconds)

    def _leave_out_still(self, job, scene):
        """Of the posed views, drop those that would see what they saw in the frame before."""
        for view in view_scenes.rendered_views(scene):
            if job.reuse.recall(view, view_cameras.view_state(view, scene)):
                view.use(False)

    def _pose_by_hand(self, scene, evaluated):
        for view, each, found in zip(view_scenes.views(scene), scene.afterlight.view_cameras, evaluated.by_hand):
            if found is None:
                self._warn(scene, view_cameras.unusable(each.camera))
            else:
                view_cameras.pose(view, scene, *found)

    def _score(self, scene, depsgraph, paths, seen, cast):
        """What the user's own views see: the shares of light as report.keep_coverage() wants them. Useless views are
        left out."""
        shares = [paths.arriving_share(seen)]
        for view, each in zip(view_scenes.views(scene), scene.afterlight.view_cameras):
            if not view.is_used:
                continue
            camera = view_cameras.camera(view, depsgraph, scene)
            frame = cameras.window(scene)[0][2:]
            row, _, depth = cameras.project(paths.positions, frame, camera)
            origins = camera.position
            if camera.orthographic:
                origins = paths.positions + np.outer(depth, camera.rotation[2])
            saw = placement.visible(origins, paths, cast) & (row >= 0)
            if not saw.any():
                self._warn(
                    scene,
                    say(
                        'The view "{}" sees no surface that lights the image and was left out. It may be inside a wall '
                        "or face away. Move it, or remove it from the list",
                        each.camera.name,
                    ),
                )
                main_thread.run(lambda view=view: view.use(False))
                continue
            seen = seen | saw
            shares.append(paths.arriving_share(seen))
        return shares

    def _choose(self, scene, paths, seen, cast, look, rng):
        """Pose the views where they were, as long as they see what they saw, else anew. Returns what _score() does."""
        half_field, count = view_cameras.HALF_FIELD, scene.afterlight.view_count
        placed = view_scenes.stored_placement(scene)
        old = placed.poses if placed else []
        shares = placement.coverage(paths, seen, cast, half_field, old)
        sees_nothing_new = old and shares[-1] <= shares[0]
        if (
            placed is None
            or len(old) > count
            or shares[-1] < placed.coverage[-1] - placement.MAX_COVERAGE_LOSS
            or sees_nothing_new
        ):
            more, more_seen = look(placement.PLACEMENT_PATHS)
            poses = placement.place(more, more_seen, cast, half_field, count, rng, old) if more else []
            shares = placement.coverage(paths, seen, cast, half_field, poses)
            placed = placement.Placement(poses, shares, placement.VIEW_CLEARANCE * paths.size)
            main_thread.run(lambda: view_scenes.store_placement(scene, placed))
            if not poses and shares[0] < 1 - placement.MAX_COVERAGE_LOSS:
                self._warn(scene, say("No views were placed, because no free position shows more than the camera does"))
        far = max(scene.camera.data.clip_end, 100 * paths.size)
        lens = view_cameras.wide_lens(scene, placed.clearance / 4, far)
        main_thread.run(
            lambda: [
                view_cameras.pose(view, scene, pose, lens) for view, pose in zip(view_scenes.views(scene), placed.poses)
            ]
        )
        return shares


def register():
    bpy.utils.register_class(AfterlightViewsEngine)


def unregister():
    """When the render ends, if one is under way: Blender frees the engines of all renders when any engine's class
    goes."""
    main_thread.after_render(lambda: bpy.utils.unregister_class(AfterlightViewsEngine))
