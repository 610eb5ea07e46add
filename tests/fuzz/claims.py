# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that claim anything: records, pointers and properties of random values, and pass files that are broken
anywhere."""

import os
import tempfile

import bpy
import numpy as np
from hypothesis import given, seed
from hypothesis import strategies as st

from scenes import box

from . import digest

SCALARS = st.one_of(st.integers(-(2**31), 2**31 - 1), st.floats(width=32), st.text(max_size=20), st.booleans())
VALUES = st.recursive(
    st.one_of(SCALARS, st.lists(st.floats(), max_size=40), st.lists(st.integers(-(2**31), 2**31 - 1), max_size=20)),
    lambda inner: st.dictionaries(st.sampled_from(["poses", "coverage", "clearance", "scene", "x"]), inner, max_size=4),
    max_leaves=6,
)
NAMES = st.sampled_from(
    [
        "enabled",
        "method",
        "view_count",
        "version",
        "helper",
        "role",
        "serves",
        "view_scenes",
        "own_tree",
        "set_aside",
        "own_camera",
        "view_cameras",
        "start",
        "denoise",
        "draws",
        "compositing_was_off",
    ]
)
POINTERS = st.sampled_from(["helper", "serves", "own_tree", "set_aside", "own_camera"])
ROLES = st.sampled_from(["", "HELPER", "SCOUT", "VIEW", "nonsense"])
CLAIMS = st.lists(
    st.one_of(
        st.tuples(st.just("raw"), NAMES, VALUES),
        st.tuples(st.just("pointer"), POINTERS, st.integers(0, 9)),
        st.tuples(st.just("role"), ROLES, st.integers(0, 9)),
        st.tuples(st.just("view"), st.just(""), st.integers(0, 9)),
        st.tuples(st.just("placed"), st.just(""), VALUES),
        st.tuples(st.just("layer"), st.just(""), VALUES),
        st.tuples(st.just("node"), st.just(""), VALUES),
        st.tuples(st.just("mark"), st.just(""), VALUES),
    ),
    min_size=1,
    max_size=5,
)
FOLDER = tempfile.mkdtemp(prefix="afterlight-fuzz-")


def run(kind, module, settings, number, journal):
    """Fuzz claims or files. settings: hypothesis'."""

    def note(text):
        if journal:
            with open(journal, "a") as file:
                file.write(text + "\n")

    @seed(number)
    @settings
    @given(CLAIMS, st.booleans(), st.booleans())
    def claims(made, ticked, reload):
        note(f"{made} {ticked} {reload}")
        _claims(module, made, ticked, reload)

    @seed(number)
    @settings
    @given(
        st.binary(max_size=4096), st.integers(0, 2**31), st.sampled_from(["garbage", "cut", "flip", "empty", "header"])
    )
    def files(junk, at, damage):
        note(f"{damage} {at} {junk[:40]!r}")
        _files(module, junk, at, damage)

    {"claims": claims, "files": files}[kind]()


def _claims(module, made, ticked, reload):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = box(bpy.context.scene, samples=1)
    scene.afterlight.method, scene.afterlight.view_count = "RADIOSITY", 1
    other = bpy.data.scenes.new("Precious")
    other.collection.objects.link(bpy.data.objects.new("Treasure", None))
    tree = bpy.data.node_groups.new("Mine", "CompositorNodeTree")
    tree.use_fake_user = True
    tree.nodes.new("CompositorNodeBlur")
    before = digest.of_the_user()
    scene.afterlight.enabled = ticked
    marked = {}
    for kind, name, value in made:
        try:
            _claim(scene, kind, name, value, marked)
        except (TypeError, OverflowError, ValueError, KeyError, RuntimeError, AttributeError):
            pass  # Blender's own refusal
    if reload:
        path = os.path.join(FOLDER, "crafted.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
    for _ in range(2):
        _settle(module)
    for each in [each for each in bpy.data.scenes if not each.afterlight.role]:
        each.afterlight.enabled = True
        _settle(module)
        each.afterlight.enabled = False
        _settle(module)
    after = digest.of_the_user()
    lost = [line for line in digest.lost(before, after) if not any(name in line for name in marked)]
    assert not lost, lost
    assert (
        {"Scene", "Precious"} <= set(bpy.data.scenes.keys())
        and "Mine" in bpy.data.node_groups
        and "Treasure" in bpy.data.objects
    )


def _claim(scene, kind, name, value, marked):
    names = ["Scene", "Precious", *sorted(each.name for each in bpy.data.scenes)]
    settings, target = scene.afterlight, bpy.data.scenes[names[value % len(names)]] if isinstance(value, int) else None
    if kind == "raw":
        scene.bl_system_properties_get(do_create=True)["afterlight"][name] = value
    elif kind == "pointer":
        pool = {
            "own_tree": bpy.data.node_groups,
            "set_aside": bpy.data.node_groups,
            "own_camera": bpy.data.objects,
        }.get(name)
        setattr(settings, name, target if pool is None else list(pool)[value % len(pool)])
    elif kind == "role":
        target.afterlight.role, target.afterlight.serves = name, scene
        marked[target.name] = True
    elif kind == "view":
        settings.view_scenes.add().scene = target
    elif kind == "placed":
        for each in bpy.data.scenes:
            if each.afterlight.role == "SCOUT":
                each["placed"] = value
    elif kind == "layer":
        scene.view_layers[0]["afterlight"] = value
        marked["layer"] = True
    elif kind == "node":
        bpy.data.node_groups["Mine"].nodes[0]["afterlight"] = value
        marked["Mine"] = True
    elif kind == "mark":
        bpy.data.scenes["Precious"]["afterlight"] = value


def _settle(module):
    addon = module.addon
    bpy.context.view_layer.update()
    for scene in bpy.data.scenes:
        addon.diagnosis.checks.findings(scene)
        if not scene.afterlight.role and addon.scene.needs.views(scene):
            addon.compositor.view_scenes.stored_placement(scene)


def _files(module, junk, at, damage):
    """A broken pass file is a message, or its passes; never another exception. It is read as far as it goes."""
    import OpenEXR

    path = os.path.join(FOLDER, "passes.exr")
    names = [f"ViewLayer.{name}.{axis}" for _, _, name, axes in module.addon.scene.passes.PASSES for axis in axes]
    OpenEXR.File(
        {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage},
        {name: np.ones((5, 7), np.float32) for name in names},
    ).write(path)
    data = bytearray(open(path, "rb").read())
    if damage == "garbage":
        data = bytearray(junk)
    elif damage == "cut":
        del data[at % len(data) :]
    elif damage == "empty":
        data.clear()
    else:
        end = len(data) if damage == "flip" else 800
        for number, byte in enumerate(junk[:16]):
            data[(at + 131 * number) % end] ^= byte
    with open(path, "wb") as file:
        file.write(data)
    passes, status = module.addon.scene.passes, module.addon.host.report
    for read in (
        lambda: passes.load(path, "ViewLayer", (0, 0, 7, 5)),
        lambda: module.addon.scene.exr.contents(path, ["ViewLayer"]),
    ):
        try:
            read()
        except status.Problem as problem:
            assert str(problem)
