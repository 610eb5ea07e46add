# SPDX-License-Identifier: GPL-3.0-or-later
"""Adding light to what a viewport's engine has drawn, before Blender manages its colours and puts overlays and gizmos
on top.

Blender draws a viewport into two textures, the engine's picture, scene-linear, and the overlays, and calls Python only
where the second is bound; but for the very first of its calls (PRE_VIEW), where the first is. That framebuffer is
remembered from there.
"""

from functools import cache

import gpu
from gpu_extras.batch import batch_for_shader

from ..gather import device

VERTICES = (-1, -1), (3, -1), (-1, 3)  # of a triangle that holds the whole frame

# The framebuffer of the engine's picture, of the viewport that is being drawn; global, since Blender makes two calls.
_picture = None


def remember():
    """Blender begins to draw a viewport."""
    global _picture
    _picture = gpu.state.active_framebuffer_get()


def forget():
    """What remember() has kept may be gone from now on."""
    global _picture
    _picture = None


def add(light, extent, strength):
    """Add strength times a gather.Texture to the engine's picture of the viewport that has been drawn, extent (width,
    height) pixels."""
    shader, batch = _show()
    blend, depth_test = gpu.state.blend_get(), gpu.state.depth_test_get()
    with _picture.bind():
        gpu.state.blend_set("ADDITIVE_PREMULT")
        gpu.state.depth_test_set("NONE")
        try:
            shader.bind()
            shader.uniform_sampler("light", light.handle)
            shader.uniform_float("extent", extent)
            shader.uniform_float("strength", strength)
            batch.draw(shader)
        finally:
            gpu.shader.unbind()  # as in device.dispatch()
            gpu.state.blend_set(blend)
            gpu.state.depth_test_set(depth_test)


@cache
def _show():
    """(shader, triangle), kept until release(). Raises gather.GpuUnavailable."""
    info = gpu.types.GPUShaderCreateInfo()
    info.vertex_in(0, "VEC2", "corner")
    info.fragment_out(0, "VEC4", "shown")
    info.sampler(0, "FLOAT_2D", "light")
    info.push_constant("VEC2", "extent")
    info.push_constant("FLOAT", "strength")
    info.vertex_source((device.SHADERS / "viewport/show_vertex.glsl").read_text())
    info.fragment_source((device.SHADERS / "viewport/show.glsl").read_text())
    try:
        shader = gpu.shader.create_from_info(info)
    except Exception as error:  # Blender raises a bare Exception here
        raise device.GpuUnavailable(
            "The GPU driver cannot compile the shader '{}'. Update the graphics driver, or try "
            "Blender's other GPU backend in the preferences",
            "show",
        ) from error
    return shader, batch_for_shader(shader, "TRIS", {"corner": VERTICES})


def release():
    """Free the shader."""
    _show.cache_clear()
