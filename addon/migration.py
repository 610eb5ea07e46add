# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of earlier versions: when one is opened its settings are converted to this version without a change of the
image. Settings of a newer version are left alone, and checks.py says so."""

import bpy
from bpy.app.handlers import persistent

from . import properties
from .compositor import setup
from .host import events

DEFAULTS_OF_0_1_0 = {
    "method": "PAPER",
    "views": "CAMERA",  # the only ones of 0.1.0
    "strength": 1.0,
    "start": "HALF",
    "samples": 256,
    "radius": 16,
    "seed": 0,
    "use_animated_seed": False,
}


def _store_defaults(old):
    """For 0.1.0, which stored only settings that were not at their defaults. Later versions store every setting."""
    properties.store_all(old, DEFAULTS_OF_0_1_0)


def _without_history(old):
    """For versions without Average Frames, whose images must not change."""
    old.use_history = False


# (version, the function that converts settings of older versions to it). When a setting is renamed, keyframes and
# drivers have to follow.
STEPS = (((0, 2, 0), _store_defaults), ((0, 3, 0), _without_history))


def migrate(old):
    """Convert one scene's settings to this version."""
    if not properties.is_stored(old):
        return
    for version, step in STEPS:
        if tuple(old.version) < version:
            step(old)
    properties.stamp(old)


@persistent
def migrate_all(*_):
    """Handler: a file was opened, or scenes were appended."""
    for scene in bpy.data.scenes:
        setup.adopt(scene)
        if scene.library is None:
            migrate(scene.afterlight)


@persistent
def stamp_all(*_):
    """Handler: the file is about to be saved, or scenes to be appended. New settings get this version."""
    for scene in bpy.data.scenes:
        if scene.library is None and properties.is_stored(scene.afterlight):
            properties.stamp(scene.afterlight)


def _once():
    """Timer: a file was open before the extension was enabled."""
    migrate_all()


HANDLERS = (
    ("load_post", migrate_all),
    ("save_pre", stamp_all),
    # Settings of the file that is open must not be taken for appended ones of 0.1.0, which have no version.
    ("blend_import_pre", stamp_all),
    ("blend_import_post", migrate_all),
)


def register():
    events.listen(HANDLERS)
    bpy.app.timers.register(_once, first_interval=0.0)


def unregister():
    events.ignore(HANDLERS)
    if bpy.app.timers.is_registered(_once):
        bpy.app.timers.unregister(_once)
