# SPDX-License-Identifier: GPL-3.0-or-later
"""The views that a view scene renders (compositor/view_scenes.py): the lens of each, and how its camera object must be
set so that Blender renders just that.

One scene renders all of them, by Blender's multi-view: it evaluates the scene once, and then renders it through each of
several cameras, which it finds by the ends of their names. A view is left out by switching off its render view.
"""

from dataclasses import dataclass
from math import radians

import bpy
import numpy as np
from mathutils import Matrix

from .. import gather
from ..host import roles
from ..host.assign import assign
from ..translations import say
from . import cameras, pixel_jitter

FIELD = radians(120)  # of an automatic view, horizontally and vertically: its pixels are not square if the frame isn't
HALF_FIELD = np.tan(FIELD / 2) * np.ones(2)  # tangents of half the field of view
BUILT_IN = "left", "right"  # render views that every scene has, of which Blender keeps the first


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


@dataclass(frozen=True)
class View:
    """A view. scene: the view scene that renders it. index: among that scene's views."""

    scene: bpy.types.Scene
    index: int

    @property
    def camera(self) -> bpy.types.Object:
        """Its own camera."""
        return roles.cameras(self.scene)[self.index]

    @property
    def suffix(self) -> str:
        """The end of its camera's name, and of its file's."""
        return roles.suffix(self.index)

    @property
    def is_used(self) -> bool:
        """Whether Blender renders it in this frame."""
        return self.scene.view_layers[0].use and self._render_view().use

    def use(self, used: bool) -> None:
        """Have Blender render it in this frame, or leave it out."""
        assign(self._render_view(), "use", used)
        assign(self.scene.view_layers[0], "use", any(each.use for each in self.scene.render.views))

    def _render_view(self):
        return self.scene.render.views[_render_view_name(self.index)]


def set_up(view_scene: bpy.types.Scene, number: int) -> None:
    """Make a view scene have `number` views, with a camera each."""
    roles.give_cameras(view_scene, number)
    render, names = view_scene.render, [_render_view_name(index) for index in range(number)]
    assign(render, "use_multiview", True)
    assign(render, "views_format", "MULTIVIEW")
    for each in [each for each in render.views if each.name not in names]:
        if each.name in BUILT_IN:
            assign(each, "use", False)
        else:
            render.views.remove(each)
    for index, name in enumerate(names):
        if name not in render.views:
            render.views.new(name).use = False
        assign(render.views[name], "camera_suffix", roles.suffix(index))


def is_set_up(view_scene: bpy.types.Scene, number: int) -> bool:
    """Whether a view scene has all that set_up() makes."""
    found = roles.cameras(view_scene)
    return (
        len(found) == number
        and view_scene.camera == found[0]
        and view_scene.render.use_multiview
        and all(_render_view_name(index) in view_scene.render.views for index in range(number))
    )


def views(view_scene: bpy.types.Scene) -> list[View]:
    """The views that a view scene can render, in order."""
    found = [View(view_scene, index) for index in range(len(roles.cameras(view_scene)))]
    return [view for view in found if _render_view_name(view.index) in view_scene.render.views]


def _render_view_name(index):
    return f"Afterlight {index + 1}"


def unusable(camera_object: bpy.types.Object | None) -> str:
    """Why an object from the user's list can't be a view, as a sentence for people; empty if it can."""
    if camera_object is None:
        return say("A view in the list has no camera. Choose one, or remove the entry")
    if camera_object.type != "CAMERA":
        return say('The view "{}" is not a camera object and was left out. Choose a camera instead', camera_object.name)
    if camera_object.data.type not in {"PERSP", "ORTHO"}:
        return say(
            'The view "{}" is panoramic and was left out. Set its Lens Type to Perspective or Orthographic',
            camera_object.name,
        )
    return ""


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


def pose(view: View, scene: bpy.types.Scene, matrix, lens: Lens) -> None:
    """Make Blender render a view in this frame of `scene`, from `matrix` (4 x 4, world).

    Blender renders it at the scene's resolution and, if there is one, within its render border. The camera is set so
    that this border holds the whole view. All views of a scene have the same field of view across and up, and so the
    same aspect of a pixel, which Blender knows for the whole view scene alone."""
    camera_object = view.camera
    data = camera_object.data
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
        assign(camera_object, name, value)
    for name, value in (
        ("pixel_aspect_x", max(1 / stretch, 1.0)),
        ("pixel_aspect_y", max(stretch, 1.0)),
        ("use_border", scene.render.use_border),
        ("use_crop_to_border", scene.render.use_crop_to_border),
    ):
        assign(view.scene.render, name, value)
    view.use(True)


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


def view_state(view: View, scene: bpy.types.Scene) -> tuple:
    """Everything that decides what a view sees of a scene that doesn't change."""
    camera_object = view.camera
    data = camera_object.data
    return (
        cameras.window(scene),
        _aspect(view.scene),
        camera_object.location[:],
        camera_object.rotation_quaternion[:],
        data.type,
        *(
            getattr(data, name)
            for name in ("sensor_width", "ortho_scale", "shift_x", "shift_y", "clip_start", "clip_end")
        ),
    )


def camera(view: View, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene) -> gather.Camera:
    """gather.Camera of a view that is rendered together with `scene`. Its pose is the one that pose() set: nothing
    animates it, so the depsgraph need not have evaluated it."""
    camera_object = view.camera
    matrix = Matrix.LocRotScale(camera_object.location, camera_object.rotation_quaternion, None)
    (x, y, _, _), full = cameras.window(scene)
    return cameras.camera_at(
        matrix,
        camera_object,
        depsgraph,
        (x, y),
        full,
        _aspect(view.scene),
        pixel_jitter.depth_sample_offset(view.scene, view.scene.view_layers[0]),
    )


def _aspect(view_scene):
    return view_scene.render.pixel_aspect_x, view_scene.render.pixel_aspect_y
