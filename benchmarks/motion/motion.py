# SPDX-License-Identifier: GPL-3.0-or-later
"""How true and how calm bounced light is in moving shots: error, flicker, lag and trails beside EEVEE's and those of
Cycles with few samples and its denoiser, and against Cycles with many.

    .venv/bin/python -m benchmarks.motion [SHOT or FILE.blend ...] [--ways eevee,production,production+history,cycles-4]
    [--frames 1-24]
        [--page FILE.md] [--sheet FILE.webp] [--sheet-frame 13] [--farm]

Each way renders all frames in one job, `bpy.ops.render.render(animation=True)`, to files, as a user does: what
Afterlight keeps from frame to frame lives no longer. The truth is Cycles with four diffuse bounces, frame by frame, in
two independent halves, kept in build/references. EEVEE's direct light is the same to the last bit in all of
Afterlight's ways and in plain EEVEE, so shadows that move take no part: what differs is the bounce. A denoiser works on
the whole picture, so Cycles with few samples has no indirect light by itself, and its whole error counts as the
light's. The whole pictures of all ways are compared besides, as the screen shows them. Exit code 1 where a way could
not be rendered."""

import argparse
import shlex
import sys
import tempfile
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import session
from clip import frame_range
from make_samples import MOVING as SHOTS

from .. import ROOT
from ..accuracy import accuracy, candidates, denoise, references
from . import motion_measures, motion_pictures, motion_report

FOLDER = ROOT / "sample_blends" / "moving"
RIVALS = tuple(f"cycles-{samples}" for samples in candidates.CYCLES_SAMPLES)
ALONE = "eevee", "tracing", "tracing-best", *RIVALS  # the ways without Afterlight
WAYS = "eevee", "tracing-best", "production", "production+history", *RIVALS  # those that are measured unless told
BOUNCES = 4


@dataclass
class Way:
    """One way to render a shot. mode(scene): a context. traced: its bounce lies in Diffuse Direct, where EEVEE puts
    its own; otherwise in the picture. whole: the error of its whole picture is its light's. without: the name of the
    same way without history."""

    name: str
    mode: callable
    traced: bool = False
    whole: bool = False
    without: str = ""


def ways_of(names, afterlight, accumulate=None):
    """[Way] by the names that --ways takes."""
    return [alone(name, afterlight) if name in ALONE else lit(afterlight, name, accumulate) for name in names]


def alone(name, afterlight):
    """One of accuracy's ways without Afterlight."""
    way = candidates.ways_of([name], afterlight, BOUNCES)[-1]
    return rival(way) if name in RIVALS else Way(way.name, way.mode, traced=way.group == "EEVEE ray tracing")


def rival(denoised):
    """Cycles with few samples and Blender's denoiser, another noise in every frame, as animators set it: noise that
    stays on the screen while the scene moves looks like dirt on the lens."""

    @contextmanager
    def mode(scene):
        with denoised.mode(scene):
            scene.cycles.use_animated_seed = True  # put back by references.as_cycles(), which switches it off
            yield

    return Way(denoised.name, mode, whole=True)


def lit(afterlight, name, accumulate=None):
    """Afterlight by PRESET or PRESET+history. Both draw anew in every frame, so that what flickers is noise."""
    preset, _, history = name.partition("+")
    title = f"Afterlight, {preset.title()}"
    ticked = candidates.ticked(afterlight, preset)

    @contextmanager
    def mode(scene):
        with ticked.mode(scene):
            settings = scene.afterlight
            settings.use_animated_seed = True
            if hasattr(settings, "use_history"):
                settings.use_history = bool(history)
            elif history:
                raise candidates.Unmeasurable(
                    "this version of Afterlight has no scene.afterlight.use_history to switch on"
                )
            if accumulate is not None:
                settings.accumulate = accumulate
            yield

    return Way(f"{title} with history" if history else title, mode, without=title if history else "")


def opened(path, options, afterlight):
    """The shot's scene as EEVEE alone renders it, the frames of `options` its range."""
    scene = candidates.open_scene(path, options.size, options.samples, afterlight)
    if options.frames:
        scene.frame_start, scene.frame_end = options.frames
    if scene.frame_end <= scene.frame_start:
        raise candidates.Unmeasurable("it has but one frame")
    return scene


