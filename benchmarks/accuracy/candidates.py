# SPDX-License-Identifier: GPL-3.0-or-later
"""What is compared with the truth: EEVEE, its ray tracing, Afterlight and short renders by Cycles, of one open file.

Pictures are (H, W, 3) float32, rows top first, linear radiance.
"""

import tempfile
import time
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..cost import bench, shares
from . import references

SAMPLES = Path(__file__).resolve().parents[2] / "sample_blends"

# Nodes that only one of the two engines knows, as Blender's own Add menu has it, and Bevel, which EEVEE passes by.
ONE_ENGINE = {
    "ShaderNodeBsdfHair",
    "ShaderNodeBsdfHairPrincipled",
    "ShaderNodeBsdfRayPortal",
    "ShaderNodeBsdfSheen",
    "ShaderNodeBsdfToon",
    "ShaderNodeScript",
    "ShaderNodeBevel",
    "ShaderNodeEeveeSpecular",
    "ShaderNodeShaderToRGB",
}
# Found by `python -m benchmarks.studies.eevee_study`: what is not named here is at Blender's default.
BEST = {
    "ray_tracing_options.trace_max_roughness": 1.0,
    "ray_tracing_options.screen_trace_thickness": 2.0,
    "ray_tracing_options.resolution_scale": "1",
    "ray_tracing_options.screen_trace_quality": 1.0,
}
STARTUP = {"use_fast_gi": True}  # where Blender's startup file differs from a scene that a script makes
CYCLES_SAMPLES = 1, 4, 16
# Blender's defaults for renders.
DENOISER = {
    "use_denoising": True,
    "denoiser": "OPENIMAGEDENOISE",
    "denoising_input_passes": "RGB_ALBEDO_NORMAL",
    "denoising_prefilter": "ACCURATE",
    "denoising_quality": "HIGH",
}
SEED = 1 << 20  # of these: none that a reference uses
SLOW = 8  # seconds, over which a frame is timed once
COMPILED = 10  # seconds, of which compilation is a small part


def diffuse_samples():
    """Paths of the sample scenes whose surfaces are matt; those that shine have benchmarks/studies/glossy_study.py."""
    from make_samples import DIFFUSE

    return sorted(SAMPLES / f"{name}.blend" for name in DIFFUSE)


def samples():
    """Paths of the sample scenes that `make accuracy` measures: the diffuse ones, and those of all materials."""
    from make_samples import ARTISTS

    return diffuse_samples() + sorted(SAMPLES / "artists" / f"{name}.blend" for name in ARTISTS)


class Unmeasurable(Exception):
    """A file that cannot be measured; the message says why."""


@dataclass
class Plain:
    """What EEVEE alone renders. diffuse: direct diffuse light, albedo included. world: what of it the world sends.
    passes, camera: light.Passes and light.Camera of it."""

    final: np.ndarray
    diffuse: np.ndarray
    world: np.ndarray
    passes: object
    camera: object


@dataclass
class Candidate:
    """One way to render the scene. group: the curve of the plot that it belongs to. mode(scene): a context in which the
    scene is rendered so. bounced(scene, final, plain): `indirect` of the frame just rendered.

    final: what Blender writes. indirect: the diffuse light in it that no lamp sent directly. seconds: of each timed
    frame; host: those of them that are not the graphics card's. failure: why there are none. bounces: for references of
    their own, whose noise counts too.
    """

    name: str
    group: str
    mode: callable
    bounced: callable
    final: np.ndarray = None
    indirect: np.ndarray = None
    seconds: list = field(default_factory=list)
    host: list = field(default_factory=list)
    failure: str = ""
    bounces: int | None = None


