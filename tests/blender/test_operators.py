# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings from scene to scene, presets, keyframes and drivers."""

import re
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest

import extension
from drawing import Layout, drawn

# Operators


def test_settings_go_to_other_scenes(scene, addon):
    settings, names = scene.afterlight, [parameter.name for parameter in addon.parameters.PARAMETERS]
    mine = dict(
        method="RADIOSITY",
        strength=0.5,
        start="QUARTER",
        samples=100,
        radius=9,
        draws=5,
        bounces=2,
        use_visibility=False,
        use_world_shadow=False,
        use_glossy=True,
        views="AUTOMATIC",
        view_count=2,
        accumulate=2,
        use_history=False,
        denoise="NONE",
        seed=3,
        use_animated_seed=True,
        use_viewport=True,
    )
    assert sorted(mine) == sorted(names)
    assert not bpy.ops.afterlight.copy_settings.poll(), "there is no other scene"
    for name, value in mine.items():
        setattr(settings, name, value)
    settings.enabled = True
    two, three = bpy.data.scenes.new("Two"), bpy.data.scenes.new("Three")
    menu = drawn(addon.ui.panel.AFTERLIGHT_MT_copy_settings)
    assert [options["text"] for kind, _, options, _ in menu if kind == "operator"] == ["To All Scenes", "Three", "Two"]
    defaults = {name: getattr(three.afterlight, name) for name in names}
    assert bpy.ops.afterlight.copy_settings(scene="Two") == {"FINISHED"}
    assert {name: getattr(two.afterlight, name) for name in names} == mine and not two.afterlight.enabled
    assert {name: getattr(three.afterlight, name) for name in names} == defaults
    assert bpy.ops.afterlight.copy_settings(enable=True) == {"FINISHED"}
    assert {name: getattr(three.afterlight, name) for name in names} == mine
    assert two.afterlight.enabled and three.afterlight.enabled and not addon.compositor.faults.find(three)
    with pytest.raises(RuntimeError, match='no other scene "Four"'):
        bpy.ops.afterlight.copy_settings(scene="Four")


def test_listed_cameras_go_to_scenes_that_contain_them(scene, addon):
    settings, shared = scene.afterlight, scene.camera
    own = bpy.data.objects.new("Own", bpy.data.cameras.new("Own"))
    scene.collection.objects.link(own)
    with_it, without = bpy.data.scenes.new("With").afterlight, bpy.data.scenes.new("Without").afterlight
    with_it.id_data.collection.objects.link(shared)
    other = bpy.data.objects.new("Other", bpy.data.cameras.new("Other"))
    for each in (with_it, without):
        each.id_data.collection.objects.link(other)
        each.view_cameras.add().camera = other
    settings.views = "MANUAL"
    for camera in (own, shared, None):
        settings.view_cameras.add().camera = camera
    assert bpy.ops.afterlight.copy_settings() == {"FINISHED"}
    assert with_it.views == without.views == "MANUAL"
    assert [each.camera for each in with_it.view_cameras] == [shared]
    assert [each.camera for each in without.view_cameras] == [other], "none of them is there"
    assert [each.camera for each in settings.view_cameras] == [own, shared, None]


def test_reset_gives_the_defaults_and_names_what_is_animated(scene, addon, capfd):
    settings = scene.afterlight
    settings.property_unset("method")
    defaults = {parameter.name: getattr(settings, parameter.name) for parameter in addon.parameters.PARAMETERS}
    settings.method, settings.views, settings.draws, settings.bounces = "PAPER", "CAMERA", 3, 8
    settings.strength, settings.start, settings.samples, settings.radius, settings.seed = 0.5, "FULL", 99, 9, 3
    settings.use_animated_seed = settings.enabled = settings.use_viewport = True
    settings.view_cameras.add().camera = scene.camera
    assert bpy.ops.afterlight.reset() == {"FINISHED"}
    assert {name: getattr(settings, name) for name in defaults} == defaults and settings.enabled
    assert [each.camera for each in settings.view_cameras] == [scene.camera], "the user's work"
    settings.keyframe_insert("radius", frame=1)
    settings.driver_add("seed")
    capfd.readouterr()
    bpy.ops.afterlight.reset()
    assert 'Radius, Seed in scene "Scene" has keyframes or a driver' in "".join(capfd.readouterr())


