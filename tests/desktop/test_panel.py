# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the panel, for docs/desktop.md, and that it can be worked."""

import time

import steps

BESIDE_THE_BOX = 110   # pixels from the left, on the panel's name
IN_THE_VALUES = 250
DOWN_TO_LAST_RENDER = 126  # pixels: past a button and three lines on coverage


def with_ray_tracing(on):
    bpy.context.scene.eevee.use_raytracing = on
    area("PROPERTIES")[1].tag_redraw()


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
    window.point_at(steps.ENABLED)
    window.xdotool("mousemove_relative", BESIDE_THE_BOX - 36, 0, "keydown", "ctrl", "click", 1, "keyup", "ctrl")


def pictured(window, name):
    window.over("VIEW_3D")  # or else a tooltip covers part of it
    time.sleep(1)
    window.picture(name, "PROPERTIES")


def test_the_panel(window, afterlight):
    """As it comes, ticked after a render with the last sub-panel opened, and with something to say."""
    steps.new_box(window)
    window.run(steps.use, "RADIOSITY")
    widen(window)
    open_panel(window)
    pictured(window, "panel_off")
    steps.tick(window)
    window.render()
    window.point_at("afterlight.view_count", IN_THE_VALUES)
    window.xdotool("mousemove_relative", 0, DOWN_TO_LAST_RENDER)
    time.sleep(0.5)
    window.click()
    window.over("PROPERTIES")
    window.xdotool("click", "--repeat", 60, "--delay", 5, 5)
    pictured(window, "panel")
    window.run(with_ray_tracing, True)
    window.over("PROPERTIES")
    window.xdotool("click", "--repeat", 60, "--delay", 5, 4)
    pictured(window, "panel_message")
    window.run(with_ray_tracing, False)
