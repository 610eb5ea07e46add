# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixes that are safe to apply at a click: each changes one thing that the user can see, and can be undone. checks.py
says which scene needs which."""

from dataclasses import dataclass

import bpy

from ..compositor import setup
from ..host import engines, roles


@dataclass(frozen=True)
class Fix:
    """button: its text. tooltip: the effects of a click. apply: the function that makes them, of Blender's context."""

    button: str
    tooltip: str
    apply: callable


def spare_camera(scene):
    """A camera that could be the scene's active one, if possible one that is not hidden in renders; None if there is
    none."""
    cameras = [thing for thing in scene.objects if thing.type == "CAMERA" and thing.data.type in {"PERSP", "ORTHO"}]
    return min(cameras, key=lambda camera: camera.hide_render, default=None)


def probe_volumes(scene):
    """The light probe volumes that EEVEE renders with."""
    # Files have few probes and many objects, and the panel asks at every redraw.
    if not any(probe.type == "VOLUME" for probe in bpy.data.lightprobes):
        return []
    return [
        thing
        for thing in scene.objects
        if thing.type == "LIGHT_PROBE" and thing.data.type == "VOLUME" and not thing.hide_render
    ]


def _repair(context):
    setup.connect(context.scene)


def _eevee(context):
    context.scene.render.engine = engines.EEVEE


def _camera(context):
    context.scene.camera = spare_camera(context.scene)


def _perspective(context):
    context.scene.camera.data.type = "PERSP"


def _view_layer(context):
    context.view_layer.use = True


def _no_stereo(context):
    context.scene.render.use_multiview = False


def _all_layers(context):
    context.scene.render.use_single_layer = False


def _no_sequencer(context):
    context.scene.render.use_sequencer = False


def _no_ray_tracing(context):
    context.scene.eevee.use_raytracing = False


def _no_probes(context):
    for volume in probe_volumes(context.scene):
        volume.hide_render = True


def _show_lit(context):
    context.window.scene = roles.lit_scene(context.scene)


def _render_layers(context):
    setup.add_picture(context.scene)


FIXES = {
    "REPAIR": Fix(
        "Repair",
        "Restore the helper scene, passes and compositor nodes that Indirect Light needs",
        _repair,
    ),
    "ENGINE": Fix(
        "Set Render Engine to EEVEE", "Render this scene with EEVEE. The settings of the other engine are kept", _eevee
    ),
    "CAMERA": Fix("Use a Camera of the Scene", "Make the first camera in the scene its active camera", _camera),
    "LENS": Fix(
        "Set Lens Type to Perspective",
        "Make it a perspective camera. Its panorama settings are kept",
        _perspective,
    ),
    "VIEW_LAYER": Fix("Render This View Layer", "Enable Use for Rendering for the active view layer", _view_layer),
    "STEREO": Fix("Turn Off Stereoscopy", "Render a single view, that of the active camera", _no_stereo),
    "SINGLE_LAYER": Fix(
        "Render All View Layers",
        "Disable Render Single Layer. All view layers that are used for rendering are then rendered",
        _all_layers,
    ),
    "SEQUENCER": Fix(
        "Render the Scene",
        "Disable Sequencer in Output properties > Post Processing. The strips are kept",
        _no_sequencer,
    ),
    "RAY_TRACING": Fix(
        "Turn Off Ray Tracing",
        "Disable EEVEE's ray tracing, so that indirect light is not added twice. Its reflections and refractions are "
        "disabled as well",
        _no_ray_tracing,
    ),
    "PROBES": Fix(
        "Disable Volumes in Renders", "Disable the light probe volumes in renders. Their baked data is kept", _no_probes
    ),
    "SHOW_LIT": Fix("Show That Scene", "Show the scene that this helper scene belongs to", _show_lit),
    "RENDER_LAYERS": Fix(
        "Add Render Layers Node",
        "Add a Render Layers node of this scene outside of node groups, so that Blender renders the scene",
        _render_layers,
    ),
}
