# SPDX-License-Identifier: GPL-3.0-or-later
"""EEVEE's passes on the GPU, drawn off screen as the viewport would show each of them."""

from contextlib import contextmanager
from dataclasses import replace

import gpu
import numpy as np

from .. import gather
from ..gather import device, interactive
from ..host import put_back
from ..scene import cameras

# What is drawn: the passes as gather/interactive.py names them, and as the viewport's shading does. Only the last but
# one changes with lamps.
SHADING = {
    "place": "POSITION",
    "normal": "NORMAL",
    "diffuse_color": "DIFFUSE_COLOR",
    "diffuse_direct": "DIFFUSE_LIGHT",
    "emission": "EMISSION",
}
ALL_PASSES = tuple(SHADING)
LIGHT_PASSES = ("diffuse_direct",)

# How the viewport and the evaluated scene must be set while passes are drawn: without a compositor, and one sample a
# pixel, which is then its middle.
_SPACE = (("overlay", "show_overlays", False),)
_SHADED = (("use_compositor", "DISABLED"), ("use_dof", False))
_SCENE = (("eevee", "taa_samples", 1), ("render", "preview_pixel_size", "1"))


class OffscreenPicture:
    """An off-screen picture, kept while its size is asked for: with it EEVEE keeps its shadows from one pass to the
    next."""

    def __init__(self):
        self._gpu_offscreen = None

    def draw(self, stage, view_matrix, window_matrix, drawn, names=ALL_PASSES):
        """Draw passes of what `stage` shows, through a camera of these matrices (4 x 4), into `drawn`, gather.Drawn.
        Returns gather.Camera where the places are among them. Within drawing(stage). Raises gather.GpuUnavailable."""
        off, camera = self._ensure(drawn.size), None
        for name in names:
            stage.space.shading.render_pass = SHADING[name]
            off.draw_view3d(
                stage.scene,
                stage.layer,
                stage.space,
                stage.region,
                view_matrix,
                window_matrix,
                do_color_management=False,
            )
            picture = device.Texture(off.texture_color)
            if name == "place":
                camera = _behind(camera_of(view_matrix, window_matrix, drawn.size), picture)
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
        """Free the picture and what EEVEE keeps for it."""
        off, self._gpu_offscreen = self._gpu_offscreen, None
        if off is not None:
            off.free()


@contextmanager
def drawing(stage):
    """While passes are drawn. What is set for that is put back; no other viewport draws meanwhile."""
    scene = stage.depsgraph.scene_eval  # of which the user's own knows nothing
    held = [(getattr(scene, part), name, value) for part, name, value in _SCENE]
    held += [(getattr(stage.space, part), name, value) for part, name, value in _SPACE]
    held += [(stage.space.shading, name, value) for name, value in (*_SHADED, ("render_pass", "COMBINED"))]
    before = [(owner, name, put_back.current(owner, name)) for owner, name, _ in held]
    try:
        for (owner, name, value), (*_, own) in zip(held, before):
            if own != value:
                setattr(owner, name, value)
        yield
    finally:
        put_back.restore(before)


def camera_of(view_matrix, window_matrix, size):
    """gather.Camera of matrices as Blender's viewports have them, for a picture of `size` (width, height) pixels."""
    view, window = np.array(view_matrix, float), np.array(window_matrix, float)
    rotation = view[:3, :3] / np.linalg.norm(view[:3, :3], axis=1)[:, None]
    return cameras.camera_through(
        window, rotation, -rotation.T @ view[:3, 3], (0, 0), size, orthographic=bool(window[3, 3])
    )


def _behind(camera, picture):
    """An orthographic viewport shows what is behind its place as well: a camera far enough back, and as near as can be
    for the precision of depths."""
    span = interactive.span(picture, camera) if camera.orthographic else None
    if span is None:
        return camera
    least, greatest = span
    back = (greatest - least) / 2 - least + 1e-3
    return replace(camera, position=camera.position + back * camera.rotation[2])
