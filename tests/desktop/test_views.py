# SPDX-License-Identifier: GPL-3.0-or-later
"""Further views in a window: placed in the render thread, for the same frame, where the command line places them."""

import json

import numpy as np
import steps


def look_closer():
    """Most of the box is out of the picture."""
    scene = bpy.context.scene
    scene.camera.location, scene.camera.rotation_euler = (-0.5, 0, 0), (1.5707963, 0, 1.5707963)
    scene.afterlight.method, scene.afterlight.view_count, scene.afterlight.views = "RADIOSITY", 5, "AUTOMATIC"


def placed():
    """[(location, rotation)] of the views, [(mark, whether rendered at rest)] of their scenes, the number of placed
    views."""
    held = [each.scene for each in bpy.context.scene.afterlight.view_scenes]
    return [
        [(*camera.location, *camera.rotation_quaternion) for camera in sorted(held[1].objects, key=lambda o: o.name)],
        [(each.afterlight.role.lower(), each.view_layers[0].use) for each in held],
        len(held[0]["placed"]["poses"]) // 16,
    ]


def move_camera():
    bpy.context.scene.camera.location.y += 0.2


def turn_camera():
    scene = bpy.context.scene
    scene.camera.rotation_euler = (1.5707963, 0, -1.5707963)
    scene.camera.location.x = 0.5


WRITE = (
    "import bpy, json, sys; bpy.context.scene.frame_set(1); "
    "bpy.app.handlers.render_complete.append(lambda *_: print('VIEWS', json.dumps([[*camera.location, "
    "*camera.rotation_quaternion] for camera in sorted(bpy.context.scene.afterlight.view_scenes[1].scene.objects, "
    "key=lambda camera: camera.name)])))"
)


def test_views_are_placed_as_on_the_command_line(window, afterlight):
    steps.new_box(window)
    window.run(look_closer)
    steps.tick(window)
    path = window.computer.folder / "views.blend"
    window.run(steps.save_as, path)  # nothing is placed yet
    window.render()
    assert window.value("bpy.context.scene.afterlight.report") == ""
    poses, states, count = window.run(placed)
    assert 1 <= count <= 5 and len(poses) == 5
    assert states == [["scout", True], ["view", False]], "at rest no view is rendered"
    lit = steps.result(window, "views")
    output = window.computer.headless(
        path, "--python-expr", WRITE, "-o", window.computer.folder / "views_####", "-f", 1
    )
    apart = json.loads(next(line for line in output.splitlines() if line.startswith("VIEWS"))[6:])
    np.testing.assert_allclose(apart[:count], poses[:count], atol=1e-6)
    assert np.isfinite(lit).all()

    window.run(move_camera)
    window.render()
    assert window.run(placed)[0] == poses, "the views stay where they see enough"
    window.run(turn_camera)
    window.render()
    assert window.value("bpy.context.scene.afterlight.report") == ""
