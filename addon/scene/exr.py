# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading the pass files that frame_store.py writes, as arrays mapped from the file."""

import mmap
from collections.abc import Callable, Iterable

import numpy as np

from ..host import temp_files
from ..host.report import Problem


def read(path: str, window: tuple[int, int, int, int]) -> Callable[[str], np.ndarray]:
    """A function from the name of a channel ("ViewLayer.Normal.X") to its pixels, (H, W) float32, top row first; it
    raises KeyError if there is no such channel. path: a file that frame_store.save() wrote. window: (x, y, width,
    height) in pixels from the bottom left, the part to cut out. Raises Problem if the file can't be read."""
    channels = _channels(path)

    def read_channel(name):
        pixels = channels[name]
        x, y, width, height = window
        if pixels.shape != (height, width):
            top = pixels.shape[0] - y - height
            pixels = pixels[top : top + height, x : x + width]
        return np.asarray(pixels, np.float32)

    return read_channel


def triple(
    read_channel: Callable[[str], np.ndarray], name: str, axes: str = "RGB"
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Three channels of a pass ("ViewLayer.Normal"). read_channel: a function from read()."""
    first, second, third = (read_channel(f"{name}.{axis}") for axis in axes)
    return first, second, third


def check(path: str) -> None:
    """Raise Problem if a file that frame_store.py wrote is not whole."""
    _channels(path)


def contents(path: str, layers: Iterable[str]) -> dict[str, list[tuple[str, str]]]:
    """{view layer: [(pass, its channels in Blender's order)]} of a file that frame_store.save() wrote."""
    channels_of: dict[str, dict[str, list[str]]] = {}
    for name in _channels(path):
        # Names of passes contain no dots: Blender replaces them.
        layer_name, pass_name, channel = ("", *name.rsplit(".", 2))[-3:]
        if layer_name in layers:  # the file also holds the compositor's output
            channels_of.setdefault(layer_name, {}).setdefault(pass_name, []).append(channel)
    order = "RGBXYZWUVA"
    return {
        layer: [
            (pass_name, "".join(sorted(channels, key=lambda channel: order.find(channel.upper()))))
            for pass_name, channels in passes.items()
        ]
        for layer, passes in channels_of.items()
    }


def _channels(path):
    """{channel: (height, width) float32, top row first} of a file that frame_store.save() wrote. Raises Problem."""
    try:
        import OpenEXR
    except ImportError as error:
        raise Problem(
            "The OpenEXR module can't be imported ({}). It comes with the extension: remove Afterlight in "
            "Preferences > Get Extensions and install it again from its zip",
            one_line(error),
        ) from error
    try:
        temp_files.check_regular(path)
        header = OpenEXR.File(path, separate_channels=True, header_only=True).header()
        channels = _mapped(path, header)
        if channels is None:
            parts = OpenEXR.File(path, separate_channels=True).parts
            channels = {name: channel.pixels for part in parts for name, channel in part.channels.items()}
        if not channels or not {channel.name for channel in header["channels"]} <= channels.keys():
            raise EOFError("not all passes are whole")  # OpenEXR only prints the reason
        return channels
    except Exception as error:  # OpenEXR raises bare RuntimeError, ValueError and its own for a truncated file
        raise Problem(
            "The passes could not be read back from {} ({}). The disk of the temporary folder may be full: "
            "free some space there",
            path,
            one_line(error),
        ) from error


def _mapped(path, header):
    """{channel: (H, W) float32, top row first} mapped from the file; None if its layout is not the one that save() asks
    for, so that OpenEXR must read it or say what is wrong with it.

    OpenEXR's reader copies every pass of every layer. Here only the passes that are used are touched, and copied once,
    on their way to the GPU. In an uncompressed file of one part each row is its number, its size in bytes, and its
    channels."""
    channels = header["channels"]
    (left, top), (right, bottom) = header["dataWindow"]
    width, height = int(right - left + 1), int(bottom - top + 1)
    bytes_per_row = 8 + 4 * width * len(channels)
    with open(path, "rb") as file:
        pages = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_COPY)  # writes to the arrays don't reach the file
    data = np.frombuffer(pages, np.uint8)
    start = data.size - height * bytes_per_row
    if start <= 0:
        return None
    rows = data[start:].reshape(height, bytes_per_row)
    numbers, sizes = rows[:, :8].copy().view("<i4").T
    if not np.array_equal(numbers, np.arange(top, bottom + 1)) or np.any(sizes != bytes_per_row - 8):
        return None
    if hasattr(mmap, "MADV_DONTNEED"):  # reading the row numbers has paged in the rows around them
        pages.madvise(mmap.MADV_DONTNEED)
    planes = rows[:, 8:].view("<f4").reshape(height, len(channels), width)
    return {channel.name: planes[:, index] for index, channel in enumerate(channels)}


def one_line(error: BaseException) -> str:
    """The text of an error without line breaks."""
    return " ".join(str(error).split())
