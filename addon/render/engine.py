# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine of the helper scene. Blender calls it after the user's scene has been rendered by EEVEE and before
the compositor runs; what it returns is the indirect light of that very frame.

A frame, from passes to picture: update() looks at the scene while Blender keeps it still; render() has the passes saved
(frames.py), loads those of the view layer at hand, gathers (gather/radiosity.py, gather/paper.py) and hands the result
back as the pass Indirect.
"""

import time
from dataclasses import dataclass, field

import bpy
import numpy as np

from .. import gather, parameters
from ..compositor.nodes import GLOSSY_PASS, PASS
from ..diagnosis import checks
from ..host import engines, main_thread, report, roles
from ..host.report import Problem
from ..scene import cameras, frame_store, needs, passes, roughness, transmittance, world_light
from ..translations import say
from . import frames
from . import job as jobs

PROGRESS_INTERVAL = 0.2  # seconds between progress updates, at least: Blender draws its window at each


@dataclass
class Shot:
    """A view layer of a frame: all that its gather needs to know of the scene, and the scene itself."""

    scene: bpy.types.Scene
    layer: str
    window: tuple  # the part of the full frame that is rendered, as cameras.window() has it
    job: jobs.Job
    frame: frames.RenderedFrame | frames.KeptFrame
    problem: str = ""
    unticked: bool = False  # by a script, since the render began
    camera: gather.Camera | None = None
    settings: gather.PaperSettings | gather.RadiositySettings | None = None
    averages: bool = False  # whether frames of an animation are averaged
    glossy: bool = False  # whether the light off glossy surfaces is wanted
    memory: dict = field(default_factory=dict)  # bytes at the fullest moment of the frame, by what they hold

    def spent(self, stage, seconds):
        """Count the time of a stage to the frame's."""
        self.frame.seconds[stage] = self.frame.seconds.get(stage, 0.0) + seconds


