# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of help: a file of the package, so that it is there without a network and speaks of this very version.

It is HTML because that alone opens at a section, in every browser; it also answers Blender's own right click > Online
Manual.
"""

from pathlib import Path

import bpy

PATH = Path(__file__).resolve().parents[2] / "docs" / "help.html"


def address(section=""):
    """URL of the page, at the element with the id `section`."""
    return PATH.as_uri() + (f"#{section}" if section else "")


def manual_map():
    """What Blender asks add-ons for on right click > Online Manual: how URLs begin, and (pattern, end) of each."""
    from ..properties import PARAMETERS, AfterlightSettings

    names = ["enabled", "use_viewport", *(parameter.name for parameter in PARAMETERS)]
    sections = [(f"bpy.types.{AfterlightSettings.__name__}.{name}".lower(), f"#{name}") for name in names]
    return PATH.as_uri(), (
        *sections,
        (f"bpy.types.{AfterlightSettings.__name__}*".lower(), ""),
        ("bpy.ops.afterlight.preset_add*", "#presets"),
        ("bpy.ops.afterlight.mend*", "#messages"),
        ("bpy.ops.afterlight.repair*", "#messages"),
        ("bpy.ops.afterlight.update*", "#update"),
        ("bpy.ops.afterlight.free_passes*", "#update"),
        ("bpy.ops.afterlight.place_views*", "#views"),
        ("bpy.ops.afterlight.view_*", "#views"),
        ("bpy.ops.afterlight.*", "#menu"),
    )


def register():
    bpy.utils.register_manual_map(manual_map)


def unregister():
    bpy.utils.unregister_manual_map(manual_map)