def test_undo_takes_operators_back(scene):
    bpy.data.scenes.new("Other")
    scene.afterlight.samples = 99
    bpy.ops.ed.undo_push(message="before")
    for operator in (bpy.ops.afterlight.copy_settings, bpy.ops.afterlight.reset):
        assert "UNDO" in getattr(bpy.types, operator.idname()).bl_options
        operator()
        bpy.ops.ed.undo_push(message="after")
        bpy.ops.ed.undo()
        assert bpy.data.scenes["Scene"].afterlight.samples == 99
        assert bpy.data.scenes["Other"].afterlight.samples == 256


def test_search_finds_what_the_menus_hold(scene, addon):
    """F3 looks through the menus that hang on the top bar's; only operators in one of them are found."""
    top = []
    for function in bpy.types.TOPBAR_MT_render.draw._draw_funcs:
        if function.__module__.startswith(extension.MODULE):
            function(SimpleNamespace(layout=Layout(top)), bpy.context)
    waiting = [arguments[0] for kind, arguments, _, _ in top if kind == "menu"]
    assert waiting == ["AFTERLIGHT_MT_indirect_light"]
    bpy.data.scenes.new("Other")
    found = set()
    while waiting:
        for kind, arguments, _, _ in drawn(getattr(bpy.types, waiting.pop())):
            if kind == "menu":
                waiting.append(arguments[0])
            elif kind == "operator":
                found.add(arguments[0])
    everything = {f"afterlight.{name}" for name in dir(bpy.ops.afterlight)}
    # With a button of their own beside what they are for.
    internal = {f"afterlight.{name}" for name in ("mend", "preset", "preset_add", "view_add", "view_remove")}
    assert found >= everything - internal


def test_operators_say_why_they_are_grey(scene):
    assert not bpy.ops.afterlight.repair.poll()
    with pytest.raises(RuntimeError, match="Enable Indirect Light first"):
        bpy.ops.afterlight.repair()
    with pytest.raises(RuntimeError, match="no other scene"):
        bpy.ops.afterlight.copy_settings()


# Presets


def test_presets_are_added_and_removed_as_blenders_own(scene, addon):
    settings, menu = scene.afterlight, addon.ui.panel.AFTERLIGHT_PT_presets

    def quality():
        return settings.method, settings.start, settings.samples, settings.radius, settings.draws, settings.view_count

    shipped = bpy.utils.preset_find("draft", "afterlight")
    settings.start, settings.samples, settings.radius, settings.strength = "FULL", 123, 21, 0.3
    mine = quality()
    assert bpy.ops.afterlight.preset_add(name="My Shot") == {"FINISHED"}
    path = Path(bpy.utils.preset_find("My_Shot", "afterlight"))
    assert path.is_relative_to(bpy.utils.user_resource("SCRIPTS")), "not in the add-on's own folder"
    assert bpy.ops.afterlight.preset_add(name="My Shot") == {"CANCELLED"}, "the name is taken"
    bpy.ops.afterlight.preset(filepath=shipped)
    assert quality() == ("RADIOSITY", "QUARTER", 123, 21, 8, 4)
    bpy.ops.afterlight.preset(filepath=str(path))
    assert quality() == mine and settings.strength == pytest.approx(0.3)
    assert menu.bl_label == "My Shot"
    assert bpy.ops.afterlight.preset_add(name="My Shot", remove_name=True) == {"FINISHED"} and not path.exists()
    assert bpy.ops.afterlight.preset_add(name="draft", remove_name=True) == {"CANCELLED"} and Path(shipped).exists()


@pytest.fixture
def presets():
    """The user's folder of presets, as it was afterwards."""
    folder = Path(bpy.utils.user_resource("SCRIPTS", path="presets/afterlight", create=True))
    before = set(folder.iterdir())
    yield folder
    for path in set(folder.iterdir()) - before:
        path.unlink()


CHANGES = "import bpy\nbpy.context.scene.afterlight.samples = 77\n"


