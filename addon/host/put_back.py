# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the user's that have to change for a moment: recorded as they are, and put back.

Settings in Blender reset one another: a file format its colour depth and colour space, a media type the codec of
videos. No order of names is right for all of them, so what differs is set again until nothing does.
"""

import bpy

MAX_ROUNDS = 5


def record(*structs, leave=()):
    """[(owner, name, value)] of all that can be set of these structs of Blender's (None among them has nothing), and of
    those that they hold. leave: names of properties to leave out."""
    found = []
    for struct in structs:
        for name, prop in struct.bl_rna.properties.items() if struct is not None else ():
            if name in ("rna_type", *leave) or prop.type == "COLLECTION":
                continue
            value = current(struct, name)
            if not prop.is_readonly:
                found.append((struct, name, value))
            elif prop.type == "POINTER" and not isinstance(value, bpy.types.ID):
                found += record(value, leave=leave)
    return found


def restore(recorded):
    """Put back what differs from [(owner, name, value)]. What Blender no longer allows stays as it is."""
    for _ in range(MAX_ROUNDS):
        differing = [(owner, name, value) for owner, name, value in recorded if current(owner, name) != value]
        if not differing:
            break
        for owner, name, value in differing:
            try:
                setattr(owner, name, value)
            except (TypeError, ValueError, AttributeError, RuntimeError):  # not allowed before another is put back
                pass


def current(owner, name):
    """The value of a setting, of which a later change makes no other."""
    value = getattr(owner, name)
    return tuple(value) if getattr(owner.bl_rna.properties[name], "is_array", False) else value
