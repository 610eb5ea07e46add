# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of earlier versions: as soon as one is opened its settings become this version's, and mean what they meant.

Settings of a newer version are left as they are; checks.py says so.
"""

import bpy
from bpy.app.handlers import persistent

from . import properties
from .compositor import setup
from .host import events

DEFAULTS_OF_0_1_0 = {
    "method": "PAPER",
    "views": "CAMERA",  # all that there was
    "strength": 1.0,
    "start": "HALF",
    "samples": 256,
    "radius": 16,
    "seed": 0,
    "use_animated_seed": False,
}


def _store_defaults(old):
    """0.1.0 stored only what differed from its defaults, and knew one method. Since then a file holds every setting."""
    properties.store_all(old, DEFAULTS_OF_0_1_0)


def _without_what_is_new(old):
    """Pictures of older files stay what they were."""
    old.use_history = False


# The version that changed something, and what brings older settings up to it. A setting that gets a new name takes its
# keyframes and drivers along.
STEPS = (((0, 2, 0), _store_defaults), ((0, 3, 0), _without_what_is_new))


def migrate(old):
    """Bring one scene's settings up to this version."""
    if not properties.is_stored(old):
        return
    for version, step in STEPS:
        if tuple(old.version) < version:
            step(old)
    properties.stamp(old)


@persistent
def migrate_all(*_):
    """A file was opened, or scenes came in from one."""
    for scene in bpy.data.scenes:
        setup.adopt(scene)
        if scene.library is None:
            migrate(scene.afterlight)


@persistent
def stamp_all(*_):
    """The file is about to be saved, or to take scenes in: settings that were only just made get their version."""
    for scene in bpy.data.scenes:
        if scene.library is None and properties.is_stored(scene.afterlight):
            properties.stamp(scene.afterlight)


def _once():
    """For a file that was open before the extension was switched on."""
    migrate_all()


HANDLERS = (
    ("load_post", migrate_all),
    ("save_pre", stamp_all),
    # What is in the file already must not pass for what comes in.
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