class AfterlightEngine(report.Reporter, bpy.types.RenderEngine):
    bl_idname = engines.LIGHT
    bl_label = "Afterlight (used by its helper scenes)"
    bl_use_postprocess = True  # without it Blender does not ask engines in Python for scenes of the compositor
    bl_use_gpu_context = bpy.app.background  # in a window the GPU is taken by turns (main_thread.py)

    is_off = False  # the extension goes: a render that is under way is lit no more
    frame = None  # between its first view layer and its last
    shot = None
    shown = "", 0.0  # the stage of which Blender shows the progress, and since when

    def update_render_passes(self, scene, layer):
        self.register_pass(scene, layer, PASS, 3, "RGB", "COLOR")
        # Asked by what the file says, since Blender asks while it is loaded: a pass that is not offered then loses its
        # links.
        if any(lit.afterlight.helper == scene and needs.glossy_light(lit) for lit in bpy.data.scenes):
            self.register_pass(scene, layer, GLOSSY_PASS, 3, "RGB", "COLOR")

    def update(self, data, depsgraph):
        """Look at the scene: Blender holds the interface off while this runs, so it is short."""
        self.shot = None
        if self.is_off or jobs.is_empty_render():
            return
        scene = roles.lit_scene(depsgraph.scene)
        if scene is None:
            self._fail(
                depsgraph.scene,
                say(
                    "This render engine is only for Afterlight's helper scenes. Set Render Engine to EEVEE and "
                    "enable Indirect Light"
                ),
            )
            return
        job = jobs.current(scene)
        frame = self.frame = self.frame or frames.of(job, scene)
        self.shot = shot = Shot(scene, depsgraph.view_layer.name, cameras.window(scene)[0], job, frame)
        if not scene.afterlight.enabled:
            shot.unticked = True
            return
        shot.problem = next((finding.text for finding in checks.findings(scene) if finding.fatal), "") or frame.problem
        if not shot.problem:
            shot.averages = frame.averages()
            shot.settings = parameters.light_settings(scene.afterlight, frame.number, shot.averages)
            shot.glossy = needs.glossy_light(scene) and not checks.holds_reflections(scene)
            shot.camera = frame.look(self, depsgraph, shot.layer)

    def render(self, depsgraph):
        """Gather, and hand back the pass. Whatever happens the pass is there, black if it must be."""
        shot = self.shot
        if shot is None:
            return
        pictures = {}
        with self.failures_of(shot.scene), main_thread.cancel_when(self.test_break):
            pictures = self._light(shot, depsgraph)
        start = time.perf_counter()
        self._hand_back(shot, pictures)
        shot.spent("hand back", time.perf_counter() - start)
        report.keep_stages(shot.scene, shot.frame.seconds)
        report.keep_memory(shot.scene, shot.memory)

    def render_frame_finish(self):
        """All view layers of the frame have their light."""
        frame, self.frame = self.frame, None
        if frame is not None and not self.is_off:
            frame.done()

    def _light(self, shot, depsgraph):
        """{pass: (H, W, 3) float32, bottom row first}: the light of a view layer, as it reaches the camera."""
        if shot.unticked:
            self._warn(
                shot.scene,
                say(
                    "Indirect Light was disabled during a render. Frames from {} on have no indirect light",
                    shot.scene.frame_current,
                ),
            )
            raise gather.Cancelled
        if shot.problem:
            raise Problem("{}", shot.problem)
        shot.frame.seconds.update(shot.job.view_stages(shot.scene))
        start = time.perf_counter()
        shot.frame.save(
            depsgraph, lambda: self._progress("Saving passes", 0.0), lambda text: self._warn(shot.scene, text)
        )
        if not shot.job.replayed:
            shot.spent("write passes", time.perf_counter() - start)
        views = self._views(shot)
        pictures = self._gather(shot, views, depsgraph)
        return self._let_through(shot, pictures)

    def _views(self, shot):
        """[gather.View]: the main one, and those of the frame."""
        frame, window = shot.frame, shot.window
        main = gather.View(
            lambda: passes.load(frame.path, shot.layer, window, shot.scene.frame_step),
            shot.camera,
            lambda: roughness.specular_passes(frame.path, shot.layer, window),
        )
        shot.memory = {
            "GPU memory": gather.gpu_bytes(
                *window[2:], shot.settings, len(frame.views), shines=shot.glossy, averages=shot.averages
            ),
            "passes file": sum(map(frame_store.size, (frame.path, *(view.path for view in frame.views)))),
        }
        return [main, *(gather.View(view.load, view.camera, view.load_specular) for view in frame.views)]

    def _gather(self, shot, views, depsgraph):
        """{pass: (H, W, 3)}: the light that the surfaces send."""
        start, timed, broken = time.perf_counter(), {} if report.wants_stages else None, {}
        options = {"progress": self._progress, "timings": timed, "broken": broken}
        scene, settings = shot.scene, shot.settings
        if isinstance(settings, gather.RadiositySettings):
            world = world_light.read(depsgraph, shot.job.worlds) if scene.afterlight.use_world_shadow else None
            gloss, history = self._gloss(shot), None
            if shot.averages:
                history = shot.job.histories.before(scene, shot.layer, settings)
            picture = gather.gather_views(views, settings, world, history=history, gloss=gloss, **options)
            if history:
                shot.job.histories.keep(scene, shot.layer, settings, history)
            pictures = {PASS: picture} | ({GLOSSY_PASS: gloss.picture} if gloss else {})
        else:
            pictures = {PASS: gather.gather_indirect(views[0].load_passes(), shot.camera, settings, **options)}
        for stage, seconds in (timed or {"gather on the GPU": time.perf_counter() - start}).items():
            shot.spent(stage, seconds)
        for name, count in broken.items():
            self.report(
                {"WARNING"},
                say(
                    "Afterlight: {} pixels of {} in {} are NaN or infinite and emit no indirect light. Look for a "
                    "material that divides by zero, or a light of infinite strength",
                    count,
                    name.replace("_", " "),
                    shot.layer,
                ),
            )
        return pictures

    def _gloss(self, shot):
        """gather.Gloss of the frame where it is wanted, else None."""
        if not shot.glossy:
            return None
        gloss = roughness.load(shot.frame.path, shot.layer, shot.window)
        if gloss is None:
            self._warn(shot.scene, say("The last render has no passes for Glossy Light. Press F12 to render them"))
        return gloss

    def _let_through(self, shot, pictures):
        """{pass: (H, W, 3)}: the light as it reaches the camera, through what scene/media.py knows of."""
        if not shot.frame.in_front:
            return pictures
        start, scene = time.perf_counter(), shot.scene
        blurred = scene.render.use_motion_blur or scene.camera.data.dof.use_dof
        cell = int(scene.eevee.volumetric_tile_size)
        share = transmittance.load(shot.frame.path, shot.layer, shot.window, cell, blurred)
        if share is not None:
            pictures = {name: picture * share for name, picture in pictures.items()}
        shot.spent("hand back", time.perf_counter() - start)
        return pictures

    def _progress(self, stage, fraction):
        now = time.perf_counter()
        if stage != self.shown[0] or now > self.shown[1] + PROGRESS_INTERVAL:
            self.shown = stage, now
            self.update_stats("Afterlight", f"{say(report.label(stage))}, {fraction:.0%}")
            self.update_progress(fraction)
        return self.test_break()

    def _hand_back(self, shot, pictures):
        """The indirect light into our passes of the layer, by their names; black where there is none."""
        *_, width, height = shot.window
        result = self.begin_result(0, 0, width, height, layer=shot.layer)
        for made in result.layers[0].passes:
            if made.name in (PASS, GLOSSY_PASS):
                picture = pictures.get(made.name)
                if picture is None:
                    picture = np.zeros((result.resolution_y, result.resolution_x, 3), np.float32)
                made.rect.foreach_set(picture.ravel())
        self.end_result(result)


def register():
    AfterlightEngine.is_off = False
    bpy.utils.register_class(AfterlightEngine)


def unregister():
    """A render that is under way is lit no more; Blender crashes if its engine goes before it ends."""
    AfterlightEngine.is_off = True
    main_thread.after_render(_let_go)


def _let_go():
    bpy.utils.unregister_class(AfterlightEngine)
    gather.release()
