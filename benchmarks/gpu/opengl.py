# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's `gpu` module as far as addon/gather uses it, on a bare OpenGL context, with a timer query around every
dispatch.

    from benchmarks.gpu import opengl
    light = opengl.start()            # addon/gather itself: the same host code, the same shader files, no Blender
    with opengl.timed(light) as passes:
        light.gather_indirect(...)
    sum(passes["gather"])                    # seconds on the GPU, one entry a dispatch

moderngl makes the context through EGL, on a graphics card or on Mesa's software driver alike."""

import importlib
import sys
import time
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import ModuleType, SimpleNamespace

import moderngl
import numpy as np

ADDON = Path(__file__).resolve().parents[2] / "addon"
FORMATS = {
    "R32F": (1, "f4"),
    "RG32F": (2, "f4"),
    "RGBA32F": (4, "f4"),
    "R16F": (1, "f2"),
    "RGBA16F": (4, "f2"),
    "R32UI": (1, "u4"),
    "RG32UI": (2, "u4"),
    "RGBA32UI": (4, "u4"),
}
LAYOUTS = {
    "RG32F": "rg32f",
    "R32F": "r32f",
    "RGBA32F": "rgba32f",
    "R16F": "r16f",
    "RGBA16F": "rgba16f",
    "R32UI": "r32ui",
    "RG32UI": "rg32ui",
    "RGBA32UI": "rgba32ui",
}


@cache
def context() -> moderngl.Context:
    """The one OpenGL context of this process. Raises SystemExit with advice where there is none."""
    try:
        return moderngl.create_context(standalone=True, require=430, backend="egl")
    except Exception as error:  # moderngl raises bare Exception
        sys.exit(
            f"No OpenGL 4.3 through EGL here ({error}). Install a graphics driver or Mesa: 'make setup' names the "
            "packages."
        )


def start() -> ModuleType:
    """addon/gather as a package of its own, on this module in place of Blender's `gpu`."""
    if "bpy" in sys.modules:
        raise RuntimeError("Blender is loaded: its own gpu module would be hidden")
    context()
    sys.modules["gpu"] = _gpu()
    sys.path.insert(0, str(ADDON))
    return importlib.import_module("gather")


@contextmanager
def timed(light):
    """Time each dispatch: a dict of lists of seconds by pass, one entry a dispatch, complete once the block ends.

    Seconds are the GPU's own, from timer queries, where those cover compute shaders. Those of Mesa's software driver do
    not: there the clock is read around each dispatch, with the driver idle before and after it."""
    seconds, running, plain = {}, [], light.device.dispatch

    def dispatch(name, *arguments, **options):
        if name.startswith("probe"):
            return plain(name, *arguments, **options)
        with _timer() as timer:
            plain(name, *arguments, **options)
        running.append((name, timer))

    light.device.dispatch = dispatch
    try:
        yield seconds
    finally:
        light.device.dispatch = plain
        for name, timer in running:
            seconds.setdefault(name, []).append(timer.elapsed * 1e-9)


@cache
def queries_cover_compute() -> bool:
    """Does a timer query see a compute shader run? Tried on one that takes milliseconds anywhere."""
    shader = context().compute_shader("""#version 430
        layout(local_size_x = 64) in;
        layout(std430, binding = 0) buffer Sink { float sink[]; };
        void main() {
          float x = float(gl_GlobalInvocationID.x);
          for (int k = 0; k < 2000; k++) { x = x * 1.000001 + 0.5; }
          sink[gl_GlobalInvocationID.x] = x;
        }""")
    sink = context().buffer(reserve=4 << 16)
    sink.bind_to_storage_buffer(0)
    for timer in (query := context().query(time=True), clock := _Clock()):
        with timer:
            shader.run(1 << 10)
    return query.elapsed > 0.2 * clock.elapsed


def _timer():
    return context().query(time=True) if queries_cover_compute() else _Clock()


class _Clock:
    """In place of a timer query: nanoseconds on the clock between two waits for the driver."""

    def __enter__(self):
        context().finish()
        self.start = time.perf_counter_ns()
        return self

    def __exit__(self, *_):
        context().finish()
        self.elapsed = time.perf_counter_ns() - self.start


