# SPDX-License-Identifier: GPL-3.0-or-later
"""What people see and press, as far as it shows without a window: the panel's contents, buttons, presets, help, words."""

import ast
import inspect
import re
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import unquote, urlparse

import bpy
import numpy as np
import pytest
from light_fixtures import camera_for, light, random_frame  # noqa: F401
from scenes import box, differences, put, render, simple_tree, nested_tree, written_down

import extension

ADDON = extension.ROOT / "addon"


@pytest.fixture
def scene(fresh):
    return box(fresh, samples=1)


@pytest.fixture
def addon(afterlight):
    return afterlight.addon


class Layout:
    """Takes the place of Blender's layout and writes down what is drawn: (kind, first argument, options, parent)."""

    def __init__(self, drawn, parent=None):
        object.__setattr__(self, "drawn", drawn)
        object.__setattr__(self, "parent", parent)
        self.active = self.enabled = True

    def __getattr__(self, kind):
        def draw(*arguments, **options):
            self.drawn.append((kind, arguments, options, self))
            return SimpleNamespace() if kind == "operator" else Layout(self.drawn, self)
        return draw

    @property
    def greyed(self):
        return not (self.active and self.enabled) or bool(self.parent and self.parent.greyed)


def drawn(panel, method="draw"):
    """What a panel or menu draws now."""
    found = []
    context = SimpleNamespace(scene=bpy.context.scene, region=SimpleNamespace(width=400),
                              preferences=bpy.context.preferences)
    getattr(panel, method)(SimpleNamespace(layout=Layout(found)), context)
    return found


def greyed(found):
    return {arguments[1] for kind, arguments, _, layout in found if kind == "prop" and layout.greyed}


def words(found):
    return " ".join(options["text"] for kind, _, options, _ in found if kind == "label")


# The panel

def test_every_setting_is_in_the_panel_and_greyed_where_it_does_not_apply(scene, addon):
    panel = addon.panel

    def settings():
        return [*drawn(panel.AFTERLIGHT_PT_indirect_light), *drawn(panel.AFTERLIGHT_PT_sampling)]

    names = {parameter.name for parameter in addon.settings.PARAMETERS}
    assert {arguments[1] for kind, arguments, _, _ in settings() if kind == "prop"} == names
    assert greyed(settings()) == names, "nothing applies before the box is ticked"
    scene.afterlight.enabled = True
    assert not greyed(settings())
    scene.afterlight.samples, scene.afterlight.radius = 256, 8
    assert greyed(settings()) == {"seed", "use_animated_seed"}, "every texel is visited: there is no noise"
    assert [arguments[1] for _, arguments, _, _ in drawn(panel.AFTERLIGHT_PT_indirect_light, "draw_header")] == ["enabled"]


def test_no_noise_where_the_seed_is_greyed(light):  # noqa: F811
    passes, camera = random_frame(light, 48, 32), camera_for(light, 48, 32)
    for samples, radius, exact in ((256, 8, True), (32, 8, False), (0, 16, True)):
        pictures = [light.gather_indirect(passes, camera, light.Settings(1, samples, radius, seed, 1.0)) for seed in (1, 2)]
        assert light.is_exact(light.Settings(1, samples, radius, 0, 1.0)) == exact == np.array_equal(*pictures)


def test_the_header_has_presets_menu_and_help(scene, addon):
    found = drawn(addon.panel.AFTERLIGHT_PT_indirect_light, "draw_header_preset")
    assert [kind for kind, *_ in found] == ["popover", "menu", "operator"]


