# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person does with Afterlight in the window, and how the pictures are had and compared."""

import time

import numpy as np
import OpenEXR

ENABLED = "afterlight.enabled"
BESIDE_THE_BOX = 110  # pixels from the left, on the panel's name
MODULE = "bl_ext.user_default.afterlight"


def install(window, package):
    """Preferences > Get Extensions > Install from Disk."""
    window.run(install_from_disk, package)
    window.wait(f"{MODULE!r} in bpy.context.preferences.addons")


def install_from_disk(path):
    bpy.ops.extensions.package_install_files(filepath=path, repo="user_default", enable_on_install=True)
    bpy.ops.wm.save_userpref()


def new_box(window):
    """A white box with a red wall, Afterlight not ticked, as if somebody had opened their file."""
    window.run(make_box)
    window.value("bpy.ops.ed.undo_push(message='Box') and None")


def make_box():
    import scenes

    bpy.ops.wm.read_homefile(use_factory_startup=True)
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scenes.box(bpy.context.scene)
    area("PROPERTIES")[1].spaces.active.context = "RENDER"
    if hasattr(bpy.context.scene, "afterlight"):
        bpy.context.scene.afterlight.method = "PAPER"  # one view less to wait for


def tick(window, on=True):
    """Click on the box in the Render properties."""
    window.point_at(ENABLED)
    window.click()
    window.wait(f"bpy.context.scene.afterlight.enabled == {on}")


def widen(window):
    """Drag the editor's left edge to where the panel has room."""
    window.over("PROPERTIES")
    window.key("Escape")  # away with the splash screen, where this is the first that a Blender sees of the mouse
    time.sleep(0.5)
    _, y, _, height = window.value("box('PROPERTIES')")
    x = window.value("area('PROPERTIES')[1].x")  # the tabs lie between it and the main region
    window.move(x - 1, y + height / 2)
    time.sleep(0.5)
    window.xdotool("mousedown", 1)
    for left in (20, 100, 170, 180):
        window.move(x - left, y + height / 2)
        time.sleep(0.1)
    window.xdotool("mouseup", 1)
    window.wait(f"area('PROPERTIES')[1].x < {x} - 100")


def open_panel(window):
    """Ctrl-click on the name: this panel opens, and all others close."""
    window.point_at(ENABLED)
    window.xdotool("mousemove_relative", BESIDE_THE_BOX - 36, 0, "keydown", "ctrl", "click", 1, "keyup", "ctrl")


def use(method):
    """Without the average over frames: a frame by the command line's -f is one of an animation, and F12 is none."""
    bpy.context.scene.afterlight.method = method
    bpy.context.scene.afterlight.use_history = False


def long_gather(width=640, height=360):
    """So much light that its gather takes some seconds, and as little as can be for EEVEE."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.eevee.taa_render_samples = 1
    scene.afterlight.start, scene.afterlight.samples, scene.afterlight.radius = "FULL", 1024, 32
    scene.afterlight.draws = 128


def into_the_gather(window):
    """Render, until it is in the middle of long_gather()."""
    window.value("watch('gather', 'gather.paper', 'gather')")
    window.value("watch('gather', 'gather.radiosity', 'sample_emitters')")
    window.start_render()
    window.wait("'gather' in running()", 120)
    time.sleep(1)


def save_as(path):
    bpy.ops.wm.save_as_mainfile(filepath=path)


def open_file(path):
    bpy.ops.wm.open_mainfile(filepath=path)


def result(window, name, scene=""):
    """(H, W, 3) of the last finished render, scene-linear."""
    path = window.computer.folder / f"{name}.exr"
    window.value(f"save_result({str(path)!r}, {scene!r})")
    return read_rgb(path)


def headless(window, name, *arguments):
    """(H, W, 3) of frame 1 of the file as it is now, rendered by `blender -b`."""
    folder = window.computer.folder
    window.run(save_as, folder / f"{name}.blend")
    return render_file(window.computer, folder / f"{name}.blend", folder / f"{name}_headless", *arguments)


def render_file(computer, blend, output, *arguments, frame=1):
    computer.headless(blend, *arguments, "--python-expr", SETTINGS, "-o", f"{output}####", "-f", frame)
    return read_rgb(output.with_name(f"{output.name}{frame:04}.exr"))


SETTINGS = (
    "import bpy; s = bpy.context.scene.render.image_settings; s.media_type = 'IMAGE'; "
    "s.file_format = 'OPEN_EXR'; s.color_depth = '32'; s.exr_codec = 'NONE'"
)


def read_rgb(path):
    channels = {
        name: channel.pixels
        for part in OpenEXR.File(str(path), separate_channels=True).parts
        for name, channel in part.channels.items()
    }
    return np.stack([channels[axis] for axis in "RGB"], axis=-1)
