# SPDX-License-Identifier: GPL-3.0-or-later
"""EEVEE's passes as GPU textures, drawn off screen as the viewport would show each of them."""

from contextlib import contextmanager
from dataclasses import replace

import gpu
import numpy as np

from .. import gather
from ..gather import device, interactive
from ..host import put_back
from ..scene import cameras

# The passes that are drawn: their names in gather/interactive.py, and the render pass of the viewport's shading. Only
# diffuse_direct changes with lights.
SHADING = {
    "position": "POSITION",
    "normal": "NORMAL",
    "diffuse_color": "DIFFUSE_COLOR",
    "diffuse_direct": "DIFFUSE_LIGHT",
    "emission": "EMISSION",
}
ALL_PASSES = tuple(SHADING)
LIGHT_PASSES = ("diffuse_direct",)

# Settings of the viewport and the evaluated scene while passes are drawn: no compositor, and one sample for each pixel,
# which is at its middle.
_SPACE = (("overlay", "show_overlays", False),)
_SHADED = (("use_compositor", "DISABLED"), ("use_dof", False))
_SCENE = (("eevee", "taa_samples", 1), ("render", "preview_pixel_size", "1"))


class OffscreenPicture:
    """An off-screen GPU image, kept while its size stays the same: EEVEE keeps its shadows with it from one pass to the
    next."""

    def __init__(self):
        self._gpu_offscreen = None

    def draw(self, viewport, view_matrix, window_matrix, drawn, names=ALL_PASSES):
        """Draw passes of what `viewport` shows, through a camera of these matrices (4 x 4), into `drawn`,
        gather.GpuPasses. Returns gather.Camera if positions are among the passes. Call within drawing(). Raises
        gather.GpuUnavailable."""
        gpu_offscreen, camera = self._ensure(drawn.size), None
        for name in names:
            viewport.space.shading.render_pass = SHADING[name]
            gpu_offscreen.draw_view3d(
                viewport.scene,
                viewport.layer,
                viewport.space,
                viewport.region,
                view_matrix,
                window_matrix,
                do_color_management=False,
            )
            picture = device.Texture(gpu_offscreen.texture_color)
            if name == "position":
                camera = _behind_all(camera_of(view_matrix, window_matrix, drawn.size), picture)
            interactive.split(name, picture, camera, drawn)
        return camera

    def _ensure(self, size):
        if self._gpu_offscreen is None or (self._gpu_offscreen.width, self._gpu_offscreen.height) != size:
            self.free()
            try:
                self._gpu_offscreen = gpu.types.GPUOffScreen(*size, format="RGBA32F")
            except Exception as error:  # Blender raises a bare Exception here
                raise gather.GpuUnavailable(
                    "The GPU has no memory for a texture of {} x {}. Use a coarser start resolution, or lower "
                    "the render resolution",
                    *size,
                ) from error
        return self._gpu_offscreen

    def free(self):
        """Free the image and what EEVEE keeps with it."""
        gpu_offscreen, self._gpu_offscreen = self._gpu_offscreen, None
        if gpu_offscreen is not None:
            gpu_offscreen.free()


@contextmanager
def drawing(viewport):
    """Context for drawing passes: changes settings of the viewport, and restores them at the end. No other viewport
    draws in the meantime."""
    scene = viewport.depsgraph.scene_eval  # changes to it don't reach the user's scene
    temporary = [(getattr(scene, part), name, value) for part, name, value in _SCENE]
    temporary += [(getattr(viewport.space, part), name, value) for part, name, value in _SPACE]
    temporary += [(viewport.space.shading, name, value) for name, value in (*_SHADED, ("render_pass", "COMBINED"))]
    previous = [(owner, name, put_back.current(owner, name)) for owner, name, _ in temporary]
    try:
        for (owner, name, value), (*_, previous_value) in zip(temporary, previous):
            if previous_value != value:
                setattr(owner, name, value)
        yield
    finally:
        put_back.restore(previous)


def camera_of(view_matrix, window_matrix, size):
    """gather.Camera of a viewport's matrices, for an image of `size` (width, height) pixels."""
    view, window = np.array(view_matrix, float), np.array(window_matrix, float)
    rotation = view[:3, :3] / np.linalg.norm(view[:3, :3], axis=1)[:, None]
    return cameras.camera_through(
        window, rotation, -rotation.T @ view[:3, 3], (0, 0), size, orthographic=bool(window[3, 3])
    )


def _behind_all(camera, picture):
    """An orthographic viewport also shows what is behind its position: move the camera back behind everything, but no
    farther, to keep depths precise."""
    depths = interactive.depth_range(picture, camera) if camera.orthographic else None
    if depths is None:
        return camera
    nearest, farthest = depths
    distance = (farthest - nearest) / 2 - nearest + 1e-3
    return replace(camera, position=camera.position + distance * camera.rotation[2])
