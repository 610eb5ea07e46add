# SPDX-License-Identifier: GPL-3.0-or-later
"""What is taken for the truth: Cycles without any of its shortcuts, in two independent halves, kept between runs.

    Reference(...)          one path length of one scene; used by `python -m benchmarks.accuracy`

Light that meshes send directly is counted as bounced light: EEVEE has none of it as direct light. So the render without
diffuse bounces, the direct light of lamps and world, has emissive meshes hidden from diffuse surfaces; and where there
are any, a render of the meshes' light alone is added to the indirect light of the others. (The difference of Diffuse
Direct with and without them is the same light, with the noise of both.)

The direct light of the world is counted too, on both sides: EEVEE lets it through walls, and Afterlight takes out what
walls cover, so only the sum of both says how good that is. Pictures are (H, W, 3) float32, rows top first.
"""

import hashlib
import json
import os
import sys
import tempfile
import time
import zipfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from . import metrics

CACHE = Path(__file__).resolve().parents[2] / "build" / "references"
PASSES = {
    "diffuse_color": "Diffuse Color",
    "diffuse_direct": "Diffuse Direct",
    "diffuse_indirect": "Diffuse Indirect",
    "glossy_color": "Glossy Color",
    "transmission_color": "Transmission Color",
}
KEPT = ("final", "direct", "indirect", "albedo", "other_albedo")  # products, since only those may be averaged
NOT_DIFFUSE = 0.2  # share of gloss and transmission in a pixel's colour that makes it so
MESHES, WORLD = -1, -2  # in place of a number of bounces: the direct light of meshes alone, and of the world alone
SHINES = {"MESH", "CURVE", "SURFACE", "META", "FONT", "CURVES", "POINTCLOUD"}
# Nothing that trades truth for calm. The file decides the bounces of gloss and glass, which are not what we add.
SETTINGS = {
    "device": "CPU",
    "use_denoising": False,
    "use_adaptive_sampling": False,
    "sample_clamp_direct": 0.0,
    "sample_clamp_indirect": 0.0,
    "blur_glossy": 0.0,
    "use_fast_gi": False,
    "max_bounces": 64,
    "min_light_bounces": 0,
    "min_transparent_bounces": 0,
    "time_limit": 0.0,
    "use_sample_subset": False,
    "use_animated_seed": False,
    "use_layer_samples": "IGNORE",
    "sampling_pattern": "TABULATED_SOBOL",
    "use_guiding": False,
    "film_exposure": 1.0,
    "pixel_filter_type": "BLACKMAN_HARRIS",
}


class Reference:
    """The mean of two halves of Cycles' samples for one number of diffuse bounces.

    samples: of each half so far. seconds: of rendering them. halves: [{name in KEPT: (H, W, 3) float64}] * 2, empty
    before the first samples.
    """

    def __init__(self, scene, bounces, source, folder=CACHE, caustics=True):
        """source: what source_key() says of the file. folder: where references are kept. caustics: whether light that
        gloss and glass send to diffuse surfaces counts."""
        self.scene, self.bounces, self.caustics = scene, bounces, caustics
        self.path = folder / f"{key(scene, bounces, source, caustics)}.npz"
        self.samples, self.seconds, self.halves = 0, 0.0, [{}, {}]
        self._read()

    def extend(self, samples):
        """Let each half have at least `samples`; what it has stays in it. Kept on disk."""
        while self.samples < samples:
            more = self.samples or samples  # twice as many each time
            start = time.perf_counter()
            for index, half in enumerate(self.halves):
                # Halves of the same length share seeds across numbers of bounces: their difference is then less noisy.
                fresh = render(self.scene, self.bounces, more, 2 * self.samples + index, self.caustics)
                for name in KEPT:
                    half[name] = (half.get(name, 0) * self.samples + fresh[name] * more) / (self.samples + more)
            self.samples += more
            self.seconds += time.perf_counter() - start
        self._write()

    def mean(self, name):
        """(H, W, 3) float32, of both halves."""
        return ((self.halves[0][name] + self.halves[1][name]) / 2).astype(np.float32)

    def white_direct(self):
        """Diffuse Direct without the albedo; 0 where a surface has none."""
        direct, albedo = self.mean("direct"), self.mean("albedo")
        return np.divide(direct, albedo, out=np.zeros_like(direct), where=albedo > 1e-6)

    def whole_albedo(self):
        """(H, W, 3): of diffuse, gloss and transmission together, as denoisers want it."""
        return self.mean("albedo") + self.mean("other_albedo")

    def not_diffuse(self):
        """(H, W) bool: pixels whose colour is gloss or glass for more than NOT_DIFFUSE of it."""
        matt, other = self.mean("albedo").sum(-1), self.mean("other_albedo").sum(-1)
        return other > NOT_DIFFUSE * (matt + other)

    def _read(self):
        if not self.path.exists():
            return
        try:
            with np.load(self.path) as stored:  # zip's own checksums notice damage
                halves = [{name: stored[f"{name}_{index}"] for name in KEPT} for index in range(2)]
                samples = int(stored["samples"])
                seconds = float(stored["seconds"]) if "seconds" in stored else 0.0  # of 0.3.0: not known
            if samples < 1 or not all(np.isfinite(array).all() for half in halves for array in half.values()):
                raise ValueError("it holds no sound picture")
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zipfile.zlib.error) as error:
            print(f"The stored reference {self.path} is damaged ({error}) and is rendered again.", file=sys.stderr)
            self.path.unlink()
            return
        self.samples, self.seconds, self.halves = samples, seconds, halves

    def _write(self):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        arrays = {f"{name}_{index}": half[name] for index, half in enumerate(self.halves) for name in KEPT}
        # Through another name, so that an interrupted run leaves no half of a file.
        with tempfile.NamedTemporaryFile(dir=self.path.parent, suffix=".part", delete=False) as part:
            np.savez(part, samples=self.samples, seconds=self.seconds, **arrays)
        os.replace(part.name, self.path)


