# SPDX-License-Identifier: GPL-3.0-or-later
"""The files in which finished passes lie (frame_store.py): read as arrays in the file's own memory."""

import mmap
from collections.abc import Callable, Iterable

import numpy as np

from ..host import temp_files
from ..host.report import Problem


def read(path: str, window: tuple[int, int, int, int]) -> Callable[[str], np.ndarray]:
    """A function from the name of a channel ("ViewLayer.Normal.X") of a file that frame_store.save() wrote to its (H,
    W) float32, rows top first, or KeyError. window, Problem: as load() has them."""
    channels = _channels(path)

    def cut(name):
        pixels = channels[name]
        x, y, width, height = window
        if pixels.shape != (height, width):
            top = pixels.shape[0] - y - height
            pixels = pixels[top : top + height, x : x + width]
        return np.asarray(pixels, np.float32)

    return cut


def triple(cut: Callable[[str], np.ndarray], name: str, axes: str = "RGB") -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Three channels of a pass ("ViewLayer.Normal"), cut() as read() gives it."""
    first, second, third = (cut(f"{name}.{axis}") for axis in axes)
    return first, second, third


def contents(path: str, layers: Iterable[str]) -> dict[str, list[tuple[str, str]]]:
    """{view layer: [(pass, its channels in Blender's order)]} of a file that frame_store.save() wrote."""
    found: dict[str, dict[str, list[str]]] = {}
    for name in _channels(path):
        of, kind, channel = ("", *name.rsplit(".", 2))[-3:]  # names of passes have no dots: Blender replaces them
        if of in layers:  # the file holds the compositor's picture as well
            found.setdefault(of, {}).setdefault(kind, []).append(channel)
    order = "RGBXYZWUVA"
    return {
        layer: [
            (kind, "".join(sorted(channels, key=lambda channel: order.find(channel.upper()))))
            for kind, channels in of.items()
        ]
        for layer, of in found.items()
    }


def _channels(path):
    """{channel: (height, width) float32, rows top first} of a file that frame_store.save() wrote. Raises Problem."""
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
        channels = _mapped(path, OpenEXR.File(path, separate_channels=True, header_only=True).header())
        if channels is None:
            parts = OpenEXR.File(path, separate_channels=True).parts
            channels = {name: channel.pixels for part in parts for name, channel in part.channels.items()}
        if not channels:  # OpenEXR only prints why
            raise EOFError("it holds no whole pass")
        return channels
    except Exception as error:  # OpenEXR raises bare RuntimeError, ValueError and its own for a truncated file
        raise Problem(
            "The passes could not be read back from {} ({}). The disk of the temporary folder may be full",
            path,
            one_line(error),
        ) from error


def _mapped(path, header):
    """{channel: (H, W) float32, rows top first} in the file's own memory, or None where it is not laid out as save()
    asks for it: OpenEXR must then read it, or say what is wrong with it.

    OpenEXR's reader copies every pass of every layer; here only what is used is touched, and copied once, on its way to
    the GPU. In a file of one part without compression each row is its number, its size in bytes, and its channels.
    """
    channels = header["channels"]
    (left, top), (right, bottom) = header["dataWindow"]
    width, height = int(right - left + 1), int(bottom - top + 1)
    line = 8 + 4 * width * len(channels)
    with open(path, "rb") as file:
        pages = mmap.mmap(
            file.fileno(), 0, access=mmap.ACCESS_COPY
        )  # what is written to the arrays stays out of the file
    data = np.frombuffer(pages, np.uint8)
    start = data.size - height * line
    if start <= 0:
        return None
    lines = data[start:].reshape(height, line)
    numbers, sizes = lines[:, :8].copy().view("<i4").T
    if not np.array_equal(numbers, np.arange(top, bottom + 1)) or np.any(sizes != line - 8):
        return None
    if hasattr(mmap, "MADV_DONTNEED"):  # for a row's number the system has mapped what is around it as well
        pages.madvise(mmap.MADV_DONTNEED)
    planes = lines[:, 8:].view("<f4").reshape(height, len(channels), width)
    return {channel.name: planes[:, index] for index, channel in enumerate(channels)}


def one_line(error: BaseException) -> str:
    """The text of an error without its line breaks."""
    return " ".join(str(error).split())
