# SPDX-License-Identifier: GPL-3.0-or-later
"""Another Blender opens the file; the extension is switched off, and Blender quits, in the middle of our part."""

import numpy as np
import pytest
import steps
from window import Window


@pytest.fixture
def another(window, afterlight):
    """A saved file and its picture, and a new Blender that has opened it."""
    steps.new_box(window)
    steps.tick(window)
    window.render()
    lit = steps.result(window, "first_process")
    path = window.computer.folder / "handed_on.blend"
    window.run(steps.save_as, path)
    new = Window(window.computer, path)
    yield new, lit
    new.close()


def switch_off():
    bpy.ops.preferences.addon_disable(module="bl_ext.user_default.afterlight")


def quit_blender():
    bpy.app.timers.register(lambda: bpy.ops.wm.quit_blender() and None)


def test_reopened_by_another_process_and_quit_in_the_middle(another):
    window, lit = another
    window.render()
    assert np.array_equal(steps.result(window, "second_process"), lit)
    window.run(steps.long_gather)
    steps.into_the_gather(window)
    window.run(quit_blender)
    assert window.blender.wait(20) == 0


def test_switched_off_in_the_middle(another):
    """That render ends without our light, and Blender goes on."""
    window, _ = another
    window.run(steps.long_gather)
    steps.into_the_gather(window)
    window.run(switch_off)
    window.wait("not rendering() and not hasattr(bpy.types, 'AfterlightEngine')", 60)
    window.render()
    assert "Traceback" not in window.log()
