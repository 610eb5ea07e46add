# SPDX-License-Identifier: GPL-3.0-or-later
"""The GPU: textures, shaders that are compiled on first use, and dispatches. All use of `gpu` is here.

Valid on OpenGL, Vulkan and Metal: parameters in a std140 uniform block, create infos, no texture atomics, no shared
memory, one image and at most fourteen samplers a pass.
"""

import time
from dataclasses import dataclass
from functools import cache, wraps
from pathlib import Path

import gpu
import numpy as np

from .pyramid import MOST_LEVELS, TABLE_WIDTH

MOST_VIEWS = 10  # the main one among them
RECORDS_WIDTH = 256  # records in a row of a texture
DRAWS_WIDTH = 1024  # entries in a row of the table that emitters are drawn from

SHADERS = Path(__file__).resolve().parents[2] / "shaders"
# Threads of a work group, (x, y). Passes over full rows read a dozen textures and want long runs of each: squares would
# miss the cache at every row.
SQUARE = 8, 8
STRIP = 64, 1
BAND_SECONDS = 0.04  # that one dispatch of a long pass is to take: so long an interface can't draw
FIRST_BAND = 1 << 18  # samples in one, until it is known how fast this GPU is


class GpuUnavailable(RuntimeError):
    """There is no GPU that can do this; the message says why and what to do. args: the text and what goes into its
    braces, apart, so that the text can be translated."""

    def __str__(self):
        text, *values = self.args
        return text.format(*values)


# The parameters of all passes, once for numpy and once for GLSL; std140 lays both out alike.
PARAMETERS = np.dtype(
    [
        ("rotation", np.float32, (3, 4)),  # rows: world to view
        ("projection", np.float32, 4),  # scale x, y; offset x, y
        ("frame", np.int32, 4),  # width, height in pixels; start; 1 if orthographic
        ("levels", np.int32, (MOST_LEVELS, 4)),  # x, y in the pyramid's texture; width, height
        (
            "regions",
            np.int32,
            (MOST_LEVELS, 4),
        ),  # samples; first entry in the table; entries; entries / samples * 65536
        ("span", np.int32, 4),  # finest and coarsest level at hand
        ("band", np.int32, 4),  # first work group or row of this dispatch; seed; first column
        ("output_scale", np.float32, 4),  # strength
    ]
)
PARAMETERS_GLSL = f"""
struct Parameters {{
  vec4 rotation[3];
  vec4 projection;
  ivec4 frame;
  ivec4 levels[{MOST_LEVELS}];
  ivec4 regions[{MOST_LEVELS}];
  ivec4 span;
  ivec4 band;
  vec4 output_scale;
}};
"""

# The cameras of several views and what is drawn from them; world space has the main camera's place as its origin.
VIEWS = np.dtype(
    [
        ("rotation", np.float32, (MOST_VIEWS, 3, 4)),  # rows: world to view
        ("projection", np.float32, (MOST_VIEWS, 4)),  # scale x, y; offset x, y, for texels of the depth map
        ("eye", np.float32, (MOST_VIEWS, 4)),  # place; 1 if orthographic
        ("emitters", np.int32, (MOST_VIEWS, 4)),  # number of the first; across, up; pixels along the side of one
        ("receivers", np.int32, (MOST_VIEWS, 4)),  # the same
        ("depths", np.int32, 4),  # width, height of a view's depth map; pixels along a texel; views
        ("draws", np.int32, 4),  # groups; candidates of each; entries of the table; steps of a way
        ("odds", np.float32, 4),  # chance of an emitter: x (power + z) + y, times its area; how far rays go
        ("world", np.float32, (4, 4)),  # EEVEE's world light, as gather_views() has it
        ("past", np.float32, (4, 4)),  # the frame before: rows, world to view; scale, offset of base texels
    ]
)
VIEWS_GLSL = f"""
struct Views {{
  vec4 rotation[{3 * MOST_VIEWS}];
  vec4 projection[{MOST_VIEWS}];
  vec4 eye[{MOST_VIEWS}];
  ivec4 emitters[{MOST_VIEWS}];
  ivec4 receivers[{MOST_VIEWS}];
  ivec4 depths;
  ivec4 draws;
  vec4 odds;
  vec4 world[4];
  vec4 past[4];
}};
"""


@dataclass(frozen=True)
class Pass:
    """One shader: the files it is made of, in order, and the textures it reads and writes, the latter in a format."""

    files: tuple[str, ...]
    reads: tuple[str, ...]
    writes: str
    group: tuple[int, int] = SQUARE
    format: str = "RGBA32F"

    @property
    def knows_views(self) -> bool:
        """Whether it has the Views block beside the Parameters."""
        return "radiosity/views" in self.files


