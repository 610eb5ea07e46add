# SPDX-License-Identifier: GPL-3.0-or-later
"""The GPU: textures, shaders that are compiled on first use, and dispatches in bands. All use of `gpu` is here.

Valid on OpenGL, Vulkan and Metal: parameters in a std140 uniform block, create infos, no texture atomics, at most
four images and fourteen samplers a pass.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import gpu
import numpy as np

from .region import TABLE_WIDTH

SHADERS = Path(__file__).resolve().parents[2] / "shaders"
GROUP = 8                  # threads along the side of a work group
BAND_COST = 1 << 24        # texture samples in one dispatch: under a second even on a software GPU


class GpuUnavailable(RuntimeError):
    """There is no GPU that can do this; the message says why and what to do."""


# The parameters of all passes, once for numpy and once for GLSL; std140 lays both out alike.
PARAMETERS = np.dtype([
    ("rotation", np.float32, (3, 4)),     # rows: world to view
    ("projection", np.float32, 4),        # scale x, y; offset x, y
    ("frame", np.int32, 4),               # width, height in pixels; start; 1 if orthographic
    ("sampling", np.int32, 4),            # samples; offsets in the table; level; seed
    ("band", np.int32, 4),                # first row of this dispatch
    ("output_scale", np.float32, 4),      # strength
])
PARAMETERS_GLSL = """
struct Parameters {
  vec4 rotation[3];
  vec4 projection;
  ivec4 frame;
  ivec4 sampling;
  ivec4 band;
  vec4 output_scale;
};
"""


@dataclass(frozen=True)
class Pass:
    """One shader: the files it is made of, in order, and the textures it reads and writes."""

    files: tuple[str, ...]
    reads: tuple[str, ...]
    writes: tuple[str, ...]


SURFACE_CHANNELS = ("depth_pass", "normal_x", "normal_y", "normal_z")
COLOR_CHANNELS = ("color_r", "color_g", "color_b")
LIGHT_CHANNELS = ("direct_r", "direct_g", "direct_b", "emission_r", "emission_g", "emission_b")
LEVEL = ("radiance", "place", "vector_areas")
COARSE = ("coarse", "coarse_place", "coarse_vector_area")
PASSES = {
    "pack": Pass(("camera", "pack"), SURFACE_CHANNELS + COLOR_CHANNELS + LIGHT_CHANNELS,
                 ("guide", "base_radiance", "base_place", "base_vector_area")),
    "halve": Pass(("halve",), LEVEL, ("coarse_radiance", "coarse_place", "coarse_vector_area")),
    "gather": Pass(("gather",), (*LEVEL, "offsets"), ("irradiance",)),
    "upsample": Pass(("bilateral", "upsample"), ("place", "vector_areas", "own", *COARSE), ("total",)),
    "composite": Pass(("camera", "bilateral", "composite"), ("guide", *COLOR_CHANNELS, *COARSE), ("indirect",)),
    "probe": Pass(("probe",), ("source",), ("probed",)),
}


def parameters(**values) -> np.ndarray:
    """A Parameters block with the named fields filled from the front, the rest zero."""
    block = np.zeros((), PARAMETERS)
    for name, value in values.items():
        value = np.asarray(value)
        block[name][tuple(slice(extent) for extent in value.shape)] = value
    return block


def texture(width: int, height: int, channels: int = 4, data: np.ndarray | None = None) -> gpu.types.GPUTexture:
    """A float32 texture of 1, 2 or 4 channels, filled from a C-contiguous array in row order if one is given.

    Raises GpuUnavailable where the GPU has no room for it or cannot make one so large.
    """
    try:
        largest = gpu.capabilities.max_texture_size_get()
        if max(width, height) > largest:
            raise GpuUnavailable(f"The frame needs a texture of {width} x {height}, but this GPU's largest is "
                                 f"{largest} x {largest}. Lower the render resolution")
        buffer = None if data is None else gpu.types.Buffer("FLOAT", data.size, data.ravel())
        return gpu.types.GPUTexture((width, height), format={1: "R32F", 2: "RG32F", 4: "RGBA32F"}[channels],
                                    data=buffer)
    except SystemError as error:
        raise GpuUnavailable("Blender has no GPU here. In background mode it needs a graphics driver; on a machine "
                             "without a display, install Mesa's software driver") from error
    except (RuntimeError, MemoryError) as error:
        if isinstance(error, GpuUnavailable):
            raise
        raise GpuUnavailable(f"The GPU has no memory for a texture of {width} x {height}. Use a coarser start "
                             "resolution, or lower the render resolution") from error


@cache
def shader(name: str) -> gpu.types.GPUShader:
    """The compiled pass, kept until release(). Raises GpuUnavailable where it does not compile."""
    made_of = PASSES[name]
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(PARAMETERS_GLSL)
    info.uniform_buf(0, "Parameters", "parameters")
    info.define("OFFSETS_WIDTH", str(TABLE_WIDTH))
    for slot, sampler in enumerate(made_of.reads):
        info.sampler(slot, "FLOAT_2D", sampler)
    for slot, image in enumerate(made_of.writes):
        info.image(slot, "RGBA32F", "FLOAT_2D", image, qualifiers={"WRITE"})
    info.local_group_size(GROUP, GROUP, 1)
    info.compute_source("\n".join((SHADERS / f"{file}.glsl").read_text() for file in ("common", *made_of.files)))
    try:
        return gpu.shader.create_from_info(info)
    except Exception as error:  # Blender raises a bare Exception here
        raise GpuUnavailable(f"The GPU driver cannot compile the shader '{name}'. Update the graphics driver, or "
                             "try Blender's other GPU backend in the preferences") from error


def release() -> None:
    """Free the compiled shaders; the next use compiles them again."""
    shader.cache_clear()


def dispatch(name: str, block: np.ndarray, textures: dict, rows_cost: int = 0, after_band=lambda done: None) -> None:
    """Run a pass over every texel of the first texture that it writes.

    textures: by the names in PASSES. rows_cost: texture samples that one row costs; a pass that costs more than
    BAND_COST runs in bands of rows, each waited for, with after_band(share of rows done) between them.
    """
    made_of = PASSES[name]
    target = textures[made_of.writes[0]]
    band = target.height
    if rows_cost * target.height > BAND_COST:
        band = min(target.height, max(GROUP, BAND_COST // rows_cost // GROUP * GROUP))
    for first in range(0, target.height, band):
        block["band"][0] = first
        uniforms = gpu.types.GPUUniformBuf(block.tobytes())  # one a dispatch: an earlier one may still be in use
        program = shader(name)
        program.bind()
        program.uniform_block("parameters", uniforms)
        for sampler in made_of.reads:
            program.uniform_sampler(sampler, textures[sampler])
        for image in made_of.writes:
            program.image(image, textures[image])
        rows = min(band, target.height - first)
        gpu.compute.dispatch(program, -(-target.width // GROUP), -(-rows // GROUP), 1)
        # Blender's context remembers what was bound last by its address. Left bound and freed later, it would be taken
        # for whatever shader gets that address next, and the compositor then crashes in the driver.
        gpu.shader.unbind()
        if band < target.height:
            wait(target)
            after_band((first + rows) / target.height)


def read(source: gpu.types.GPUTexture) -> np.ndarray:
    """(height, width, channels) float32, the texture's first row first; waits for the GPU."""
    return np.asarray(source.read())


def wait(target: gpu.types.GPUTexture) -> None:
    """Return when everything that writes `target` has run: reads one texel of it back."""
    probed = texture(1, 1)
    dispatch("probe", parameters(), {"source": target, "probed": probed})
    read(probed)
