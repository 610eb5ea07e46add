# SPDX-License-Identifier: GPL-3.0-or-later
"""The GPU: textures, shaders that are compiled on first use, and dispatches. All use of `gpu` is here.

Valid on OpenGL, Vulkan and Metal: fields in std140 uniform blocks, create infos, no texture atomics, no shared memory,
one image and at most fourteen samplers a pass.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import cache, wraps
from pathlib import Path
from typing import Any, Protocol

import gpu
import numpy as np

from .shader_interface import DEFINES, PASSES, SQUARE, SURFEL_FORMAT, SURFELS
from .std140 import typedefs

SHADERS = Path(__file__).resolve().parents[2] / "shaders"
BAND_SECONDS = 0.04  # that one dispatch of a long pass is to take: so long an interface can't draw
FIRST_BAND = 1 << 18  # samples in one, until it is known how fast this GPU is
UNIFORM_SLOTS = {"frame": 0, "views": 1, "options": 2}


class GpuUnavailable(RuntimeError):
    """There is no GPU that can do this; the message says why and what to do. args: the text, then the values of its
    braces, apart so that the text can be translated."""

    def __str__(self) -> str:
        text, *values = self.args
        return text.format(*values)


class Executor(Protocol):
    """Makes calls where `gpu` may be used."""

    def run(self, call: Callable[[], Any]) -> Any:
        """Return what call() returns there, or raise what it raises."""

    def later(self, call: Callable[[], Any]) -> None:
        """Make a call there some time."""


class ThisThread:
    """The executor as a rule: `gpu` may be used wherever we are. In a window it may not (host/main_thread.py)."""

    def run(self, call: Callable[[], Any]) -> Any:
        return call()

    def later(self, call: Callable[[], Any]) -> None:
        call()


executor: Executor = ThisThread()  # global, as Blender has one GPU context for Python
_unsettled: Texture | None = None  # the texture that was written last, until settle() waits for it; global like it


def use_executor(new: Executor) -> None:
    """Make all calls of `gpu` by this one from now on."""
    global executor
    executor = new


def on_gpu(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function that the executor runs."""

    @wraps(function)
    def there(*arguments: Any, **options: Any) -> Any:
        return executor.run(lambda: function(*arguments, **options))

    return there


class Texture:
    """A texture. The executor frees it, wherever its last reference goes."""

    def __init__(self, handle: Any) -> None:
        self.handle = handle
        self.width: int = handle.width
        self.height: int = handle.height
        self.format: str = handle.format

    def __del__(self) -> None:
        if executor is not None:  # Python is not ending
            executor.later([vars(self).pop("handle", None)].clear)  # the list has the only reference by then

    @on_gpu
    def read(self) -> Any:
        return self.handle.read()

    @on_gpu
    def clear(self, format: str, value: tuple[float, float, float, float]) -> None:
        self.handle.clear(format=format, value=value)
        _to_settle(self)


@on_gpu
def texture(width: int, height: int, format: str = "RGBA32F", data: np.ndarray | None = None) -> Texture:
    """A texture, filled from a C-contiguous float32 array in row order if one is given.

    Raises GpuUnavailable where the GPU has no room for it or cannot make one so large.
    """
    try:
        largest = gpu.capabilities.max_texture_size_get()
        if max(width, height) > largest:
            raise GpuUnavailable(
                "The frame needs a texture of {} x {}, but this GPU's largest is {} x {}. Lower the render resolution",
                width,
                height,
                largest,
                largest,
            )
        buffer = None if data is None else gpu.types.Buffer("FLOAT", data.size, data.ravel())
        made = Texture(gpu.types.GPUTexture((width, height), format=format, data=buffer))
    except SystemError as error:
        raise GpuUnavailable(
            "Blender has no GPU here. In background mode it needs a graphics driver; on a machine "
            "without a display, install Mesa's software driver"
        ) from error
    except (RuntimeError, MemoryError) as error:
        if isinstance(error, GpuUnavailable):
            raise
        raise GpuUnavailable(
            "The GPU has no memory for a texture of {} x {}. Use a coarser start resolution, or lower "
            "the render resolution",
            width,
            height,
        ) from error
    if data is not None:
        _to_settle(made)
    return made


