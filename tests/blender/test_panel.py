# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel, as far as it shows without a window: its rows, what is greyed out, and the fixes of a scene."""

import bpy
import numpy as np
import pytest

from drawing import drawn, greyed, words
from gather_fixtures import camera_for, random_frame
from scenes import differences, nested_tree, put, render, simple_tree, written_down

# The panel


def test_every_setting_is_in_the_panel_and_greyed_where_it_does_not_apply(scene, addon):
    panel = addon.ui.panel

    def settings():
        return [
            *drawn(panel.AFTERLIGHT_PT_indirect_light),
            *drawn(panel.AFTERLIGHT_PT_sampling),
            *(
                drawn(addon.ui.views_panel.AFTERLIGHT_PT_views)
                if addon.ui.views_panel.AFTERLIGHT_PT_views.poll(bpy.context)
                else ()
            ),
        ]

    names = {parameter.name for parameter in addon.parameters.PARAMETERS}
    paper, radiosity = (
        {"samples", "radius"},
        {
            "draws",
            "bounces",
            "use_visibility",
            "use_world_shadow",
            "use_glossy",
            "views",
            "view_count",
            "accumulate",
            "use_history",
            "denoise",
        },
    )
    for method, others in (("RADIOSITY", paper), ("PAPER", radiosity)):
        scene.afterlight.method = method
        assert {arguments[1] for kind, arguments, _, _ in settings() if kind == "prop"} == names - others
        assert greyed(settings()) == names - others, "nothing applies before the box is ticked"
    scene.afterlight.enabled = True
    assert not greyed(settings())
    scene.afterlight.method, scene.afterlight.views = "RADIOSITY", "CAMERA"
    assert greyed(settings()) == {"view_count"}, "there are no further views"
    scene.afterlight.method = "PAPER"
    scene.afterlight.samples, scene.afterlight.radius = 256, 8
    assert greyed(settings()) == {"seed", "use_animated_seed"}, "every texel is visited: there is no noise"
    ((_, arguments, _, _),) = drawn(panel.AFTERLIGHT_PT_indirect_light, "draw_header")
    assert arguments[1] == "enabled"


def test_no_noise_where_the_seed_is_greyed(light):
    passes, camera = random_frame(light, 48, 32), camera_for(light, 48, 32)
    for samples, radius, exact in ((256, 8, True), (32, 8, False), (0, 16, True)):
        pictures = [
            light.gather_indirect(passes, camera, light.Settings(1, samples, radius, seed, 1.0)) for seed in (1, 2)
        ]
        assert light.is_exact(light.Settings(1, samples, radius, 0, 1.0)) == exact == np.array_equal(*pictures)


def test_the_header_has_presets_menu_and_help(scene, addon):
    found = drawn(addon.ui.panel.AFTERLIGHT_PT_indirect_light, "draw_header_preset")
    assert [kind for kind, *_ in found if kind != "separator"] == ["popover", "menu", "operator"]


def test_the_last_render_is_shown_by_stage_with_total_and_memory(scene, addon, tmp_path):
    panel = addon.ui.panel.AFTERLIGHT_PT_last_render
    assert not panel.poll(bpy.context)
    scene.afterlight.enabled = True
    render(scene, tmp_path / "lit.exr")
    assert panel.poll(bpy.context)
    labels = [options["text"] for kind, _, options, _ in drawn(panel) if kind == "label"]
    shown = dict(zip(labels[::2], labels[1::2]))
    assert list(shown) == ["Write passes", "Gather on the GPU", "Hand back", "Total time", "GPU memory", "Passes file"]
    seconds = [float(value.removesuffix(" s")) for value in shown.values() if value.endswith(" s")]
    assert abs(sum(seconds[:-1]) - seconds[-1]) < 0.003 and seconds[-1] > 0
    taken = addon.host.report.memory(scene)
    passes = 64 * 36 * 13 * 4  # bytes of 13 channels
    assert passes < taken["GPU memory"] < 2 * passes and taken["passes file"] > passes
    assert list(shown.values())[-2:] == [f"{size / 2**20:.1f} MiB" for size in taken.values()]
    for name in shown:  # put together as they are shown, so test_words.py does not find them
        assert name in addon.translations.de_DE.TEXTS, name
    scene.eevee.use_raytracing = True
    render(scene, tmp_path / "plain.exr")
    assert "ray tracing" in words(drawn(panel))


@pytest.mark.parametrize(
    "start, size, radius", [(1, (64, 36), 16), (2, (97, 53), 16), (4, (640, 360), 24), (1, (50, 3), 64)]
)
def test_memory_is_what_the_textures_take(addon, monkeypatch, start, size, radius):
    """The whole way through the light with textures that only count themselves."""
    light = addon.gather
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


# Fixes


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


SPOILED = [
    other_engine,
    another_camera,
    lamp_for_a_camera,
    panorama,
    no_view_layer,
    stereo,
    single_layer,
    strips,
    ray_tracing,
    probes,
    compositing_off,
    helper_deleted,
    all_in_groups,
]


@pytest.mark.parametrize("spoil", SPOILED)
def test_one_click_fixes_it_and_undo_takes_it_back(scene, addon, spoil):
    findings = addon.diagnosis.checks.findings
    (nested_tree if spoil == all_in_groups else simple_tree)(scene)
    scene.afterlight.enabled = True
    assert not findings(scene)
    spoil(scene)
    (found,) = findings(scene)
    assert found.fix and found.fatal == (spoil != probes)
    panel = drawn(addon.ui.panel.AFTERLIGHT_PT_indirect_light)
    assert words(panel) == found.text
    assert [
        (arguments[0], options["text"])
        for kind, arguments, options, _ in panel
        if kind == "operator" and arguments[0] == "afterlight.mend"
    ] == [("afterlight.mend", addon.diagnosis.fixes.FIXES[found.fix].button)]
    bpy.ops.ed.undo_push(message="spoiled")
    before = written_down()
    assert bpy.ops.afterlight.mend(cure=found.fix) == {"FINISHED"}
    assert not findings(scene)
    bpy.ops.ed.undo_push(message="fixed")
    bpy.ops.ed.undo()
    assert not differences(before, written_down())
    assert [again.text for again in findings(bpy.context.scene)] == [found.text]


def test_no_button_where_only_the_user_knows(scene, addon):
    findings = addon.diagnosis.checks.findings
    tree = simple_tree(scene)
    scene.afterlight.enabled = True
    tree.nodes.remove(tree.nodes["Afterlight"])
    (found,) = findings(scene)
    assert "Link the Image" in found.text and not found.fix
    for node in [node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers"]:
        tree.nodes.remove(node)
    (found,) = findings(scene)
    assert "Add one" in found.text and not found.fix
    scene.afterlight.enabled = False
    bpy.data.objects.remove(scene.camera)
    (found,) = findings(scene)
    assert "Add > Camera" in found.text and not found.fix


def test_a_helper_scene_leads_to_the_scene_it_lights(scene, addon):
    scene.afterlight.enabled = True
    bpy.context.window.scene = scene.afterlight.helper
    (found,) = addon.diagnosis.checks.findings(bpy.context.scene)
    assert bpy.ops.afterlight.mend(cure=found.fix) == {"FINISHED"} and bpy.context.window.scene == scene


def test_lines_are_broken_where_they_fit(addon):
    wrapped = addon.ui.drawing.wrapped
    assert wrapped("one two three", lambda line: len(line) <= 7) == ["one two", "three"]
    assert wrapped("extraordinary", lambda line: len(line) <= 7) == ["extraordinary"]