def job(scene, layers=False):
    """(seconds, [{channel or pass: array} of each frame]): the scene's frames, rendered in one go. layers: all passes
    and not the composited picture, which is "RGBA"."""
    import bpy

    image = scene.render.image_settings
    if layers:
        image.media_type = "MULTI_LAYER_IMAGE"
    else:
        image.media_type, image.file_format = "IMAGE", "OPEN_EXR"
    image.color_depth, image.exr_codec = "32", "ZIP"
    with tempfile.TemporaryDirectory(prefix="afterlight-motion-") as folder:
        scene.render.filepath = str(Path(folder) / "frame_####.exr")
        scene.frame_set(scene.frame_end)  # an animation that begins at the current frame passes for F12 in its first
        start = time.perf_counter()
        bpy.ops.render.render(animation=True, scene=scene.name)
        seconds = time.perf_counter() - start
        if scene.afterlight.enabled and scene.afterlight.report:
            raise candidates.Unmeasurable(scene.afterlight.report)
        return seconds, [read(path) for path in sorted(Path(folder).iterdir())]


def read(path):
    """{pass without its layer's name: (H, W, 1 to 4) float32} of an EXR file, or {"Combined": ...} of a picture."""
    import OpenEXR

    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = {name: channel.pixels for part in file.parts for name, channel in part.channels.items()}
    found = {}
    for axes in ("RGB", "XYZW", "XYZ", "Z"):
        for name in {name.rpartition(".")[0] for name in channels}:
            parts = [f"{name}.{axis}" if name else axis for axis in axes]
            if all(part in channels for part in parts):
                found.setdefault(
                    name.rpartition(".")[2] or "Combined", np.stack([channels[part] for part in parts], -1)
                )
    return found


def surface(frame):
    """motion_measures.Surface of a frame with all passes."""
    return motion_measures.Surface(frame["Vector"], frame["Depth"][..., 0], frame["Diffuse Color"], frame["Normal"])


def picture(frame):
    return frame["Combined"][..., :3]


def diffuse(frame):
    return frame["Diffuse Direct"] * frame["Diffuse Color"]


def truth(scene, path, samples):
    """Three arrays float32 by Cycles: the indirect light and the whole picture, (2, frames, H, W, 3), in two halves of
    `samples` or more each; and the albedo, (frames, H, W, 3)."""
    source, light, pictures, albedo = references.source_key(path), [], [], []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        one = references.Truth(scene, BOUNCES, source)
        one.extend(BOUNCES, samples)
        light.append([one.indirect(BOUNCES, half) for half in range(2)])
        pictures.append([one.final(BOUNCES, half) for half in range(2)])
        albedo.append(one.of[BOUNCES].whole_albedo())
        print(f"  Cycles, frame {frame}", file=sys.stderr, flush=True)
    return *(np.array(found, np.float32).swapaxes(0, 1) for found in (light, pictures)), np.array(albedo)


def measure(path, options, afterlight):
    """motion_report.Shot. Raises candidates.Unmeasurable where nothing can be measured."""
    scene = opened(path, options, afterlight)
    if references.world_shines(scene):
        raise candidates.Unmeasurable("its world shines, which EEVEE counts as direct light")
    scene.view_layers[0].use_pass_vector = True
    seconds, plain = job(scene, layers=True)
    scene.view_layers[0].use_pass_vector = False
    light, pictures, albedo = truth(scene, path, options.truth_samples)

    def clean(shot):
        guides = zip(shot, albedo, (frame["Normal"] for frame in plain), strict=True)
        return np.array([denoise.denoised(*each) for each in guides])

    surfaces = [surface(frame) for frame in plain]
    shot = motion_report.Shot(
        path.stem,
        scene.frame_start,
        light,
        pictures,
        [motion_measures.track(*pair) for pair in zip(surfaces, surfaces[1:])],
        motion_pictures.Pictures(
            motion_pictures.displayed(scene, clean(pictures.mean(0))),
            motion_pictures.displayed(scene, pictures),
            motion_pictures.displayed(scene, np.array([clean(half) for half in pictures])),
        ),
    )
    for way in ways_of(options.ways, afterlight, options.accumulate):
        print(f"  {way.name}", file=sys.stderr, flush=True)
        if way.name != "EEVEE":
            scene = opened(path, options, afterlight)
        try:
            spent, frames = (seconds, plain) if way.name == "EEVEE" else rendered(scene, way)
        except candidates.Unmeasurable as reason:
            shot.failures[way.name] = str(reason)
            continue
        whole = np.array([picture(frame) for frame in frames])
        shot.add(way.name, None if way.whole else added(way, frames, plain), whole, spent, way.without)
        shot.pictures.add(way.name, motion_pictures.displayed(scene, whole))
    direct = np.array([picture(frame) for frame in plain])  # EEVEE's own has no indirect light
    shot.pictures.add(
        motion_report.REACHABLE,
        motion_pictures.displayed(scene, direct + clean(light.mean(0))),
        motion_pictures.displayed(scene, direct + light),
    )
    return shot


