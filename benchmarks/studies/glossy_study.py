# SPDX-License-Identifier: GPL-3.0-or-later
"""The light off glossy surfaces beside Cycles' and beside EEVEE's ray tracing.

    .venv/bin/python -m benchmarks.studies.glossy_study [FILE.blend ...] [--samples 256] [--size 320x180] [--pictures F]
    .venv/bin/python -m benchmarks.studies.glossy_study --constants MARCH_STEPS=8,16,32 LOBE_SHARE=0,0.5,1
    .venv/bin/python -m benchmarks.studies.glossy_study --cost --size 640x360

Prints tables: relative L1 error and energy of the indirect glossy light, over the pixels with a Glossy Color; the
first row is the noise of the reference itself. The reference is Cycles with four diffuse bounces and the file's glossy
ones, in two halves of `samples` each: Glossy Indirect, with the light that meshes and the world send directly, which
EEVEE has no lamps for. With
--constants Afterlight alone, with other values of the shaders' constants or RAYS. With --cost the seconds of the whole
gather without and with the glossy light, the lesser of two each.

The tables in docs/method/glossy.md, all of 26 November 2026: against EEVEE's ray tracing at commit c87df14, of the
constants at 3f484d0, of the cost at fc0e05e.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

import session

from .. import ROOT, figures
from ..accuracy import candidates, metrics, references
from ..cost import bench
from . import radiosity_study

SCENES = "metal_bin", "polished_floor", "plastics"
BOUNCES, EEVEE_SAMPLES, PRESET = 4, 16, "production"
LEAST_COLOR = 0.004  # of Glossy Color: what a pixel must have to count


class Truth:
    """halves: [(H, W, 3)] * 2 of the light off glossy surfaces that no lamp has sent directly, by Cycles. Kept in
    build/."""

    def __init__(self, scene, source, samples):
        name = references.key(scene, BOUNCES, source)
        path = references.CACHE / f"glossy-{name}-{samples}.npz"
        if path.exists():
            self.halves = list(np.load(path)["halves"])
            return
        layer = references.layer(scene)
        layer.use_pass_glossy_direct = layer.use_pass_glossy_indirect = True
        self.halves = [
            sum(
                self._render(scene, bounces, samples, 2 * samples + index)
                for bounces in (BOUNCES, *sorted(references.alone(scene)))
            )
            for index in range(2)
        ]
        path.parent.mkdir(parents=True, exist_ok=True)
        np.savez(path, halves=np.stack(self.halves))

    def _render(self, scene, bounces, samples, seed):
        import bpy

        with references.as_cycles(scene, bounces, samples, seed):
            bpy.ops.render.render(scene=scene.name)
            kind = "Glossy Indirect" if bounces == BOUNCES else "Glossy Direct"
            found = references.saved_passes(scene, "Glossy Color", kind)
        return found["Glossy Color"] * found[kind]

    @property
    def mean(self):
        return (self.halves[0] + self.halves[1]) / 2


def direct(scene):
    """(Glossy Direct times Glossy Color, Glossy Color) of the finished render by EEVEE."""
    found = references.saved_passes(scene, "Glossy Direct", "Glossy Color")
    return found["Glossy Direct"] * found["Glossy Color"], found["Glossy Color"]


def of_world(scene):
    """(H, W, 3): the world in EEVEE's reflections. A render, where the world shines."""
    import bpy

    if not references.world_shines(scene):
        return 0.0
    lamps = [lamp for lamp in references.lamps(scene) if not lamp.hide_render]
    try:
        for lamp in lamps:
            lamp.hide_render = True
        bpy.ops.render.render(scene=scene.name)
        return direct(scene)[0]
    finally:
        for lamp in lamps:
            lamp.hide_render = False


def lit(scene, afterlight):
    """((H, W, 3) of the pass Indirect Glossy, seconds of the glossy gather) of a frame with the preset."""
    bench.use_preset(PRESET, afterlight)
    settings = scene.afterlight
    settings.use_glossy = True
    settings.enabled = True
    return again(scene, afterlight)


def again(scene, afterlight, render=None):
    """As lit(), of the scene as it is; render: another operator."""
    import bpy

    found, engine = {}, afterlight.addon.render.engine.AfterlightEngine
    hand_back, gather = engine._hand_back, afterlight.addon.gather.glossy.gather

    def spy(self, shot, pictures):
        found.update(pictures)
        hand_back(self, shot, pictures)

    def timed(*arguments):
        start = time.perf_counter()
        picture = gather(*arguments)
        found["seconds"] = time.perf_counter() - start
        return picture

    engine._hand_back, afterlight.addon.gather.glossy.gather = spy, timed
    try:
        (render or (lambda: bpy.ops.render.render(scene=scene.name)))()
    finally:
        engine._hand_back, afterlight.addon.gather.glossy.gather = hand_back, gather
    if scene.afterlight.report:
        sys.exit(scene.afterlight.report)
    return found["Indirect Glossy"][::-1], found["seconds"]


