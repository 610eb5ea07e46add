# SPDX-License-Identifier: GPL-3.0-or-later
"""How rough the surfaces of a picture are, which EEVEE has no pass for.

Where the view layer has a value AOV of this name, that is taken: the user's materials say it themselves. Elsewhere the
Cryptomatte pass tells each pixel's material, and its nodes its roughness (materials.py).
"""

from dataclasses import replace

import bpy
import numpy as np

from .. import gather
from ..host import main_thread
from . import exr, materials, passes

AOV = "Roughness"
UNKNOWN_ROUGHNESS = (
    0.5  # where nodes decide it that are not read, and of surfaces without a material: Blender's own default
)
# Beside passes.PASSES: the view layer's switch, and the pass.
COLOR, DIRECT = ("use_pass_glossy_color", "Glossy Color"), ("use_pass_glossy_direct", "Glossy Direct")
MATERIAL = "use_pass_cryptomatte_material", "CryptoMaterial00"


def needed(layer: bpy.types.ViewLayer) -> tuple[tuple[str, str], ...]:
    """(switch, pass) of what load() reads of a view layer."""
    return (COLOR, DIRECT) if has_aov(layer) else (COLOR, DIRECT, MATERIAL)


def has_aov(layer: bpy.types.ViewLayer) -> bool:
    """Whether the view layer's materials write their roughness themselves."""
    return any(aov.name == AOV and aov.type == "VALUE" and aov.is_valid for aov in layer.aovs)


def load(path: str, layer: str, window: tuple[int, int, int, int]) -> gather.Gloss | None:
    """gather.Gloss of a view layer from a file that frame_store.save() wrote, and None where it lacks a pass. path,
    layer, window, Problem: as passes.load() has them."""
    cut = exr.read(path, window)
    try:
        color = exr.triple(cut, f"{layer}.{COLOR[1]}")
        try:
            rough = cut(f"{layer}.{AOV}.X")
        except KeyError:
            rough = from_cryptomatte(cut(f"{layer}.{MATERIAL[1]}.r"))
    except KeyError:
        return None
    return gather.Gloss(color, rough)


def specular_passes(path: str, layer: str, window: tuple[int, int, int, int]) -> gather.Passes | None:
    """gather.Passes of a view layer as gather.View.shine wants them, and None where the file lacks a pass."""
    cut, found = exr.read(path, window), passes.load(path, layer, window)
    try:
        color, direct = (exr.triple(cut, f"{layer}.{name}") for _, name in (COLOR, DIRECT))
    except KeyError:
        return None
    return replace(found, diffuse_color=color, diffuse_direct=direct, emission=(np.zeros_like(found.depth),) * 3)


def from_cryptomatte(numbers: np.ndarray) -> np.ndarray:
    """(H, W) float32 of the numbers by which Cryptomatte calls materials."""
    found, at = np.unique(np.ascontiguousarray(numbers).view(np.uint32), return_inverse=True)
    wanted = set(found.tolist())
    known = main_thread.run(
        lambda: {
            number: materials.roughness(material, UNKNOWN_ROUGHNESS)
            for material in bpy.data.materials
            if (number := cryptomatte_id(material.name)) in wanted
        }
    )
    return np.array([known.get(number, UNKNOWN_ROUGHNESS) for number in found.tolist()], np.float32)[at].reshape(
        numbers.shape
    )


def cryptomatte_id(name: str) -> int:
    """The bits of the number by which Cryptomatte calls a thing of this name: MurmurHash3 (A. Appleby; 32 bits, seed
    0), made a float that is finite and not denormal (Cryptomatte specification 1.2.0, ID generation)."""

    def turned(word, by):
        return (word << by | word >> (32 - by)) & 0xFFFFFFFF

    def mixed(word):
        return turned(word * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF

    data = name.encode()
    whole, found = len(data) & ~3, 0
    for first in range(0, whole, 4):
        found = (
            turned(found ^ mixed(int.from_bytes(data[first : first + 4], "little")), 13) * 5 + 0xE6546B64
        ) & 0xFFFFFFFF
    found ^= mixed(int.from_bytes(data[whole:], "little")) ^ len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        found = (found ^ found >> shift) * factor & 0xFFFFFFFF
    return found ^ 1 << 23 if found >> 23 & 0xFF in (0, 0xFF) else found
