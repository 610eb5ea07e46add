# SPDX-License-Identifier: GPL-3.0-or-later
"""Adding light to the image that a viewport's engine has drawn, before Blender applies colour management and draws
overlays and gizmos.

Blender draws a viewport into two textures: the engine's image, scene-linear, and the overlays. It calls Python only
while the second is bound, except for the very first call (PRE_VIEW), when the first is. That framebuffer is remembered
from there.
"""

from functools import cache

import gpu
from gpu_extras.batch import batch_for_shader

from ..gather import device

VERTICES = (-1, -1), (3, -1), (-1, 3)  # of a triangle that covers the whole frame

# Framebuffer of the engine's image, of the viewport that is being drawn; global, since Blender makes two calls.
_picture = None


def remember():
    """Remember the framebuffer of the viewport that Blender begins to draw."""
    global _picture
    _picture = gpu.state.active_framebuffer_get()


def forget():
    """Forget the framebuffer, which may be freed from now on."""
    global _picture
    _picture = None


def add(light, extent, strength):
    """Add strength times a gather.Texture to the engine's image of the viewport. extent: (width, height) of the region
    in pixels."""
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
            gpu.shader.unbind()  # a shader that is freed while bound crashes Blender later, see device.dispatch()
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
