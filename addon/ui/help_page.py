# SPDX-License-Identifier: GPL-3.0-or-later
"""The help page: a file of the package, so that it needs no network and matches this version.

It is HTML because browsers open HTML at a section. Blender's right click > Online Manual opens it as well.
"""

from pathlib import Path

import bpy

from ..parameters import PARAMETERS
from ..properties import AfterlightSettings, AfterlightView

PATH = Path(__file__).resolve().parents[2] / "docs" / "help.html"
# The section of what is not in the table of parameters. Of several patterns that match, Blender takes the first.
OTHERS = (
    (f"bpy.types.{AfterlightSettings.__name__}.enabled".lower(), "#enabled"),
    (f"bpy.types.{AfterlightSettings.__name__}.view_camera*".lower(), "#views"),
    (f"bpy.types.{AfterlightView.__name__}.*".lower(), "#views"),
    (f"bpy.types.{AfterlightSettings.__name__}*".lower(), ""),
    ("bpy.ops.afterlight.preset*", "#presets"),
    ("bpy.ops.afterlight.mend*", "#messages"),
    ("bpy.ops.afterlight.repair*", "#messages"),
    ("bpy.ops.afterlight.update*", "#update"),
    ("bpy.ops.afterlight.free_passes*", "#update"),
    ("bpy.ops.afterlight.place_views*", "#views"),
    ("bpy.ops.afterlight.view_*", "#views"),
    ("bpy.ops.afterlight.*", "#menu"),
)


def address(section=""):
    """URL of the page, at the element with the id `section`."""
    return PATH.as_uri() + (f"#{section}" if section else "")


def manual_map():
    """Blender's map for right click > Online Manual: how all URLs begin, and (pattern, rest of the URL) pairs."""
    names = [parameter.name for parameter in PARAMETERS]
    sections = [(f"bpy.types.{AfterlightSettings.__name__}.{name}".lower(), f"#{name}") for name in names]
    return PATH.as_uri(), (*sections, *OTHERS)


def register():
    bpy.utils.register_manual_map(manual_map)


def unregister():
    bpy.utils.unregister_manual_map(manual_map)
