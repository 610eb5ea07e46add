# SPDX-License-Identifier: GPL-3.0-or-later
"""The light itself: indirect illumination between the pixels of finished passes, on the GPU.

Knows `gpu` and numpy, and no scene: arrays in, an array out. The way through is paper.py, the mathematics
docs/method/paper.md.
"""

from .device import GpuUnavailable, release
from .memory import gpu_bytes, is_exact
from .paper import Cancelled, Pyramid, composite, gather, gather_indirect, merge, pack, upload, upsample
from .radiosity import gather_views
from .temporal import History
from .types import FARTHEST, MOST_GROUPS, Camera, Drawn, Draws, Gloss, Passes, Settings, View

__all__ = [
    "FARTHEST",
    "Camera",
    "Cancelled",
    "Drawn",
    "Draws",
    "Gloss",
    "GpuUnavailable",
    "History",
    "MOST_GROUPS",
    "Passes",
    "Pyramid",
    "Settings",
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
