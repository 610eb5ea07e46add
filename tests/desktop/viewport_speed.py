# SPDX-License-Identifier: GPL-3.0-or-later
"""What the light in a viewport costs beside EEVEE's own drawing, stage by stage: of a redraw while a lamp or the view
moves, and of one at rest.

    PYTHONPATH=tests/desktop:tools tools/desktop.sh .venv/bin/python tests/desktop/viewport_speed.py [opengl] [vulkan]
    [FRAMES]

The region has 1180 x 786 pixels, as many as 1280 x 720. After each stage the GPU is waited for, so that times are its
own; they are medians, over EEVEE's: one sample of the whole region, drawn in the same run."""

import shutil
import sys
import time
from statistics import median

import steps
import test_viewport as viewport
from window import ROOT, Computer, Window

import extension

# (label, settings)
CASES = (
    ("Paper, Quarter, 64 samples", {"method": "PAPER", "start": "QUARTER", "samples": 64}),
    ("Radiosity, Draft", {"method": "RADIOSITY", "start": "QUARTER", "draws": 8, "bounces": 3, "view_count": 4}),
    ("Radiosity, Production", {"method": "RADIOSITY", "start": "HALF", "draws": 16, "bounces": 4, "view_count": 7}),
)
# What is timed: a stage, the module of the extension, and the names in it. A stage has what those within it do not.
STAGES = (
    ("passes", "viewport.offscreen", "OffscreenPicture.draw"),
    ("split", "gather.interactive", "split"),
    ("views, emitters", "gather.interactive", "build_records"),
    ("surfels", "gather.interactive", "pack"),
    ("pyramid", "gather.interactive", "merge"),
    ("gather", "gather.interactive", "gather"),
    ("gather", "gather.interactive", "gather_bounces"),
    ("table of emitters", "gather.radiosity", "emitter_table"),
    ("history", "gather.temporal", "History.go_on"),
    ("smooth", "gather.interactive", "smooth"),
    ("smooth", "gather.interactive", "upsample"),
    ("composite", "gather.interactive", "composite"),
    ("mean", "gather.interactive", "Mean.add"),
    ("place views", "viewport.view_cache", "ViewCache.place"),
)
EEVEE = "passes", "split"


def time_stages(stages):
    """From now on `spent` has, for each redraw in which there was something to do, its kind and the seconds of each
    stage."""
    import importlib
    import time

    root = "bl_ext.user_default.afterlight.addon."
    device = importlib.import_module(root + "gather.device")
    names["spent"], running = [], []

    def settled():
        probe = device.texture(1, 1)
        probe.clear(format="FLOAT", value=(0, 0, 0, 0))
        device.read(probe)

    def watch(stage, module, path):
        owner = importlib.import_module(root + module)
        *inner, name = path.split(".")
        for each in inner:
            owner = getattr(owner, each)
        function = getattr(owner, name)

        def watched(*arguments, **options):
            settled()
            running.append(0.0)
            start = time.perf_counter()
            try:
                return function(*arguments, **options)
            finally:
                settled()
                whole = time.perf_counter() - start
                own = whole - running.pop()
                if running:
                    running[-1] += whole
                if spent:
                    spent[-1][1][stage] = spent[-1][1].get(stage, 0.0) + own

        setattr(owner, name, watched)

    for stage, module, path in stages:
        watch(stage, module, path)
    region = importlib.import_module(root + "viewport.region_light").RegionLight
    for kind in ("_gather_draft", "_gather"):

        def begun(self, *arguments, kind=kind, function=getattr(region, kind)):
            spent.append((kind, {}))
            return function(self, *arguments)

        setattr(region, kind, begun)


def draw_alone(count):
    """Seconds that EEVEE takes for one sample of the whole region, each of so many times."""
    import time

    import gpu
    import numpy as np
    from bl_ext.user_default.afterlight.addon.viewport import offscreen, region_light

    window, editor, shown = area("VIEW_3D")
    space = editor.spaces.active
    stage = region_light.ViewportContext(
        bpy.context.scene, bpy.context.view_layer, space, shown, space.region_3d, bpy.context.evaluated_depsgraph_get()
    )
    off, found = gpu.types.GPUOffScreen(*stage.extent, format="RGBA16F"), []
    with offscreen.drawing(stage):
        space.shading.render_pass = "COMBINED"
        for number in range(count + 1):
            matrix = stage.rv3d.view_matrix.copy()
            matrix[0][3] += 1e-3 * number  # or else there would be nothing to draw
            start = time.perf_counter()
            off.draw_view3d(
                stage.scene, stage.layer, space, shown, matrix, stage.rv3d.window_matrix, do_color_management=False
            )
            np.asarray(off.texture_color.read())
            found.append(time.perf_counter() - start)
    off.free()
    return found[1:]


def turn(number):
    """Look from a little further to the side."""
    bpy.context.scene.camera.location.x = 0.02 * (number % 5)
    bpy.context.view_layer.update()


def moved(window, move, count):
    """{stage: seconds} of so many redraws after a move each."""
    rows = []
    for number in range(count + 1):
        window.value("spent.clear()")
        window.run(move, number)
        for each in range(400):
            time.sleep(0.05)
            found = window.value("[row for row in spent if row[0] == '_draft' and 'mean' in row[1]]")
            if found:
                rows.append(found[0][1])
                break
    return rows[1:]


def report(label, rows, alone):
    stages = {
        stage: median(row.get(stage, 0.0) for row in rows) for stage in dict.fromkeys(stage for stage, *_ in STAGES)
    }
    ours = sum(seconds for stage, seconds in stages.items() if stage not in EEVEE[:1])
    print(
        f"\n{label}: EEVEE's passes {stages['passes'] / alone:.2f}, all else {ours / alone:.2f} of EEVEE's sample "
        f"({alone:.3f} s)"
    )
    print("  " + ", ".join(f"{stage} {seconds / alone:.3f}" for stage, seconds in stages.items() if seconds))
    sys.stdout.flush()


def main():
    backends = [word for word in sys.argv[1:] if word in ("opengl", "vulkan")] or ["opengl"]
    frames = next((int(word) for word in sys.argv[1:] if word.isdigit()), 7)
    for backend in backends:
        folder = ROOT / "build" / "speed" / backend
        shutil.rmtree(folder, ignore_errors=True)
        window = Window(Computer(folder, backend))
        try:
            steps.install(window, extension.package())
            steps.new_box(window)
            window.run(viewport.show_box, "1")
            steps.tick(window)
            window.run(viewport.draw_handlers)
            window.run(time_stages, STAGES)
            for label, values in CASES:
                viewport.switch_on(window)
                for name, value in values.items():
                    window.value(f"setattr(bpy.context.scene.afterlight, {name!r}, {value!r})")
                viewport.wait_for_light(window, 600)
                rest = [row for kind, row in window.value("spent") if kind == "_gather"][1:]
                alone = median(window.run(draw_alone, frames))
                print(f"\n== {backend}, {label}")
                report("at rest", rest, alone)
                report("while a lamp moves", moved(window, viewport.shake, frames), alone)
                report("while the view moves", moved(window, turn, frames), alone)
                window.run(viewport.change, "bpy.context.scene.afterlight.use_viewport = False")
                window.value("spent.clear()")
        finally:
            window.close()


if __name__ == "__main__":
    main()
