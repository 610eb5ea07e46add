# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a render is running, and which scenes must wait for its end to be set up or cleared.

From its start Blender holds pointers to the scenes and the compositor of a render: adding or removing any of them then,
from a handler, a timer, a driver or a thread, crashes Blender. Code that wants to do so asks postpones() first; the
postponed scenes are set up, or cleared, when the render is over.
"""

# For each running render, whether it is locked; one may begin within another's handlers. Global, and no part of
# render/job.py, since lower layers ask before they change the file.
_renders = []
_waiting = set()  # session_uids of postponed scenes; global, since they wait for whichever render ends last


def begin():
    """A render begins. Until lock() the file may still be changed."""
    _renders.append(False)


def lock():
    """Blender begins to evaluate the scenes of the render: from now on the file must not be changed."""
    if _renders:
        _renders[-1] = True


def end():
    """The render is over. Returns the session_uids of the postponed scenes; empty while another render is running."""
    if _renders:
        _renders.pop()
    if is_locked():
        return set()
    waited = set(_waiting)
    _waiting.clear()
    return waited


def is_locked():
    """Whether scenes and nodes must not be added or removed."""
    return any(_renders)


def postpones(scene):
    """Whether `scene` can't be set up or cleared now. If so it is noted, and handled when the render is over."""
    if is_locked():
        _waiting.add(scene.session_uid)
    return is_locked()


def is_postponed(scene):
    """Whether `scene` is waiting for the end of the render."""
    return scene.session_uid in _waiting


def reset():
    """Forget all renders: another file was loaded, or the extension is being disabled."""
    _renders.clear()
    _waiting.clear()
