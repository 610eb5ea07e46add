# SPDX-License-Identifier: GPL-3.0-or-later
"""ESC: in the middle of EEVEE's part and of ours. It stops at once, and leaves the plain picture and every setting."""

import os
import time

import numpy as np
import pytest
import steps

AT_ONCE = 0.3  # seconds from the key to the end of the render, on a machine with nothing else to do


def long_for_eevee():
    bpy.context.scene.eevee.taa_render_samples = 48


def quick():
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scene.eevee.taa_render_samples = 4
    scene.afterlight.start, scene.afterlight.samples, scene.afterlight.radius = "HALF", 256, 16


def escape(window):
    """Press ESC; seconds until Blender says that the render is cancelled."""
    cancelled = window.value("happened('render_cancel')")
    # xdotool itself says when, on the clock that Blender's Python reads: starting a process can take as long as the
    # rest.
    start = float(
        window.xdotool(
            "exec", "--sync", "--terminator", "then", "cat", "/proc/uptime", "then", "key", "Escape"
        ).split()[0]
    )
    window.wait(f"happened('render_cancel') > {cancelled} and not rendering()")
    return window.value("[event[1] for event in events if event[0] == 'render_cancel'][-1]") - start


@pytest.fixture
def lit(window, afterlight):
    """A ticked scene that has been rendered once, and its picture."""
    steps.new_box(window)
    steps.tick(window)
    window.run(quick)
    window.render()
    return steps.result(window, "before")


@pytest.mark.parametrize("method", ["PAPER", "RADIOSITY"])
def test_in_ours(window, lit, method):
    window.run(steps.use, method)
    if method == "RADIOSITY":
        window.render()  # its views are placed
    window.run(steps.long_gather)
    window.value("remember()")
    steps.into_the_gather(window)
    seconds = escape(window)
    # Where others want the cores too, all of it takes as much longer, Blender's own part as well.
    share = max(1, os.getloadavg()[0] / os.cpu_count())
    print(f"ESC in ours: {seconds:.2f} s, with {share:.1f} programs a core")
    assert window.value("changed()") == []
    left = steps.result(window, "left")
    window.run(quick)
    window.run(steps.use, "PAPER")
    window.render()
    assert np.array_equal(steps.result(window, "after"), lit)
    assert left.shape == (360, 640, 3) and 0 < np.mean(left) < 0.9 * np.mean(lit)
    assert seconds < AT_ONCE * share


def test_in_eevee(window, lit):
    window.run(long_for_eevee)
    window.value("remember()")
    cancelled = window.value("happened('render_cancel')")
    window.start_render()
    time.sleep(2)  # Blender answers nothing while EEVEE renders
    window.key("Escape")
    window.wait(f"happened('render_cancel') > {cancelled} and not rendering()")
    assert window.value("changed()") == []
    window.run(quick)
    window.render()
    assert np.array_equal(steps.result(window, "after_eevee"), lit)
