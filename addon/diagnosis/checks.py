# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a scene, in one list for the panel, the render and the terminal."""

from dataclasses import dataclass

import bpy

from ..compositor import faults
from ..host import engines, render_lock, roles
from ..host.version import VERSION
from ..scene import needs
from ..translations import say
from . import fixes


@dataclass(frozen=True)
class Finding:
    """text: what is wrong and what to do. fix: the name in fixes.FIXES of what corrects it, empty if only the user can.
    fatal: whether the render has no indirect light because of it."""

    text: str
    fix: str = ""
    fatal: bool = True


def findings(scene):
    """Everything that is wrong with `scene`, the most important first. Changes nothing."""
    if roles.is_helper(scene):
        return [_of_helper(scene)]
    if render_lock.is_postponed(scene):
        text = say(
            "Indirect Light was enabled, or a setting that changes its nodes was changed, during a render. It takes "
            "effect in the next render. Scripts should change settings before the render begins"
        )
        return [Finding(text)]
    return [
        *_of_engine(scene),
        *_of_camera(scene),
        *_of_layers(scene),
        *_of_ray_tracing(scene),
        *_of_nodes(scene),
        *_of_probes(scene),
        *_of_version(scene),
    ]


def counts_twice(scene):
    """Whether EEVEE's ray tracing has added indirect light to its Diffuse Direct pass. Its roughness limit and Fast GI
    make no difference to that (docs/blender/rendering.md)."""
    eevee = scene.eevee
    return scene.render.engine == engines.EEVEE and eevee.use_raytracing and eevee.indirect_light_intensity > 0


def holds_reflections(scene):
    """Whether EEVEE's light probes reflect the scene, so that the glossy light would be added twice."""
    return any(probe.type in {"SPHERE", "PLANE"} for probe in bpy.data.lightprobes) and any(
        thing.type == "LIGHT_PROBE" and thing.data.type in {"SPHERE", "PLANE"} and not thing.hide_render
        for thing in scene.objects
    )


def _of_helper(scene):
    lit = roles.lit_scene(scene)
    if lit is None:
        return Finding(
            say("This helper scene's owner was deleted, or it is a copy of a helper scene. You can delete it")
        )
    return Finding(
        say('This is a helper scene of "{}" and cannot be lit itself. Render that scene', lit.name), "SHOW_LIT"
    )


def _of_engine(scene):
    if scene.render.engine not in (engines.EEVEE, engines.REPLAY):
        text = say(
            "Indirect Light needs EEVEE, but the render engine is {}. Set Render Engine to EEVEE, or disable Indirect "
            "Light",
            scene.render.engine.removeprefix("BLENDER_").title(),
        )
        yield Finding(text, "ENGINE")


def _of_camera(scene):
    camera = scene.camera
    if camera is None or camera.type != "CAMERA":
        fix = "CAMERA" if fixes.spare_camera(scene) else ""
        if camera is not None:
            text = say(
                'The scene\'s active camera "{}" is not a camera object. Choose a camera in the Scene properties',
                camera.name,
            )
        elif fix:
            text = say("The scene has no active camera. Choose one in the Scene properties")
        else:
            text = say("The scene has no camera. Add one (Add > Camera) and make it the active camera")
        yield Finding(text, fix)
    elif camera.data.type not in {"PERSP", "ORTHO"}:
        text = say('The camera "{}" is panoramic. Set its Lens Type to Perspective or Orthographic', camera.name)
        yield Finding(text, "LENS" if camera.data.is_editable else "")


def _of_layers(scene):
    """What keeps Blender from rendering the scene as one image through all its view layers."""
    render = scene.render
    if not any(layer.use for layer in scene.view_layers):
        text = say("No view layer is rendered. Enable Use for Rendering in the View Layer properties")
        yield Finding(text, "VIEW_LAYER")
    if render.use_multiview:
        text = say("Stereo and multi-view renders are not supported. Disable Stereoscopy in the Output properties")
        yield Finding(text, "STEREO")
    if render.use_single_layer:
        text = say(
            "With Render Single Layer, Blender does not render the helper scene that computes the light. Disable it in "
            "the View Layer properties"
        )
        yield Finding(text, "SINGLE_LAYER")
    if render.use_sequencer and scene.sequence_editor and len(scene.sequence_editor.strips):
        text = say(
            "The strips of the Video Sequencer are rendered instead of the scene. Disable Sequencer in Output "
            "properties > Post Processing, or remove the strips"
        )
        yield Finding(text, "SEQUENCER")


def _of_ray_tracing(scene):
    if counts_twice(scene):
        text = say("EEVEE's ray tracing already adds indirect light. Disable either ray tracing or Indirect Light")
        yield Finding(text, "RAY_TRACING")


def _of_nodes(scene):
    if scene.afterlight.enabled:
        for text, fix in faults.find(scene).items():
            yield Finding(text, fix)


def _of_probes(scene):
    if fixes.probe_volumes(scene):
        text = say(
            "Light probe volumes add indirect light of their own once they are baked. Disable them in renders, or "
            "delete their baked data"
        )
        yield Finding(text, "PROBES", fatal=False)
    if needs.glossy_light(scene) and holds_reflections(scene):
        text = say(
            "Light probe spheres and planes already reflect the scene, so Glossy Light is left out. Disable them in "
            "renders to use it"
        )
        yield Finding(text, fatal=False)


def _of_version(scene):
    if tuple(scene.afterlight.version) > VERSION:
        text = say(
            "These settings were saved by Afterlight {}, but this is {}. Settings that this version does not know are "
            "kept in the file and have no effect",
            _dotted(scene.afterlight.version),
            _dotted(VERSION),
        )
        yield Finding(text, fatal=False)


def _dotted(version):
    return ".".join(map(str, version))
