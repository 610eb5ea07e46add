# SPDX-License-Identifier: GPL-3.0-or-later
"""Adding and removing functions in Blender's lists of handlers (bpy.app.handlers)."""

import bpy


def listen(handlers):
    """Add functions to Blender's handlers: pairs of (name of the list, function)."""
    for event, handler in handlers:
        getattr(bpy.app.handlers, event).append(handler)


def call_last(event, call):
    """Call `call` once, after all other handlers of the event that Blender is handling now."""
    called = getattr(bpy.app.handlers, event)

    def last(*_):
        called.remove(last)
        call()

    called.append(last)


def ignore(handlers):
    """Remove what listen() added. Loading factory settings may have removed it already."""
    for event, handler in handlers:
        if handler in getattr(bpy.app.handlers, event):
            getattr(bpy.app.handlers, event).remove(handler)
