# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a render is under way, and which scenes must wait for its end.

From its beginning on Blender holds the scenes and the compositor of a render: adding or removing some then, from a
handler, a timer, a driver or a thread, crashes Blender. Whoever wants to asks postpones() first; the scenes that had
to wait are set up, or cleared, when the render is over.
"""

# For each render that goes on, whether it is locked: one may begin within another's handlers. Global, and no part of
# render/job.py, since whatever changes the file asks here, below the render.
_renders = []
_waiting = set()  # session_uids of scenes; global, since they wait for whichever render ends last


def begin():
    """A render begins. Until lock() the file may still be changed."""
    _renders.append(False)


def lock():
    """Blender begins to evaluate the scenes of the render."""
    if _renders:
        _renders[-1] = True


def end():
    """The render is over. Returns the session_uids of the scenes that had to wait; empty while another render goes
    on."""
    if _renders:
        _renders.pop()
    if is_locked():
        return set()
    waited = set(_waiting)
    _waiting.clear()
    return waited


def is_locked():
    """Whether scenes and nodes must stay as they are."""
    return any(_renders)


def postpones(scene):
    """Whether `scene` can't be set up or cleared now; it is then when the render is over."""
    if is_locked():
        _waiting.add(scene.session_uid)
    return is_locked()


def is_postponed(scene):
    """Whether `scene` waits for the end of the render."""
    return scene.session_uid in _waiting


def reset():
    """Another file is loaded, or the extension goes."""
    _renders.clear()
    _waiting.clear()
