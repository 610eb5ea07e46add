# SPDX-License-Identifier: GPL-3.0-or-later
"""The cameras of views: the lens of each, and how its camera object must be set so that Blender renders just that. The
view scenes are those of compositor/view_scenes.py."""

from dataclasses import dataclass
from math import radians

import bpy
import numpy as np
from mathutils import Matrix

from .. import gather
from ..host.assign import assign
from . import cameras, pixel_jitter

FIELD = radians(120)  # of an automatic view, horizontally and vertically: its pixels are not square if the frame isn't
HALF_FIELD = np.tan(FIELD / 2) * np.ones(2)  # tangents of half the field of view


@dataclass(frozen=True)
class Lens:
    """The projection of a view. pixel: (width, height) of a pixel, at depth 1 (perspective) or in metres
    (orthographic). centre: (x, y), where the optical axis meets the image, in pixels from its middle. near, far: clip
    start and end, metres."""

    pixel: tuple
    near: float
    far: float
    centre: tuple = (0.0, 0.0)
    orthographic: bool = False


def lens_of(camera_object: bpy.types.Object, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene) -> Lens:
    """Lens of an evaluated camera of the user's for a view in the rendered part of the frame: a square field of view,
    so that the image's shorter side sees as far as the longer one."""
    *_, width, height = cameras.window(scene)[0]
    size = np.array((width, height))
    gather_camera = cameras.camera_at(
        camera_object.matrix_world, camera_object, depsgraph, (0, 0), (width, height), (1.0, 1.0)
    )
    pixel = (gather_camera.scale * size).max() / size
    axis = -(gather_camera.offset + gather_camera.scale * size / 2) / pixel
    return Lens(
        tuple(pixel),
        camera_object.data.clip_start,
        camera_object.data.clip_end,
        tuple(axis),
        gather_camera.orthographic,
    )


def wide_lens(scene: bpy.types.Scene, near: float, far: float) -> Lens:
    """Lens of an automatic view."""
    return Lens(tuple(2 * HALF_FIELD / np.array(cameras.window(scene)[0][2:])), near, far)


def pose(view: bpy.types.Scene, scene: bpy.types.Scene, matrix, lens: Lens) -> None:
    """Make a view scene render in this frame of `scene`, from `matrix` (4 x 4, world).

    Blender renders it at the scene's resolution and, if there is one, within its render border. The camera is set so
    that this border holds the whole view."""
    camera, data = view.camera, view.camera.data
    location, rotation, _ = Matrix(matrix).decompose()
    (x, y, width, height), full = cameras.window(scene)
    across, up = lens.pixel
    # Blender measures a frame in widths of its pixels, and fits its longer side to the sensor.
    stretch = up / across
    longer = max(full[0], stretch * full[1])
    values = {
        "type": "ORTHO" if lens.orthographic else "PERSP",
        "sensor_fit": "AUTO",
        "lens": 500.0,
        "sensor_width": 500.0 * across * longer,
        "ortho_scale": across * longer,
        "shift_x": (full[0] / 2 - x - width / 2 - lens.centre[0]) / longer,
        "shift_y": stretch * (full[1] / 2 - y - height / 2 - lens.centre[1]) / longer,
        "clip_start": lens.near,
        "clip_end": lens.far,
    }
    for name, value in values.items():
        assign(data, name, value)
    for name, value in (("rotation_mode", "QUATERNION"), ("location", location), ("rotation_quaternion", rotation)):
        assign(camera, name, value)
    for name, value in (
        ("pixel_aspect_x", max(1 / stretch, 1.0)),
        ("pixel_aspect_y", max(stretch, 1.0)),
        ("use_border", scene.render.use_border),
        ("use_crop_to_border", scene.render.use_crop_to_border),
    ):
        assign(view.render, name, value)
    assign(view.view_layers[0], "use", True)


def window_matrix(lens: Lens, scene: bpy.types.Scene) -> np.ndarray:
    """(4, 4) float64: the projection matrix of a lens in `scene`."""
    size, pixel = np.array(cameras.window(scene)[0][2:], float), np.array(lens.pixel)
    low, high = ((side * size / 2 - lens.centre) * pixel for side in (-1, 1))
    near, far = lens.near, lens.far
    projection = np.zeros((4, 4))
    projection[(0, 1), (0, 1)] = 2 / (high - low)
    if lens.orthographic:
        projection[:2, 3] = -(high + low) / (high - low)
        projection[2, 2:], projection[3, 3] = (-2 / (far - near), -(far + near) / (far - near)), 1
    else:
        projection[:2, 2] = (high + low) / (high - low)
        projection[2, 2:], projection[3, 2] = (-(far + near) / (far - near), -2 * far * near / (far - near)), -1
    return projection


def view_state(view: bpy.types.Scene, scene: bpy.types.Scene) -> tuple:
    """Everything that decides what a view sees of a scene that doesn't change."""
    camera, data = view.camera, view.camera.data
    return (
        cameras.window(scene),
        _aspect(view),
        camera.location[:],
        camera.rotation_quaternion[:],
        data.type,
        *(
            getattr(data, name)
            for name in ("sensor_width", "ortho_scale", "shift_x", "shift_y", "clip_start", "clip_end")
        ),
    )


def camera(view: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene) -> gather.Camera:
    """gather.Camera of a view that is rendered together with `scene`. Its pose is the one that pose() set: nothing
    animates it, so the depsgraph need not have evaluated it."""
    matrix = Matrix.LocRotScale(view.camera.location, view.camera.rotation_quaternion, None)
    (x, y, _, _), full = cameras.window(scene)
    return cameras.camera_at(
        matrix,
        view.camera,
        depsgraph,
        (x, y),
        full,
        _aspect(view),
        pixel_jitter.depth_sample_offset(view, view.view_layers[0]),
    )


def _aspect(view):
    return view.render.pixel_aspect_x, view.render.pixel_aspect_y
