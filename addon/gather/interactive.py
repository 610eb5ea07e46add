# SPDX-License-Identifier: GPL-3.0-or-later
"""The indirect light of pictures that EEVEE has drawn on the GPU, for a picture that stays there: for the viewport.

split          EEVEE's pictures become the channels that all passes read
depth_range    of a picture, for the clipping planes of orthographic cameras
indirect       one gather, by the stages of a finished frame (paper.py, radiosity.py)
Mean           of the gathers so far, which the viewport shows
"""

import numpy as np

from . import device
from .device import Texture
from .paper import gather, merge, upsample
from .radiosity import gather as gather_bounces
from .radiosity import smooth
from .records import build_records
from .shader_interface import COLOR_CHANNELS, DEPTH_RANGE_BLOCK, LIGHT_CHANNELS, SURFACE_CHANNELS
from .stages import composite, pack, upload
from .temporal import History
from .types import Camera, GpuPasses, PaperSettings, Passes, RadiositySettings, View
from .view_layout import layout

# The channels of each picture: names in the shaders, and components; -1 is the depth of a position.
CHANNELS = {
    "position": (("depth_pass", -1),),
    "normal": tuple(zip(SURFACE_CHANNELS[1:], range(3), strict=True)),
    "diffuse_color": tuple(zip(COLOR_CHANNELS, range(3), strict=True)),
    "diffuse_direct": tuple(zip(LIGHT_CHANNELS[:3], range(3), strict=True)),
    "emission": tuple(zip(LIGHT_CHANNELS[3:], range(3), strict=True)),
}


def split(name: str, picture: Texture, camera: Camera | None, drawn: GpuPasses) -> None:
    """Put a picture, by its name in CHANNELS, into `drawn`, and replace the one before. picture: (height, width),
    bottom row first; "position" holds world positions, (0, 0, 0) where there is no surface, and needs the camera."""
    width, height = drawn.size
    quads = -(-width // 4)
    for channel, component in CHANNELS[name]:
        target = drawn.textures[channel] = device.texture(quads, height)
        device.dispatch(
            "split_picture",
            {"picture": picture, "channel_out": target},
            device.groups(quads, height),
            size=drawn.size,
            component=component,
            depth_axis=np.zeros(4) if camera is None else _depth_axis(camera),
        )


def read(drawn: GpuPasses) -> Passes:
    """The passes, read back from the GPU."""
    width, height = drawn.size

    def channels(name: str) -> list[np.ndarray]:
        return [device.read(drawn.textures[channel]).reshape(height, -1)[:, :width] for channel, _ in CHANNELS[name]]

    def triple(name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        x, y, z = channels(name)
        return x, y, z

    return Passes(
        channels("position")[0],
        triple("normal"),
        triple("diffuse_color"),
        triple("diffuse_direct"),
        triple("emission"),
    )


def depth_range(picture: Texture, camera: Camera) -> tuple[float, float] | None:
    """(least, greatest) depth of a picture of positions along the axis of the camera; None where it shows nothing."""
    target = device.texture(-(-picture.width // DEPTH_RANGE_BLOCK), -(-picture.height // DEPTH_RANGE_BLOCK))
    device.dispatch(
        "depth_range",
        {"picture": picture, "range_out": target},
        device.groups(target.width, target.height),
        depth_axis=_depth_axis(camera),
    )
    ranges = device.read(target)
    least, greatest = float(ranges[..., 0].min()), float(ranges[..., 1].max())
    return (least, greatest) if least <= greatest else None


def _depth_axis(camera: Camera) -> np.ndarray:
    axis = camera.rotation[2]
    return np.array([*axis, -axis @ camera.position])


def indirect(
    views: list[View],
    size: tuple[int, int],
    settings: PaperSettings | RadiositySettings,
    world: np.ndarray | None = None,
    history: History | None = None,
) -> Texture:
    """The indirect light of the first view, as composite() makes it.

    views, world: as in gather_views(); the method Paper takes the first view alone. size: (width, height) of views that
    are not coarse, of which there need be none. history: of the gather before; it is averaged with this one, and holds
    the mean afterwards. Radiosity gathers once, whatever settings.gathers. Raises GpuUnavailable.
    """
    main = views[0].camera
    if isinstance(settings, PaperSettings):
        passes = views[0].load_passes()
        channels = upload(passes)
        pyramid = pack(channels, passes, main, settings)
        merge(pyramid)
        return composite(channels, pyramid, upsample(pyramid, gather(pyramid, settings)), settings.strength)
    records, channels, passes = build_records(views, settings, world, size)
    base = pack(channels, passes, main, settings)
    light, *_ = gather_bounces(settings, base, records, lambda *_: None, lambda *_: None)
    if history is not None:
        light = history.go_on(base, main, None, records.table, light, 1)
    return composite(channels, base, smooth(base, light, records.table, settings), settings.strength)


def coarse_size(size: tuple[int, int]) -> tuple[int, int]:
    """(width, height) of coarse views beside others of `size`."""
    across, up = layout(1, size)["depth_size"]
    return int(across), int(up)


class Mean:
    """The mean of pictures of one size. texture: (height, width), rgb, bottom row first; None before the first. count:
    of pictures."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        self.texture: Texture | None = None
        self.count = 0

    def add(self, picture: Texture, size: tuple[int, int]) -> None:
        """Add a picture, as composite() makes it, of a frame of `size` (width, height)."""
        self.count += 1
        before, self.texture = self.texture, device.texture(*size)
        device.dispatch(
            "running_mean",
            {"indirect": picture, "mean": before or picture, "mean_out": self.texture},
            device.groups(*size),
            size=size,
            count=self.count,
        )
