# SPDX-License-Identifier: GPL-3.0-or-later
"""Recording settings of the user's before Afterlight changes them for a moment, and putting them back.

Blender's settings reset one another: a file format its colour depth and colour space, a media type the video codec. No
fixed order of names is right for all of them, so whatever differs is set again until nothing does.
"""

import bpy

MAX_ROUNDS = 5  # rounds of setting what still differs


def record(*structs, leave=()):
    """[(owner, name, value)] of every writable setting of these bpy structs and of the structs within them. None among
    them counts as empty. leave: names of properties to leave out."""
    recorded = []
    for struct in structs:
        for name, prop in struct.bl_rna.properties.items() if struct is not None else ():
            if name in ("rna_type", *leave) or prop.type == "COLLECTION":
                continue
            value = current(struct, name)
            if not prop.is_readonly:
                recorded.append((struct, name, value))
            elif prop.type == "POINTER" and not isinstance(value, bpy.types.ID):
                recorded += record(value, leave=leave)
    return recorded


def restore(recorded):
    """Set the values of [(owner, name, value)] again where they differ. Values that Blender no longer allows are
    skipped."""
    for _ in range(MAX_ROUNDS):
        differing = [(owner, name, value) for owner, name, value in recorded if current(owner, name) != value]
        if not differing:
            break
        for owner, name, value in differing:
            try:
                setattr(owner, name, value)
            except (TypeError, ValueError, AttributeError, RuntimeError):  # not allowed before another is restored
                pass


def current(owner, name):
    """The value of a setting, as a copy that later changes do not affect."""
    value = getattr(owner, name)
    return tuple(value) if getattr(owner.bl_rna.properties[name], "is_array", False) else value
