# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered part of a frame, and the cameras that see it, as gather.Camera."""

import bpy
import numpy as np

from .. import gather
from . import pixel_jitter

Window = tuple[int, int, int, int]  # x, y from the bottom left; width, height; in pixels
Size = tuple[int, int]  # width, height


def window(scene: bpy.types.Scene) -> tuple[Window, Size]:
    """((x, y, width, height), (full width, full height)) in pixels: the part of the frame that is rendered, counted
    from its bottom left, and the full frame. Rounded as Blender rounds."""
    render = scene.render
    width, height = (
        max(1, int(size * render.resolution_percentage / 100)) for size in (render.resolution_x, render.resolution_y)
    )
    if not render.use_border:
        return (0, 0, width, height), (width, height)

    def pixel(share, size):
        return int(np.float32(share) * np.float32(size))

    x, y = pixel(render.border_min_x, width), pixel(render.border_min_y, height)
    right, top = pixel(render.border_max_x, width), pixel(render.border_max_y, height)
    return (x, y, right - x, top - y), (width, height)


def first_layer(scene: bpy.types.Scene) -> bpy.types.ViewLayer:
    """The first view layer that is rendered."""
    return next(layer for layer in scene.view_layers if layer.use)


def camera(
    evaluated: bpy.types.Object, depsgraph: bpy.types.Depsgraph, scene: bpy.types.Scene, layer: str | None = None
) -> gather.Camera:
    """gather.Camera of an evaluated camera object, for the rendered part of `scene`'s frame. layer: name of the view
    layer, by default the first that is rendered.

    Computed from Blender's own projection matrix, which includes lens, sensor fit, shift and pixel aspect."""
    (x, y, _, _), full = window(scene)
    aspect = scene.render.pixel_aspect_x, scene.render.pixel_aspect_y
    layer = scene.view_layers[layer] if layer else first_layer(scene)
    return camera_at(
        evaluated.matrix_world,
        evaluated,
        depsgraph,
        (x, y),
        full,
        aspect,
        pixel_jitter.depth_sample_offset(scene, layer),
    )


def camera_at(
    matrix,
    lens: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    corner: tuple[int, int],
    full: Size,
    aspect: tuple[float, float],
    middle: tuple[float, float] = (0.0, 0.0),
) -> gather.Camera:
    """gather.Camera at `matrix` (world) with the lens of the camera object `lens`, for the part of a frame of `full`
    pixels (width, height) that begins at `corner`. middle: (x, y), offset in pixels from the middle of a pixel to where
    EEVEE sampled its depth (pixel_jitter.py)."""
    (x, y), (width, height) = corner, full
    projection = np.array(lens.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=aspect[0], scale_y=aspect[1]))
    axes = np.array(matrix.to_3x3())
    to_world = axes / np.linalg.norm(axes, axis=0)  # Blender ignores the scale of a camera
    return camera_through(
        projection,
        np.linalg.inv(to_world),
        matrix.translation,
        np.array([x, y]) + middle,
        (width, height),
        orthographic=lens.data.type == "ORTHO",
    )


def camera_through(
    projection: np.ndarray, rotation: np.ndarray, position, corner, full: Size, *, orthographic: bool
) -> gather.Camera:
    """gather.Camera of a projection matrix (4, 4) float64. corner: of the image, within the frame of `full` pixels."""
    # ndc = (P00 q + P02 * -1) / 1 in perspective, P00 q + P03 in orthographic; ndc = 2 pixel / size - 1.
    shift = -projection[:2, 3] if orthographic else projection[:2, 2]
    focus, size = projection[(0, 1), (0, 1)], np.array(full, float)
    return gather.Camera(
        rotation=rotation,
        scale=2 / size / focus,
        offset=(2 * np.asarray(corner) / size - 1 + shift) / focus,
        orthographic=orthographic,
        position=np.array(position, float),
    )


def positions(passes: gather.Passes, gather_camera: gather.Camera, flat_indices: np.ndarray) -> np.ndarray:
    """(N, 3) float64, world positions of the pixels with these flat indices. passes: gather.Passes, as seen by
    gather.Camera."""
    width, height = passes.size
    row, column = np.divmod(flat_indices, width)
    ray = gather_camera.offset + gather_camera.scale * np.stack([column + 0.5, height - row - 0.5], axis=-1)
    depth = passes.depth[row, column].astype(float)[:, None]
    local = np.concatenate([ray * (1 if gather_camera.orthographic else depth), -depth], axis=1)
    return local @ gather_camera.rotation + gather_camera.position  # the inverse of the rotation is its transpose


def project(points: np.ndarray, size: Size, gather_camera: gather.Camera) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(rows, columns, depths) of world positions (N, 3) in a frame of `size` (width, height) seen by gather.Camera;
    rows and columns are -1 where a position is outside the frame."""
    width, height = size
    local = (points - gather_camera.position) @ gather_camera.rotation.T
    depth = -local[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        plane = local[:, :2] if gather_camera.orthographic else local[:, :2] / depth[:, None]
    column, up = np.nan_to_num(
        (plane - gather_camera.offset) / gather_camera.scale, nan=-1.0, posinf=-1.0, neginf=-1.0
    ).T
    inside = (depth > 0) & (column >= 0) & (column < width) & (up >= 0) & (up < height)
    row = np.where(inside, height - 1 - np.floor(up).clip(0, height - 1), -1).astype(int)
    return row, np.where(inside, np.floor(column), -1).astype(int), depth
