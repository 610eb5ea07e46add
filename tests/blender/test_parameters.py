# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of settings: an entry is all that a new setting needs, and listeners hear of changes."""

import zipfile

import bpy
import pytest
from test_package import another_blender

import extension

ENTRY = """    Parameter(
        "fresh",
        IntProperty,
        "Fresh",
        "A setting that a test adds. No cost",
        {"default": 3, "min": 1},
        panel=SAMPLING,
        methods=RADIOSITY,
        active=lambda settings: settings.use_visibility,
        gather_field="candidates",
    ),
"""


@pytest.fixture
def with_entry(package, tmp_path):
    """The extension's zip with one more entry in the table."""
    changed = tmp_path / package.name
    with zipfile.ZipFile(package) as before, zipfile.ZipFile(changed, "w") as after:
        for name in before.namelist():
            data = before.read(name)
            if name == "addon/parameters.py":
                start = b"PARAMETERS = (\n"
                assert data.count(start) == 1
                data = data.replace(start, start + ENTRY.encode())
            after.writestr(name, data)
    return changed


def test_a_new_entry_is_everywhere(tmp_path, with_entry):
    found = another_blender(
        tmp_path / "user",
        with_entry,
        f"""
        sys.path.insert(0, {str(extension.ROOT / "tests")!r})
        from drawing import drawn, greyed

        addon = extension.install(zip_path).addon
        settings, other = bpy.context.scene.afterlight, bpy.data.scenes.new("Other").afterlight
        panel = addon.ui.panel.AFTERLIGHT_PT_sampling

        def rows():
            return drawn(panel), [arguments[1] for kind, arguments, _, _ in drawn(panel) if kind == "prop"]

        settings.enabled = True
        row = rows()[1].index("fresh"), "fresh" in greyed(rows()[0])
        settings.use_visibility = False
        grey = "fresh" in greyed(rows()[0])
        settings.method = "PAPER"
        hidden = "fresh" not in rows()[1]
        settings.method, settings.fresh = "RADIOSITY", 7
        bpy.ops.afterlight.copy_settings()
        bpy.ops.afterlight.preset_add(name="Mine")
        preset = Path(bpy.utils.preset_find("Mine", "afterlight")).read_text()
        gathered = addon.properties.light_settings(settings, 0).candidates
        bpy.ops.afterlight.reset()
        addon.properties.store_all(settings)
        print(json.dumps(dict(
            row=row, grey=grey, hidden=hidden, copied=other.fresh, preset="settings.fresh = 7" in preset,
            gathered=gathered, reset=settings.fresh, stored=settings.is_property_set("fresh"),
            link=dict(addon.ui.help_page.manual_map()[1]).get("bpy.types.afterlightsettings.fresh"),
            keyed=settings.keyframe_insert("fresh"))))
        """,
    )
    assert found == {
        "row": [0, False],
        "grey": True,
        "hidden": True,
        "copied": 7,
        "preset": True,
        "gathered": 7,
        "reset": 3,
        "stored": True,
        "link": "#fresh",
        "keyed": True,
    }


def test_blender_has_the_settings_as_the_table_says(addon):
    properties = addon.properties.AfterlightSettings.bl_rna.properties
    for parameter in addon.parameters.PARAMETERS:
        prop = properties[parameter.name]
        assert (prop.name, prop.description) == (parameter.label, parameter.tooltip)
        assert prop.is_animatable == parameter.is_animatable, parameter.name
    assert not properties["enabled"].is_animatable


def test_each_row_is_in_a_panel_that_exists(addon):
    panels = {addon.parameters.MAIN, addon.parameters.SAMPLING, addon.parameters.VIEWS}
    for parameter in addon.parameters.PARAMETERS:
        assert parameter.panel in panels and parameter.methods <= addon.parameters.GATHER_SETTINGS.keys()


def test_an_unknown_method_is_the_default_one(scene, addon):
    """A file of a newer version may have another."""
    scene.afterlight.method = "PAPER"
    scene.bl_system_properties_get()["afterlight"]["method"] = 9
    assert scene.afterlight.method == ""
    assert addon.parameters.method_of(scene.afterlight) == addon.parameters.DEFAULT_METHOD
    found = addon.parameters.light_settings(scene.afterlight, 0)
    assert isinstance(found, addon.parameters.GATHER_SETTINGS[addon.parameters.DEFAULT_METHOD])


def test_frames_have_seeds_of_their_own_where_they_are_averaged(scene, addon):
    settings = scene.afterlight
    settings.seed = 5

    def seeds(**options):
        return [addon.parameters.light_settings(settings, frame, **options).seed for frame in (1, 2)]

    assert seeds() == [5, 5] and len(set(seeds(goes_on=True))) == 2
    settings.use_animated_seed = True
    assert len({5, *seeds()}) == 3


@pytest.fixture
def heard(addon, monkeypatch):
    """What listeners are told: ("change" or "switch", name of the scene)."""
    found = []
    for name in ("change", "switch"):
        calls = getattr(addon.properties, f"on_{name}")
        assert calls, "the viewport listens"
        monkeypatch.setattr(addon.properties, f"on_{name}", [lambda scene, name=name: found.append((name, scene.name))])
    return found


def test_listeners_hear_of_what_changes_the_viewport(scene, heard):
    settings = scene.afterlight
    settings.strength = 0.5
    assert heard == [], "it is not shown"
    settings.use_viewport = True
    settings.enabled = True
    assert heard[0] == heard[-1] == ("switch", "Scene")
    heard.clear()
    settings.strength = 0.7
    assert heard == [("change", "Scene")]
    settings.view_count = 3
    assert heard == [("change", "Scene")] * 2
    heard.clear()
    bpy.ops.afterlight.reset()
    assert heard == [("switch", "Scene")] and not settings.use_viewport
