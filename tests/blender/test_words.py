# SPDX-License-Identifier: GPL-3.0-or-later
"""What users read: the help page, tooltips and messages, and their translations."""

import ast
import inspect
import re
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import unquote, urlparse

import bpy
import pytest

import extension
from drawing import drawn, words

ADDON = extension.ROOT / "addon"


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
    for parameter in addon.parameters.PARAMETERS:
        bpy.ops.wm.doc_view_manual(doc_id=f"AfterlightSettings.{parameter.name}")
    bpy.ops.wm.doc_view_manual(doc_id="AfterlightSettings.enabled")
    for doc_id in ("AfterlightSettings.view_cameras", "AfterlightView.camera"):
        bpy.ops.wm.doc_view_manual(doc_id=doc_id)
    operators = [f"afterlight.{name}" for name in dir(bpy.ops.afterlight)]
    for operator in operators:
        bpy.ops.wm.doc_view_manual(doc_id=operator)
    path = opened[0][0]
    assert path.is_file() and path == addon.ui.help_page.PATH and {file for file, _ in opened} == {path}
    anchors = Anchors(path.read_text()).ids
    sections = [section for _, section in opened]
    assert sections[:2] == ["", "samples"]
    settings = [*(parameter.name for parameter in addon.parameters.PARAMETERS), "enabled", "views", "views"]
    first = 2 + len(settings)
    assert sections[2:first] == settings
    assert len(sections) == first + len(operators) and set(sections[1:]) <= set(anchors)


def test_the_page_of_help_is_whole(addon):
    text = (extension.ROOT / "docs" / "help.html").read_text()
    page = Anchors(text)
    assert len(page.ids) == len(set(page.ids))
    assert all(link.startswith("#") and link[1:] in page.ids for link in page.links), "nothing needs a network"
    for parameter in addon.parameters.PARAMETERS:
        assert f">{parameter.label} <" in text, parameter.label
    for parameter in addon.parameters.PARAMETERS:
        section = re.search(rf'<h3 id="{parameter.name}">.*?(?=<h[23])', text, re.S)[0]
        for method in addon.parameters.GATHER_SETTINGS:
            said = f"<p>{method.title()} only" in section
            assert said == (parameter.methods == {method}), (parameter.name, method)
    start = next(parameter for parameter in addon.parameters.PARAMETERS if parameter.name == "start")
    for _, label, *_ in start.options["items"]:
        assert f"<th>{label}</th>" in text
    for preset in (ADDON / "presets" / "afterlight").glob("*.py"):
        values = re.findall(r"= (\d+)", preset.read_text())
        presets = text[text.index('<h2 id="presets">') :]
        row = re.search(rf"<th>{preset.stem.title()}</th><td>(.*?)</td>", presets, re.S)[1]
        assert all(value in row for value in values), preset


def test_the_sections_of_settings_are_in_the_order_of_the_panel(addon):
    names = [parameter.name for parameter in addon.parameters.PARAMETERS]
    page = Anchors((extension.ROOT / "docs" / "help.html").read_text())
    assert [each for each in page.ids if each in names] == names


def test_help_names_the_settings_that_take_no_keyframes(addon):
    text = (extension.ROOT / "docs" / "help.html").read_text()
    named = re.search(r'<p id="not-animatable">.*?</p>', text, re.S)[0]
    fixed = {parameter.name for parameter in addon.parameters.PARAMETERS if not parameter.is_animatable}
    assert sorted(Anchors(named).links) == sorted(f"#{name}" for name in {"enabled", *fixed})


def test_help_lists_the_stages_that_renders_report():
    text = (extension.ROOT / "docs" / "help.html").read_text()
    listed = re.findall(r"<tr><th>(.*?)</th>", text[text.index('id="last-render"') : text.index('id="messages"')])
    assert listed == [f"{stage[:1].upper()}{stage[1:]}" for stage in STAGES]
    code = "".join(path.read_text() for path in (ADDON / "render").glob("*.py"))
    assert all(f'"{stage}"' in code for stage in STAGES), "no code reports it"


def test_limits_of_bounces_are_told(addon):
    """Placement and drafts count fewer of them than the setting says."""
    depth, draft = addon.views.placement.MAX_BOUNCES, addon.viewport.region_light.DRAFT_BOUNCES
    bounces = next(parameter for parameter in addon.parameters.PARAMETERS if parameter.name == "bounces")
    assert depth < bounces.options["max"] and f"the first {depth} bounces" in bounces.tooltip
    text = (extension.ROOT / "docs" / "help.html").read_text()
    section = text[text.index('<h3 id="bounces">') : text.index('<h3 id="use_visibility">')]
    assert f"the first {depth} bounces" in section and f"compute {draft}." in section