def test_the_last_render_is_shown_by_stage_with_total_and_memory(scene, addon, tmp_path):
    panel = addon.panel.AFTERLIGHT_PT_last_render
    assert not panel.poll(bpy.context)
    scene.afterlight.enabled = True
    render(scene, tmp_path / "lit.exr")
    assert panel.poll(bpy.context)
    labels = [options["text"] for kind, _, options, _ in drawn(panel) if kind == "label"]
    shown = dict(zip(labels[::2], labels[1::2]))
    assert list(shown) == ["Write passes", "Read passes", "Gather on the GPU", "Hand back", "Total Time", "GPU memory",
                           "Passes file"]
    seconds = [float(value.removesuffix(" s")) for value in shown.values() if value.endswith(" s")]
    assert abs(sum(seconds[:-1]) - seconds[-1]) < 0.003 and seconds[-1] > 0
    taken = addon.pipeline.status.memory(scene)
    passes = 64 * 36 * 13 * 4  # bytes of 13 channels
    assert passes < taken["GPU memory"] < 2 * passes and taken["passes file"] > passes
    assert [value for value in shown.values() if "iB" in value] == [f"{size / 2**20:.1f} MiB" for size in taken.values()]
    for name in shown:
        assert name in addon.translations.de_DE.TEXTS, name
    scene.eevee.use_raytracing = True
    render(scene, tmp_path / "plain.exr")
    assert "ray tracing" in words(drawn(panel))


@pytest.mark.parametrize("start, size, radius", [(1, (64, 36), 16), (2, (97, 53), 16), (4, (640, 360), 24), (1, (50, 3), 64)])
def test_memory_is_what_the_textures_take(addon, monkeypatch, start, size, radius):
    """The whole way through the light with textures that only count themselves."""
    light = addon.light
    held = most = 0

    class Texture:
        def __init__(self, width, height, format="RGBA32F", data=None):
            nonlocal held, most
            self.width, self.height, self.format = width, height, format
            self.bytes = width * height * {"RGBA32F": 16, "RGBA32UI": 16, "RG32F": 8}[format]
            held += self.bytes
            most = max(most, held)

        def __del__(self):
            nonlocal held
            held -= self.bytes

    device = light.device
    monkeypatch.setattr(device, "texture", Texture)
    monkeypatch.setattr(device, "dispatch", lambda *_: None)
    monkeypatch.setattr(device, "wait", lambda *_: None)
    monkeypatch.setattr(device, "read", lambda texture: np.zeros((texture.height, texture.width, 4), np.float32))
    width, height = size
    plane = np.ones((height, width), np.float32)
    passes = light.Passes(plane, *[(plane,) * 3] * 4)
    camera = light.Camera(np.eye(3), np.ones(2), np.zeros(2))
    settings = light.Settings(start, 64, radius, 0, 1.0)
    light.gather_indirect(passes, camera, settings)
    assert light.gpu_bytes(width, height, settings) == most and held == 0


# What mends

def other_engine(scene):
    scene.render.engine = "BLENDER_WORKBENCH"


def another_camera(scene):
    scene.camera = None


def lamp_for_a_camera(scene):
    scene.camera = bpy.data.objects["Lamp"]


def panorama(scene):
    scene.camera.data.type = "PANO"


def no_view_layer(scene):
    scene.view_layers[0].use = False


def stereo(scene):
    scene.render.use_multiview = True


def single_layer(scene):
    scene.render.use_single_layer = True


def strips(scene):
    scene.sequence_editor_create().strips.new_effect("Color", "COLOR", 1, 1, length=10)


def ray_tracing(scene):
    scene.eevee.use_raytracing = True


def probes(scene):
    put(bpy.data.lightprobes.new("Volume", "VOLUME"))


def compositing_off(scene):
    scene.render.use_compositing = False


def helper_deleted(scene):
    bpy.data.scenes.remove(scene.afterlight.helper)