SURFACE_CHANNELS = ("depth_pass", "normal_x", "normal_y", "normal_z")
COLOR_CHANNELS = ("color_r", "color_g", "color_b")
LIGHT_CHANNELS = ("direct_r", "direct_g", "direct_b", "emission_r", "emission_g", "emission_b")
PASSES = {
    "pack": Pass(
        ("common/camera", "common/surfel", "common/pack"),
        SURFACE_CHANNELS + COLOR_CHANNELS + LIGHT_CHANNELS,
        "surfels_out",
        STRIP,
    ),
    "pack_with_normals": Pass(
        ("common/camera", "common/surfel", "common/geometric", "common/pack"),
        SURFACE_CHANNELS + COLOR_CHANNELS + LIGHT_CHANNELS,
        "surfels_out",
        STRIP,
    ),
    "merge": Pass(("common/camera", "common/surfel", "paper/tiles", "paper/merge"), (), "surfels_out"),
    "gather": Pass(
        ("common/camera", "common/surfel", "paper/tiles", "common/random", "common/form_factor", "paper/gather"),
        ("surfels", "offsets"),
        "irradiance_out",
    ),
    "upsample": Pass(
        ("common/camera", "common/surfel", "common/bilateral", "paper/upsample"), ("surfels", "irradiance"), "total_out"
    ),
    "composite": Pass(
        ("common/camera", "common/surfel", "common/bilateral", "common/composite"),
        (*SURFACE_CHANNELS, *COLOR_CHANNELS, "surfels", "total"),
        "indirect_out",
        STRIP,
    ),
    "depths": Pass(
        ("common/camera", "radiosity/views", "radiosity/depths"), SURFACE_CHANNELS, "depths_out", format="RG32F"
    ),
    "emit": Pass(
        ("common/camera", "radiosity/views", "radiosity/visibility", "radiosity/emit"),
        (*SURFACE_CHANNELS, *COLOR_CHANNELS, *LIGHT_CHANNELS, "depths"),
        "records_out",
    ),
    "emit_with_normals": Pass(
        ("common/camera", "radiosity/views", "radiosity/visibility", "common/geometric", "radiosity/emit"),
        (*SURFACE_CHANNELS, *COLOR_CHANNELS, *LIGHT_CHANNELS, "depths"),
        "records_out",
    ),
    "radiate": Pass(
        ("common/camera", "radiosity/views", "radiosity/radiate"), ("emitters", "irradiance"), "radiance_out"
    ),
    "draw_blocks": Pass(
        (
            "common/camera",
            "radiosity/views",
            "radiosity/visibility",
            "common/random",
            "common/form_factor",
            "radiosity/receiver_block",
            "radiosity/draw",
        ),
        ("receivers", "emitters", "radiance", "table", "depths"),
        "irradiance_out",
    ),
    "draw_base": Pass(
        (
            "common/camera",
            "common/surfel",
            "radiosity/views",
            "radiosity/visibility",
            "common/random",
            "common/form_factor",
            "radiosity/receiver_base",
            "radiosity/draw",
        ),
        ("surfels", "emitters", "radiance", "table", "depths"),
        "irradiance_out",
    ),
    "smooth": Pass(
        ("common/camera", "common/surfel", "radiosity/views", "common/bilateral", "radiosity/smooth"),
        ("surfels", "irradiance"),
        "total_out",
    ),
    "reproject": Pass(
        ("common/camera", "common/surfel", "radiosity/views", "temporal/reproject"),
        ("surfels", "past_surfels", "past_light", "motion"),
        "known_out",
    ),
    "accumulate": Pass(
        ("common/camera", "common/surfel", "common/bilateral", "temporal/accumulate"),
        ("surfels", "irradiance", "known"),
        "light_out",
    ),
    "reflect": Pass(
        (
            "common/camera",
            "common/surfel",
            "radiosity/views",
            "radiosity/visibility",
            "common/random",
            "glossy/ggx",
            "glossy/march",
            "radiosity/receiver_base",
            "glossy/reflect",
        ),
        ("surfels", "gloss", "emitters", "radiance", "depths"),
        "irradiance_out",
    ),
    "smooth_gloss": Pass(
        ("common/camera", "common/surfel", "common/bilateral", "glossy/smooth_gloss"),
        ("surfels", "gloss", "irradiance"),
        "total_out",
    ),
    "split_picture": Pass(("viewport/split_picture",), ("picture",), "channel_out"),
    "depth_range": Pass(("viewport/depth_range",), ("picture",), "span_out"),
    "running_mean": Pass(("viewport/running_mean",), ("indirect", "mean"), "mean_out"),
    "shrink": Pass(("common/shrink",), ("picture",), "shrunk_out"),
    "probe": Pass(("common/probe",), ("source",), "probed_out"),
    "probe_surfels": Pass(("common/probe",), ("surfels",), "probed_out"),
}
SURFELS = "surfels", "past_surfels", "surfels_out"  # the names of textures in this format:
SURFEL_FORMAT = "RGBA32UI"