def rendered(scene, way):
    """(seconds of the job, its frames) of a way."""
    with way.mode(scene):
        return job(scene, layers=way.traced)


def added(way, frames, plain):
    """(frames, H, W, 3): the indirect light of a way of EEVEE's or Afterlight's, which EEVEE alone has not."""
    look = diffuse if way.traced else picture
    return np.array([look(frame) - look(without) for frame, without in zip(frames, plain, strict=True)])


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="benchmarks.motion", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("shots", nargs="*", metavar="SHOT", help=f"of {', '.join(SHOTS)}, or files; those four without")
    parser.add_argument(
        "--ways", default=",".join(WAYS), help=f"{','.join(WAYS)}; tracing; any PRESET or PRESET+history"
    )
    parser.add_argument("--frames", type=frame_range, metavar="FIRST-LAST", help="the scene's without")
    parser.add_argument("--size", type=accuracy.picture_size, default=(160, 90), metavar="WxH", help="160x90")
    parser.add_argument("--samples", type=int, default=16, help="EEVEE's; 16")
    parser.add_argument("--truth-samples", type=int, default=128, help="of each of Cycles' halves; 128")
    parser.add_argument("--accumulate", type=int, help="scene.afterlight.accumulate; its default without")
    parser.add_argument("--page", type=Path, help="the table in Markdown")
    parser.add_argument(
        "--sheet", type=Path, help="contact sheet, WebP; with several shots their names are put before it"
    )
    parser.add_argument(
        "--sheet-frame", type=int, help="the frame that it shows; without, the middle one, or the one after a switch"
    )
    parser.add_argument("--farm", action="store_true", help="the second half of a shot as a job of its own, instead")
    options = parser.parse_args(arguments)
    options.command = shlex.join([".venv/bin/python", "-m", "benchmarks.motion", *arguments])
    options.paths = [
        (FOLDER / f"{name}.blend" if name in SHOTS else Path(name)).resolve() for name in options.shots or SHOTS
    ]
    options.ways = options.ways.split(",")
    presets = set(candidates.names_of_ways()).difference(ALONE)
    known = {*ALONE, *presets, *(f"{name}+history" for name in presets)}
    if unknown := [name for name in options.ways if name not in known]:
        parser.error(f"there is no way {unknown[0]}; there are {', '.join(sorted(known))}")
    return options


def main(arguments, farm):
    """farm: the module motion_farm, which takes the ways from this one."""
    options = parse(arguments)
    afterlight = session.enable_afterlight()
    report, of = (farm, farm.measure) if options.farm else (motion_report, measure)
    rows, failed = [], False
    for path in options.paths:
        print(f"{path.name}:", file=sys.stderr, flush=True)
        try:
            found = of(path, options, afterlight)
        except candidates.Unmeasurable as reason:
            print(f"{path.name} cannot be measured: {reason}", file=sys.stderr)
            failed = True
            continue
        failed |= bool(found.failures)
        rows.append(found.rows())
        text = report.page(options, rows)
        print(text, flush=True)
        if options.page:  # after each shot: an hour's work must not hang on the last
            options.page.write_text(text)
        if options.sheet and not options.farm:
            several = len(options.paths) > 1
            found.sheet(
                options.sheet.with_stem(f"{path.stem}_{options.sheet.stem}") if several else options.sheet,
                options.sheet_frame,
            )
    return int(failed)
