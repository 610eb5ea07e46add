# SPDX-License-Identifier: GPL-3.0-or-later
"""The gather's own shader without its fetches: what is left is its arithmetic, whatever its texts and textures are.

with without_fetches(light):
    light.gather_indirect(...)          # with opengl.timed() around it"""

import re
from contextlib import contextmanager
from functools import cache

from . import opengl


def gather_passes(light):
    """Names of the passes that gather."""
    return [name for name, made_of in light.shader_interface.PASSES.items() if "paper/gather" in made_of.files]


@contextmanager
def without_fetches(light):
    """Within the block the passes that gather fetch no records and no offsets; what light they find means nothing."""
    device, gpu_types = light.device, light.device.gpu.types
    plain = device.shader
    device.shader, gpu_types.GPUShaderCreateInfo = _shaders(light), _create_info(light)
    try:
        yield
    finally:
        device.shader, gpu_types.GPUShaderCreateInfo = plain, opengl.CreateInfo


@cache
def _shaders(light):
    """light.device.shader() with a memory of its own."""
    return cache(light.device.shader.__wrapped__)


@cache
def _create_info(light):
    gather = (light.device.SHADERS / "paper/gather.glsl").read_text()

    class CreateInfo(opengl.CreateInfo):
        def __init__(self):
            super().__init__()
            self.vectors = {}

        def sampler(self, slot, kind, name):
            super().sampler(slot, kind, name)
            self.vectors[name] = "uvec4" if kind.startswith("UINT") else "vec4"

        def compute_source(self, text):
            super().compute_source(fetchless(text, self.vectors) if gather in text else text)

    return CreateInfo


def fetchless(text, vectors):
    """A shader's text with its fetches made up. A thread reads one record, real numbers, when it starts; each fetch
    then returns that with its lowest bits flipped by the place asked for, so that the compiler keeps all arithmetic.
    Offsets are 0 or 1: every sample falls inside the picture. vectors: "vec4" or "uvec4" by sampler."""
    made_up, start = "", ""
    for name, vector in vectors.items():
        bits = {
            "uvec4": "kept_{0} ^ uvec4(p.x & 1)",
            "vec4": "uintBitsToFloat(floatBitsToUint(kept_{0}) ^ uvec4(p.x & 1))",
        }[vector].format(name)
        if name == "offsets":
            bits = "vec4(p.x & 1, (p.x >> 1) & 1, 0, 0)"
        made_up += f"{vector} kept_{name};\n"
        made_up += f"{vector} made_up_{name}(ivec2 p, int level) {{ return {vector}({bits}); }}\n"
        start += f"  kept_{name} = texelFetch({name}, ivec2(gl_GlobalInvocationID.xy) % textureSize({name}, 0), 0);\n"
    text = re.sub(r"\btexelFetch\(\s*(\w+)\s*,", r"made_up_\1(", text)
    text = text.replace("void main()", "void with_fetches_made_up()")
    return f"{made_up}{text}\nvoid main()\n{{\n{start}  with_fetches_made_up();\n}}\n"
