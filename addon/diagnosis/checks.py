# SPDX-License-Identifier: GPL-3.0-or-later
"""What in a scene keeps Afterlight from lighting it, or would light it twice: one list for panel, render and -b."""

from dataclasses import dataclass

import bpy

from .. import properties
from ..compositor import faults
from ..host import engines, render_lock, roles
from ..scene import needs
from ..translations import say
from . import fixes


@dataclass(frozen=True)
class Finding:
    """text: what is wrong and what to do. fatal: the render goes on without our light. cure: what mends it at a click,
    by its name in fixes.py; empty where only the user can."""

    text: str
    cure: str = ""
    fatal: bool = True


def findings(scene):
    """Everything wrong with `scene`, what matters most first. Reads the scene, changes nothing."""
    if roles.is_helper(scene):
        lit = roles.lit_scene(scene)
        if lit is None:
            return [
                Finding(
                    say(
                        "This scene served to light another, or is a copy of one that does. Nothing needs it: it "
                        "can be deleted"
                    )
                )
            ]
        return [Finding(say('This scene only serves to light "{}". Render that one', lit.name), "SHOW_LIT")]
    if render_lock.is_postponed(scene):
        return [
            Finding(
                say(
                    "Indirect Light was ticked, or a setting that changes its nodes was changed, in the middle "
                    "of a render: it "
                    "takes effect with the next one. Scripts should do that before the render begins"
                )
            )
        ]
    found = [*_of_engine(scene), *_of_camera(scene), *_of_layers(scene)]
    if counts_twice(scene):
        found.append(
            Finding(say("EEVEE's ray tracing already adds bounced light: ours would count it twice"), "RAY_TRACING")
        )
    if scene.afterlight.enabled:
        found += [Finding(text, cure) for text, cure in faults.find(scene).items()]
    if fixes.probe_volumes(scene):
        found.append(
            Finding(
                say(
                    "Light probe volumes hold bounced light once they are baked, and ours comes on top. "
                    "Disable them in renders, or free their bakes"
                ),
                "PROBES",
                fatal=False,
            )
        )
    if needs.glossy_light(scene) and holds_reflections(scene):
        found.append(
            Finding(
                say(
                    "Light probe spheres and planes hold reflections of the scene already, so the glossy light is left "
                    "out. Disable them in renders to have it"
                ),
                fatal=False,
            )
        )
    if tuple(scene.afterlight.version) > properties.VERSION:
        found.append(
            Finding(
                say(
                    "These settings were saved by Afterlight {}, and this is {}. What this version does "
                    "not know is kept in the file, but has no effect",
                    _dotted(scene.afterlight.version),
                    _dotted(properties.VERSION),
                ),
                fatal=False,
            )
        )
    return found


def counts_twice(scene):
    """Whether EEVEE's own bounce is already in its Diffuse Direct pass. Its roughness limit and Fast GI make no
    difference to that (docs/blender/rendering.md)."""
    eevee = scene.eevee
    return scene.render.engine == "BLENDER_EEVEE" and eevee.use_raytracing and eevee.indirect_light_intensity > 0


def holds_reflections(scene):
    """Whether EEVEE's light probes reflect the scene: then ours would come on top."""
    return any(probe.type in {"SPHERE", "PLANE"} for probe in bpy.data.lightprobes) and any(
        thing.type == "LIGHT_PROBE" and thing.data.type in {"SPHERE", "PLANE"} and not thing.hide_render
        for thing in scene.objects
    )


def _of_engine(scene):
    if scene.render.engine not in (engines.EEVEE, engines.REPLAY):
        engine = scene.render.engine.removeprefix("BLENDER_").title()
        yield Finding(
            say(
                "Indirect Light works on EEVEE's passes, and the render engine is {}. Set Render Engine to "
                "EEVEE, or untick Indirect Light",
                engine,
            ),
            "ENGINE",
        )


def _of_camera(scene):
    camera = scene.camera
    spare = (
        "CAMERA" if (camera is None or camera.type != "CAMERA") and fixes.spare_camera(scene) else ""
    )  # looks at all objects
    if camera is None:
        yield Finding(
            say("The scene has no camera. Choose one in the Scene properties")
            if spare
            else say("The scene has no camera. Add one (Add > Camera) and make it the scene's camera"),
            spare,
        )
    elif camera.type != "CAMERA":
        yield Finding(
            say(
                'The scene looks through "{}", which is no camera. Choose a camera in the Scene properties', camera.name
            ),
            spare,
        )
    elif camera.data.type not in {"PERSP", "ORTHO"}:
        yield Finding(
            say('The camera "{}" is panoramic. Set its Lens Type to Perspective or Orthographic', camera.name),
            "LENS" if camera.data.is_editable else "",
        )


def _of_layers(scene):
    """What keeps Blender from rendering the scene as one picture through all its view layers."""
    render = scene.render
    if not any(layer.use for layer in scene.view_layers):
        yield Finding(
            say("No view layer is rendered. Tick Use for Rendering in the View Layer properties"), "VIEW_LAYER"
        )
    if render.use_multiview:
        yield Finding(
            say("Stereo and multi-view renders are not supported. Untick Stereoscopy in the Output properties"),
            "STEREO",
        )
    if render.use_single_layer:
        yield Finding(
            say(
                "Render Single Layer is on, and with it Blender leaves out the scene that gathers the light. "
                "Untick it in the View Layer properties"
            ),
            "SINGLE_LAYER",
        )
    if render.use_sequencer and scene.sequence_editor and len(scene.sequence_editor.strips):
        yield Finding(
            say(
                "The Video Sequencer's strips are rendered instead of the scene. Untick Sequencer in Output "
                "properties > Post Processing, or render the scene without strips"
            ),
            "SEQUENCER",
        )


def _dotted(version):
    return ".".join(map(str, version))
