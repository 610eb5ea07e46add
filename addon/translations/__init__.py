# SPDX-License-Identifier: GPL-3.0-or-later
"""Afterlight in other languages. The English texts in the code are the keys, as in Blender's own translations.

Blender translates names, tooltips and labels by itself. Texts that contain values go through say(). To add a language,
write a module like de_DE.py; tests/blender/test_words.py names the texts that it lacks.
"""

import bpy
from bpy.app.translations import pgettext_rpt

from . import de_DE

LANGUAGES = {"de_DE": de_DE.TEXTS}
CONTEXTS = "*", "Operator"  # Blender looks names of operators up in a context of their own


def say(text, *values):
    """A text in the language of Blender's interface, with the values in place of its braces."""
    return pgettext_rpt(text).format(*values)


def register():
    bpy.app.translations.register(
        __name__,
        {
            language: {(context, text): translation for text, translation in texts.items() for context in CONTEXTS}
            for language, texts in LANGUAGES.items()
        },
    )


def unregister():
    bpy.app.translations.unregister(__name__)
