# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender sees of Afterlight, registered in the order in which the parts need one another."""

from . import migration, properties, translations
from .host import main_thread
from .render import engine, handlers, relight, views_engine
from .ui import help_page, operators, panel, views_panel
from .viewport import draw_handlers as viewports

# migration before handlers: what follows a loaded file must find its settings in order.
PARTS = (
    translations,
    help_page,
    properties,
    main_thread,
    engine,
    views_engine,
    relight,
    operators,
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