def test_no_script_but_a_preset_is_run(scene, presets, tmp_path):
    (tmp_path / "other.py").write_text(CHANGES)
    (presets / "link.py").symlink_to(tmp_path / "other.py")
    (presets / "text.txt").write_text(CHANGES)
    inside = presets / "inside.py"
    inside.write_text(CHANGES)
    outside = presets / "sub" / ".." / ".." / "other.py"
    for path in (
        tmp_path / "other.py",
        presets / "link.py",
        presets / "text.txt",
        outside,
        presets / "none.py",
        presets,
        "",
    ):
        with pytest.raises(RuntimeError, match="is not in a folder of Indirect Light presets"):
            bpy.ops.afterlight.preset(filepath=str(path))
        assert scene.afterlight.samples == 256
    assert bpy.ops.afterlight.preset(filepath=str(inside)) == {"FINISHED"} and scene.afterlight.samples == 77


@pytest.mark.parametrize(
    "error, words",
    [
        ("raise KeyError('x')", "KeyError: 'x'"),
        ("def (", "SyntaxError"),
        ("settings", "NameError"),
        ("raise SystemExit(3)", "SystemExit: 3"),
    ],
)
def test_a_preset_with_an_error_changes_nothing(scene, addon, presets, capfd, error, words):
    label = addon.ui.panel.AFTERLIGHT_PT_presets.bl_label
    (presets / "broken.py").write_text(CHANGES + error)
    capfd.readouterr()
    with pytest.raises(RuntimeError, match=words):
        bpy.ops.afterlight.preset(filepath=str(presets / "broken.py"))
    assert scene.afterlight.samples == 256 and addon.ui.panel.AFTERLIGHT_PT_presets.bl_label == label
    assert "Traceback" not in "".join(capfd.readouterr())


def test_the_name_of_a_preset_is_no_path(scene, presets):
    precious = presets.parent / "precious.py"
    precious.touch()
    for name in ("../precious", str(precious.with_suffix(""))):
        with pytest.raises(RuntimeError, match="There is no preset"):
            bpy.ops.afterlight.preset_add(name=name, remove_name=True)
    assert precious.exists()


def test_presets_on_a_disk_that_is_full(scene, presets, capfd):
    resource = pytest.importorskip("resource", reason="needs a limit for the size of files")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    capfd.readouterr()
    resource.setrlimit(resource.RLIMIT_FSIZE, (10, before[1]))
    try:
        with pytest.raises(RuntimeError) as raised:
            bpy.ops.afterlight.preset_add(name="Full")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert "could not be saved" in str(raised.value) and "Traceback" not in str(raised.value)
    assert not (presets / "Full.py").exists(), "no preset that is cut short"


def test_each_shipped_preset_has_a_tooltip_of_its_own(scene, addon):
    """What the mouse shows over the entries of the menu: one of ours as it is drawn, and a user's."""
    operators = addon.ui.operators
    shipped = {path.stem for path in operators.PRESETS.glob("*.py")}
    assert shipped == set(operators.TOOLTIPS)

    class Entry:
        filepath = ""

    texts = []
    for name in sorted(shipped):
        Entry.filepath = bpy.utils.preset_find(name, "afterlight")
        texts.append(operators.AFTERLIGHT_OT_preset.description(bpy.context, Entry))
    Entry.filepath = "/somewhere/draft.py"
    texts.append(operators.AFTERLIGHT_OT_preset.description(bpy.context, Entry))
    assert len(set(texts)) == len(texts) and texts[-1] == operators.AFTERLIGHT_OT_preset.bl_description
    assert addon.ui.panel.AFTERLIGHT_PT_presets.preset_operator == "afterlight.preset"


def test_shipped_presets_set_what_their_method_has(addon):
    stored = {each.name: each for each in addon.parameters.PARAMETERS if each.in_presets}
    added = addon.ui.operators.AFTERLIGHT_OT_preset_add.preset_values
    assert added == [f"settings.{name}" for name in stored]
    for path in addon.ui.operators.PRESETS.glob("*.py"):
        values = dict(re.findall(r'^settings\.(\w+) = "?(\w+)"?$', path.read_text(), re.M))
        needed = {name for name, each in stored.items() if values["method"] in each.methods}
        assert stored.keys() >= values.keys() >= needed - {"use_glossy"}, path
        assert "use_glossy" not in values, "as the help says"