@cache
@on_gpu
def shader(name: str) -> Any:
    """The compiled pass, a gpu.types.GPUShader, kept until release(). Raises GpuUnavailable where it does not
    compile."""
    made_of = PASSES[name]
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(typedefs(made_of.blocks.values()))  # in one call: a second would replace the first
    for block, struct in made_of.blocks.items():
        info.uniform_buf(UNIFORM_SLOTS[block], struct.name, block)
    for constant, value in (DEFINES | made_of.defines).items():
        info.define(constant, str(value))
    for slot, sampler in enumerate(made_of.reads):
        info.sampler(slot, "UINT_2D" if sampler in SURFELS else "FLOAT_2D", sampler)
    if made_of.writes in SURFELS:
        info.image(0, SURFEL_FORMAT, "UINT_2D", made_of.writes, qualifiers={"READ", "WRITE"})
    else:
        info.image(0, made_of.format, "FLOAT_2D", made_of.writes, qualifiers={"WRITE"})
    info.local_group_size(*made_of.group, 1)
    info.compute_source("\n".join((SHADERS / f"{file}.glsl").read_text() for file in ("common/common", *made_of.files)))
    try:
        return gpu.shader.create_from_info(info)
    except Exception as error:  # Blender raises a bare Exception here
        raise GpuUnavailable(
            "The GPU driver cannot compile the shader '{}'. Update the graphics driver, or try "
            "Blender's other GPU backend in the preferences",
            name,
        ) from error


def release() -> None:
    """Free the compiled shaders; the next use compiles them again."""
    shader.cache_clear()


@on_gpu
def dispatch(
    name: str,
    textures: dict[str, Texture],
    groups: tuple[int, int],
    /,
    *,
    frame: np.ndarray | None = None,
    views: np.ndarray | None = None,
    **options: Any,
) -> None:
    """Run a pass in (x, y) work groups. textures: by their names in PASSES. frame, views: a FRAME and a VIEWS block
    where the pass has them. options: its own, by name; raises TypeError for one that is missing or unknown."""
    made_of = PASSES[name]
    blocks = made_of.filled(frame, views, options)
    program = shader(name)
    # New ones for each dispatch: those of an earlier one may still be in use.
    uniforms = {block: gpu.types.GPUUniformBuf(values.tobytes()) for block, values in blocks.items()}
    program.bind()
    for block, buffer in uniforms.items():
        program.uniform_block(block, buffer)
    for sampler in made_of.reads:
        program.uniform_sampler(sampler, textures[sampler].handle)
    program.image(made_of.writes, textures[made_of.writes].handle)
    gpu.compute.dispatch(program, *groups, 1)
    # Blender's context remembers the last bound shader by its address. Left bound and freed later, it would be taken
    # for whatever shader gets that address next, and the compositor then crashes in the driver.
    gpu.shader.unbind()
    if not name.startswith("probe"):
        _to_settle(textures[made_of.writes])


def _to_settle(target: Texture) -> None:
    global _unsettled
    if not isinstance(executor, ThisThread):
        _unsettled = target


def settle() -> None:
    """Wait for all that has been dispatched, sent and cleared. Blender's windows have a GPU context each, and the
    unfinished work of one may be invisible to another: an executor that takes turns with them calls this at the end of
    its turn."""
    global _unsettled
    target, _unsettled = _unsettled, None
    if target is not None:
        wait(target)


def groups(width: int, height: int, shape: tuple[int, int] = SQUARE) -> tuple[int, int]:
    """Work groups (x, y) of a shape with a thread for each of width x height."""
    return -(-width // shape[0]), -(-height // shape[1])


def read(source: Texture) -> np.ndarray:
    """(height, width, channels) float32, the texture's first row first; waits for the GPU."""
    return np.asarray(source.read())


@on_gpu
def wait(target: Texture) -> None:
    """Return when all passes that write `target` have run: reads one texel of it back."""
    probed = texture(1, 1)
    name = "probe_surfels" if target.format == SURFEL_FORMAT else "probe"
    dispatch(name, {PASSES[name].reads[0]: target, "probed_out": probed}, (1, 1))
    read(probed)


_band: dict[str, float] = {}  # samples, by pass; global, since the GPU is as fast in the next frame


def band(name: str) -> float:
    """The number of samples that one dispatch of a long pass may take."""
    return _band.get(name, FIRST_BAND)


@on_gpu
def run_band(name: str, samples: int, textures: dict[str, Texture], groups: tuple[int, int], /, **named: Any) -> None:
    """dispatch() of this many samples, and a wait for it; band() then knows how fast this GPU is."""
    start = time.perf_counter()
    dispatch(name, textures, groups, **named)
    wait(textures[PASSES[name].writes])
    fitting = samples * BAND_SECONDS / (time.perf_counter() - start)
    _band[name] = min(max(fitting, band(name) / 4, FIRST_BAND / 16), 2 * band(name))
