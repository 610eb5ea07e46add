# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lists of handlers."""

import bpy


def listen(handlers, first=False):
    """Have Blender call functions: (name of one of its lists, function) each. first: before those of everybody else."""
    for event, handler in handlers:
        called = getattr(bpy.app.handlers, event)
        called.insert(0 if first else len(called), handler)


def ignore(handlers):
    """Undo listen(). Loading factory settings may have done so already."""
    for event, handler in handlers:
        if handler in getattr(bpy.app.handlers, event):
            getattr(bpy.app.handlers, event).remove(handler)