def study(path, wanted, afterlight):
    """{row: "error, energy"} of one scene."""
    import bpy

    scene = candidates.open_scene(path, wanted.size, EEVEE_SAMPLES, afterlight)
    layer = references.layer(scene)
    layer.use_pass_glossy_color = layer.use_pass_glossy_direct = True
    truth = Truth(scene, references.source_key(path), wanted.samples)
    bpy.ops.render.render(scene=scene.name)
    plain, color = direct(scene)
    world, mask = of_world(scene), color.max(-1) > LEAST_COLOR
    rows, pictures = {"Cycles' own noise": f"{metrics.noise(*truth.halves, mask):.3f}"}, {"Cycles": truth.mean}

    def add(name, picture, seconds=None):
        found = metrics.compare(picture.astype(np.float32), truth.mean.astype(np.float32), mask, False)
        rows[name] = f"{found['l1']:.3f}, {found['energy']:.3f}" + (f" ({seconds:.1f} s)" if seconds else "")
        pictures[name] = picture
        print(f"{path.stem}: {name}: {rows[name]}", flush=True)

    if not wanted.constants:
        add("EEVEE", plain * 0 + world)
        for name, settings in (("default", {}), ("best", candidates.BEST)):
            with candidates.traced(scene, settings):
                bpy.ops.render.render(scene=scene.name)
                add(f"EEVEE ray tracing, {name}", direct(scene)[0] - plain + world)
        picture, seconds = lit(scene, afterlight)
        add("Afterlight", picture + world, seconds)
    else:
        lit(scene, afterlight)
        draws = scene.afterlight.draws
        for values in wanted.constants:
            constants = {name: value for name, value in values.items() if name != "RAYS"}
            with radiosity_study.changed(afterlight.addon.gather, **constants):
                scene.afterlight.draws = 2 * int(values["RAYS"]) if "RAYS" in values else draws
                picture, seconds = again(scene, afterlight, bpy.ops.afterlight.update)
                name = ", ".join(f"`{name}` {value}" for name, value in values.items())
                add(name or "as it is", picture + world, seconds)
    scene.afterlight.enabled = False
    if wanted.pictures:
        save(wanted.pictures / f"glossy_{path.stem}.webp", pictures, truth.mean[mask].mean())
    return rows


def cost(path, wanted, afterlight):
    """{row: seconds} of one scene."""
    import bpy

    scene, found = candidates.open_scene(path, wanted.size, 1, afterlight), {}
    lit(scene, afterlight)
    for glossy in (False, True) * 2:
        scene.afterlight.use_glossy = glossy
        bpy.ops.afterlight.update()
        seconds = afterlight.addon.host.report.stages(scene)["gather on the GPU"]
        name = "with Glossy Light" if glossy else "without"
        found[name] = min(seconds, found.get(name, seconds))
    scene.afterlight.enabled = False
    return {name: f"{seconds:.1f} s" for name, seconds in found.items()}


def save(path, pictures, mean):
    """A strip of the pictures, each with its name, bright enough to see."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    columns = 2
    lines = -(-len(pictures) // columns)
    figure, axes = pyplot.subplots(lines, columns, figsize=(5 * columns, 3.1 * lines), squeeze=False)
    for axis in axes.flat:
        axis.set_axis_off()
    for axis, (name, picture) in zip(axes.flat, pictures.items()):
        axis.imshow(np.clip(picture / (4 * mean), 0, 1) ** (1 / 2.2))
        axis.set_title(name, fontsize=9)
    figure.tight_layout()
    figures.save(figure, path, dpi=90)


def combinations(texts):
    """[{name: value}] of all that texts NAME=VALUE,VALUE ask for, one name at a time."""
    return [{}] * bool(texts) + [
        {name: value} for text in texts for name, values in [text.split("=")] for value in values.split(",")
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "files", nargs="*", type=Path, default=[ROOT / "sample_blends" / f"{name}.blend" for name in SCENES]
    )
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(320, 180))
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--cost", action="store_true")
    parser.add_argument("--constants", nargs="+", default=[])
    wanted = parser.parse_args()
    wanted.constants = combinations(wanted.constants)
    afterlight = session.enable_afterlight()
    measure = cost if wanted.cost else study
    found = {path.stem: measure(path.resolve(), wanted, afterlight) for path in wanted.files}
    print(f"| {'gather' if wanted.cost else 'error, energy'} | {' | '.join(found)} |\n|---|{'---|' * len(found)}")
    for row in next(iter(found.values())):
        print(f"| {row} | {' | '.join(rows[row] for rows in found.values())} |")


if __name__ == "__main__":
    main()
