# SPDX-License-Identifier: GPL-3.0-or-later
"""The roughness of surfaces at each pixel, for which EEVEE has no pass.

If the view layer has a value AOV named "Roughness" that is used: the materials write it themselves. Otherwise the
Cryptomatte pass gives each pixel's material, and its nodes the roughness (materials.py).
"""

from dataclasses import replace

import bpy
import numpy as np

from .. import gather
from ..host import main_thread
from . import exr, materials, passes

AOV = "Roughness"
UNKNOWN_ROUGHNESS = 0.5  # of materials that can't be read, and of surfaces without one: Blender's default
# (switch, pass) besides passes.PASSES. switch: a property of the view layer.
COLOR, DIRECT = ("use_pass_glossy_color", "Glossy Color"), ("use_pass_glossy_direct", "Glossy Direct")
MATERIAL = "use_pass_cryptomatte_material", "CryptoMaterial00"


def needed(layer: bpy.types.ViewLayer) -> tuple[tuple[str, str], ...]:
    """(switch, pass) of each pass of a view layer that load() reads."""
    return (COLOR, DIRECT) if has_aov(layer) else (COLOR, DIRECT, MATERIAL)


def has_aov(layer: bpy.types.ViewLayer) -> bool:
    """Whether the view layer's materials write their roughness themselves."""
    return any(aov.name == AOV and aov.type == "VALUE" and aov.is_valid for aov in layer.aovs)


def load(path: str, layer: str, window: tuple[int, int, int, int]) -> gather.Gloss | None:
    """gather.Gloss of a view layer from a file that frame_store.save() wrote; None if it lacks a pass. window: (x, y,
    width, height) in pixels from the bottom left. Raises Problem if the file can't be read."""
    read_channel = exr.read(path, window)
    try:
        color = exr.triple(read_channel, f"{layer}.{COLOR[1]}")
        try:
            rough = read_channel(f"{layer}.{AOV}.X")
        except KeyError:
            rough = from_cryptomatte(read_channel(f"{layer}.{MATERIAL[1]}.r"))
    except KeyError:
        return None
    return gather.Gloss(color, rough)


def specular_passes(path: str, layer: str, window: tuple[int, int, int, int]) -> gather.Passes | None:
    """gather.Passes with specular in place of diffuse color and light, for gather.View.load_specular(); None if the
    file lacks a pass."""
    read_channel, frame_passes = exr.read(path, window), passes.load(path, layer, window)
    try:
        color, direct = (exr.triple(read_channel, f"{layer}.{name}") for _, name in (COLOR, DIRECT))
    except KeyError:
        return None
    return replace(
        frame_passes, diffuse_color=color, diffuse_direct=direct, emission=(np.zeros_like(frame_passes.depth),) * 3
    )


def from_cryptomatte(id_pixels: np.ndarray) -> np.ndarray:
    """(H, W) float32 roughness of Cryptomatte's material ids, (H, W) float32."""
    unique, inverse = np.unique(np.ascontiguousarray(id_pixels).view(np.uint32), return_inverse=True)
    ids = set(unique.tolist())
    roughness_of = main_thread.run(
        lambda: {
            number: materials.roughness(material, UNKNOWN_ROUGHNESS)
            for material in bpy.data.materials
            if (number := cryptomatte_id(material.name)) in ids
        }
    )
    values = np.array([roughness_of.get(number, UNKNOWN_ROUGHNESS) for number in unique.tolist()], np.float32)
    return values[inverse].reshape(id_pixels.shape)


def cryptomatte_id(name: str) -> int:
    """The bits of Cryptomatte's id for this name: MurmurHash3 (A. Appleby; 32 bits, seed 0), made a finite float that
    is not denormal (Cryptomatte specification 1.2.0, ID generation)."""

    def turned(word, by):
        return (word << by | word >> (32 - by)) & 0xFFFFFFFF

    def mixed(word):
        return turned(word * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF

    data = name.encode()
    whole_bytes, hashed = len(data) & ~3, 0
    for first in range(0, whole_bytes, 4):
        hashed = (
            turned(hashed ^ mixed(int.from_bytes(data[first : first + 4], "little")), 13) * 5 + 0xE6546B64
        ) & 0xFFFFFFFF
    hashed ^= mixed(int.from_bytes(data[whole_bytes:], "little")) ^ len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        hashed = (hashed ^ hashed >> shift) * factor & 0xFFFFFFFF
    return hashed ^ 1 << 23 if hashed >> 23 & 0xFF in (0, 0xFF) else hashed
