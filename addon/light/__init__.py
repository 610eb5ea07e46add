# SPDX-License-Identifier: GPL-3.0-or-later
"""The light itself: one bounce of indirect illumination between the pixels of finished passes, on the GPU.

Knows `gpu` and numpy, and no scene: arrays in, an array out. The way through is pipeline.py, the mathematics
docs/method.md.
"""

from .device import GpuUnavailable, release
from .inputs import FARTHEST, Camera, Passes, Settings
from .memory import gpu_bytes, is_exact
from .pipeline import (Cancelled, Pyramid, composite, gather, gather_indirect, merge, pack, upload, upsample)

__all__ = ["FARTHEST", "Camera", "Cancelled", "GpuUnavailable", "Passes", "Pyramid", "Settings", "composite", "gather",
           "gather_indirect", "gpu_bytes", "is_exact", "merge", "pack", "release", "upload", "upsample"]
