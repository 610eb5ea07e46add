# SPDX-License-Identifier: GPL-3.0-or-later
"""Set a property only if its value differs."""


def assign(data, name, value):
    """Set a property if its value differs: setting one tags the file as edited, and Blender then calls our handlers
    again."""
    old = getattr(data, name)
    if (tuple(old) != tuple(value)) if hasattr(old, "__len__") and not isinstance(old, str) else old != value:
        setattr(data, name, value)
