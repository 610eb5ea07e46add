# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine of the scene that comes before the views: Blender calls it when EEVEE has finished the lit scene, and
what it does to the cameras of the views holds for the same frame."""

import traceback

import bpy

from ..translations import say
from . import checks, status, views, wiring
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
        if scene.afterlight.views == "MANUAL":
            for view, each in zip(views.scenes(scene), scene.afterlight.view_cameras):
                if problem := views.unusable(each.camera):
                    self._warn(scene, problem)
                    continue
                evaluated = each.camera.evaluated_get(depsgraph)
                views.pose(view, scene, evaluated.matrix_world, views.lens_of(evaluated, depsgraph, scene))

    def _warn(self, scene, text):
        if status.warn(scene, text):
            self.report({"WARNING"}, f"Afterlight: {text}")


def register():
    bpy.utils.register_class(AfterlightScout)


def unregister():
    bpy.utils.unregister_class(AfterlightScout)
