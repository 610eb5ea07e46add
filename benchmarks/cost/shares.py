# SPDX-License-Identifier: GPL-3.0-or-later
"""Which seconds of a render are the graphics card's, and which the host's.

    with shares.clock() as clock:
        bpy.ops.render.render()
    clock.gpu       # seconds

The host's are the same on any machine with such a processor: evaluation, placing of views, files, compositing. A
graphics card has EEVEE, from the end of the evaluation of its scene to its last sample (which holds the hand-over of
the scene, too: nothing tells where it ends), and the gather, from its first stage to its last."""

import re
import time
from contextlib import contextmanager
from dataclasses import dataclass

SAMPLING = "Rendering "  # how EEVEE's messages begin: "Rendering 1 / 16 samples", after a sample
GATHER = re.compile(r"(?!Saving passes).*, \d+%")  # those of our engine's stages, but for the files'


@dataclass
class Clock:
    """gpu: seconds of the graphics card so far."""

    gpu: float = 0.0


@contextmanager
def clock():
    """A Clock of the frames rendered within, complete once the block ends."""
    found, drawing, gathering = Clock(), None, None  # since when the card is at work

    def on_evaluated(scene, depsgraph):
        nonlocal drawing
        drawing = time.perf_counter()

    def on_message(text, *_):
        nonlocal drawing, gathering
        now = time.perf_counter()
        if gathering is not None:
            found.gpu += now - gathering
        gathering = now if GATHER.fullmatch(text) else None
        if text.startswith(SAMPLING) and drawing is not None:
            found.gpu += now - drawing
            drawing = now

    with listening(frame_change_post=on_evaluated, render_stats=on_message):
        yield found


@contextmanager
def listening(**hooks):
    """Blender's handlers of these names call these functions. They pass for Afterlight's own: it takes others for
    scripts that may move anything from frame to frame, and would measure another case."""
    import bpy

    import extension

    for name, hook in hooks.items():
        hook.__module__ = f"{extension.MODULE}.addon"
        getattr(bpy.app.handlers, name).append(hook)
    try:
        yield
    finally:
        for name, hook in hooks.items():
            getattr(bpy.app.handlers, name).remove(hook)