class Texture:
    def __init__(self, size, format, data=None):
        self.width, self.height = size
        self.format = format
        components, kind = FORMATS[format]
        self.own = context().texture(size, components, data, dtype=kind, alignment=1)
        self.own.filter = moderngl.NEAREST, moderngl.NEAREST

    def __del__(self):
        self.own.release()

    def clear(self, *, format, value):
        components, kind = FORMATS[self.format]
        self.own.write(np.full((self.height, self.width, components), value[:components], kind).tobytes())

    def read(self):
        components, kind = FORMATS[self.format]
        pixels = np.frombuffer(self.own.read(alignment=1), kind).reshape(self.height, self.width, components)
        return pixels if components > 1 else pixels[..., 0]


class UniformBuffer:
    def __init__(self, data):
        self.own = context().buffer(data)

    def __del__(self):
        self.own.release()


class CreateInfo:
    """Collects what Blender collects, as plain GLSL."""

    def __init__(self):
        self.types, self.defines, self.resources, self.layout, self.source = "", "", "", "", ""
        self.blocks, self.samplers, self.images = {}, {}, {}

    def typedef_source(self, text):
        self.types = text  # Blender keeps the last

    def define(self, name, value=""):
        self.defines += f"#define {name} {value}\n"

    def uniform_buf(self, slot, kind, name):
        self.blocks[name] = slot
        self.resources += f"layout(std140, binding = {slot}) uniform {name}_block {{ {kind} {name}; }};\n"

    def sampler(self, slot, kind, name):
        self.samplers[name] = slot
        prefix = {"FLOAT": "", "UINT": "u", "INT": "i"}[kind.removesuffix("_2D")]
        self.resources += f"layout(binding = {slot}) uniform {prefix}sampler2D {name};\n"

    def image(self, slot, format, kind, name, qualifiers=frozenset({"NO_RESTRICT"})):
        self.images[name] = slot, "READ" in qualifiers, "WRITE" in qualifiers
        access = {(True, False): "readonly", (False, True): "writeonly", (True, True): ""}[self.images[name][1:]]
        prefix = {"FLOAT": "", "UINT": "u", "INT": "i"}[kind.removesuffix("_2D")]
        self.resources += f"layout({LAYOUTS[format]}, binding = {slot}) {access} uniform {prefix}image2D {name};\n"

    def local_group_size(self, x, y=1, z=1):
        self.layout = f"layout(local_size_x = {x}, local_size_y = {y}, local_size_z = {z}) in;\n"

    def compute_source(self, text):
        self.source = text


class Shader:
    bound = None

    def __init__(self, info):
        self.info = info
        self.own = context().compute_shader(
            "#version 430\n" + info.defines + info.types + info.resources + info.layout + info.source
        )

    def __del__(self):
        self.own.release()

    def bind(self):
        Shader.bound = self

    def uniform_block(self, name, buffer):
        buffer.own.bind_to_uniform_block(self.info.blocks[name])

    def uniform_sampler(self, name, texture):
        texture.own.use(self.info.samplers[name])

    def image(self, name, texture):
        slot, reads, writes = self.info.images[name]
        texture.own.bind_to_image(slot, read=reads, write=writes)


def dispatch(shader, x, y, z):
    shader.own.run(x, y, z)
    context().memory_barrier()


def _unbind():
    Shader.bound = None


def _gpu():
    module = ModuleType("gpu")
    module.types = SimpleNamespace(
        GPUTexture=Texture,
        GPUUniformBuf=UniformBuffer,
        GPUShader=Shader,
        GPUShaderCreateInfo=CreateInfo,
        Buffer=lambda kind, shape, data: np.ascontiguousarray(data),
    )
    module.shader = SimpleNamespace(create_from_info=Shader, unbind=_unbind)
    module.compute = SimpleNamespace(dispatch=dispatch)
    module.capabilities = SimpleNamespace(max_texture_size_get=lambda: context().info["GL_MAX_TEXTURE_SIZE"])
    return module
