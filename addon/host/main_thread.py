# SPDX-License-Identifier: GPL-3.0-or-later
"""A queue of calls for the main thread: GPU work and changes to the file while a render runs in its own thread.

In a window a render has its own thread. Blender lends that thread the GPU only together with the lock that the
interface needs for drawing, so the interface would freeze, and ESC go unnoticed, for all of our part of the render. Our
engine therefore does not ask for the GPU. It puts each GPU call into this queue, and the main thread makes the calls in
short slices between two looks at the window.

Changes to the file during a render go the same way: setting a property tags all dependency graphs, and Blender crashes
if the main thread is building one at that moment.
"""

import queue
import threading
import time
from concurrent.futures import Future
from contextlib import contextmanager
from contextvars import ContextVar

import bpy

from .. import gather

TURN_SECONDS = 0.02  # how long the main thread makes calls before it looks at the window again
NEXT_CALL_WAIT = 0.002  # seconds that such a turn waits for the next call
RENDER_INTERVAL, IDLE_INTERVAL = 0.0, 0.1  # seconds between two turns: during a render, and otherwise
CALL_POLL_INTERVAL = 0.05  # seconds between two checks whether a waiting call is still wanted
MUST_RUN_TIMEOUT = 0.5  # seconds that a mandatory call waits for the main thread

_calls = queue.SimpleQueue()  # (Future, call); global, since there is one main thread
_takes_calls = False  # whether the main thread makes calls; global like the queue
# Says whether the render of the current thread is to stop; global, but each thread has its own value.
_stopped = ContextVar("stopped", default=lambda: False)


@contextmanager
def cancel_when(stopped):
    """Context in which waiting calls raise gather.Cancelled as soon as stopped() is true."""
    before = _stopped.set(stopped)
    try:
        yield
    finally:
        _stopped.reset(before)


def run(call):
    """Make a call in the main thread: returns what it returns and raises what it raises. Raises gather.Cancelled
    instead if the render is to stop or the main thread makes no more calls."""
    if _is_main():
        return call()
    if _stopped.get()():
        raise gather.Cancelled
    pending = _enqueue(call)
    while not pending.done():
        try:
            pending.exception(timeout=CALL_POLL_INTERVAL)
        except TimeoutError:
            if (_stopped.get()() or not _takes_calls) and pending.cancel():
                raise gather.Cancelled from None
    return pending.result()


def must_run(call):
    """Make a call in the main thread even if the render is to stop: for settings that must be put back. If the main
    thread does not get to it in time, because it is waiting for the end of the render, the call is made here."""
    if _is_main():
        return call()
    pending = _enqueue(call)
    try:
        return pending.result(timeout=MUST_RUN_TIMEOUT)
    except TimeoutError:
        return call() if pending.cancel() else pending.result()


def later(call):
    """Make a call in the main thread without waiting for it; immediately if this is the main thread."""
    if _is_main():
        call()
    else:
        _enqueue(call)


class MainThread:
    """The gather's executor in a window."""

    def run(self, call):
        return run(call)

    def later(self, call):
        later(call)


def after_render(call):
    """Make a call, which returns None, once no render is running: immediately, or by a timer."""
    if bpy.app.background or not bpy.app.is_job_running("RENDER"):
        call()
    else:
        bpy.app.timers.register(lambda: IDLE_INTERVAL if bpy.app.is_job_running("RENDER") else call(), persistent=True)


def _enqueue(call):
    """Queue a call for the main thread. Returns its Future."""
    pending = Future()
    _calls.put((pending, call))
    return pending


def _is_main():
    return threading.current_thread() is threading.main_thread()


def _make_calls():
    """A timer: make queued calls for one turn. Returns the seconds until the next turn, None to end."""
    slice_end, timeout = time.perf_counter() + TURN_SECONDS, 0.0
    while (seconds_left := slice_end - time.perf_counter()) > 0:
        try:
            pending, call = _calls.get(timeout=min(seconds_left, timeout))
        except queue.Empty:
            break
        _make_call(pending, call)
        timeout = NEXT_CALL_WAIT
    if timeout:
        gather.device.settle()
    if bpy.app.is_job_running("RENDER"):
        return RENDER_INTERVAL
    return IDLE_INTERVAL if _takes_calls else None


def _make_call(pending, call):
    if pending.set_running_or_notify_cancel():
        try:
            pending.set_result(call())
        except BaseException as error:
            pending.set_exception(error)


def register():
    global _takes_calls
    if not bpy.app.background:
        _takes_calls = True
        gather.device.use_executor(MainThread())
        bpy.app.timers.register(_make_calls, persistent=True)


def unregister():
    """Make no more calls. A running render is no longer lit; the GPU memory that it leaves is still freed."""
    global _takes_calls
    _takes_calls = False
