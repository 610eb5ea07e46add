# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine of the scene that comes before the views: Blender calls it when EEVEE has finished the lit scene, and
what it does to the cameras of the views holds for the same frame."""

import time
import traceback

import bpy
import numpy as np

from .. import light
from ..translations import say
from . import checks, materials, passes, placement, rays, relight, status, views, wiring
from .status import Problem


class AfterlightScout(bpy.types.RenderEngine):
    bl_idname = views.SCOUT_ENGINE
    bl_label = "Afterlight's views (used by its helper scenes)"
    bl_use_postprocess = True  # without it Blender does not ask engines in Python for scenes of the compositor

    def render(self, depsgraph):
        """Pose the views, or leave them out. There is no picture."""
        scene = wiring.source(depsgraph.scene)
        if scene is None or not views.is_rendered(scene):
            return
        for view in views.scenes(scene):
            views.drop(view)
        if relight.is_replayed(scene):
            return  # the views that were kept with the frame are used again
        if any(finding.fatal for finding in checks.findings(scene)):
            return  # the engine of the light says so
        views.mirror(scene)
        try:
            self._place(scene, depsgraph)
        except Problem as problem:
            self._warn(scene, say(*problem.args))
        except Exception as error:  # a bug of ours must not cost the light of the main view
            traceback.print_exc()
            self._warn(scene, say("Afterlight met an error of its own ({}). The terminal has the details; please "
                                  "report them", error))

    def _place(self, scene, depsgraph):
        if scene.afterlight.views == "AUTOMATIC":
            self._automatic(scene, depsgraph)
            return
        for view, each in zip(views.scenes(scene), scene.afterlight.view_cameras):
            if problem := views.unusable(each.camera):
                self._warn(scene, problem)
                continue
            evaluated = each.camera.evaluated_get(depsgraph)
            views.pose(view, scene, evaluated.matrix_world, views.lens_of(evaluated, depsgraph, scene))

    def _automatic(self, scene, depsgraph):
        start = time.perf_counter()
        camera = scene.camera.evaluated_get(depsgraph)
        picture = Picture(scene, passes.camera(camera, depsgraph, scene))
        geometry = rays.Geometry(depsgraph)
        rng = np.random.default_rng(scene.afterlight.seed)
        found = placement.bounces(*picture.receivers(rng), geometry.cast, picture.radiance_by(geometry, rng), rng)
        if found is None:
            self._warn(scene, say("No views were placed: what the camera sees gets no light from any surface"))
            return
        seen, _, _ = picture.sees(found.places, found.normals)
        half, most = views.half_field(scene), scene.afterlight.view_count
        known = views.placed(scene)
        if known is not None and len(known.poses) <= most:
            covered = placement.coverage(found, seen, geometry.cast, half, known.poses)
            if covered < known.coverage[-1] - placement.FALL:
                known = None
        else:
            known = None
        if known is None:
            old = views.placed(scene)
            known = placement.place(found, seen, geometry.cast, half, most, rng, old.poses if old else ())
            views.keep_placed(scene, known)
            if len(known.poses) == 0 and known.coverage[0] < 0.9:
                self._warn(scene, say("No views were placed: there is no free place for one"))
        lens = views.wide_lens(scene, known.clearance / 4, max(camera.data.clip_end, 100 * found.size))
        for view, pose in zip(views.scenes(scene), known.poses):
            views.pose(view, scene, pose, lens)
        status.covered(scene, known.coverage, time.perf_counter() - start)

    def _warn(self, scene, text):
        if status.warn(scene, text):
            self.report({"WARNING"}, f"Afterlight: {text}")


class Picture:
    """The main view as EEVEE has just finished it, by the first view layer that is rendered."""

    def __init__(self, scene, camera):
        layer = next(layer for layer in scene.view_layers if layer.use)
        path = passes.file_path(scene)
        relight.forget(scene.session_uid)  # its file is written again
        self._frame = passes.load(passes.save(scene), layer.name, passes.window(scene)[0])
        passes.discard(path)
        self._camera, self._sky = camera, materials.sky(layer.world_override or scene.world)

    def receivers(self, rng):
        """(places, normals, albedo) of pixels spread over the picture."""
        frame = self._frame
        flat = placement.pixels((frame.depth > 0) & (frame.depth < light.FARTHEST), rng)
        row, column = np.divmod(flat, frame.size[0])
        places = passes.positions(frame, self._camera, flat)
        normals = np.stack([axis[row, column] for axis in frame.normal], -1).astype(float)
        albedo = np.mean([axis[row, column] for axis in frame.diffuse_color], 0)
        # Off the surface by more than the depth's own precision.
        off = 1e-3 * np.abs(frame.depth[row, column])[:, None]
        return np.nan_to_num(places + off * normals), np.nan_to_num(normals), np.nan_to_num(albedo)

    def sees(self, places, normals):
        """(bool (N,), rows, columns): which of these points of surfaces the picture shows, and where."""
        row, column, depth = passes.project(places, self._frame, self._camera)
        shown = self._frame.depth[row, column]
        toward = self._camera.rotation[2] if self._camera.orthographic else self._camera.position - places
        return (row >= 0) & (depth < 1.01 * shown) & (np.sum(toward * normals, -1) > 0), row, column

    def radiance_by(self, geometry, rng):
        """What placement.bounces() asks: from the picture where it shows the point, else by the lamps and materials."""
        def radiance(places, normals, things):
            albedo, emission = geometry.look(things)
            direct = rays.direct_light(geometry, places, normals, rng) + self._sky
            seen, row, column = self.sees(places, normals)
            for guess, known in ((direct, self._frame.diffuse_direct), (albedo, self._frame.diffuse_color),
                                 (emission, self._frame.emission)):
                shown = np.nan_to_num(np.mean([axis[row, column] for axis in known], 0), posinf=0.0)
                guess[seen] = np.clip(shown[seen], 0, None)
            return direct, albedo, emission
        return radiance


def register():
    bpy.utils.register_class(AfterlightScout)


def unregister():
    bpy.utils.unregister_class(AfterlightScout)