class Truth:
    """All references of one scene: {N: Reference}, MESHES where meshes shine, WORLD where the world does; and 0 and 1
    where shorter paths are asked for."""

    def __init__(self, scene, bounces, source, folder=CACHE, shorter=False):
        self.scene, self.source, self.folder = scene, source, folder
        self.alone = alone(scene)
        numbers = {bounces} | self.alone | ({0, 1} if shorter else set())
        self.of = {number: Reference(scene, number, source, folder) for number in sorted(numbers)}
        self.longest = bounces

    def extend(self, bounces, samples):
        """More samples for one number of bounces, and for the light of meshes and of the world, which is part of it."""
        for number in {bounces} | self.alone:
            self.of[number].extend(samples)

    def seconds(self, bounces):
        """That what extend() extends has taken so far."""
        return sum(self.of[number].seconds for number in {bounces} | self.alone)

    def bounced(self, bounces, index=None):
        """(H, W, 3) radiance that comes from surfaces, the light of meshes included; of both halves, or of one."""
        parts = [] if bounces == 0 else [(bounces, "indirect")] + [(MESHES, "direct")] * (MESHES in self.of)
        return self._sum(parts, index)

    def indirect(self, bounces, index=None):
        """(H, W, 3) radiance that comes from anything but lamps: bounced() and the world's; of both halves, or of
        one."""
        return self.bounced(bounces, index) + self._sum([(WORLD, "direct")] * (WORLD in self.of), index)

    def _sum(self, parts, index):
        halves = (0, 1) if index is None else (index,)
        arrays = [self.of[number].halves[half][name] for number, name in parts for half in halves]
        return sum(arrays, np.zeros_like(self.final(self.longest))) / len(halves)

    def final(self, bounces, index=None):
        """(H, W, 3), what Cycles shows."""
        halves = self.of[bounces].halves
        return halves[index]["final"] if index is not None else self.of[bounces].mean("final")

    def noise(self, mask, without=None):
        """{"indirect", "final"}: relative L1 error of the longest reference by its own noise. Given a number of
        bounces, that of its difference from the longest: much of their noise is the same."""
        found = {}
        for kind, picture in (("indirect", self.indirect), ("final", self.final)):
            first, second = (picture(self.longest, index) for index in range(2))
            shift = 0 if without is None else (picture(without, 1) - picture(without, 0)) / 2
            found[kind] = metrics.noise(first + shift, second - shift, mask)
        return found


def source_key(path):
    """Hash of a .blend file that is open, and of every file it uses (libraries, images, caches)."""
    import bpy

    found = hashlib.sha256(Path(path).read_bytes())
    for other in sorted(bpy.utils.blend_paths(absolute=True)):
        found.update(other.encode())
        if Path(other).is_file():
            found.update(hashlib.sha256(Path(other).read_bytes()).digest())
    return found.hexdigest()


def key(scene, bounces, source, caustics=True):
    """Name of a reference in the cache: the same file, settings and Blender give the same picture."""
    import bpy

    render = scene.render
    settings = {
        "source": source,
        "size": [render.resolution_x, render.resolution_y],
        "frame": scene.frame_current,
        "layer": layer(scene).name,
        "bounces": bounces,
        "filter": render.filter_size,
        "cycles": SETTINGS,
        "blender": bpy.app.version_string,
        "build": bpy.app.build_hash.decode(),
    }
    if not caustics:
        settings["caustics"] = False
    if shadowless(scene):
        settings["shadowless"] = "without multiple importance sampling"
    return hashlib.sha256(json.dumps(settings, sort_keys=True).encode()).hexdigest()


def render(scene, bounces, samples, seed, caustics=True):
    """{name in KEPT: (H, W, 3) float32} by Cycles. The scene is as before afterwards."""
    import bpy

    with as_cycles(scene, bounces, samples, seed, caustics):
        bpy.ops.render.render(scene=scene.name)
        return read(scene)


def with_alone(scene, indirect, samples, seed):
    """(H, W, 3): indirect light by Cycles, and the direct light of what is rendered by itself: see alone()."""
    return sum((render(scene, each, samples, seed)["direct"] for each in alone(scene)), indirect)


