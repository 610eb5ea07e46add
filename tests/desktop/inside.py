# SPDX-License-Identifier: GPL-3.0-or-later
"""What a Blender under test runs at its start: does what the tests ask for over a socket, one line of JSON each way.

It looks at Blender from a timer, as often as Blender lets it, so that mouse, keys and renders go on meanwhile. The
functions at the end are for the tests to call by name."""

import json
import os
import socket
import sys
import time
import traceback

import bpy

sys.path[:0] = os.environ["AFTERLIGHT_TESTS"].split(os.pathsep)
connection = socket.socket(fileno=int(os.environ["AFTERLIGHT_CONTROL"]))
connection.setblocking(False)
waiting = b""
names = {"bpy": bpy}  # the globals of all that is sent
events = []  # (name of Blender's handler, seconds, frame), as they happen
spans = []  # [what of the extension runs, begin, end], by watch()
ticks = []  # when the main thread came round to tick()
ticking = False
TICK = 0.01  # seconds


def listen():
    """Carry out what has come in; Blender calls it again after TICK."""
    global waiting
    try:
        waiting += connection.recv(1 << 20)
    except BlockingIOError:
        pass
    while b"\n" in waiting:
        line, waiting = waiting.split(b"\n", 1)
        answer(json.loads(line))
    return TICK


def answer(request):
    try:
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            if "source" in request:
                exec(request["source"], names)
                reply = {"value": names[request["name"]](*request["arguments"])}
            else:
                reply = {"value": eval(request["expression"], names)}
        message = json.dumps(reply)
    except Exception:  # the test fails with it, not Blender
        message = json.dumps({"error": traceback.format_exc()})
    sys.stdout.flush()
    connection.setblocking(True)
    connection.sendall(message.encode() + b"\n")
    connection.setblocking(False)


def note(name):
    def handler(scene, *_):
        events.append((name, time.perf_counter(), scene.frame_current))

    return bpy.app.handlers.persistent(handler)


def area(kind):
    """(window, area, region) of the largest editor of a kind."""
    found = [
        (window, each)
        for window in bpy.context.window_manager.windows
        for each in window.screen.areas
        if each.type == kind
    ]
    window, largest = max(found, key=lambda pair: pair[1].width * pair[1].height)
    return window, largest, next(each for each in largest.regions if each.type == "WINDOW")


def box(kind):
    """(x, y, width, height) of the main region of the largest editor of a kind, from the bottom left."""
    _, _, region = area(kind)
    return region.x, region.y, region.width, region.height


def hovered(kind):
    """Data path of the property under the mouse in that editor, or ''."""
    window, editor, region = area(kind)
    with bpy.context.temp_override(window=window, area=editor, region=region):
        found = bpy.context.property
    return found[1] if found else ""


def rendering():
    return bpy.app.is_job_running("RENDER")


def happened(name):
    """How often a handler has been called."""
    return sum(event[0] == name for event in events)


def remember():
    """Write down all that the file holds, for changed()."""
    import scenes

    names["remembered"] = scenes.written_down()


def changed():
    """What in the file differs from when remember() was called, a line each."""
    import scenes

    return scenes.differences(names["remembered"], scenes.written_down())


def watch(span, *path):
    """From now on, note when a function of the extension begins and ends, as `span` in `spans`. path: of its module in
    the extension, then the names that lead to it."""
    import importlib

    owner = importlib.import_module(f"bl_ext.user_default.afterlight.addon.{path[0]}")
    for name in path[1:-1]:
        owner = getattr(owner, name)
    function = getattr(owner, path[-1])

    def watched(*arguments, **options):
        row = [span, time.perf_counter(), None]
        spans.append(row)
        try:
            return function(*arguments, **options)
        finally:
            row[2] = time.perf_counter()

    setattr(owner, path[-1], watched)


def running():
    """The spans that are under way."""
    return [span for span, _, end in spans if end is None]


def tick():
    ticks.append(time.perf_counter())
    return TICK if ticking else None


def count_ticks(on):
    """Begin to note when the main thread comes round to us, or stop and return (spans, ticks)."""
    global ticking
    ticking = names["ticking"] = on
    if on:
        spans.clear()
        ticks.clear()
        bpy.app.timers.register(tick)
    return spans, ticks


def save_result(path, scene_name=""):
    """The finished picture into a 32 bit EXR, with the scene's own format as it was afterwards."""
    scene = bpy.data.scenes[scene_name] if scene_name else bpy.context.scene
    settings = scene.render.image_settings
    saved = settings.media_type, settings.file_format, settings.color_depth, settings.exr_codec
    settings.media_type, settings.file_format = "IMAGE", "OPEN_EXR"
    settings.color_depth, settings.exr_codec = "32", "NONE"
    bpy.data.images["Render Result"].save_render(path, scene=scene)
    settings.media_type, settings.file_format = saved[:2]
    settings.color_depth, settings.exr_codec = saved[2:]


names.update(globals())
for _name in ("render_init", "render_pre", "render_post", "render_write", "render_complete", "render_cancel"):
    getattr(bpy.app.handlers, _name).append(note(_name))
bpy.app.timers.register(listen, persistent=True)
