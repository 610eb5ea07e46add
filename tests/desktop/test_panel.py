# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the panel, for docs/desktop.md, and that it can be worked."""

import time

import steps

BESIDE_THE_BOX = 110   # pixels from the left, on the panel's name
IN_THE_VALUES = 250


def with_ray_tracing(on):
    bpy.context.scene.eevee.use_raytracing = on
    area("PROPERTIES")[1].tag_redraw()


def widen(window):
    """Drag the editor's left edge to where the panel has room."""
    _, y, _, height = window.value("box('PROPERTIES')")
    x = window.value("area('PROPERTIES')[1].x")  # the tabs lie between it and the main region
    window.move(x - 1, y + height / 2)
    window.xdotool("mousedown", 1)
    for left in (20, 100, 170, 180):
        window.move(x - left, y + height / 2)
        time.sleep(0.1)
    window.xdotool("mouseup", 1)
    window.wait(f"area('PROPERTIES')[1].x < {x} - 100")


def open_panel(window):
    """Ctrl-click on the name: this panel opens, and all others close."""
    window.point_at(steps.ENABLED)
    window.xdotool("mousemove_relative", BESIDE_THE_BOX - 36, 0, "keydown", "ctrl", "click", 1, "keyup", "ctrl")


def pictured(window, name):
    window.over("VIEW_3D")  # or else a tooltip covers part of it
    time.sleep(1)
    window.picture(name, "PROPERTIES")


def test_the_panel(window, afterlight):
    steps.new_box(window)
    widen(window)
    open_panel(window)
    window.picture("panel_off", "PROPERTIES")
    steps.tick(window)
    window.render()
    window.point_at("afterlight.use_animated_seed", IN_THE_VALUES)
    window.xdotool("mousemove_relative", 0, 26, "click", 1)  # the name of the sub-panel below: Last Render
    pictured(window, "panel")
    window.run(with_ray_tracing, True)
    pictured(window, "panel_message")
    window.run(with_ray_tracing, False)
