# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of Afterlight that register something in Blender, in the order in which they need one another."""

from . import migration, properties, translations
from .host import main_thread
from .render import engine, handlers, relight, views_engine
from .ui import help_page, operators, panel, transfer, views_panel
from .viewport import draw_handlers as viewports

# migration before handlers: those of a loaded file need settings of this version.
PARTS = (
    translations,
    help_page,
    properties,
    main_thread,
    engine,
    views_engine,
    relight,
    operators,
    transfer,
    panel,
    views_panel,
    migration,
    handlers,
    viewports,
)


def register():
    for part in PARTS:
        part.register()


def unregister():
    for part in reversed(PARTS):
        part.unregister()
