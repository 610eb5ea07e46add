# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender sees of Afterlight, registered in the order in which the parts need one another."""

from . import operators, panel, settings
from .pipeline import engine, handlers, relight

PARTS = (settings, engine, relight, operators, panel, handlers)


def register():
    for part in PARTS:
        part.register()


def unregister():
    for part in reversed(PARTS):
        part.unregister()
