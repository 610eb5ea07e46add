# SPDX-License-Identifier: GPL-3.0-or-later
"""Files with more in them than one scene of one view layer."""

import numpy as np
import steps


def layers_and_scenes():
    """Two view layers laid over each other, and a second scene that is ticked too."""
    import scenes
    scene = bpy.context.scene
    scenes.layered_tree(scene)
    scene.afterlight.enabled = True
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        bpy.ops.scene.new(type="FULL_COPY")
    window.scene.name = "Other"
    window.scene.afterlight.strength = 0.5


def show(name):
    for window in bpy.context.window_manager.windows:
        window.scene = bpy.data.scenes[name]


def test_two_scenes_of_two_view_layers(window, afterlight):
    """Each is lit with its own settings, as the command line lights it."""
    steps.new_box(window)
    window.run(layers_and_scenes)
    pictures = {}
    for name in ("Scene", "Other"):
        window.run(show, name)
        window.render()
        assert window.value(f"bpy.data.scenes[{name!r}].afterlight.report") == ""
        pictures[name] = steps.result(window, f"scene_{name}", name)
        expected = steps.headless(window, f"headless_{name}", "-S", name)
        assert np.array_equal(pictures[name], expected)
    assert np.mean(pictures["Other"]) < np.mean(pictures["Scene"])
