# SPDX-License-Identifier: GPL-3.0-or-later
"""Afterlight: bounced light for EEVEE, gathered in screen space from the passes EEVEE has already rendered.

The root of the repository is the extension. Blender imports this file; everything else lives in `addon/`
(the method in `addon/gather/`, the way into and out of Blender in `addon/`) and in `shaders/`.
"""

from . import addon


def register():
    addon.register()


def unregister():
    addon.unregister()
