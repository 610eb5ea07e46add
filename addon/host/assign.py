# SPDX-License-Identifier: GPL-3.0-or-later
"""Setting a property only where that changes it."""


def assign(data, name, value):
    """Set only what differs: setting tags the file as edited, and Blender would call us again."""
    old = getattr(data, name)
    if (tuple(old) != tuple(value)) if hasattr(old, "__len__") and not isinstance(old, str) else old != value:
        setattr(data, name, value)
