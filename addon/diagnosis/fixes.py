# SPDX-License-Identifier: GPL-3.0-or-later
"""What mends a scene at a click, where that is safe: each cure changes one thing that the user can see, and undo takes
it back. checks.py says which scene needs which."""

from dataclasses import dataclass

import bpy

from ..compositor import setup
from ..host import roles


@dataclass(frozen=True)
class Cure:
    """button: its text. tooltip: what else comes of it. apply: a function of Blender's context."""

    button: str
    tooltip: str
    apply: callable


def spare_camera(scene):
    """A camera that the scene could look through, or None: one that is rendered before one that is hidden."""
    cameras = [thing for thing in scene.objects if thing.type == "CAMERA" and thing.data.type in {"PERSP", "ORTHO"}]
    return min(cameras, key=lambda camera: camera.hide_render, default=None)


def probe_volumes(scene):
    """The light probe volumes that EEVEE renders with. The file's few probes are asked first: scenes have many objects,
    and the panel asks at every redraw."""
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
    context.scene.render.engine = "BLENDER_EEVEE"


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


CURES = {
    "REPAIR": Cure(
        "Repair",
        "Put back what Indirect Light needs: the helper scene, the passes and the nodes in the compositor",
        _repair,
    ),
    "ENGINE": Cure(
        "Set Render Engine to EEVEE", "Render this scene with EEVEE. The settings of the other engine are kept", _eevee
    ),
    "CAMERA": Cure("Use a Camera of the Scene", "Look through the first camera that the scene holds", _camera),
    "LENS": Cure(
        "Set Lens Type to Perspective",
        "Make the camera an ordinary one. Its panorama's settings are kept",
        _perspective,
    ),
    "VIEW_LAYER": Cure(
        "Render This View Layer", "Tick Use for Rendering of the view layer that the window shows", _view_layer
    ),
    "STEREO": Cure("Turn Off Stereoscopy", "Render one view, that of the scene's camera", _no_stereo),
    "SINGLE_LAYER": Cure(
        "Render All View Layers",
        "Untick Render Single Layer. The render then takes as long as all view layers that are used",
        _all_layers,
    ),
    "SEQUENCER": Cure(
        "Render the Scene",
        "Untick Sequencer in Output properties > Post Processing. The strips are kept",
        _no_sequencer,
    ),
    "RAY_TRACING": Cure(
        "Turn Off Ray Tracing",
        "Turn off EEVEE's ray tracing, so that bounced light is counted once. Its reflections and refractions go too",
        _no_ray_tracing,
    ),
    "PROBES": Cure(
        "Disable Volumes in Renders", "Leave the light probe volumes out of renders. Their bakes are kept", _no_probes
    ),
    "SHOW_LIT": Cure("Show That Scene", "Show the scene that this one serves to light in this window", _show_lit),
    "RENDER_LAYERS": Cure(
        "Add Render Layers Node",
        "Add a Render Layers node of this scene at the top level of the compositor, so that Blender renders it",
        _render_layers,
    ),
}
