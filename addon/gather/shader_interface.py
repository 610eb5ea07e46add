# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface between host and shaders: the passes, their textures, and the named fields of their uniform blocks.

Each field is declared once, here. The numpy layout that the host fills and the GLSL struct that shaders read are made
from the declaration. A pass has up to three blocks, under these names in GLSL:

    frame      a picture: its camera, its size and its pyramid (FRAME), where a pass includes common/camera
    views      the cameras of all views and the records that are theirs (VIEWS), where it includes radiosity/views
    options    what this pass alone is given
"""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from .pyramid import MAX_LEVELS, OFFSETS_WIDTH
from .std140 import Field, Struct
from .types import FARTHEST, MAX_VIEWS

RECORDS_WIDTH = 256  # records in a row of a texture
EMITTER_TABLE_WIDTH = 1024  # entries in a row of the table that emitters are sampled from
DEPTH_RANGE_BLOCK = 16  # pixels along the side of the block that one thread of "depth_range" reads
DEFINES = {
    "FARTHEST": FARTHEST,
    "OFFSETS_WIDTH": OFFSETS_WIDTH,
    "RECORDS_WIDTH": RECORDS_WIDTH,
    "EMITTER_TABLE_WIDTH": EMITTER_TABLE_WIDTH,
    "DEPTH_RANGE_BLOCK": DEPTH_RANGE_BLOCK,
}

LEVEL = Struct(
    "Level",
    (
        Field("origin", "ivec2", "lower left texel in the pyramid's texture, where all levels lie side by side"),
        Field("size", "ivec2", "width, height in texels"),
    ),
)
CAMERA = (
    Field("rotation", "vec4", "rows: world to view; w is not used", count=3),
    Field("scale", "vec2", "of a pixel, in view units at depth 1 (perspective) or metres (orthographic)"),
    Field("offset", "vec2", "of the lower left corner: pixel p has the view ray offset + scale * p"),
)
FRAME = Struct(
    "Frame",
    (
        *CAMERA,
        Field("size", "ivec2", "width, height in pixels"),
        Field("start", "int", "pixels along the side of a base texel"),
        Field("is_orthographic", "bool", "or else perspective"),
        Field("levels", LEVEL, "of the pyramid, finest first", count=MAX_LEVELS, optional=True),
    ),
)

GRID = Struct(
    "Grid",
    (
        Field("first", "int", "number of the view's first record"),
        Field("side", "int", "pixels along the side of a block"),
        Field("size", "ivec2", "blocks across and up; records are numbered by rows from the lower left"),
    ),
)
VIEW_CAMERA = Struct(
    "ViewCamera",
    (
        Field("rotation", "vec4", "rows: world to view; w: the translation, m", count=3),
        Field("scale", "vec2", "as a frame's, of a texel of the depth map"),
        Field("offset", "vec2", "as a frame's"),
        Field("emitters", GRID, "blocks that send light"),
        Field("receivers", GRID, "blocks that gather the light that emitters send on"),
        Field("is_orthographic", "bool", "or else perspective"),
        Field("position", "vec3", "world, m; the main camera's is the origin"),
    ),
)
VIEWS = Struct(
    "Views",
    (
        Field("cameras", VIEW_CAMERA, "of the views, the main one first", count=MAX_VIEWS),
        Field("depth_size", "ivec2", "width, height of a view's depth map, in texels"),
        Field("depth_step", "int", "pixels along the side of a texel of the depth map"),
        Field("count", "int", "number of views"),
        Field("world", "mat4", "EEVEE's world light as radiance: rgb of the coefficients of 1, x, y, z"),
    ),
)

REGION = Struct(
    "Region",
    (
        Field("samples", "int", "of each texel"),
        Field("first", "int", "entry of the table of offsets"),
        Field("entries", "int", "number of offsets"),
        Field("part", "uint", "entries / samples, in units of 1 / 65536"),
    ),
)
SEED = Field("seed", "uint", "of the random numbers")
BAND = (
    Field("first_row", "int", "of the target, where this dispatch begins"),
    Field("first_column", "int", "of the target, where this dispatch begins"),
)
EMITTERS = Field("count", "int", "of emitters")
ENTRIES = Field("entries", "int", "of the table of emitters")
BY_AREA = Field("by_area", "float", "share of the table in proportion to area, the rest to power")
WORLD_POWER = Field("world_power", "float", "sum of the world light's mean radiance over r, g, b")
SAMPLING = (
    *BAND,
    SEED,
    Field("groups", "int", "of candidates, for each receiver"),
    Field("candidates", "int", "in a group"),
    ENTRIES,
    Field("shadow_steps", "int", "along a shadow ray; 0: nothing hides anything"),
    WORLD_POWER,
)
STRENGTH = Field("strength", "float", "factor on the light that is added to the picture")
DEPTH_AXIS = Field("depth_axis", "vec4", "depth of a world position p, m, is -dot(depth_axis, (p, 1))")
VIEW = Field("view", "int", "number of the view that is read")

# Threads of a work group, (x, y). Passes over full rows read a dozen textures and want long runs of each: squares would
# miss the cache at every row.
SQUARE = 8, 8
STRIP = 64, 1


@dataclass(frozen=True)
class Pass:
    """A shader: its files in order, the textures that it reads, the one that it writes and its format, its options, the
    threads of a work group, and what is defined for its files."""

    files: tuple[str, ...]
    reads: tuple[str, ...]
    writes: str
    options: tuple[Field, ...] = ()
    group: tuple[int, int] = SQUARE
    format: str = "RGBA32F"
    defines: dict[str, str] = field(default_factory=dict)

    @cached_property
    def option_block(self) -> Struct:
        return Struct("Options", self.options)

    @cached_property
    def blocks(self) -> dict[str, Struct]:
        """Its uniform blocks, by their names in GLSL."""
        blocks = {"frame": FRAME} if "common/camera" in self.files else {}
        if "radiosity/views" in self.files:
            blocks["views"] = VIEWS
        if self.options:
            blocks["options"] = self.option_block
        return blocks

    def filled(
        self, frame: np.ndarray | None, views: np.ndarray | None, options: dict[str, Any]
    ) -> dict[str, np.ndarray]:
        """The blocks' values. Raises TypeError where one is missing, or not this pass's."""
        filled = {name: block for name, block in (("frame", frame), ("views", views)) if block is not None}
        own = self.option_block.filled(**options)
        if self.options:
            filled["options"] = own
        if {name: block.dtype for name, block in filled.items()} != {
            name: struct.dtype for name, struct in self.blocks.items()
        }:
            raise TypeError(f"The pass that writes {self.writes} has the blocks {[*self.blocks]}, not {[*filled]}")
        return filled


SURFACE_CHANNELS = ("depth_pass", "normal_x", "normal_y", "normal_z")
COLOR_CHANNELS = ("color_r", "color_g", "color_b")
LIGHT_CHANNELS = ("direct_r", "direct_g", "direct_b", "emission_r", "emission_g", "emission_b")
ALL_CHANNELS = (*SURFACE_CHANNELS, *COLOR_CHANNELS, *LIGHT_CHANNELS)
# Names of textures that hold surfels, in this format.
SURFELS = "surfels", "past_surfels", "surfels_out"
SURFEL_FORMAT = "RGBA32UI"

_SURFEL = ("common/camera", "common/surfel")
_VIEWS = ("radiosity/views", "radiosity/visibility")
_SAMPLE = ("radiosity/shadow_ray", "common/random", "common/form_factor")
_EMIT_CHANNELS = (*ALL_CHANNELS, "depths")
_EMIT = (VIEW, Field("receives", "bool", "whether receivers are made, or else emitters"))
PASSES = {
    "pack": Pass((*_SURFEL, "common/pack"), ALL_CHANNELS, "surfels_out", group=STRIP),
    "pack_with_normals": Pass((*_SURFEL, "common/geometric", "common/pack"), ALL_CHANNELS, "surfels_out", group=STRIP),
    "merge": Pass(
        (*_SURFEL, "paper/tiles", "paper/merge"),
        (),
        "surfels_out",
        (
            Field("finer_level", "int", "that is summed"),
            Field("last_level", "int", "coarsest that is made; the first is the one after finer_level"),
        ),
    ),
    "gather": Pass(
        (*_SURFEL, "paper/tiles", "common/random", "common/form_factor", "paper/gather"),
        ("surfels", "offsets"),
        "irradiance_out",
        (
            Field("last_level", "int", "coarsest of the pyramid"),
            Field("first_group", "int", "number of this dispatch's first work group"),
            SEED,
            Field("regions", REGION, "that the texels of each level gather from", count=MAX_LEVELS),
        ),
    ),
    "upsample": Pass(
        (*_SURFEL, "common/bilateral", "paper/upsample"),
        ("surfels", "irradiance"),
        "total_out",
        (Field("last_level", "int", "coarsest of the pyramid"),),
    ),
    "composite": Pass(
        (*_SURFEL, "common/bilateral", "common/composite"),
        (*SURFACE_CHANNELS, *COLOR_CHANNELS, "surfels", "total"),
        "indirect_out",
        (STRENGTH,),
        STRIP,
    ),
    "depths": Pass(
        ("common/camera", "radiosity/views", "radiosity/depths"),
        SURFACE_CHANNELS,
        "depths_out",
        (VIEW,),
        format="RG32F",
    ),
    "emit": Pass(("common/camera", *_VIEWS, "radiosity/emit"), _EMIT_CHANNELS, "records_out", _EMIT),
    "emit_with_normals": Pass(
        ("common/camera", *_VIEWS, "common/geometric", "radiosity/emit"), _EMIT_CHANNELS, "records_out", _EMIT
    ),
    "radiate": Pass(("radiosity/views", "radiosity/radiate"), ("emitters", "irradiance"), "radiance_out"),
    "radiate_specular": Pass(
        ("radiosity/views", "radiosity/radiate"),
        ("emitters", "irradiance", "diffuse_radiance"),
        "radiance_out",
        defines={"ADDS_DIFFUSE": "1"},
    ),
    "row_sums": Pass(
        ("radiosity/views", "radiosity/row_sums"), ("radiance",), "sums_out", (EMITTERS, WORLD_POWER), STRIP, "RG32F"
    ),
    "row_starts": Pass(("radiosity/row_starts",), ("sums",), "starts_out", (ENTRIES, BY_AREA), STRIP),
    "table": Pass(
        ("common/random", "radiosity/table"), ("sums", "starts"), "table_out", (EMITTERS, ENTRIES, SEED), format="R32F"
    ),
    "sample_blocks": Pass(
        (*_VIEWS, *_SAMPLE, "radiosity/receiver_block", "radiosity/sample_emitters"),
        ("receivers", "emitters", "radiance", "table", "starts", "depths"),
        "irradiance_out",
        SAMPLING,
    ),
    "sample_base": Pass(
        (*_SURFEL, *_VIEWS, *_SAMPLE, "radiosity/receiver_base", "radiosity/sample_emitters"),
        ("surfels", "emitters", "radiance", "table", "starts", "depths"),
        "irradiance_out",
        SAMPLING,
    ),
    "smooth": Pass(
        (*_SURFEL, "radiosity/views", "common/bilateral", "radiosity/smooth"),
        ("surfels", "irradiance"),
        "total_out",
        (
            Field("step", "int", "texels between the taps"),
            Field("is_last", "bool", "whether this is the last step, which keeps the world's light above 0"),
            Field("has_world", "bool", "whether some of the world's light may be taken away"),
            STRENGTH,
        ),
    ),
    "reproject": Pass(
        (*_SURFEL, "radiosity/views", "temporal/reproject"),
        ("surfels", "past_surfels", "past_light", "motion"),
        "history_out",
        (
            Field("has_motion", "bool", "whether EEVEE's Vector pass is there"),
            Field("past_scale", "vec2", "as a frame's, of a base texel of the frame before"),
            Field("past_offset", "vec2", "as a frame's, of the frame before"),
            Field("past_rotation", "vec4", "rows: world to the view of the frame before; w: the translation", count=3),
        ),
    ),
    "accumulate": Pass(
        (*_SURFEL, "common/bilateral", "temporal/accumulate"),
        ("surfels", "irradiance", "history"),
        "light_out",
        (
            Field("gathers", "float", "that the irradiance is the mean of"),
            Field("earlier_gathers", "float", "that the history counts as, at most"),
            Field("allows_drift", "bool", "whether the light may have changed since"),
        ),
    ),
    "reflect": Pass(
        (
            *_SURFEL,
            *_VIEWS,
            "common/random",
            "glossy/ggx",
            "glossy/march",
            "radiosity/receiver_base",
            "glossy/reflect",
        ),
        ("surfels", "gloss", "emitters", "radiance", "depths"),
        "irradiance_out",
        (
            *BAND,
            SEED,
            Field("rays", "int", "of each texel"),
            Field("reach", "float", "length of a ray at most, m"),
        ),
    ),
    "smooth_gloss": Pass(
        (*_SURFEL, "common/bilateral", "glossy/smooth_gloss"), ("surfels", "gloss", "irradiance"), "total_out"
    ),
    "split_picture": Pass(
        ("viewport/split_picture",),
        ("picture",),
        "channel_out",
        (
            Field("size", "ivec2", "width, height in pixels"),
            Field("component", "int", "that is taken: 0 to 2; -1: the depth of a position"),
            DEPTH_AXIS,
        ),
    ),
    "depth_range": Pass(("viewport/depth_range",), ("picture",), "range_out", (DEPTH_AXIS,)),
    "running_mean": Pass(
        ("viewport/running_mean",),
        ("indirect", "mean"),
        "mean_out",
        (
            Field("size", "ivec2", "width, height in pixels"),
            Field("count", "int", "of pictures, this one among them"),
        ),
    ),
    "shrink": Pass(
        ("common/shrink",),
        ("picture",),
        "shrunk_out",
        (
            Field("size", "ivec2", "columns and rows of the grid"),
            Field("limit", "float", "of the brightest channel; 0: none"),
            Field("color", "vec3", "factor on the pixels"),
        ),
    ),
    "probe": Pass(("common/probe",), ("source",), "probed_out", defines={"SOURCE": "source"}),
    "probe_surfels": Pass(("common/probe",), ("surfels",), "probed_out", defines={"SOURCE": "surfels"}),
}
