# SPDX-License-Identifier: GPL-3.0-or-later
"""The GPU and the file in a window: taken by turns with the interface.

A render has a thread of its own there. Blender lends it the GPU only together with the lock that its interface draws
under, and so for the whole of our part nothing could be drawn, and no ESC be seen. Therefore our engine asks for none:
what it wants of the GPU it leaves here, a call at a time, and the main thread makes the calls between two looks at the
window.

So is whatever changes the file during a render. To set a property tags all dependency graphs, and Blender crashes where
the main thread builds one at that moment.
"""

import queue
import sys
import threading
import time
from concurrent.futures import Future
from contextlib import contextmanager
from contextvars import ContextVar

import bpy

from .. import gather

TURN_SECONDS = 0.02  # seconds of calls before the window has its turn
NEXT_CALL_WAIT = 0.002  # seconds that a turn waits for the next call
RENDER_INTERVAL, IDLE_INTERVAL = 0.0, 0.1  # seconds until the next look: while something renders, and else
CALL_POLL_INTERVAL = 0.05  # seconds that a call waits before it asks whether it is still wanted
MUST_RUN_TIMEOUT = 0.5  # seconds that one waits which must be made

_calls = queue.SimpleQueue()  # (Future, call)
_takes_calls = False  # whether anybody makes the calls; global like the queue, since the main thread is one
_stopped = ContextVar("stopped", default=lambda: False)  # of the render whose thread this is


@contextmanager
def cancel_when(stopped):
    """What waits for its turn within gives up as soon as stopped() is true."""
    before = _stopped.set(stopped)
    try:
        yield
    finally:
        _stopped.reset(before)


def run(call):
    """Have the main thread make a call: returns what it returns, raises what it raises. Raises gather.Cancelled instead
    when the render is to stop, or nobody makes calls any more."""
    if _is_main():
        return call()
    if _stopped.get()():
        raise gather.Cancelled
    future = _enqueue(call)
    while not future.done():
        try:
            future.exception(timeout=CALL_POLL_INTERVAL)
        except TimeoutError:
            if (_stopped.get()() or not _takes_calls) and future.cancel():
                raise gather.Cancelled from None
    return future.result()


def must_run(call):
    """As run(), for what must be put back though the render is to stop: made here where the main thread does not come
    round to it, since it waits for the end of the render."""
    if _is_main():
        return call()
    future = _enqueue(call)
    try:
        return future.result(timeout=MUST_RUN_TIMEOUT)
    except TimeoutError:
        return call() if future.cancel() else future.result()


def later(call):
    """Have the main thread make a call when it comes round to it."""
    if _is_main():
        call()
    else:
        _enqueue(call)


def after_render(call):
    """Make a call that returns None when no render is under way: now, or soon."""
    if bpy.app.background or not bpy.app.is_job_running("RENDER"):
        call()
    else:
        bpy.app.timers.register(lambda: IDLE_INTERVAL if bpy.app.is_job_running("RENDER") else call(), persistent=True)


def _enqueue(call):
    """The Future of a call that the main thread is to make."""
    future = Future()
    _calls.put((future, call))
    return future


def _is_main():
    return threading.current_thread() is threading.main_thread()


def _make_calls():
    """Make calls for a moment; Blender asks again when it has looked after its window."""
    end, wait = time.perf_counter() + TURN_SECONDS, 0.0
    while (left := end - time.perf_counter()) > 0:
        try:
            future, call = _calls.get(timeout=min(left, wait))
        except queue.Empty:
            break
        _make_call(future, call)
        wait = NEXT_CALL_WAIT
    if wait:
        gather.device.settle()
    if bpy.app.is_job_running("RENDER"):
        return RENDER_INTERVAL
    return IDLE_INTERVAL if _takes_calls else None


def _make_call(future, call):
    if future.set_running_or_notify_cancel():
        try:
            future.set_result(call())
        except BaseException as error:
            future.set_exception(error)


def register():
    global _takes_calls
    if not bpy.app.background:
        _takes_calls = True
        gather.device.place = sys.modules[__name__]
        bpy.app.timers.register(_make_calls, persistent=True)


def unregister():
    """A render that is under way is not lit any more, and what it leaves behind is still freed."""
    global _takes_calls
    _takes_calls = False
