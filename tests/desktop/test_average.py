# SPDX-License-Identifier: GPL-3.0-or-later
"""An animation whose frames are averaged, of shiny surfaces, in the window: the frames of `blender -b -a`, the first
one's nine gathers among them."""

import numpy as np
import steps

FRAMES = range(1, 4)


def animate(folder):
    import scenes

    scene = bpy.context.scene
    scenes.set_format(scene)
    scene.frame_start, scene.frame_end = 1, 3
    scene.frame_set(1)  # where the animation begins: only the operator tells it from a single frame
    scene.render.filepath = folder + "/window_"
    settings = scene.afterlight
    settings.method, settings.views, settings.draws, settings.bounces = "RADIOSITY", "CAMERA", 2, 2
    settings.use_glossy = True
    shader = bpy.data.materials["White"].node_tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 0.5, 0.3
    for frame, x in ((1, 0.0), (3, 0.1)):
        scene.camera.location.x = x
        scene.camera.keyframe_insert("location", frame=frame)


def test_averaged_frames(window, afterlight):
    steps.new_box(window)
    steps.tick(window)
    folder = window.computer.folder / "average"
    folder.mkdir()
    window.run(animate, folder)
    window.run(steps.save_as, folder / "average.blend")
    window.computer.headless(folder / "average.blend", "-o", folder / "headless_####", "-a")
    expected = [steps.read_rgb(folder / f"headless_{frame:04}.exr") for frame in FRAMES]
    before = window.finished_renders()
    window.over("VIEW_3D")
    window.key("ctrl+F12")
    window.wait(f"happened('render_complete') > {before}")
    for frame, picture in zip(FRAMES, expected):
        found = steps.read_rgb(folder / f"window_{frame:04}.exr")
        # What drawing in bands rounds may choose another emitter now and then (docs/blender/desktop.md).
        assert np.abs(found - picture).mean() < 1e-4 * picture.mean(), (frame, np.abs(found - picture).mean())
