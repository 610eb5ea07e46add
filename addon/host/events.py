# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lists of handlers."""

import bpy


def listen(handlers):
    """Have Blender call functions: (name of one of its lists, function) each."""
    for event, handler in handlers:
        getattr(bpy.app.handlers, event).append(handler)


def call_last(event, call):
    """Have Blender make a call once, after all handlers of the event that it is calling right now."""
    called = getattr(bpy.app.handlers, event)

    def last(*_):
        called.remove(last)
        call()

    called.append(last)


def ignore(handlers):
    """Undo listen(). Loading factory settings may have done so already."""
    for event, handler in handlers:
        if handler in getattr(bpy.app.handlers, event):
            getattr(bpy.app.handlers, event).remove(handler)