def open_scene(path, size, samples, afterlight):
    """The scene of a .blend file as EEVEE alone renders it, at `size`. Raises Unmeasurable."""
    import bpy

    if not Path(path).is_file():
        raise Unmeasurable("there is no such file")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise Unmeasurable(" ".join(str(error).removeprefix("Error: ").split())) from error
    scene = bpy.context.scene
    if scene.library is not None:
        raise Unmeasurable("its scene is linked from another file")
    scene.afterlight.enabled = False
    scene.compositing_node_group = None
    scene.render.compositor_device = (
        "CPU"  # the GPU compositor crashes by itself in long processes (docs/blender/rendering.md)
    )
    scene.render.engine = "BLENDER_EEVEE"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.use_border = False
    scene.eevee.use_raytracing = False
    scene.eevee.taa_render_samples = samples
    scene.render.use_file_extension = False
    image = scene.render.image_settings
    image.media_type, image.file_format = "IMAGE", "OPEN_EXR"
    image.color_mode, image.color_depth, image.exr_codec = "RGBA", "32", "NONE"
    image.color_management = "FOLLOW_SCENE"
    problem = next((finding.text for finding in afterlight.addon.diagnosis.checks.findings(scene) if finding.fatal), "")
    if problem:
        raise Unmeasurable(problem)
    if alone := nodes_of_one_engine():
        raise Unmeasurable(f"only one of EEVEE and Cycles renders what it uses: {', '.join(alone)}")
    if not any(
        instance.object.type in references.SHINES for instance in bpy.context.evaluated_depsgraph_get().object_instances
    ):
        raise Unmeasurable("it shows no mesh")
    layer = references.layer(scene)
    for other in scene.view_layers:
        other.use = other == layer
    for _, switch, _, _ in afterlight.addon.scene.passes.PASSES:
        setattr(layer, switch, True)
    return scene


def nodes_of_one_engine():
    """Labels of ONE_ENGINE's nodes that the open scene renders with."""
    import bpy

    found = set()
    for datablock in bpy.context.evaluated_depsgraph_get().ids:
        if isinstance(datablock, (bpy.types.Material, bpy.types.World, bpy.types.Light)):
            found |= {
                node.bl_label for node in references.nodes_of(datablock.node_tree) if node.bl_idname in ONE_ENGINE
            }
    return sorted(found)


def names_of_ways():
    """Names of all ways to render: EEVEE's, Afterlight's presets, Cycles with few samples and its denoiser."""
    presets = sorted(path.stem for path in (SAMPLES.parent / "addon" / "presets" / "afterlight").glob("*.py"))
    return ["eevee", "tracing", "tracing-best", *presets, *(f"cycles-{samples}" for samples in CYCLES_SAMPLES)]


def ways_of(names, afterlight, bounces):
    """[Candidate], plain EEVEE first, whether it is named or not: the others' costs are ratios to its."""

    def way(name):
        kind, _, samples = name.partition("-")
        if kind == "cycles":
            return denoised(bounces, int(samples))
        return known.get(name) or ticked(afterlight, name)

    known = {
        "eevee": Candidate("EEVEE", "EEVEE", nullcontext, lambda scene, final, plain: plain.world),
        "tracing": Candidate(
            "EEVEE ray tracing, default", "EEVEE ray tracing", lambda scene: traced(scene, {}), traced_diffuse
        ),
        "tracing-best": Candidate(
            "EEVEE ray tracing, best", "EEVEE ray tracing", lambda scene: traced(scene, BEST), traced_diffuse
        ),
    }
    return [way(name) for name in dict.fromkeys(["eevee", *names])]


@contextmanager
def traced(scene, settings):
    """EEVEE's ray tracing as Blender starts with it, but for `settings`, {property below scene.eevee: value}."""
    import bpy

    # property_unset() does nothing to these, and their RNA defaults are not what Blender starts with.
    fresh = bpy.data.scenes.new("Fresh")
    try:
        wanted = {path: fresh.path_resolve(f"eevee.{path}") for path in tracing_settings(fresh.eevee)}
    finally:
        bpy.data.scenes.remove(fresh)
    for path, value in (wanted | STARTUP | settings | {"use_raytracing": True}).items():
        owner, _, name = path.rpartition(".")
        setattr(scene.eevee.path_resolve(owner) if owner else scene.eevee, name, value)
    try:
        yield
    finally:
        scene.eevee.use_raytracing = False


def tracing_settings(eevee):
    """Paths below scene.eevee of all that ray tracing can be told."""
    own = [
        prop.identifier
        for prop in eevee.bl_rna.properties
        if prop.identifier.startswith(("fast_gi", "use_fast_gi", "ray_tracing_method", "indirect_light"))
    ]
    return own + [
        f"ray_tracing_options.{prop.identifier}"
        for prop in eevee.ray_tracing_options.bl_rna.properties
        if prop.type != "POINTER"
    ]


def traced_diffuse(scene, final, plain):
    """EEVEE's bounce lies in its direct diffuse light (docs/blender/rendering.md)."""
    return diffuse(scene) - plain.diffuse + plain.world


def diffuse(scene):
    """Diffuse Direct times Diffuse Color of the finished render by EEVEE."""
    found = references.saved_passes(scene, "Diffuse Direct", "Diffuse Color")
    return found["Diffuse Direct"] * found["Diffuse Color"]