# Keyframes and drivers


def test_every_setting_takes_keyframes_and_drivers_frame_by_frame(scene, addon, tmp_path, monkeypatch):
    """What the engine hands to the light, in a rendered animation."""
    seen = []
    gather = addon.render.engine.gather.gather_indirect

    def spy(passes, camera, settings, **options):
        seen.append(settings)
        return gather(passes, camera, settings, **options)

    monkeypatch.setattr(addon.render.engine.gather, "gather_indirect", spy)
    near = pytest.approx
    settings = scene.afterlight
    settings.enabled = True
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = str(tmp_path / "frame_")
    keyed = {
        "strength": (1.0, 0.5, 0.25),
        "start": ("QUARTER", "HALF", "FULL"),
        "samples": (16, 32, 64),
        "radius": (4, 6, 8),
        "seed": (1, 5, 9),
        "use_animated_seed": (False, True, False),
    }
    radiosity = {
        "draws": (1, 2, 3),
        "bounces": (1, 2, 3),
        "use_visibility": (True, False, True),
        "use_world_shadow": (True, True, False),
        "accumulate": (1, 2, 3),
    }
    # They decide which scenes and passes there are, and stay as they are.
    wiring = {"method", "use_viewport", "views", "view_count", "use_glossy", "use_history", "denoise"}
    assert keyed.keys() | radiosity.keys() | wiring == {parameter.name for parameter in addon.parameters.PARAMETERS}
    for name, values in keyed.items():
        for frame, value in enumerate(values, 1):
            setattr(settings, name, value)
            assert settings.keyframe_insert(name, frame=frame), name
    scene.frame_set(1)
    bpy.ops.render.render(animation=True)
    assert [(each.strength, each.start, each.samples, each.radius, each.seed) for each in seen] == [
        (1.0, 4, 16, 4, 1),
        (0.5, 2, 32, 6, 5 + 2 * 7919),
        (0.25, 1, 64, 8, 9),
    ]

    seen.clear()
    scene.animation_data_clear()
    drivers = {
        "strength": "frame / 4",
        "start": "3 - frame",
        "samples": "16 * frame",
        "radius": "3 + frame",
        "seed": "100 + frame",
        "use_animated_seed": "frame == 2",
    }
    assert drivers.keys() == keyed.keys()
    for name, expression in drivers.items():
        settings.driver_add(name).driver.expression = expression
    scene.frame_set(1)
    bpy.ops.render.render(animation=True)
    assert [(each.strength, each.start, each.samples, each.radius, each.seed) for each in seen] == [
        (near(0.25), 1, 16, 4, 101),
        (near(0.5), 2, 32, 5, 102 + 2 * 7919),
        (near(0.75), 4, 48, 6, 103),
    ]

    seen.clear()
    scene.animation_data_clear()
    monkeypatch.setattr(
        addon.render.engine.gather, "gather_views", lambda views, settings, world, **_: seen.append((settings, world))
    )
    settings.method, settings.views = "RADIOSITY", "CAMERA"
    scene.world = bpy.data.worlds.new("Sky")
    sky = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND").inputs["Strength"]
    for frame, strength in ((1, 1.0), (2, 2.0), (3, 3.0)):
        sky.default_value = strength
        sky.keyframe_insert("default_value", frame=frame)
    for name, values in radiosity.items():
        for frame, value in enumerate(values, 1):
            setattr(settings, name, value)
            assert settings.keyframe_insert(name, frame=frame), name
    scene.frame_set(1)
    bpy.ops.render.render(animation=True)
    assert [(each.groups, each.bounces, each.visibility, each.gathers) for each, _ in seen] == [
        (1, 1, True, 1),
        (2, 2, False, 2),
        (3, 3, True, 3),
    ]
    worlds = [world for _, world in seen]
    assert worlds[2] is None and worlds[1] == pytest.approx(2 * worlds[0]) and worlds[0][0].min() > 0, (
        "as in each frame"
    )
    assert not worlds[0][1:].any(), "one colour"
    for name in wiring:
        with pytest.raises(TypeError, match="not animatable"):
            settings.keyframe_insert(name)
