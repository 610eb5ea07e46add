# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender sees of Afterlight, registered in the order in which the parts need one another."""

from . import help_page, migration, operators, panel, settings, translations, views_panel
from .pipeline import engine, handlers, relight, scout, turns
from .viewport import handlers as viewports

# migration before handlers: what follows a loaded file must find its settings in order.
PARTS = (translations, help_page, settings, turns, engine, scout, relight, operators, panel, views_panel, migration,
         handlers, viewports)


def register():
    for part in PARTS:
        part.register()


def unregister():
    for part in reversed(PARTS):
        part.unregister()