# Words


def rna_texts(addon):
    """Tooltips of the classes that the add-on registers, and of their properties with names and items."""
    kinds = [
        kind
        for base in (bpy.types.Operator, bpy.types.Panel, bpy.types.Menu)
        for kind in base.__subclasses__()
        if kind.__module__.startswith(extension.MODULE)
    ]
    assert {kind.__name__ for kind in kinds} >= {"AFTERLIGHT_OT_update", "AFTERLIGHT_PT_sampling"}
    properties = [
        *addon.properties.AfterlightSettings.bl_rna.properties,
        *addon.properties.AfterlightView.bl_rna.properties,
    ]
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


STAGES = "place views", "EEVEE, views", "write passes", "gather on the GPU", "hand back", "GPU memory", "passes file"
LIGHT_STAGES = "upload", "pyramid", "gather", "upsample", "read back", "glossy"
SAID = {"say": 0, "Problem": 0, "GpuUnavailable": 0, "poll_message_set": 0, "_progress": 0}


def said_texts():
    """(text, place) of every text in the code that is shown: in say() and its like, and `text=` of layouts. Fails on
    texts that are put together before they can be translated."""
    for path in sorted(ADDON.rglob("*.py")):
        # A class's own bl_label changes with presets.
        for label in re.findall(r'^    bl_label = "(.*)"$', path.read_text(), re.M):
            yield label, path.name
        for call in [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]:
            name = getattr(call.func, "attr", getattr(call.func, "id", ""))
            place = f"{path.name}:{call.lineno}"
            shown = [call.args[SAID[name]]] if name in SAID and call.args else []
            shown += [
                keyword.value
                for keyword in call.keywords
                if keyword.arg == "text" and not any(other.arg == "translate" for other in call.keywords)
            ]
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
    status = addon.host.report
    texts = {text: "a class" for text in rna_texts(addon)} | dict(said_texts())
    stages = [text for text in texts if text.islower()]  # stages are said in words of their own
    texts = {status.label(text) if text in stages else text: place for text, place in texts.items()}
    for stage in (*STAGES, *LIGHT_STAGES):
        texts[status.label(stage)] = "a stage"
    texts = {text: place for text, place in texts.items() if re.search("[a-z]", text)}
    missing = {text: place for text, place in texts.items() if text not in german}
    assert not missing, "\n".join(f"{place}: {text!r}" for text, place in missing.items())
    assert sorted(german.keys() - texts.keys()) == [], "no longer shown"
    for text, translation in german.items():
        assert translation.strip() and translation.count("{") == text.count("{"), text


def test_words_are_said_in_the_language_of_the_interface(scene, addon, monkeypatch):
    """Blender's module has no languages built in, its desktop has (tests/desktop/test_interface.py). Here: what is
    asked, and that the answer is what is shown."""
    tables = {}
    monkeypatch.setattr(
        addon.translations,
        "bpy",
        SimpleNamespace(
            app=SimpleNamespace(translations=SimpleNamespace(register=lambda name, table: tables.update(table)))
        ),
    )
    addon.translations.register()
    for context in ("*", "Operator"):
        assert tables["de_DE"][context, "Strength"] == "Stärke"
    monkeypatch.setattr(addon.translations, "pgettext_rpt", lambda text: tables["de_DE"].get(("*", text), text))
    scene.afterlight.enabled = True
    scene.camera.data.type, scene.camera.name = "PANO", "Haupt{}kamera"
    (found,) = addon.diagnosis.checks.findings(scene)
    assert "Haupt{}kamera" in found.text and "Perspektive" in found.text
    assert words(drawn(addon.ui.panel.AFTERLIGHT_PT_indirect_light)) == found.text


def test_tooltips_say_what_it_does_and_what_it_costs(addon):
    for parameter in addon.parameters.PARAMETERS:
        assert re.search(r"cost|time|fast", parameter.tooltip, re.I), parameter.name
    for kind in bpy.types.Operator.__subclasses__():
        if kind.__module__.startswith(extension.MODULE):
            assert getattr(kind, "bl_description", "") or inspect.getattr_static(kind, "description", None), kind
