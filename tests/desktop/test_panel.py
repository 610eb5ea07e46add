# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the panel, for docs/blender/desktop.md, and that it can be worked."""

import time

import steps

IN_THE_VALUES = 250
DOWN_TO_LAST_RENDER = 126  # pixels: past a button and three lines on coverage


def with_ray_tracing(on):
    bpy.context.scene.eevee.use_raytracing = on
    area("PROPERTIES")[1].tag_redraw()


def pictured(window, name):
    window.over("VIEW_3D")  # or else a tooltip covers part of it
    time.sleep(1)
    window.picture(name, "PROPERTIES")


def test_the_panel(window, afterlight):
    """As it comes, ticked after a render with the last sub-panel opened, and with something to say."""
    steps.new_box(window)
    window.run(steps.use, "RADIOSITY")
    steps.widen(window)
    steps.open_panel(window)
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
