# SPDX-License-Identifier: GPL-3.0-or-later
"""Afterlight: bounced light for EEVEE, gathered in screen space from the passes EEVEE has already rendered.

The root of the repository is the extension. Blender imports this file; everything else is in `addon/` and `shaders/`
(docs/ARCHITECTURE.md).
"""

from . import addon


def register():
    addon.register()


def unregister():
    addon.unregister()
