# SPDX-License-Identifier: GPL-3.0-or-later
"""The gather: indirect illumination between the surfaces that finished passes show, on the GPU.

Knows `gpu` and numpy, and no scene: arrays in, an array out. Two methods: paper.py, between the surfaces of one picture
(docs/method/paper.md), and radiosity.py, between those of several views (docs/method/radiosity.md).
"""

from .device import GpuUnavailable, release
from .memory import gpu_bytes, is_exact
from .paper import gather, gather_indirect, merge, upsample
from .radiosity import gather_views
from .stages import Cancelled, Pyramid, composite, pack, upload
from .temporal import History
from .types import (
    FARTHEST,
    MAX_GROUPS,
    MAX_VIEWS,
    Camera,
    Gloss,
    GpuPasses,
    PaperSettings,
    Passes,
    RadiositySettings,
    View,
)

__all__ = [
    "FARTHEST",
    "MAX_GROUPS",
    "MAX_VIEWS",
    "Camera",
    "Cancelled",
    "Gloss",
    "GpuPasses",
    "GpuUnavailable",
    "History",
    "PaperSettings",
    "Passes",
    "Pyramid",
    "RadiositySettings",
    "View",
    "composite",
    "gather",
    "gather_indirect",
    "gather_views",
    "gpu_bytes",
    "is_exact",
    "merge",
    "pack",
    "release",
    "upload",
    "upsample",
]