def all_in_groups(scene):
    tree = scene.compositing_node_group
    for node in [node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers" and node.scene == scene]:
        tree.nodes.remove(node)


MENDED = [other_engine, another_camera, lamp_for_a_camera, panorama, no_view_layer, stereo, single_layer, strips, ray_tracing,
          probes, compositing_off, helper_deleted, all_in_groups]


@pytest.mark.parametrize("spoil", MENDED)
def test_one_click_mends_it_and_undo_takes_it_back(scene, addon, spoil):
    findings = addon.pipeline.checks.findings
    (nested_tree if spoil == all_in_groups else simple_tree)(scene)
    scene.afterlight.enabled = True
    assert not findings(scene)
    spoil(scene)
    (found,) = findings(scene)
    assert found.cure and found.fatal == (spoil != probes)
    panel = drawn(addon.panel.AFTERLIGHT_PT_indirect_light)
    assert words(panel) == found.text
    assert [(arguments[0], options["text"]) for kind, arguments, options, _ in panel if kind == "operator"] == [
        ("afterlight.mend", addon.pipeline.cures.CURES[found.cure].button)]
    bpy.ops.ed.undo_push(message="spoiled")
    before = written_down()
    assert bpy.ops.afterlight.mend(cure=found.cure) == {"FINISHED"}
    assert not findings(scene)
    bpy.ops.ed.undo_push(message="mended")
    bpy.ops.ed.undo()
    assert not differences(before, written_down())
    assert [again.text for again in findings(bpy.context.scene)] == [found.text]


def test_no_button_where_only_the_user_knows(scene, addon):
    findings = addon.pipeline.checks.findings
    tree = simple_tree(scene)
    scene.afterlight.enabled = True
    tree.nodes.remove(tree.nodes["Afterlight"])
    (found,) = findings(scene)
    assert "Link the Image" in found.text and not found.cure
    for node in [node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers"]:
        tree.nodes.remove(node)
    (found,) = findings(scene)
    assert "Add one" in found.text and not found.cure
    scene.afterlight.enabled = False
    bpy.data.objects.remove(scene.camera)
    (found,) = findings(scene)
    assert "Add > Camera" in found.text and not found.cure


def test_a_helper_scene_leads_to_the_scene_it_lights(scene, addon):
    scene.afterlight.enabled = True
    bpy.context.window.scene = scene.afterlight.helper
    (found,) = addon.pipeline.checks.findings(bpy.context.scene)
    assert bpy.ops.afterlight.mend(cure=found.cure) == {"FINISHED"} and bpy.context.window.scene == scene


def test_lines_are_broken_where_they_fit(addon):
    wrapped = addon.panel.wrapped
    assert wrapped("one two three", lambda line: len(line) <= 7) == ["one two", "three"]
    assert wrapped("extraordinary", lambda line: len(line) <= 7) == ["extraordinary"]


# Operators

def test_settings_go_to_other_scenes(scene, addon):
    settings, names = scene.afterlight, [parameter.name for parameter in addon.settings.PARAMETERS]
    mine = dict(strength=0.5, start="QUARTER", samples=100, radius=9, seed=3, use_animated_seed=True)
    assert sorted(mine) == sorted(names)
    assert not bpy.ops.afterlight.copy_settings.poll(), "there is no other scene"
    for name, value in mine.items():
        setattr(settings, name, value)
    settings.enabled = True
    two, three = bpy.data.scenes.new("Two"), bpy.data.scenes.new("Three")
    menu = drawn(addon.panel.AFTERLIGHT_MT_copy_settings)
    assert [options["text"] for kind, _, options, _ in menu if kind == "operator"] == ["To All Scenes", "Three", "Two"]
    defaults = {name: getattr(three.afterlight, name) for name in names}
    assert bpy.ops.afterlight.copy_settings(scene="Two") == {"FINISHED"}
    assert {name: getattr(two.afterlight, name) for name in names} == mine and not two.afterlight.enabled
    assert {name: getattr(three.afterlight, name) for name in names} == defaults
    assert bpy.ops.afterlight.copy_settings(enable=True) == {"FINISHED"}
    assert {name: getattr(three.afterlight, name) for name in names} == mine
    assert two.afterlight.enabled and three.afterlight.enabled and not addon.pipeline.wiring.faults(three)
    with pytest.raises(RuntimeError, match='no other scene "Four"'):
        bpy.ops.afterlight.copy_settings(scene="Four")


def test_reset_gives_the_defaults_and_names_what_is_animated(scene, addon, capfd):
    settings = scene.afterlight
    defaults = {parameter.name: getattr(settings, parameter.name) for parameter in addon.settings.PARAMETERS}
    settings.strength, settings.start, settings.samples, settings.radius, settings.seed = 0.5, "FULL", 99, 9, 3
    settings.use_animated_seed = settings.enabled = True
    assert bpy.ops.afterlight.reset() == {"FINISHED"}
    assert {name: getattr(settings, name) for name in defaults} == defaults and settings.enabled
    settings.keyframe_insert("radius", frame=1)
    settings.driver_add("seed")
    capfd.readouterr()
    bpy.ops.afterlight.reset()
    assert 'Radius, Seed of "Scene" has keyframes or a driver' in "".join(capfd.readouterr())


def test_undo_takes_operators_back(scene):
    other = bpy.data.scenes.new("Other")
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
    internal = {"afterlight.mend", "afterlight.preset_add"}  # with a button of their own beside what they are for
    assert found >= everything - internal - {"afterlight.update", "afterlight.free_passes"}


def test_operators_say_why_they_are_grey(scene):
    assert not bpy.ops.afterlight.repair.poll()
    with pytest.raises(RuntimeError, match="Tick Indirect Light first"):
        bpy.ops.afterlight.repair()
    with pytest.raises(RuntimeError, match="no other scene"):
        bpy.ops.afterlight.copy_settings()


# Presets

def test_presets_are_added_and_removed_as_blenders_own(scene, addon):
    settings, menu = scene.afterlight, addon.panel.AFTERLIGHT_PT_presets
    shipped = bpy.utils.preset_find("draft", "afterlight")
    settings.start, settings.samples, settings.radius, settings.strength = "FULL", 123, 21, 0.3
    assert bpy.ops.afterlight.preset_add(name="My Shot") == {"FINISHED"}
    path = Path(bpy.utils.preset_find("My_Shot", "afterlight"))
    assert path.is_relative_to(bpy.utils.user_resource("SCRIPTS")), "not in the add-on's own folder"
    assert bpy.ops.afterlight.preset_add(name="My Shot") == {"CANCELLED"}, "the name is taken"
    bpy.ops.script.execute_preset(filepath=shipped, menu_idname="AFTERLIGHT_PT_presets")
    assert (settings.start, settings.samples, settings.radius, settings.strength) == ("QUARTER", 64, 8, pytest.approx(0.3))
    bpy.ops.script.execute_preset(filepath=str(path), menu_idname="AFTERLIGHT_PT_presets")
    assert (settings.start, settings.samples, settings.radius, settings.strength) == ("FULL", 123, 21, pytest.approx(0.3))
    assert menu.bl_label == "My Shot"
    assert bpy.ops.afterlight.preset_add(name="My Shot", remove_name=True) == {"FINISHED"} and not path.exists()
    assert bpy.ops.afterlight.preset_add(name="draft", remove_name=True) == {"CANCELLED"} and Path(shipped).exists()


# Keyframes and drivers

def test_every_setting_takes_keyframes_and_drivers_frame_by_frame(scene, addon, tmp_path, monkeypatch):
    """What the engine hands to the light, in a rendered animation."""
    seen = []
    gather = addon.pipeline.engine.light.gather_indirect

    def spy(passes, camera, settings, **options):
        seen.append(settings)
        return gather(passes, camera, settings, **options)

    monkeypatch.setattr(addon.pipeline.engine.light, "gather_indirect", spy)
    near = pytest.approx
    settings = scene.afterlight
    settings.enabled = True
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = str(tmp_path / "frame_")
    keyed = {"strength": (1.0, 0.5, 0.25), "start": ("QUARTER", "HALF", "FULL"), "samples": (16, 32, 64),
             "radius": (4, 6, 8), "seed": (1, 5, 9), "use_animated_seed": (False, True, False)}
    assert keyed.keys() == {parameter.name for parameter in addon.settings.PARAMETERS}
    for name, values in keyed.items():
        for frame, value in enumerate(values, 1):
            setattr(settings, name, value)
            assert settings.keyframe_insert(name, frame=frame), name
    scene.frame_set(1)
    bpy.ops.render.render(animation=True)
    assert [(each.strength, each.start, each.samples, each.radius, each.seed) for each in seen] == [
        (1.0, 4, 16, 4, 1), (0.5, 2, 32, 6, 5 + 2 * 7919), (0.25, 1, 64, 8, 9)]

    seen.clear()
    scene.animation_data_clear()
    drivers = {"strength": "frame / 4", "start": "3 - frame", "samples": "16 * frame", "radius": "3 + frame",
               "seed": "100 + frame", "use_animated_seed": "frame == 2"}
    assert drivers.keys() == keyed.keys()
    for name, expression in drivers.items():
        settings.driver_add(name).driver.expression = expression
    scene.frame_set(1)
    bpy.ops.render.render(animation=True)
    assert [(each.strength, each.start, each.samples, each.radius, each.seed) for each in seen] == [
        (near(0.25), 1, 16, 4, 101), (near(0.5), 2, 32, 5, 102 + 2 * 7919), (near(0.75), 4, 48, 6, 103)]


# Help

class Anchors(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.ids, self.links = [], []
        self.feed(text)

    def handle_starttag(self, _tag, attributes):
        self.ids += [value for name, value in attributes if name == "id"]
        self.links += [value for name, value in attributes if name == "href"]


@pytest.fixture
def opened(monkeypatch):
    """The (file, section) pairs that the browser was sent to."""
    import webbrowser
    found = []

    def open(url, *_, **__):
        parts = urlparse(url)
        assert parts.scheme == "file"
        found.append((Path(unquote(parts.path)), parts.fragment))
        return True
    monkeypatch.setattr(webbrowser, "open", open)
    return found


def test_help_and_online_manual_open_an_existing_section(scene, addon, opened):
    bpy.ops.afterlight.help()
    bpy.ops.afterlight.help(section="samples")
    for parameter in addon.settings.PARAMETERS:
        bpy.ops.wm.doc_view_manual(doc_id=f"AfterlightSettings.{parameter.name}")
    bpy.ops.wm.doc_view_manual(doc_id="AfterlightSettings.enabled")
    operators = [f"afterlight.{name}" for name in dir(bpy.ops.afterlight)]
    for operator in operators:
        bpy.ops.wm.doc_view_manual(doc_id=operator)
    path = opened[0][0]
    assert path.is_file() and path == addon.help_page.PATH and {file for file, _ in opened} == {path}
    anchors = Anchors(path.read_text()).ids
    sections = [section for _, section in opened]
    assert sections[:2] == ["", "samples"]
    assert sections[2:9] == [*(parameter.name for parameter in addon.settings.PARAMETERS), "enabled"]
    assert len(sections) == 9 + len(operators) and set(sections[1:]) <= set(anchors)


def test_the_page_of_help_is_whole(addon):
    text = (extension.ROOT / "docs" / "help.html").read_text()
    page = Anchors(text)
    assert len(page.ids) == len(set(page.ids))
    assert all(link.startswith("#") and link[1:] in page.ids for link in page.links), "nothing needs a network"
    for parameter in addon.settings.PARAMETERS:
        assert f">{parameter.label} <" in text, parameter.label
    for _, label, *_ in addon.settings.PARAMETERS[1].options["items"]:
        assert f"<th>{label}</th>" in text
    for preset in (ADDON / "presets" / "afterlight").glob("*.py"):
        values = re.findall(r"= (\d+)", preset.read_text())
        row = re.search(rf"<th>{preset.stem.title()}</th><td>(.*?)</td>", text, re.S)[1]
        assert all(value in row for value in values), preset


# Words

def rna_texts(addon):
    """Tooltips of every class and names, tooltips and items of every property that the add-on registers, as Blender's interface shows them."""
    kinds = [kind for base in (bpy.types.Operator, bpy.types.Panel, bpy.types.Menu) for kind in base.__subclasses__()
             if kind.__module__.startswith(extension.MODULE)]
    assert {kind.__name__ for kind in kinds} >= {"AFTERLIGHT_OT_update", "AFTERLIGHT_OT_reset", "AFTERLIGHT_MT_copy_settings"}
    properties = list(addon.settings.AfterlightSettings.bl_rna.properties)
    for kind in kinds:
        yield getattr(kind, "bl_description", "")
        if issubclass(kind, bpy.types.Operator):
            group, _, name = kind.bl_idname.partition(".")
            properties += getattr(getattr(bpy.ops, group), name).get_rna_type().properties
    for prop in properties:
        # Blender itself has words for what every operator and group has, and for what operators of presets have.
        if prop.identifier in {"rna_type", "name", "remove_name", "remove_active"}:
            continue
        if not prop.is_hidden:
            yield from (prop.name, prop.description)
        if prop.type == "ENUM":
            for item in prop.enum_items:
                yield from (item.name, item.description)


STAGES = "write passes", "read passes", "gather on the GPU", "hand back", "GPU memory", "passes file"
LIGHT_STAGES = "upload", "pyramid", "gather", "upsample", "read back"
SAID = {"say": 0, "Problem": 0, "GpuUnavailable": 0, "poll_message_set": 0, "_progress": 0}


def said_texts():
    """(text, place) of every text in the code that is shown: in say() and its like, and `text=` of layouts. Fails on texts
    that are put together before they can be translated."""
    for path in sorted(ADDON.rglob("*.py")):
        for label in re.findall(r'^    bl_label = "(.*)"$', path.read_text(), re.M):  # a class's own changes with presets
            yield label, path.name
        for call in [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]:
            name = getattr(call.func, "attr", getattr(call.func, "id", ""))
            place = f"{path.name}:{call.lineno}"
            shown = [call.args[SAID[name]]] if name in SAID and call.args else []
            shown += [keyword.value for keyword in call.keywords if keyword.arg == "text"
                      and not any(other.arg == "translate" for other in call.keywords)]
            shown += [call.args[1]] if name in {"report", "_fail"} and len(call.args) > 1 else []
            for value in shown:
                for part in (value.body, value.orelse) if isinstance(value, ast.IfExp) else (value,):
                    if isinstance(part, ast.JoinedStr):
                        texts = [piece.value for piece in part.values if isinstance(piece, ast.Constant)]
                        assert texts == ["Afterlight: "], f"{place}: put together before it can be translated"
                    elif isinstance(part, ast.Constant) and isinstance(part.value, str):
                        yield part.value, place


def test_german_has_every_text_and_no_other(addon):
    german = addon.translations.de_DE.TEXTS
    status = addon.pipeline.status
    texts = {text: "a class" for text in rna_texts(addon)} | dict(said_texts())
    stages = [text for text in texts if text.islower()]  # stages are said in words of their own
    texts = {status.in_words(text) if text in stages else text: place for text, place in texts.items()}
    for stage in (*STAGES, *LIGHT_STAGES):
        texts[status.in_words(stage)] = "a stage"
    texts = {text: place for text, place in texts.items() if re.search("[a-z]", text)}
    missing = {text: place for text, place in texts.items() if text not in german}
    assert not missing, "\n".join(f"{place}: {text!r}" for text, place in missing.items())
    assert sorted(german.keys() - texts.keys()) == [], "no longer shown"
    for text, translation in german.items():
        assert translation.strip() and translation.count("{") == text.count("{"), text


def test_words_are_said_in_the_language_of_the_interface(scene, addon, monkeypatch):
    """Blender's module has no languages built in, its desktop has (tests/desktop). Here: what is asked of it, and that the
    answer is what is shown."""
    tables = {}
    monkeypatch.setattr(addon.translations, "bpy", SimpleNamespace(app=SimpleNamespace(translations=SimpleNamespace(
        register=lambda name, table: tables.update(table)))))
    addon.translations.register()
    for context in ("*", "Operator"):
        assert tables["de_DE"][context, "Strength"] == "Stärke"
    monkeypatch.setattr(addon.translations, "pgettext_rpt", lambda text: tables["de_DE"].get(("*", text), text))
    scene.afterlight.enabled = True
    scene.camera.data.type, scene.camera.name = "PANO", "Haupt{}kamera"
    (found,) = addon.pipeline.checks.findings(scene)
    assert "Haupt{}kamera" in found.text and "Perspektive" in found.text
    assert words(drawn(addon.panel.AFTERLIGHT_PT_indirect_light)) == found.text


def test_tooltips_say_what_it_does_and_what_it_costs(addon):
    for parameter in addon.settings.PARAMETERS:
        assert re.search(r"cost|time|fast", parameter.tooltip, re.I), parameter.name
    for kind in addon.operators.CLASSES:
        assert getattr(kind, "bl_description", "") or inspect.getattr_static(kind, "description", None), kind
