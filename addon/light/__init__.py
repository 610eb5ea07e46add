# SPDX-License-Identifier: GPL-3.0-or-later
"""The light itself: indirect illumination between the pixels of finished passes, on the GPU.

Knows `gpu` and numpy, and no scene: arrays in, an array out. The way through is pipeline.py, the mathematics
docs/method.md.
"""

from .device import GpuUnavailable, release
from .history import History
from .inputs import FARTHEST, MOST_GROUPS, Camera, Drawn, Draws, Gloss, Passes, Settings, View
from .memory import gpu_bytes, is_exact
from .pipeline import (Cancelled, Pyramid, composite, gather, gather_indirect, merge, pack, upload, upsample)
from .views import gather_views

__all__ = ["FARTHEST", "Camera", "Cancelled", "Drawn", "Draws", "Gloss", "GpuUnavailable", "History", "MOST_GROUPS", "Passes", "Pyramid", "Settings",
           "View", "composite", "gather", "gather_indirect", "gather_views", "gpu_bytes", "is_exact", "merge", "pack", "release",
           "upload", "upsample"]
