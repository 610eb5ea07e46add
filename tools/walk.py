# SPDX-License-Identifier: GPL-3.0-or-later
"""The way of one frame through the sources: the files of the add-on that F12 enters, in order, traced while it renders.

    .venv/bin/python tools/walk.py

Each file with the number of times that another calls into it. docs/ARCHITECTURE.md follows the same way in words."""

import sys
import threading
from pathlib import Path

import extension

SIZE = 96, 54


class Walk:
    """steps: the files in the order in which one calls another, each once for as long as it stays at work."""

    def __init__(self, root):
        self.root, self.steps = root, []

    def profile(self, frame, event, _argument):
        if event != "call":
            return
        path = frame.f_code.co_filename
        caller = frame.f_back.f_code.co_filename if frame.f_back else ""
        if path.startswith(self.root) and path != caller and (not self.steps or self.steps[-1] != path):
            self.steps.append(path)


def main():
    afterlight = extension.start()

    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(extension.ROOT / "sample_blends" / "cornell_box.blend"), load_ui=False)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage, scene.eevee.taa_render_samples = 100, 1
    scene.render.compositor_device = "CPU"
    scene.afterlight.enabled = True
    root = str(Path(afterlight.__file__).parent / "addon")
    walk = Walk(root)
    sys.setprofile(walk.profile)
    threading.setprofile(walk.profile)
    try:
        bpy.ops.render.render()
    finally:
        sys.setprofile(None)
        threading.setprofile(None)
    if scene.afterlight.report:
        sys.exit(scene.afterlight.report)
    names = [Path(step).relative_to(root).as_posix() for step in walk.steps]
    first = list(dict.fromkeys(names))
    print(f"{len(first)} files, {len(names)} steps from one to another:")
    for name in first:
        print(f"  {name}  {names.count(name)}")


if __name__ == "__main__":
    main()
