# SPDX-License-Identifier: GPL-3.0-or-later
"""What in a scene keeps Afterlight from lighting it, or would light it twice: one list for panel, render and -b."""

from dataclasses import dataclass

import bpy

from . import relight, wiring


@dataclass(frozen=True)
class Finding:
    """text: what is wrong and what to do. fatal: the render goes on without our light. operator, button: what mends
    it at a click; empty where only the user can."""

    text: str
    fatal: bool = True
    operator: str = ""
    button: str = ""


def findings(scene):
    """Everything wrong with `scene`, what matters most first. Reads the scene, changes nothing."""
    render, camera = scene.render, scene.camera
    found = []
    if wiring.is_helper(scene):
        lit = wiring.source(scene)
        return [Finding(f'This scene only serves to light "{lit.name if lit else "another"}". Render that one')]
    if render.engine != "BLENDER_EEVEE" and not relight.is_replayed(scene):
        engine = render.engine.removeprefix("BLENDER_").title()
        found.append(Finding(f"Indirect Light works on EEVEE's passes, and the render engine is {engine}. Set Render "
                             "Engine to EEVEE, or untick Indirect Light"))
    if camera is None:
        found.append(Finding("The scene has no camera. Add one (Add > Camera) and make it the scene's camera"))
    elif camera.type != "CAMERA":
        found.append(Finding(f'The scene looks through "{camera.name}", which is no camera. Choose a camera in the '
                             "Scene properties"))
    elif camera.data.type not in {"PERSP", "ORTHO"}:
        found.append(Finding(f'The camera "{camera.name}" is panoramic. Set its Lens Type to Perspective or '
                             "Orthographic"))
    if not any(layer.use for layer in scene.view_layers):
        found.append(Finding("No view layer is rendered. Tick Use for Rendering in the View Layer properties"))
    if render.use_multiview:
        found.append(Finding("Stereo and multi-view renders are not supported. Untick Stereoscopy in the Output "
                             "properties"))
    if render.use_single_layer:
        found.append(Finding("Render Single Layer is on, and with it Blender leaves out the scene that gathers the "
                             "light. Untick it in the View Layer properties"))
    if render.use_sequencer and scene.sequence_editor and len(scene.sequence_editor.strips):
        found.append(Finding("The Video Sequencer's strips are rendered instead of the scene. Untick Sequencer in "
                             "Output properties > Post Processing, or render the scene without strips"))
    if counts_twice(scene):
        found.append(Finding("EEVEE's ray tracing already adds bounced light: ours would count it twice",
                             operator="afterlight.ray_tracing_off", button="Turn Off Ray Tracing"))
    if scene.afterlight.enabled:
        found += [Finding(text, operator="afterlight.repair", button="Repair") for text in wiring.faults(scene)]
    if _shows_probe_volume(scene):
        found.append(Finding("Light probe volumes hold bounced light once they are baked, and ours comes on top. "
                             "Disable them in renders, or free their bakes", fatal=False))
    return found


def _shows_probe_volume(scene):
    """The file's few light probes are asked first: scenes have many objects, and the panel asks at every redraw."""
    return any(probe.type == "VOLUME" for probe in bpy.data.lightprobes) and any(
        thing.type == "LIGHT_PROBE" and thing.data.type == "VOLUME" and not thing.hide_render
        for thing in scene.objects)


def counts_twice(scene):
    """Whether EEVEE's own bounce is already in its Diffuse Direct pass. Its roughness limit and Fast GI make no
    difference to that (docs/blender.md)."""
    eevee = scene.eevee
    return scene.render.engine == "BLENDER_EEVEE" and eevee.use_raytracing and eevee.indirect_light_intensity > 0
