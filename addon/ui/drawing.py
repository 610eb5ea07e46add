# SPDX-License-Identifier: GPL-3.0-or-later
"""What our panels have in common: where they are, rows of settings, texts that need more than one line."""

import blf

from .. import parameters
from ..host import engines, roles


class InRenderProperties:
    """A panel in the Render properties of scenes that use EEVEE or Afterlight."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        # With another engine an enabled panel stays, to say that it has no effect.
        scene = context.scene
        return scene.render.engine == engines.EEVEE or scene.afterlight.enabled or roles.is_helper(scene)


def draw_settings(layout, settings, panel):
    """The rows of the parameters of a panel. Those without effect are greyed out, or hidden with another method."""
    for parameter in parameters.rows(settings, panel):
        row = layout.row()
        row.active = parameter.active(settings)
        row.prop(settings, parameter.name)


def draw_value(layout, name, value):
    """A row with a name on the left and a text on the right."""
    split = layout.split(factor=0.6)
    split.label(text=name, translate=False)
    right = split.row()
    right.alignment = "RIGHT"
    right.label(text=value, translate=False)


def draw_text(layout, text, icon, context):
    """A text in as many lines as it needs in the panel, with an icon before the first."""
    scale = context.preferences.system.ui_scale
    blf.size(0, context.preferences.ui_styles[0].widget.points * scale)
    width = context.region.width - 80 * scale  # icon, margins of panel and box, scroll bar
    column = layout.column(align=True)
    column.scale_y = 0.8
    for line in wrapped(text, lambda line: blf.dimensions(0, line)[0] <= width):
        column.label(text=line, icon=icon, translate=False)
        icon = "BLANK1"


def wrapped(text, fits):
    """The lines of a text; labels do not wrap text. fits(line): whether a line is short enough."""
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".lstrip()
        if fits(longer) or not lines[-1]:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
