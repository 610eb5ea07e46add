# SPDX-License-Identifier: GPL-3.0-or-later
"""What the gather is given: a camera, EEVEE's passes and the settings. Plain numpy, no GPU."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields

import numpy as np

from .pyramid import LARGEST_RADIUS

# Draws of a texel. Mesa's software driver ends the loops of a shader, without a word, after 65,535 rounds in all:
# those along the ways to this many emitters, in ten views, and over 16 candidates each, stay within it.
MOST_GROUPS = 128
FARTHEST = 1e9  # metres; EEVEE writes 1e10 where there is no surface
Triple = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class Camera:
    """How pixels see the world. Lens shift, pixel aspect and a render border all live in scale and offset.

    Pixel (i, j), j counted from the bottom row, has the view ray q = offset + scale * (i + 0.5, j + 0.5). Its point
    at planar depth z (metres, above 0) is (q.x z, q.y z, -z) in perspective and (q.x, q.y, -z) in orthographic.

    rotation: (3, 3) float64, world to view. scale, offset: (2,) float64, in view units at depth 1 (perspective) or
    metres (orthographic). position: (3,) float64, world, metres; matters where there are several views.
    """

    rotation: np.ndarray
    scale: np.ndarray
    offset: np.ndarray
    orthographic: bool = False
    position: np.ndarray = field(default_factory=lambda: np.zeros(3))


@dataclass(eq=False)
class Passes:
    """EEVEE's finished passes, rows top first as OpenEXR gives them; every array (H, W) float32, of any strides.

    depth: planar, metres; background 1e10 (anything above 1e9, or 0 and below, is no surface). normal: world space.
    diffuse_color: albedo. diffuse_direct: direct light without the albedo, as radiance of a white surface.
    emission: radiance. Radiance is in W sr^-1 m^-2, as linear as EEVEE writes it.
    motion: (x, y) in pixels, y up, from where a surface is to where it was in the frame before; None where that is not
    known.
    """

    depth: np.ndarray
    normal: Triple
    diffuse_color: Triple
    diffuse_direct: Triple
    emission: Triple
    motion: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        height, width = self.depth.shape
        return width, height

    def channels(self) -> dict[str, Triple]:
        """The arrays of each pass that light comes from, depth as a pass of one channel."""
        passes = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "motion"}
        return passes | {"depth": (self.depth,)}

    def lacks_normals(self) -> bool:
        """Is there a surface without a normal? Materials of pure emission can write (0, 0, 0)."""
        without = self.depth < FARTHEST
        for axis in self.normal:
            without &= axis == 0
        return bool(without.any())

    def broken(self) -> dict[str, int]:
        """How many pixels hold NaN or infinity, by pass; empty for sound passes. The shaders leave such pixels out as
        emitters, so this is only what a message to people needs."""
        counts = {
            name: int(np.count_nonzero(~np.logical_and.reduce([np.isfinite(array) for array in arrays])))
            for name, arrays in self.channels().items()
        }
        return {name: count for name, count in counts.items() if count}


@dataclass(eq=False)
class Drawn:
    """Passes that are on the GPU already. size: (width, height) in pixels. textures: as pipeline.upload() makes them
    of Passes."""

    size: tuple[int, int]
    textures: dict

    def lacks_normals(self) -> bool:
        """As Passes have it. There may be some: nobody has looked."""
        return True


@dataclass(frozen=True, eq=False)
class View:
    """A picture of the scene that sends light, and the camera that saw it. source: its Passes, or a function that loads
    them: each is needed only for a moment, and they are large; or Drawn. shine: a function that loads Passes of the
    same picture which have Glossy Color and Glossy Direct in the places of the diffuse ones, and no emission; or None
    where they can't be had. coarse: whether its picture has a pixel for each texel of the depth maps, however large
    the first view's is."""

    source: Passes | Drawn | Callable[[], Passes]
    camera: Camera
    shine: Callable[[], Passes | None] = lambda: None
    coarse: bool = False

    @property
    def passes(self) -> Passes:
        """The passes, loaded again each time where they have to be."""
        return self.source() if callable(self.source) else self.source


@dataclass(eq=False)
class Gloss:
    """How the surfaces of the picture shine, rows top first, and what gather_views() finds them to show.

    color: EEVEE's Glossy Color, the share of the light that the lobe sends back, (H, W) float32 each. roughness: (H,
    W) float32, as Blender's materials have it, 0 to 1. picture: (H, W, 3) float32, bottom row first: the indirect
    light that they reflect, to add to the picture, W sr^-1 m^-2; below 0 where the world's goes. None until it is
    gathered.
    """

    color: Triple
    roughness: np.ndarray
    picture: np.ndarray | None = None


@dataclass(frozen=True)
class Draws:
    """Settings of the light between several views.

    start: pixels along the side of a base texel of the picture (1, 2 or 4). groups: draws of a base texel whose way is
    looked along, at most MOST_GROUPS; candidates: emitters weighed for each. bounces: how often the light is passed
    on, 1 and more. visibility: whether surfaces hide what lies behind them. gathers: of which the picture is the mean.
    smooth: whether neighbours are averaged. seed, strength: as in Settings. Raises ValueError for anything else."""

    start: int
    groups: int = 16
    candidates: int = 16
    bounces: int = 4
    visibility: bool = True
    seed: int = 0
    strength: float = 1.0
    gathers: int = 1
    smooth: bool = True

    def __post_init__(self):
        _check_start(self.start)
        if min(self.groups, self.candidates, self.bounces, self.gathers) < 1:
            raise ValueError(
                f"Groups, candidates, bounces and gathers are 1 or more, not {self.groups}, {self.candidates}, "
                f"{self.bounces}, {self.gathers}"
            )
        if self.groups > MOST_GROUPS:
            raise ValueError(f"Groups are at most {MOST_GROUPS}, not {self.groups}")


@dataclass(frozen=True)
class Settings:
    """start: pixels along the side of a base texel (1, 2 or 4). samples: per texel at the finest level, doubled at
    each coarser one; 0, or any number not below the size of the region, takes every texel of it. radius: of the
    region, in texels, 2 to 140. seed: any integer; the same seed gives the same picture. strength: factor on the
    result. Raises ValueError for anything else."""

    start: int
    samples: int
    radius: int
    seed: int
    strength: float

    def __post_init__(self):
        _check_start(self.start)
        if self.samples < 0:
            raise ValueError(f"The number of samples must not be negative: {self.samples}")
        if not 2 <= self.radius <= LARGEST_RADIUS:
            raise ValueError(f"The radius must be 2 to {LARGEST_RADIUS} texels, not {self.radius}")


def _check_start(start):
    if start not in (1, 2, 4):
        raise ValueError(f"The start resolution must be 1, 2 or 4 pixels a texel, not {start}")
