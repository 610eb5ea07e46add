# SPDX-License-Identifier: GPL-3.0-or-later
"""What panels and menus draw, without a window."""

from types import SimpleNamespace

import bpy


class Layout:
    """Takes the place of Blender's layout and writes down what is drawn: (kind, first argument, options, parent)."""

    def __init__(self, drawn, parent=None):
        object.__setattr__(self, "drawn", drawn)
        object.__setattr__(self, "parent", parent)
        self.active = self.enabled = True

    def __getattr__(self, kind):
        def draw(*arguments, **options):
            self.drawn.append((kind, arguments, options, self))
            return SimpleNamespace() if kind == "operator" else Layout(self.drawn, self)

        return draw

    @property
    def greyed(self):
        return not (self.active and self.enabled) or bool(self.parent and self.parent.greyed)


def drawn(panel, method="draw"):
    """What a panel or menu draws now."""
    found = []
    context = SimpleNamespace(
        scene=bpy.context.scene, region=SimpleNamespace(width=400), preferences=bpy.context.preferences
    )
    getattr(panel, method)(SimpleNamespace(layout=Layout(found)), context)
    return found


def greyed(found):
    return {arguments[1] for kind, arguments, _, layout in found if kind == "prop" and layout.greyed}


def words(found):
    return " ".join(options["text"] for kind, _, options, _ in found if kind == "label")
