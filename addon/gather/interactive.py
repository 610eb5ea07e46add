# SPDX-License-Identifier: GPL-3.0-or-later
"""The light of pictures that EEVEE has drawn on the GPU, for a picture that stays there: what a viewport needs.

split       EEVEE's pictures become the channels that all passes read
indirect    one gather, by the same stages as a finished frame's (paper.py, radiosity.py)
Mean        of the gathers so far, which is what is shown
"""

import numpy as np

from . import device
from .paper import Texture, composite, gather, merge, pack, upload, upsample
from .radiosity import SMOOTH_STEPS, UNSMOOTHED, layout, look, smooth, view_table
from .radiosity import gather as gather_all
from .temporal import History
from .types import Camera, Drawn, Draws, Passes, Settings, View

SPAN_BLOCK = 16  # pixels along the side of what one thread of "span" looks at
# What each picture is split into: names as the shaders have them, and components; -1 is the depth of a place.
CHANNELS = {
    "place": (("depth_pass", -1),),
    "normal": tuple(zip(device.SURFACE_CHANNELS[1:], range(3))),
    "diffuse_color": tuple(zip(device.COLOR_CHANNELS, range(3))),
    "diffuse_direct": tuple(zip(device.LIGHT_CHANNELS[:3], range(3))),
    "emission": tuple(zip(device.LIGHT_CHANNELS[3:], range(3))),
}


def split(name: str, picture: Texture, camera: Camera | None, drawn: Drawn) -> None:
    """Put a picture, by its name in CHANNELS, into `drawn`, in place of what it was. picture: (height, width), bottom
    row first; "place" holds places in the world, and (0, 0, 0) where there is none, and needs the camera."""
    width, height = drawn.size
    block = device.parameters(frame=(width, height)) if camera is None else _axis_block(camera, (width, height))
    quads = -(-width // 4)
    for channel, component in CHANNELS[name]:
        target = drawn.textures[channel] = device.texture(quads, height)
        block["span"][0] = component
        device.dispatch(
            "split_picture", block, {"picture": picture, "channel_out": target}, device.groups(quads, height)
        )


def read(drawn: Drawn) -> Passes:
    """Passes of what was drawn, out of the GPU."""
    width, height = drawn.size
    found = {
        name: tuple(device.read(drawn.textures[channel]).reshape(height, -1)[:, :width] for channel, _ in channels)
        for name, channels in CHANNELS.items()
    }
    (depth,) = found.pop("place")
    return Passes(depth=depth, **found)


def span(picture: Texture, camera: Camera) -> tuple[float, float] | None:
    """(least, greatest) depth of what a picture of places shows, along the axis of the camera; None where it shows
    nothing."""
    target = device.texture(-(-picture.width // SPAN_BLOCK), -(-picture.height // SPAN_BLOCK))
    device.dispatch(
        "depth_range",
        _axis_block(camera, (picture.width, picture.height)),
        {"picture": picture, "span_out": target},
        device.groups(target.width, target.height),
    )
    found = device.read(target)
    least, greatest = float(found[..., 0].min()), float(found[..., 1].max())
    return (least, greatest) if least <= greatest else None


def _axis_block(camera, size):
    """A Parameters block with the row of a camera that gives depths, below 0 before it."""
    axis = camera.rotation[2]
    block = device.parameters(frame=size)
    block["rotation"][2] = *axis, -axis @ camera.position
    return block


def indirect(
    views: list[View],
    size: tuple[int, int],
    settings: Settings | Draws,
    world: np.ndarray | None = None,
    history: History | None = None,
) -> Texture:
    """The indirect light of the first view, as composite() makes it.

    views, world: as gather_views() has them; the method Paper takes the first view alone. size: (width, height) of
    views that are not coarse, of which there need be none. history: what the gather before left, averaged with this
    one, which is left there in its place. Radiosity gathers once, whatever settings.gathers. Raises GpuUnavailable.
    """
    main, shown = views[0].camera, views[0].passes
    if isinstance(settings, Settings):
        channels = upload(shown)
        pyramid = pack(channels, shown, main, settings)
        merge(pyramid)
        return composite(channels, pyramid, upsample(pyramid, gather(pyramid, settings)))
    table = view_table(views, size, settings, world)
    depths, emitters, receivers, channels = look(views, table)
    base = pack(channels, shown, main, settings)
    light, *_ = gather_all(settings, table, base, depths, emitters, receivers, lambda *_: None, lambda *_: None)
    if history is not None:
        light = history.go_on(base, main, None, table, light, 1)
    return composite(channels, base, smooth(base, light, table, SMOOTH_STEPS if settings.smooth else UNSMOOTHED))


def coarse_size(size: tuple[int, int]) -> tuple[int, int]:
    """(width, height) of coarse views beside others of `size`."""
    across, up = layout(1, size)["depths"][:2]
    return int(across), int(up)


class Mean:
    """The mean of pictures of one size. texture: (height, width), rgb, bottom row first; None before the first. count:
    of pictures."""

    def __init__(self):
        self.clear()

    def clear(self) -> None:
        self.texture, self.count = None, 0

    def add(self, picture: Texture, size: tuple[int, int]) -> None:
        """One more, as composite() makes it, of a frame of `size` (width, height)."""
        self.count += 1
        before, self.texture = self.texture, device.texture(*size)
        device.dispatch(
            "running_mean",
            device.parameters(frame=size, span=(self.count,)),
            {"indirect": picture, "mean": before or picture, "mean_out": self.texture},
            device.groups(*size),
        )
