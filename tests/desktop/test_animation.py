# SPDX-License-Identifier: GPL-3.0-or-later
"""An animation in the window, while somebody scrubs and changes settings: the frames of `blender -b -a`."""

import numpy as np
import steps

FRAMES = range(1, 9)


def animate(folder):
    """Keyframes on the camera and on our settings."""
    import scenes

    scene = bpy.context.scene
    scenes.set_format(scene)
    scene.frame_start, scene.frame_end = 1, 8
    scene.render.filepath = folder + "/window_"
    camera, settings = scene.camera, scene.afterlight
    for frame, x, strength, samples in ((1, -0.4, 1, 16), (8, 0.4, 0.25, 256)):
        camera.location.x, settings.strength, settings.samples = x, strength, samples
        camera.keyframe_insert("location", frame=frame)
        settings.keyframe_insert("strength", frame=frame)
        settings.keyframe_insert("samples", frame=frame)


def scrub(window):
    """Drag through the timeline and back."""
    x, y, width, height = window.value("box('DOPESHEET_EDITOR')")
    window.move(x + 0.2 * width, y + height - 8)
    window.xdotool("mousedown", 1)
    for share in (0.3, 0.5, 0.7, 0.4):
        window.move(x + share * width, y + height - 8)
    window.xdotool("mouseup", 1)


def test_animation(window, afterlight):
    steps.new_box(window)
    steps.tick(window)
    folder = window.computer.folder / "animation"
    folder.mkdir()
    window.run(animate, folder)
    window.run(steps.save_as, folder / "animation.blend")
    window.computer.headless(folder / "animation.blend", "-o", folder / "headless_####", "-a")
    expected = [steps.read_rgb(folder / f"headless_{frame:04}.exr") for frame in FRAMES]
    assert not np.array_equal(expected[0], expected[1])

    before, written = window.finished_renders(), window.value("happened('render_write')")
    window.over("VIEW_3D")
    window.key("ctrl+F12")
    window.wait(f"happened('render_write') > {written}")
    scrubs = 0
    while window.value("rendering()"):
        scrub(window)
        scrubs += 1
    window.wait(f"happened('render_complete') > {before}")
    for frame, picture in zip(FRAMES, expected):
        assert np.array_equal(steps.read_rgb(folder / f"window_{frame:04}.exr"), picture), frame
    assert scrubs > 1


def test_settings_changed_meanwhile(window, afterlight):
    """Frames that are under way take the old settings or the new; none is lost, and the settings stay as set."""
    steps.new_box(window)
    steps.tick(window)
    folder = window.computer.folder / "changed"
    folder.mkdir()
    window.run(still_frames, folder)
    before, written = window.finished_renders(), window.value("happened('render_write')")
    window.over("VIEW_3D")
    window.key("ctrl+F12")
    window.wait(f"happened('render_write') > {written}")
    for _ in range(200):
        if not window.value("rendering()"):
            break
        window.run(change)
    window.wait(f"happened('render_complete') > {before}")
    pictures = [steps.read_rgb(folder / f"window_{frame:04}.exr") for frame in range(1, 7)]
    assert all(np.isfinite(picture).all() for picture in pictures)
    assert np.mean(pictures[-1]) > 1.1 * np.mean(pictures[0])
    assert window.value("[bpy.context.scene.afterlight.strength, bpy.context.scene.afterlight.start]") == [2.0, "FULL"]


def still_frames(folder):
    import scenes

    scene = bpy.context.scene
    scenes.set_format(scene)
    scene.frame_start, scene.frame_end = 1, 6
    scene.render.filepath = folder + "/window_"
    scene.afterlight.strength = 1


def change():
    settings = bpy.context.scene.afterlight
    settings.start = "QUARTER" if settings.start == "HALF" else "HALF"
    settings.strength, settings.start = 2, "FULL"
