# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine of the helper scene. Blender calls it after the user's scene has been rendered by EEVEE and before
the compositor runs; what it returns is the indirect light of that very frame.

A frame, from passes to picture: update() looks at the scene while Blender keeps it still; render() saves the passes,
loads those of the view layer at hand, gathers (gather/paper.py) and hands the result back as the pass Indirect. Where
a frame is lit again (relight.py), the scene itself has this engine for a moment and hands EEVEE's passes back.
"""

import time
from dataclasses import dataclass, field

import bpy
import numpy as np

from .. import gather, properties
from ..compositor import setup, view_scenes
from ..compositor.nodes import GLOSSY_PASS, PASS
from ..compositor.setup import ENGINE
from ..diagnosis import checks
from ..host import main_thread, report, roles
from ..host.report import Problem
from ..scene import animation, media, passes, roughness, transmittance, world_light
from ..translations import say
from . import histories, relight

TELL = 0.2  # seconds between two words on progress: Blender draws its window at each


@dataclass
class Shot:
    """What a frame of one view layer needs to know of the scene, and the scene itself."""

    scene: bpy.types.Scene
    layer: str
    window: tuple
    again: relight.Kept = None  # the frame whose light is gathered again, where that is what goes on
    view_scenes: int = 0  # how many the settings ask for
    camera: gather.Camera = None
    properties: gather.Settings = None
    goes_on: bool = False  # whether frames of an animation are averaged
    problem: str = ""
    unticked: bool = False  # by a script, since the render began
    shines: bool = False  # whether the light off glossy surfaces is wanted
    in_front: bool = False  # whether something may take of the light on its way (media.py)
    seconds: dict = field(default_factory=dict)  # by stage, over the frame's view layers so far
    memory: dict = field(default_factory=dict)  # bytes at the fullest moment of the frame, by what they hold

    def spent(self, stage, seconds):
        self.seconds[stage] = self.seconds.get(stage, 0.0) + seconds


class AfterlightEngine(report.Reporter, bpy.types.RenderEngine):
    bl_idname = ENGINE
    bl_label = "Afterlight (used by its helper scenes)"
    bl_use_postprocess = True  # without it Blender does not ask engines in Python for scenes of the compositor
    bl_use_gpu_context = bpy.app.background  # in a window the GPU is taken by turns (main_thread.py)

    idle = False  # render nothing: handlers.py has a use for an empty render
    shot = None
    view_scenes = ()  # what views.save() gave for the frame
    told = "", 0.0  # stage that Blender shows, and since when
    file = ""  # the saved passes of the frame, between its first view layer and its last

    def update_render_passes(self, scene, layer):
        if relight.is_replayed(scene):
            relight.register_passes(self, scene, layer)
            return
        self.register_pass(scene, layer, PASS, 3, "RGB", "COLOR")
        # Asked by what the file says, since Blender asks while it is loaded: a pass that is not offered then loses its
        # links.
        if any(lit.afterlight.helper == scene and setup.wants_gloss(lit) for lit in bpy.data.scenes):
            self.register_pass(scene, layer, GLOSSY_PASS, 3, "RGB", "COLOR")

    def update(self, data, depsgraph):
        """Look at the scene: Blender holds the interface off while this runs, so it is short."""
        before, self.shot = self.shot, None
        if self.idle or relight.is_replayed(depsgraph.scene):
            return
        source = roles.source(depsgraph.scene)
        if source is None:
            self._fail(
                depsgraph.scene,
                say(
                    "This render engine is only for Afterlight's helper scenes. Set Render Engine to EEVEE and enable "
                    "Indirect Light"
                ),
            )
            return
        again = relight.kept(source) if relight.is_replayed(source) else None
        self.shot = shot = Shot(
            source, depsgraph.view_layer.name, passes.window(source)[0], again, view_scenes.wanted(source)
        )
        if before and (self.file or again):  # another view layer of the same frame
            shot.seconds = before.seconds
        if not source.afterlight.enabled:
            shot.unticked = True
            return
        shot.problem = next((finding.text for finding in checks.findings(source) if finding.fatal), "")
        if again and not shot.problem:
            shot.problem = report.message(source)  # EEVEE's passes could not be handed back: there is nothing to light
        if not shot.problem:
            frame = again.frame if again else source.frame_current
            shot.goes_on = not again and histories.goes_on(source)
            shot.settings = properties.light_settings(source.afterlight, frame, shot.goes_on)
            shot.shines = setup.wants_gloss(source) and not checks.holds_reflections(source)
            shot.in_front = again.in_front if again else media.present(source)
            shot.camera = again.camera if again else self._look(depsgraph, source, shot.layer)

    def render(self, depsgraph):
        """Gather, and hand back the pass. Whatever happens the pass is there, black if it must be."""
        shot, scene = self.shot, depsgraph.scene
        if shot is None:
            if relight.is_replayed(scene):
                self._attempt(scene, lambda: relight.replay(self, scene, depsgraph.view_layer.name))
            return
        pictures = self._attempt(shot.scene, lambda: self._gather(shot, depsgraph)) or {}
        start = time.perf_counter()
        self._hand_back(shot, pictures)
        shot.spent("hand back", time.perf_counter() - start)
        report.timed(shot.scene, shot.seconds)
        report.took(shot.scene, shot.memory)

    def _attempt(self, scene, work):
        """work(), or None where it fails: then `scene`'s report says why."""
        try:
            with main_thread.until(self.test_break):
                return work()
        except gather.Cancelled:
            pass
        except (Problem, gather.GpuUnavailable) as problem:
            self._fail(scene, say(*problem.args))
        except Exception as error:  # a bug of ours must not cost a picture, nor pass for success on a farm
            report.tell_traceback()
            self._fail(
                scene,
                say("Internal error in Afterlight ({}). Please report it with the details in the terminal", error),
            )

    def render_frame_finish(self):
        """All view layers of the frame are done: their passes are kept, to be lit again."""
        if self.file and self.shot and self.shot.camera:
            relight.keep(self.shot.scene, self.file, self.shot.camera, self.views, self.shot.views, self.shot.in_front)
        elif self.file:
            for path in (self.file, *(view.path for view in self.views)):
                passes.discard(path)
        self.file, self.views = "", ()

    def _look(self, depsgraph, source, layer):
        """gather.Camera of the frame's view layer. `source`'s camera is evaluated through our own depsgraph, with
        nothing else of the scene but what moves the camera."""
        helper, render = depsgraph.scene, source.render
        same_time = (helper.render.frame_map_old, helper.render.frame_map_new, helper.frame_subframe) == (
            render.frame_map_old,
            render.frame_map_new,
            source.frame_subframe,
        )
        if helper.camera == source.camera and same_time:
            return passes.camera(source.camera.evaluated_get(depsgraph), depsgraph, source, layer)
        own = helper.camera

        def set_up():
            helper.render.frame_map_old, helper.render.frame_map_new = render.frame_map_old, render.frame_map_new
            helper.camera = source.camera

        main_thread.surely(set_up)
        try:
            self.frame_set(source.frame_current, source.frame_subframe)
            return passes.camera(source.camera.evaluated_get(depsgraph), depsgraph, source, layer)
        finally:
            main_thread.surely(lambda: setattr(helper, "camera", own))

    def _gather(self, shot, depsgraph):
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
        shot.seconds |= report.views_stages(shot.scene)
        start = time.perf_counter()
        if not self.file and not shot.again:  # the first view layer of the frame saves the passes of all
            if self._progress("Saving passes", 0.0):
                raise gather.Cancelled
            relight.forget(shot.scene.session_uid, but=animation.files())
            self.file = passes.save_once(shot.scene)
            self.views = view_scenes.save(shot.scene, depsgraph, lambda text: self._warn(shot.scene, text))
            shot.spent("write passes", time.perf_counter() - start)
        path = shot.again.path if shot.again else self.file
        main = gather.View(
            lambda: passes.load(path, shot.layer, shot.window, shot.scene.frame_step),
            shot.camera,
            lambda: roughness.shine(path, shot.layer, shot.window),
        )
        saved = shot.again.views if shot.again else self.views
        if shot.again and shot.views > shot.again.wanted:
            self._warn(
                shot.scene,
                say(
                    "The last render had {} further views, but the settings now have {}. Press F12 to render all of "
                    "them",
                    len(saved),
                    shot.views,
                ),
            )
        further = [gather.View(view.load, view.camera, view.shine) for view in saved]
        shot.memory = {
            "GPU memory": gather.gpu_bytes(
                *shot.window[2:], shot.settings, len(further), shines=shot.shines, averages=shot.goes_on
            ),
            "passes file": sum(map(passes.size, (path, *(view.path for view in saved)))),
        }
        start = time.perf_counter()
        timed, broken = {} if report.wants_stages else None, {}
        options = {"progress": self._progress, "timings": timed, "broken": broken}
        if isinstance(shot.settings, gather.Draws):
            sky = world_light.light(depsgraph) if shot.scene.afterlight.use_world_shadow else None
            gloss = self._gloss(shot, path)
            past = histories.before(shot.scene, shot.layer, shot.settings) if shot.goes_on else None
            picture = gather.gather_views([main, *further], shot.settings, sky, history=past, gloss=gloss, **options)
            if past:
                histories.keep(shot.scene, shot.layer, shot.settings, past)
            picture = {PASS: picture} | ({GLOSSY_PASS: gloss.picture} if gloss else {})
        else:
            picture = {PASS: gather.gather_indirect(main.passes, shot.camera, shot.settings, **options)}
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
        picture = self._let_through(shot, path, picture)
        for stage, seconds in (timed or {"gather on the GPU": time.perf_counter() - start}).items():
            shot.spent(stage, seconds)
        return picture

    def _gloss(self, shot, path):
        """gather.Gloss of the frame where it is wanted, else None."""
        if not shot.shines:
            return None
        gloss = roughness.load(path, shot.layer, shot.window)
        if gloss is None:
            self._warn(shot.scene, say("The last render has no passes for Glossy Light. Press F12 to render them"))
        return gloss

    def _let_through(self, shot, path, pictures):
        """{pass: (H, W, 3)}: the light as it reaches the camera, through what media.py knows of."""
        if not shot.in_front:
            return pictures
        start, scene = time.perf_counter(), shot.scene
        blurred = scene.render.use_motion_blur or scene.camera.data.dof.use_dof
        share = transmittance.load(path, shot.layer, shot.window, int(scene.eevee.volumetric_tile_size), blurred)
        if share is not None:
            pictures = {name: picture * share for name, picture in pictures.items()}
        shot.spent("hand back", time.perf_counter() - start)
        return pictures

    def _progress(self, stage, fraction):
        now = time.perf_counter()
        if stage != self.told[0] or now > self.told[1] + TELL:
            self.told = stage, now
            self._tell(f"{say(report.in_words(stage))}, {fraction:.0%}", fraction)
        return self.test_break()

    def _tell(self, text, fraction):
        self.update_stats("Afterlight", text)
        self.update_progress(fraction)

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
    AfterlightEngine.idle = False
    bpy.utils.register_class(AfterlightEngine)


def unregister():
    """A render that is under way is lit no more; Blender crashes if its engine goes before it ends."""
    AfterlightEngine.idle = True
    main_thread.after_render(_let_go)


def _let_go():
    bpy.utils.unregister_class(AfterlightEngine)
    gather.release()
