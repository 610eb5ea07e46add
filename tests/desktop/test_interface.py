# SPDX-License-Identifier: GPL-3.0-or-later
"""What only Blender's desktop has: other languages, and the search."""

import time

import steps

F3 = "69"  # its key code, as with F12 in window.py


def say_in(language):
    """Switch the interface to a language. (number of texts in the table, those that come out untranslated, what is
    said of a scene) Blender's own words go before ours where it has the text too."""
    import bl_ext.user_default.afterlight as afterlight

    view = bpy.context.preferences.view
    view.language = language
    view.use_translate_interface = view.use_translate_tooltips = view.use_translate_reports = True
    translated = bpy.app.translations.pgettext_iface
    german = afterlight.addon.translations.de_DE.TEXTS
    other = [
        text
        for text, words in german.items()
        for context in ("*", "Operator")
        if translated(text, context) == text != words
    ]
    scene = bpy.context.scene
    camera, scene.camera = scene.camera, None
    (found,) = afterlight.addon.diagnosis.checks.findings(scene)
    scene.camera = camera
    return len(german), other, found.text


def test_the_interface_speaks_german(window, afterlight):
    steps.new_box(window)
    steps.tick(window)
    try:
        count, other, said = window.run(say_in, "de_DE")
        assert count > 100 and other == [] and said.startswith("Die Szene hat keine aktive Kamera")
        time.sleep(0.5)  # the panel is drawn
        window.picture("german")
    finally:
        _, other, said = window.run(say_in, "en_US")
    assert len(other) > count and said.startswith("The scene has no active camera")


def set_samples(samples):
    bpy.context.scene.afterlight.samples = samples
    bpy.ops.ed.undo_push(message="Samples")


def test_search_finds_and_runs_an_operator(window, afterlight):
    steps.new_box(window)
    window.run(set_samples, 99)
    window.over("PROPERTIES")
    window.key(F3)
    time.sleep(1)
    window.xdotool("type", "--delay", 50, "indirect reset")
    time.sleep(1)
    window.picture("search")
    window.key("Return")
    window.wait("bpy.context.scene.afterlight.samples == 256")
    window.key("ctrl+z")
    window.wait("bpy.context.scene.afterlight.samples == 99")
