# SPDX-License-Identifier: GPL-3.0-or-later
"""A person installs Afterlight, ticks the box and presses F12: the picture is the one that `blender -b` makes."""

import numpy as np
import pytest
import steps

LIT = {}  # the picture by method and backend, and its file


def test_install_and_find_the_panel(window, afterlight):
    steps.new_box(window)
    window.point_at(steps.ENABLED)
    window.picture("panel_found")


@pytest.mark.parametrize("method", ["PAPER", "RADIOSITY"])
def test_picture_is_that_of_the_command_line(window, afterlight, method):
    """Bit for bit; and it is not that of EEVEE alone."""
    steps.new_box(window)
    window.render()
    plain = steps.result(window, "plain")
    window.run(steps.use, method)
    steps.tick(window)
    window.render()
    window.picture("rendered")
    lit = steps.result(window, "lit")
    assert window.value("bpy.context.scene.afterlight.report") == ""
    assert np.all(lit >= plain) and np.mean(lit) > 1.2 * np.mean(plain)
    assert np.array_equal(lit, steps.headless(window, f"lit_{method}"))
    for (other_method, backend), (other, blend) in LIT.items():
        if other_method == method:
            print(f"{method}: largest difference to {backend}: {np.max(np.abs(lit - other)):.2g}")
            if method == "PAPER":  # EEVEE's colours are half floats: a step of theirs, where rounding falls otherwise
                np.testing.assert_allclose(lit, other, rtol=0, atol=2**-11)
                continue
            # Rounding decides here and there which of two equally good places a view gets: 0.4 % of the light
            assert abs(lit.mean() / other.mean() - 1) < 0.02
            # and, where the views are those of the other's file, which emitter is drawn: other noise of the same light
            same_views = steps.render_file(window.computer, blend, window.computer.folder / f"views_of_{backend}")
            print(
                f"views of {backend}: {abs(same_views.mean() / other.mean() - 1):.2g} in the mean, "
                f"{np.abs(same_views - other).mean() / other.mean():.2g} a pixel"
            )
            assert abs(same_views.mean() / other.mean() - 1) < 0.005
            assert np.abs(same_views - other).mean() < 0.05 * other.mean()
    LIT[method, window.computer.backend] = lit, window.computer.folder / f"lit_{method}.blend"


def test_undo_redo_save_reopen(window, afterlight):
    steps.new_box(window)
    steps.tick(window)
    window.render()
    lit = steps.result(window, "before_undo")
    window.over("VIEW_3D")
    window.key("ctrl+z")
    window.wait("not bpy.context.scene.afterlight.enabled and len(bpy.data.scenes) == 1")
    window.render()
    assert np.mean(steps.result(window, "undone")) < np.mean(lit)
    window.over("VIEW_3D")
    window.key("ctrl+shift+z")
    window.wait("bpy.context.scene.afterlight.enabled and len(bpy.data.scenes) == 2")
    window.render()
    assert np.array_equal(steps.result(window, "redone"), lit)
    path = window.computer.folder / "saved.blend"
    window.run(steps.save_as, path)
    window.run(steps.open_file, path)
    window.render()
    assert np.array_equal(steps.result(window, "reopened"), lit)