def ticked(afterlight, preset):
    """Afterlight with a preset."""

    @contextmanager
    def mode(scene):
        bench.use_preset(preset, afterlight)
        scene.afterlight.use_glossy = False  # presets leave it as it is
        scene.afterlight.enabled = True
        try:
            yield
        finally:
            scene.afterlight.enabled = False

    return Candidate(
        f"Afterlight, {preset.title()}",
        "Afterlight",
        mode,
        lambda scene, final, plain: final - plain.final + plain.world,
    )


def denoised(bounces, samples):
    """Cycles with few samples and Blender's denoiser as it comes: OpenImageDenoise with albedo and normal. It works on
    the whole picture, so there is no indirect light by itself."""

    @contextmanager
    def mode(scene):
        with references.as_cycles(scene, bounces, samples, SEED):
            before = [(name, getattr(scene.cycles, name)) for name in DENOISER]
            try:
                for name, value in DENOISER.items():
                    setattr(scene.cycles, name, value)
                yield
            finally:
                for name, value in before:
                    setattr(scene.cycles, name, value)

    return Candidate(
        f"Cycles, {samples} sample{'s' * (samples > 1)}, denoised",
        "Cycles, denoised",
        mode,
        lambda scene, final, plain: None,
    )


def render_all(scene, candidates, rounds, afterlight):
    """Fill in the candidates and return Plain. Frames are timed in turn, `rounds` times, so that a busy machine slows
    all alike; a frame that takes over SLOW seconds but once."""
    compile_shaders(scene, candidates)
    plain = None
    for number in range(rounds):
        for candidate in candidates:
            if candidate.failure or (number and candidate.seconds[0] > SLOW):
                continue
            with candidate.mode(scene):
                with shares.clock() as clock:
                    seconds, final = written(scene)
                if scene.afterlight.enabled and scene.afterlight.report:
                    candidate.failure = scene.afterlight.report
                    continue
                candidate.seconds.append(seconds)
                candidate.host.append(seconds - clock.gpu)
                if number == 0:
                    plain = plain or look(scene, final, afterlight)
                    candidate.final, candidate.indirect = final, candidate.bounced(scene, final, plain)
    return plain


def compile_shaders(scene, candidates):
    """Frames of one sample, so that no timed one compiles: that takes seconds. (Cycles on processors compiles nothing.)
    Where such a frame is slow by itself, that hardly shows in the others."""
    import bpy

    samples = scene.eevee.taa_render_samples
    scene.eevee.taa_render_samples = 1
    try:
        for candidate in candidates:
            if candidate.group.startswith("Cycles"):
                continue
            with candidate.mode(scene):
                start = time.perf_counter()
                bpy.ops.render.render(scene=scene.name)
                if time.perf_counter() - start > COMPILED:
                    return
    finally:
        scene.eevee.taa_render_samples = samples


def written(scene):
    """(seconds, picture) of a frame, as Blender writes it to a file: composited, linear."""
    import bpy
    import OpenEXR

    with tempfile.TemporaryDirectory(prefix="afterlight-accuracy-") as folder:
        scene.render.filepath = str(Path(folder) / "frame.exr")
        start = time.perf_counter()
        bpy.ops.render.render(write_still=True, scene=scene.name)
        seconds = time.perf_counter() - start
        with OpenEXR.File(scene.render.filepath) as file:
            return seconds, np.array(file.channels()["RGBA"].pixels[..., :3], np.float32)


def look(scene, final, afterlight):
    """Plain, of the frame that EEVEE has just rendered."""
    import bpy

    passes = afterlight.addon.scene.passes
    path = afterlight.addon.scene.frame_store.save(scene)
    try:
        found = passes.load(path, references.layer(scene).name, afterlight.addon.scene.cameras.window(scene)[0])
    finally:
        afterlight.addon.scene.frame_store.discard(path)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    camera = afterlight.addon.scene.cameras.camera(scene.camera.evaluated_get(depsgraph), depsgraph, scene)
    direct = diffuse(scene)  # before world_light() renders again
    return Plain(final, direct, world_light(scene), found, camera)


def world_light(scene):
    """(H, W, 3): what diffuse surfaces send on of the world's light, as EEVEE has it. A render, where the world
    shines."""
    import bpy

    if not references.world_shines(scene):
        return np.zeros((scene.render.resolution_y, scene.render.resolution_x, 3), np.float32)
    lamps = [lamp for lamp in references.lamps(scene) if not lamp.hide_render]
    try:
        for lamp in lamps:
            lamp.hide_render = True
        bpy.ops.render.render(scene=scene.name)
        return diffuse(scene)
    finally:
        for lamp in lamps:
            lamp.hide_render = False
