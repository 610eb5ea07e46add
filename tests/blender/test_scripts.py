# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts that tick, untick and set Indirect Light during a render: each frame is lit or plain, with a message, and
Blender doesn't crash."""

import json
import os
import subprocess
import sys
from pathlib import Path

import bpy
import pytest

from scenes import box

TESTS = Path(__file__).resolve().parents[1]
CASES = (
    ("frame_change_pre", "toggle", "views"),
    ("render_post", "toggle", ""),
    ("frame_change_post", "toggle", ""),
    ("render_pre", "toggle", ""),
    ("render_write", "toggle", ""),
    ("render_init", "toggle", ""),
    ("driver", "toggle", ""),
    ("render_pre", "in_a_thread", ""),
    ("frame_change_pre", "tick", "unticked"),
    ("render_pre", "radiosity", ""),
)

# Runs in a process of its own, since 0.3.0 crashed. Prints, for each case, the mean of each frame and the messages.
SCRIPT = """
import json, os, sys, threading
import bpy, scenes
bpy.ops.preferences.addon_enable(module=sys.argv[1])
folder = sys.argv[2]

def toggle(scene):
    scene.afterlight.enabled = not scene.afterlight.enabled

def tick(scene):
    scene.afterlight.enabled = True

def radiosity(scene):
    scene.afterlight.method = "RADIOSITY"

def in_a_thread(scene):
    threading.Thread(target=toggle, args=(scene,)).start()

def new(how):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = scenes.box(bpy.context.scene, samples=1)
    scene.render.resolution_x, scene.render.resolution_y = 16, 9
    scene.frame_end, settings = 2, scene.afterlight
    settings.method, settings.view_count, settings.use_history = "RADIOSITY" if how == "views" else "PAPER", 1, False
    settings.draws, settings.bounces, settings.samples, settings.radius = 1, 1, 16, 4
    settings.enabled = how != "unticked"
    return scene

def frames(scene, name):
    path = os.path.join(folder, name + "_")
    scenes.set_format(scene)
    scene.render.filepath = path
    bpy.ops.render.render(animation=True)
    return [float(scenes.read_rgb(f"{path}{frame:04}.exr").mean()) for frame in (1, 2)]

plain, lit = (frames(new(how), f"known{how}")[0] for how in ("unticked", ""))
rendering = []
print("known", json.dumps([plain, lit]))
for number, (event, name, how) in enumerate(json.loads(sys.argv[3])):
    scene, change = new(how), globals()[name]
    if event == "driver":
        bpy.app.driver_namespace["change"] = lambda: (change(bpy.data.scenes["Scene"]) if rendering else None) or 0.0
        scene.camera.driver_add("location", 2).driver.expression = "change() + frame * 0"
        bpy.app.handlers.render_init.append(lambda *_: rendering.append(1))
        bpy.app.handlers.render_complete.insert(0, lambda *_: rendering.clear())
    else:
        getattr(bpy.app.handlers, event).append(lambda *_: change(bpy.data.scenes["Scene"]))
    means = frames(scene, str(number))
    if event != "driver":
        getattr(bpy.app.handlers, event).pop()
    else:
        bpy.app.handlers.render_init.pop(), bpy.app.handlers.render_complete.pop(0)
    module = sys.modules[sys.argv[1]].addon
    helpers = [each.name for each in bpy.data.scenes if each.afterlight.role]
    warned = module.host.report.warnings(scene)
    print("case", json.dumps([event, change.__name__, means, scene.afterlight.report, warned,
                              scene.afterlight.enabled, len(helpers), list(module.compositor.faults.find(scene))
                              if scene.afterlight.enabled else []]), flush=True)
    scene.camera.animation_data_clear()
    bpy.app.driver_namespace.pop("change", None)
"""


@pytest.fixture(scope="module")
def outcome(afterlight, tmp_path_factory):
    """(plain mean, lit mean), and the result of each (event, change)."""
    folder = tmp_path_factory.mktemp("scripts")
    command = [sys.executable, "-X", "faulthandler", "-c", SCRIPT, afterlight.__name__, str(folder), json.dumps(CASES)]
    run = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(TESTS)})
    lines = [line.split(" ", 1) for line in run.stdout.splitlines() if line.startswith(("known ", "case "))]
    cases = {
        tuple(case[:2]): case[2:] for kind, case in ((kind, json.loads(text)) for kind, text in lines) if kind == "case"
    }
    assert run.returncode == 0 and "Traceback" not in run.stderr + run.stdout, (
        list(cases),
        run.stdout[-2000:],
        run.stderr[-4000:],
    )
    return json.loads(lines[0][1]), cases


@pytest.mark.parametrize("case", [case[:2] for case in CASES], ids=" ".join)
def test_frames_are_lit_or_plain(outcome, case):
    """Six of eight of these used to crash Blender at the second frame."""
    (plain, lit), cases = outcome
    means, report, warnings, enabled, helpers, faults = cases[case]
    assert lit > 1.1 * plain
    for mean in means:
        assert mean == pytest.approx(plain, rel=1e-3) or mean > 1.1 * plain, means
    assert not faults and bool(helpers) == enabled, "set up, or cleared, when the render was over"
    if any(mean == pytest.approx(plain, rel=1e-3) for mean in means):
        assert "during a render" in report + "".join(warnings) or case[0] == "render_init"


def test_what_waits_is_said_and_done(fresh, afterlight):
    """When the render ends, scenes that were ticked during it are set up; loading another file forgets them."""
    scene, addon = box(fresh), afterlight.addon
    addon.host.render_lock.begin()
    addon.host.render_lock.lock()
    scene.afterlight.enabled = True
    assert not [each for each in bpy.data.scenes if each.afterlight.role]
    (finding,) = addon.diagnosis.checks.findings(scene)
    assert finding.fatal and "during a render" in finding.text
    addon.render.handlers.after_render()
    assert not addon.diagnosis.checks.findings(scene)
    scene.afterlight.enabled = False
    assert len(bpy.data.scenes) == 1
