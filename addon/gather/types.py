# SPDX-License-Identifier: GPL-3.0-or-later
"""The input of the gather: cameras, EEVEE's passes and the settings. Plain numpy, no GPU."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields

import numpy as np

from .pyramid import MAX_RADIUS

# Shadow rays of a texel. Mesa's software driver ends the loops of a shader silently after 65,535 rounds in all: those
# along so many shadow rays, in ten views, and over 16 candidates for each, stay below that.
MAX_GROUPS = 128
MAX_VIEWS = 10  # the main one among them
FARTHEST = 1e9  # metres; EEVEE writes 1e10 where there is no surface
Triple = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class Camera:
    """The projection of a picture. Lens shift, pixel aspect and a render border are part of scale and offset.

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
    motion: (x, y) in pixels, y up, from a surface's position in this frame to that in the frame before; None where it
    is not known.
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
        """The arrays of each pass but motion; depth is a pass of one channel."""
        passes = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "motion"}
        return passes | {"depth": (self.depth,)}

    def lacks_normals(self) -> bool:
        """Is there a surface without a normal? Materials of pure emission can write (0, 0, 0)."""
        without = self.depth < FARTHEST
        for axis in self.normal:
            without &= axis == 0
        return bool(without.any())

    def broken(self) -> dict[str, int]:
        """Number of pixels with NaN or infinity, by pass; empty for sound passes. Only for messages to people: the
        shaders leave out such pixels as emitters."""
        counts = {
            name: int(np.count_nonzero(~np.logical_and.reduce([np.isfinite(array) for array in arrays])))
            for name, arrays in self.channels().items()
        }
        return {name: count for name, count in counts.items() if count}


@dataclass(eq=False)
class GpuPasses:
    """Passes that are on the GPU already. size: (width, height) in pixels. textures: by channel, as stages.upload()
    makes them."""

    size: tuple[int, int]
    textures: dict

    def lacks_normals(self) -> bool:
        """True: there may be surfaces without a normal, and to look for them would take a read back."""
        return True


@dataclass(frozen=True, eq=False)
class View:
    """A picture of the scene that sends light, and its camera.

    source: Passes, or a function that loads them, since they are large and needed only for a moment; or GpuPasses.
    load_specular: a function that loads Passes of the same picture with Glossy Color and Glossy Direct in the fields of
    the diffuse ones, and no emission; or None where the picture has none. coarse: whether the picture has a pixel for
    each texel of the depth maps, whatever the first view's resolution."""

    source: Passes | GpuPasses | Callable[[], Passes]
    camera: Camera
    load_specular: Callable[[], Passes | None] = lambda: None
    coarse: bool = False

    def load_passes(self) -> Passes | GpuPasses:
        """The passes; may open a file."""
        return self.source() if callable(self.source) else self.source


@dataclass(eq=False)
class Gloss:
    """The specular reflectance of the picture's surfaces, rows top first, and the light that gather_views() adds to it.

    color: EEVEE's Glossy Color, the albedo of the specular lobe, (H, W) float32 each. roughness: (H, W) float32, 0 to
    1, as in Blender's materials. picture: (H, W, 3) float32, bottom row first: the specular indirect light, to add to
    the picture, W sr^-1 m^-2; below 0 where the world's light is covered. None until it is gathered.
    """

    color: Triple
    roughness: np.ndarray
    picture: np.ndarray | None = None


@dataclass(frozen=True)
class RadiositySettings:
    """Settings of the method Radiosity: light between several views.

    start: pixels along the side of a base texel of the picture (1, 2 or 4). groups: shadow rays of a base texel, at
    most MAX_GROUPS; candidates: emitters of which each is chosen. bounces: 1 and more. visibility: whether surfaces
    block shadow rays. gathers: independent gathers that the picture is the mean of. smooth: whether noise is smoothed.
    seed, strength: as in PaperSettings. Raises ValueError for anything else."""

    start: int
    groups: int = 16
    candidates: int = 16
    bounces: int = 4
    visibility: bool = True
    seed: int = 0
    strength: float = 1.0
    gathers: int = 1
    smooth: bool = True

    def __post_init__(self) -> None:
        _check_start(self.start)
        if min(self.groups, self.candidates, self.bounces, self.gathers) < 1:
            raise ValueError(
                f"Groups, candidates, bounces and gathers are 1 or more, not {self.groups}, {self.candidates}, "
                f"{self.bounces}, {self.gathers}"
            )
        if self.groups > MAX_GROUPS:
            raise ValueError(f"Groups are at most {MAX_GROUPS}, not {self.groups}")


@dataclass(frozen=True)
class PaperSettings:
    """Settings of the method Paper: light between the surfaces of one picture.

    start: pixels along the side of a base texel (1, 2 or 4). samples: of a texel at the finest level, doubled at each
    coarser one; 0, or any number from the region's texels on, takes all of them. radius: of the region, in texels, 2 to
    140. seed: any integer; the same seed gives the same picture. strength: factor on the result. Raises ValueError for
    anything else."""

    start: int
    samples: int
    radius: int
    seed: int
    strength: float

    def __post_init__(self) -> None:
        _check_start(self.start)
        if self.samples < 0:
            raise ValueError(f"The number of samples must not be negative: {self.samples}")
        if not 2 <= self.radius <= MAX_RADIUS:
            raise ValueError(f"The radius must be 2 to {MAX_RADIUS} texels, not {self.radius}")


def _check_start(start: int) -> None:
    if start not in (1, 2, 4):
        raise ValueError(f"The start resolution must be 1, 2 or 4 pixels a texel, not {start}")