def read(scene):
    """{name in KEPT: (H, W, 3) float32} of the finished render by Cycles."""
    found = saved_passes(scene, "Combined", *PASSES.values())
    albedo = found["Diffuse Color"]
    return {
        "final": found["Combined"],
        "direct": found["Diffuse Direct"] * albedo,
        "indirect": found["Diffuse Indirect"] * albedo,
        "albedo": albedo,
        "other_albedo": found["Glossy Color"] + found["Transmission Color"],
    }


@contextmanager
def as_cycles(scene, bounces, samples, seed=0, caustics=True):
    """The scene set up for Cycles; without diffuse bounces, and for the world alone, its emissive meshes light nothing
    diffuse."""
    wanted = SETTINGS | {
        "samples": samples,
        "diffuse_bounces": max(bounces, 0),
        "seed": seed,
        "filter_width": scene.render.filter_size,
    }
    if not caustics:
        wanted |= {"caustics_reflective": False, "caustics_refractive": False}
    changes = [(scene.cycles, name, value) for name, value in wanted.items()]
    changes += [(layer(scene), f"use_pass_{name}", True) for name in PASSES]
    changes += [(lamp, "visible_camera", False) for lamp in lamps(scene)]  # EEVEE shows none
    changes += [(light.cycles, "use_multiple_importance_sampling", False) for light in shadowless(scene)]
    if bounces in (0, WORLD):
        changes += [(mesh, "visible_diffuse", False) for mesh in emissive(scene)]
    if bounces in (MESHES, WORLD):
        changes += [(lamp, "hide_render", True) for lamp in lamps(scene)]
    if bounces == MESHES:
        changes += [(scene, "world", None), (layer(scene), "world_override", None)]
    changes += [(scene.render, "engine", "CYCLES")]
    before = [(thing, name, getattr(thing, name)) for thing, name, _ in changes]
    try:
        for thing, name, value in changes:
            setattr(thing, name, value)
        yield
    finally:
        for thing, name, value in reversed(before):
            setattr(thing, name, value)


def layer(scene):
    """The view layer that is measured: the first that is rendered."""
    return next(each for each in scene.view_layers if each.use)


def saved_passes(scene, *names):
    """{name: (H, W, 3) float32} of the finished render of any engine."""
    import OpenEXR

    frame_store = session_package().scene.frame_store
    path = frame_store.save(scene)
    try:
        channels = {
            name: channel.pixels
            for part in OpenEXR.File(path, separate_channels=True).parts
            for name, channel in part.channels.items()
        }
    finally:
        frame_store.discard(path)
    name_of = layer(scene).name
    return {name: np.stack([channels[f"{name_of}.{name}.{axis}"] for axis in "RGB"], -1) for name in names}


def session_package():
    """The extension's own package."""
    import extension

    return sys.modules[extension.MODULE].addon


def shown(scene):
    """Objects of `scene` and of what it instances."""
    import bpy

    instances = bpy.context.evaluated_depsgraph_get().object_instances
    return sorted(
        {instance.object.original for instance in instances} | set(scene.objects), key=lambda thing: thing.name_full
    )


def lamps(scene):
    """Light objects of `scene` and of what it instances."""
    return [thing for thing in shown(scene) if thing.type == "LIGHT"]


def alone(scene):
    """Of MESHES and WORLD, what shines in a scene: its direct light is rendered by itself."""
    return {number for number, shines in ((MESHES, emissive), (WORLD, world_shines)) if shines(scene)}


def shadowless(scene):
    """Light datablocks that cast no shadows. Cycles' rays towards them pass through all surfaces, but those that it
    mixes in by multiple importance sampling do not: what arrives would then depend on how many other lights there
    are."""
    return sorted({lamp.data for lamp in lamps(scene) if not lamp.data.use_shadow}, key=lambda light: light.name_full)


def emissive(scene):
    """Objects of `scene` and of what it instances with a material that sends light."""
    return [
        thing
        for thing in shown(scene)
        if thing.type in SHINES
        and any(slot.material and sends_light(slot.material.node_tree) for slot in thing.material_slots)
    ]


def world_shines(scene):
    """Does anything but blackness surround the scene?"""
    world = layer(scene).world_override or scene.world
    return world is not None and sends_light(world.node_tree)


def sends_light(tree):
    """Does the node tree of a material or a world hold, at any depth, a node that emits?"""
    return any(_sends(node) for node in nodes_of(tree))


def nodes_of(tree):
    """All nodes of a tree and of the groups in it, each once; none for None."""
    trees, found = [tree] if tree else [], []
    for each in trees:
        found += each.nodes
        trees += [
            node.node_tree for node in each.nodes if getattr(node, "node_tree", None) and node.node_tree not in trees
        ]
    return found


def _sends(node):
    if node.type not in {"EMISSION", "BACKGROUND", "BSDF_PRINCIPLED"}:
        return False
    color, strength = (
        node.inputs[name]
        for name in (
            ("Emission Color", "Emission Strength") if node.type == "BSDF_PRINCIPLED" else ("Color", "Strength")
        )
    )
    return (strength.is_linked or strength.default_value > 0) and (color.is_linked or any(color.default_value[:3]))