class Here:
    """The place where `gpu` may be used, as a rule: wherever we are. In a window it is elsewhere
    (host/main_thread.py)."""

    @staticmethod
    def run(call):
        """Return what call() returns there, or raise what it raises."""
        return call()

    @staticmethod
    def later(call):
        """Make a call there some time."""
        call()


place = Here
_written = None  # what was written last, by a dispatch or from here, where somebody will settle() it


def on_gpu(function):
    """A function all of whose work is done at `place`."""

    @wraps(function)
    def there(*arguments, **options):
        return place.run(lambda: function(*arguments, **options))

    return there


class Texture:
    """A texture. It is freed at `place`, wherever the last who knows it lets go of it."""

    def __init__(self, handle):
        self.handle = handle
        self.width, self.height, self.format = handle.width, handle.height, handle.format

    def __del__(self):
        if place is not None:  # Python is not ending
            place.later([vars(self).pop("handle", None)].clear)  # the list alone knows it by then

    @on_gpu
    def read(self):
        return self.handle.read()

    @on_gpu
    def clear(self, format, value):
        self.handle.clear(format=format, value=value)
        _to_settle(self)


def parameters(**values) -> np.ndarray:
    """A Parameters block with the named fields filled from the front, the rest zero."""
    block = np.zeros((), PARAMETERS)
    for name, value in values.items():
        value = np.asarray(value)
        block[name][tuple(slice(extent) for extent in value.shape)] = value
    return block


def as_int32(seed: int) -> int:
    """The lowest 32 bits of any integer, as the signed number of the same bits."""
    return (seed & 0xFFFFFFFF) - ((seed & 0x80000000) << 1)


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
def shader(name: str) -> gpu.types.GPUShader:
    """The compiled pass, kept until release(). Raises GpuUnavailable where it does not compile."""
    made_of = PASSES[name]
    info = gpu.types.GPUShaderCreateInfo()
    # One call: a second would put its text in place of the first's.
    info.typedef_source(PARAMETERS_GLSL + VIEWS_GLSL * made_of.knows_views)
    info.uniform_buf(0, "Parameters", "parameters")
    info.define("OFFSETS_WIDTH", str(TABLE_WIDTH))
    if made_of.knows_views:
        info.uniform_buf(1, "Views", "views")
        info.define("RECORDS_WIDTH", str(RECORDS_WIDTH))
        info.define("DRAWS_WIDTH", str(DRAWS_WIDTH))
    if made_of.files == ("common/probe",):
        info.define("SOURCE", made_of.reads[0])
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
    name: str, block: np.ndarray, textures: dict, groups: tuple[int, int], views: np.ndarray | None = None
) -> None:
    """Run a pass in (x, y) work groups; textures by the names in PASSES; views: a Views block where it knows them."""
    made_of, program = PASSES[name], shader(name)
    uniforms = gpu.types.GPUUniformBuf(block.tobytes())  # one a dispatch: an earlier one may still be in use
    program.bind()
    program.uniform_block("parameters", uniforms)
    if made_of.knows_views:
        cameras = gpu.types.GPUUniformBuf(views.tobytes())
        program.uniform_block("views", cameras)
    for sampler in made_of.reads:
        program.uniform_sampler(sampler, textures[sampler].handle)
    program.image(made_of.writes, textures[made_of.writes].handle)
    gpu.compute.dispatch(program, *groups, 1)
    # Blender's context remembers what was bound last by its address. Left bound and freed later, it would be taken
    # for whatever shader gets that address next, and the compositor then crashes in the driver.
    gpu.shader.unbind()
    if not name.startswith("probe"):
        _to_settle(textures[made_of.writes])


def _to_settle(target):
    global _written
    if place is not Here:
        _written = target


def settle() -> None:
    """Wait for all that has been dispatched, sent and cleared. Blender's windows have a GPU context each, and what one
    has not finished another need not see: so `place` calls this before it lets go of its turn."""
    global _written
    target, _written = _written, None
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
    """Return when everything that writes `target` has run: reads one texel of it back."""
    probed = texture(1, 1)
    name = "probe_surfels" if target.format == SURFEL_FORMAT else "probe"
    dispatch(name, parameters(), {PASSES[name].reads[0]: target, "probed_out": probed}, (1, 1))
    read(probed)


_band = {}  # samples, by pass


def band(name: str) -> float:
    """How many samples one dispatch of a long pass may take."""
    return _band.get(name, FIRST_BAND)


@on_gpu
def run_band(name: str, samples: int, *arguments) -> None:
    """As dispatch(), of this many samples, and waited for; band() then knows how fast this GPU is."""
    start = time.perf_counter()
    dispatch(name, *arguments)
    wait(arguments[1][PASSES[name].writes])
    fitting = samples * BAND_SECONDS / (time.perf_counter() - start)
    _band[name] = min(max(fitting, band(name) / 4, FIRST_BAND / 16), 2 * band(name))
