# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel under EEVEE's own in the Render properties."""

from pathlib import Path

import bpy
from bl_ui.utils import PresetPanel
from bpy.types import Menu, Panel

from .pipeline import checks, status, wiring

FOLDER = str(Path(__file__).parent)


class AFTERLIGHT_MT_presets(Menu):
    bl_label = "Indirect Light Presets"
    preset_subdir = "afterlight"
    preset_operator = "script.execute_preset"
    draw = Menu.draw_preset


class AFTERLIGHT_PT_presets(PresetPanel, Panel):
    bl_label = "Indirect Light Presets"
    preset_subdir = "afterlight"
    preset_operator = "script.execute_preset"
    preset_add_operator = "afterlight.preset_add"


class _InRenderProperties:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        # Where the box is ticked the panel stays, to say that another engine can't be lit.
        scene = context.scene
        return scene.render.engine == "BLENDER_EEVEE" or scene.afterlight.enabled or wiring.is_helper(scene)


class AFTERLIGHT_PT_indirect_light(_InRenderProperties, Panel):
    bl_label = "Indirect Light"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.afterlight, "enabled", text="")

    def draw_header_preset(self, _context):
        AFTERLIGHT_PT_presets.draw_panel_header(self.layout)

    def draw(self, context):
        layout, settings = self.layout, context.scene.afterlight
        layout.use_property_split, layout.use_property_decorate = True, True
        if settings.enabled or wiring.is_helper(context.scene):
            for finding in checks.findings(context.scene):
                _draw_finding(layout, finding, context)
        column = layout.column()
        column.active = settings.enabled
        column.prop(settings, "strength")


class AFTERLIGHT_PT_sampling(_InRenderProperties, Panel):
    bl_label = "Sampling"
    bl_parent_id = "AFTERLIGHT_PT_indirect_light"

    def draw(self, context):
        layout, settings = self.layout, context.scene.afterlight
        layout.use_property_split, layout.use_property_decorate = True, True
        layout.active = settings.enabled
        column = layout.column()
        column.prop(settings, "start")
        column.prop(settings, "samples")
        column.prop(settings, "radius")
        column = layout.column(align=True)
        column.prop(settings, "seed")
        column.prop(settings, "use_animated_seed")


class AFTERLIGHT_PT_last_render(_InRenderProperties, Panel):
    bl_label = "Last Render"
    bl_parent_id = "AFTERLIGHT_PT_indirect_light"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and bool(context.scene.afterlight.report or status.stages(context.scene))

    def draw(self, context):
        layout = self.layout
        if context.scene.afterlight.report:
            _draw_text(layout, context.scene.afterlight.report, "ERROR", context)
        for stage, seconds in status.stages(context.scene).items():
            row = layout.row()
            row.label(text=stage.replace("_", " ").capitalize())
            row.label(text=f"{seconds:.2f} s")


def _draw_finding(layout, finding, context):
    box = layout.box()
    _draw_text(box, finding.text, "ERROR" if finding.fatal else "INFO", context)
    if finding.operator:
        box.operator(finding.operator, text=finding.button)


def _draw_text(layout, text, icon, context):
    """Labels do not wrap by themselves."""
    width = max(20, int(context.region.width / context.preferences.system.ui_scale / 7))
    column, line = layout.column(align=True), ""
    for word in (*text.split(), None):
        if word is None or len(line) + len(word) >= width:
            column.label(text=line, icon=icon)
            line, icon = "", "BLANK1"
        line += f"{word} " if word else ""


CLASSES = (AFTERLIGHT_MT_presets, AFTERLIGHT_PT_presets, AFTERLIGHT_PT_indirect_light, AFTERLIGHT_PT_sampling,
           AFTERLIGHT_PT_last_render)

_register_classes, _unregister_classes = bpy.utils.register_classes_factory(CLASSES)


def register():
    _register_classes()
    bpy.utils.register_preset_path(FOLDER)


def unregister():
    bpy.utils.unregister_preset_path(FOLDER)
    _unregister_classes()
