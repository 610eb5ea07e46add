# SPDX-License-Identifier: GPL-3.0-or-later
"""The light in viewports, as far as it needs no window: which edits it follows, through which cameras it sees, and that
it is off unless enabled. tests/desktop/test_viewport.py tests the rest."""

from importlib import import_module

import bpy
import numpy as np
import pytest
from mathutils import Matrix


@pytest.fixture
def changes(addon, scene):
    """A function that returns which kinds of change have happened since its last call."""
    scene_changes = import_module(f"{addon.__name__}.viewport.scene_changes")
    scene.afterlight.enabled = scene.afterlight.use_viewport = True
    bpy.context.view_layer.update()
    before = [scene_changes.change_counts(scene)]

    def changed():
        bpy.context.view_layer.update()
        now = scene_changes.change_counts(scene)
        found = {kind for kind in ("lights", "geometry") if getattr(now, kind) != getattr(before[0], kind)}
        before[0] = now
        return found

    changed()
    assert changed() == set()
    return changed


def lamp_moves(scene):
    bpy.data.objects["Lamp"].location.x += 0.1


def lamp_brightens(scene):
    bpy.data.lights["Lamp"].energy *= 2


def wall_moves(scene):
    bpy.data.objects["Wall"].location.z -= 0.1


def material_changes(scene):
    bpy.data.materials["Red"].node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0, 1, 0, 1)


def wall_is_hidden(scene):
    bpy.data.objects["Wall.001"].hide_set(True)


def wall_is_removed(scene):
    bpy.data.objects.remove(bpy.data.objects["Wall.001"])


def both_move(scene):
    lamp_moves(scene)
    wall_moves(scene)


def eevee_is_set(scene):
    scene.eevee.light_threshold = 0.5


def world_is_given(scene):
    scene.world = bpy.data.worlds.new("World")


def frame_changes(scene):
    scene.frame_set(7)


def wall_is_selected(scene):
    bpy.data.objects["Wall"].select_set(True)


def strength_is_set(scene):
    scene.afterlight.strength = 0.5


@pytest.mark.parametrize(
    "edit, kinds",
    [
        (lamp_moves, {"lights"}),
        (lamp_brightens, {"lights"}),
        (wall_moves, {"geometry"}),
        (material_changes, {"geometry"}),
        (wall_is_hidden, {"geometry"}),
        (wall_is_removed, {"geometry"}),
        (both_move, {"geometry"}),
        (eevee_is_set, {"geometry"}),
        (frame_changes, {"geometry"}),
        (wall_is_selected, set()),
        (strength_is_set, set()),
    ],
)
def test_edits_are_told_apart(scene, changes, edit, kinds):
    edit(scene)
    assert changes() == kinds


def test_a_new_world_is_followed(scene, changes):
    world_is_given(scene)
    assert changes()


def test_where_no_viewport_is_lit_nothing_is_followed(scene, changes):
    scene.afterlight.use_viewport = False
    wall_moves(scene)
    assert changes() == set()


def test_a_viewport_is_lit_where_all_is_asked_for(scene, addon):
    from types import SimpleNamespace

    handlers = import_module(f"{addon.__name__}.viewport.draw_handlers")
    space = SimpleNamespace(shading=SimpleNamespace(type="RENDERED", render_pass="COMBINED"))
    assert not handlers.is_lit(scene, space), "not unless asked for"
    scene.afterlight.use_viewport = True
    assert not handlers.is_lit(scene, space), "nor without the box in the panel's header"
    scene.afterlight.enabled = True
    assert handlers.is_lit(scene, space) and handlers.problem(scene) == ""
    for shading in (("SOLID", "COMBINED"), ("MATERIAL", "COMBINED"), ("RENDERED", "NORMAL")):
        assert not handlers.is_lit(
            scene, SimpleNamespace(shading=SimpleNamespace(type=shading[0], render_pass=shading[1]))
        )
    scene.eevee.use_raytracing = True
    assert not handlers.is_lit(scene, space) and "already adds" in handlers.problem(scene)
    scene.eevee.use_raytracing = False
    scene.render.engine = "BLENDER_WORKBENCH"
    assert not handlers.is_lit(scene, space)
    assert not handlers.is_lit(scene.afterlight.helper, space)


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_matrices_see_what_cameras_see(scene, addon, kind):
    """camera_of() a camera's matrices equals cameras.camera(), and so does window_matrix() of its lens if the frame is
    square."""
    offscreen, view_cameras, passes = (
        import_module(f"{addon.__name__}.{name}")
        for name in ("viewport.offscreen", "scene.view_cameras", "scene.passes")
    )
    scene.render.resolution_x = scene.render.resolution_y = 48
    camera = scene.camera
    camera.data.type, camera.data.shift_x, camera.data.shift_y = kind, 0.1, -0.05
    camera.rotation_euler = 1.2, 0.1, 0.3
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = camera.evaluated_get(depsgraph)
    exact = addon.scene.cameras.camera_at(evaluated.matrix_world, evaluated, depsgraph, (0, 0), (48, 48), (1.0, 1.0))
    lens = view_cameras.lens_of(evaluated, depsgraph, scene)
    for window in (
        evaluated.calc_matrix_camera(depsgraph, x=48, y=48),
        Matrix(view_cameras.window_matrix(lens, scene).tolist()),
    ):
        found = offscreen.camera_of(evaluated.matrix_world.inverted(), window, (48, 48))
        assert found.orthographic == exact.orthographic == (kind == "ORTHO")
        for name in ("rotation", "scale", "offset", "position"):
            np.testing.assert_allclose(getattr(found, name), getattr(exact, name), atol=1e-5, err_msg=name)


def test_small_shifts_fill_a_pixel(addon):
    region = import_module(f"{addon.__name__}.viewport.region_light")
    window = Matrix(((1, 0, 0.2, 0), (0, 2, -0.1, 0), (0, 0, -1, -0.2), (0, 0, -1, 0)))
    place, size = np.array([0.3, -0.2, -2.0, 1.0]), (64, 36)

    def seen(number):
        clip = np.array(region._shifted(window, number, size)) @ place
        return (clip[:2] / clip[3] + 1) / 2 * size

    shifts = np.array([seen(number) - seen(0) for number in range(64)])
    assert (np.abs(shifts) <= 0.5).all() and np.abs(shifts.mean(0)).max() < 0.02 and (shifts.std(0) > 0.25).all()
