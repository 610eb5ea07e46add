# SPDX-License-Identifier: GPL-3.0-or-later
"""Update Indirect Light in the window: the picture of a whole render, without EEVEE, and the file as it was."""

import numpy as np
import steps


def change():
    settings = bpy.context.scene.afterlight
    settings.strength, settings.start, settings.samples = 0.5, "FULL", 64


def invoke_update():
    window, editor, region = area("PROPERTIES")
    with bpy.context.temp_override(window=window, area=editor, region=region):
        bpy.ops.afterlight.update("INVOKE_DEFAULT")


def execute_update():
    bpy.ops.afterlight.update()


def render_by_script():
    bpy.ops.render.render()


def test_the_light_alone_is_gathered_again(window, afterlight):
    steps.new_box(window)
    steps.tick(window)
    window.render()
    first = steps.result(window, "first")
    window.run(change)
    window.value("remember()")
    before = window.finished_renders()
    window.run(invoke_update)
    window.wait(f"happened('render_complete') > {before} and not rendering()")
    window.wait("bpy.context.scene.render.engine == 'BLENDER_EEVEE'")
    updated = steps.result(window, "updated")
    assert window.value("changed()") == []
    window.render()
    whole = steps.result(window, "whole")
    assert np.array_equal(updated, whole) and not np.array_equal(updated, first)


def test_scripts_render_and_update_in_the_window(window, afterlight):
    """There the render is the main thread's own, and waits for no turn."""
    steps.new_box(window)
    steps.tick(window)
    window.render()
    first = steps.result(window, "by_hand")
    window.run(render_by_script)
    assert np.array_equal(steps.result(window, "by_script"), first)
    window.run(change)
    window.run(execute_update)
    updated = steps.result(window, "updated_by_script")
    assert window.value("bpy.context.scene.render.engine") == "BLENDER_EEVEE"
    window.render()
    assert np.array_equal(updated, steps.result(window, "whole_by_hand"))
