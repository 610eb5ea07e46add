# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel below EEVEE's own in the Render properties, and its menu, which is in the top bar as well."""

from pathlib import Path

import bpy
from bl_ui.utils import PresetPanel
from bpy.types import Menu, Panel

from .. import parameters, properties
from ..diagnosis import checks
from ..diagnosis.fixes import FIXES
from ..host import report, roles
from ..translations import say
from ..viewport import draw_handlers as viewports
from . import transfer
from .drawing import InRenderProperties, draw_settings, draw_text, draw_value

FOLDER = str(Path(__file__).parents[1])


class AFTERLIGHT_PT_presets(PresetPanel, Panel):
    bl_label = "Indirect Light Presets"
    preset_subdir = "afterlight"
    preset_operator = "afterlight.preset"
    preset_add_operator = "afterlight.preset_add"


class AFTERLIGHT_MT_copy_settings(Menu):
    bl_label = "Copy Settings"

    def draw(self, context):
        layout = self.layout
        layout.operator("afterlight.copy_settings", text="To All Scenes").scene = ""
        layout.separator()
        for scene in transfer.other_scenes(context.scene):
            layout.operator("afterlight.copy_settings", text=scene.name, translate=False).scene = scene.name


class AFTERLIGHT_MT_indirect_light(Menu):
    bl_label = "Indirect Light"

    def draw(self, _context):
        layout = self.layout
        layout.operator("afterlight.update", icon="FILE_REFRESH")
        layout.operator("afterlight.free_passes")
        layout.separator()
        layout.menu("AFTERLIGHT_MT_copy_settings")
        layout.operator("afterlight.reset", text="Reset Settings")
        layout.operator("afterlight.repair")
        layout.operator("afterlight.place_views")
        layout.separator()
        layout.operator("afterlight.help", icon="QUESTION").section = ""


def draw_in_top_bar(menu, _context):
    """In the menu Render: Blender's search (F3) finds operators of menus, but not of panels."""
    menu.layout.separator()
    menu.layout.menu("AFTERLIGHT_MT_indirect_light")


def draw_in_viewport_shading(menu, context):
    """In the pop-over of viewports with Rendered shading."""
    if context.space_data.shading.type == "RENDERED" and InRenderProperties.poll(context):
        row = menu.layout.row()
        row.active = context.scene.afterlight.enabled
        row.prop(context.scene.afterlight, "use_viewport", text="Indirect Light")


class AFTERLIGHT_PT_indirect_light(InRenderProperties, Panel):
    bl_label = "Indirect Light"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.active = not roles.is_helper(context.scene)
        self.layout.prop(context.scene.afterlight, "enabled", text="")

    def draw_header_preset(self, _context):
        layout = self.layout
        AFTERLIGHT_PT_presets.draw_panel_header(layout)
        layout.menu("AFTERLIGHT_MT_indirect_light", icon="DOWNARROW_HLT", text="")
        layout.operator("afterlight.help", icon="QUESTION", text="").section = ""
        layout.separator(factor=0.5)  # from the handle by which panels are moved

    def draw(self, context):
        layout, scene = self.layout, context.scene
        settings = scene.afterlight
        layout.use_property_split, layout.use_property_decorate = True, True
        if settings.enabled or roles.is_helper(scene):
            for finding in checks.findings(scene):
                _draw_finding(layout, finding, context)
        column = layout.column()
        column.active = settings.enabled
        draw_settings(column, settings, parameters.MAIN)
        if properties.is_shown(settings) and (problem := viewports.problem(scene)):
            draw_text(layout, problem, "ERROR", context)
        row = layout.row(align=True)
        row.operator("afterlight.update", icon="FILE_REFRESH")
        row.operator("afterlight.free_passes", icon="TRASH", text="")


class AFTERLIGHT_PT_sampling(InRenderProperties, Panel):
    bl_label = "Sampling"
    bl_parent_id = "AFTERLIGHT_PT_indirect_light"
    bl_order = 1

    def draw(self, context):
        layout, settings = self.layout, context.scene.afterlight
        layout.use_property_split, layout.use_property_decorate = True, True
        layout.active = settings.enabled
        draw_settings(layout.column(), settings, parameters.SAMPLING)


class AFTERLIGHT_PT_last_render(InRenderProperties, Panel):
    bl_label = "Last Render"
    bl_parent_id = "AFTERLIGHT_PT_indirect_light"
    bl_order = 3
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and bool(context.scene.afterlight.report or report.stages(context.scene))

    def draw(self, context):
        layout, scene = self.layout, context.scene
        if scene.afterlight.report:
            draw_text(layout, scene.afterlight.report, "ERROR", context)
        stages = report.stages(scene)
        if stages:
            column = layout.column(align=True)
            for stage, seconds in stages.items():
                draw_value(column, say(report.label(stage)), f"{seconds:.3f} s")
            column.separator()
            draw_value(column, say("Total time"), f"{sum(stages.values()):.3f} s")
        if memory := report.memory(scene):
            column = layout.column(align=True)
            for name, size in memory.items():
                draw_value(column, say(report.label(name)), f"{size / 2**20:.1f} MiB")


def _draw_finding(layout, finding, context):
    box = layout.box()
    draw_text(box, finding.text, "ERROR" if finding.fatal else "INFO", context)
    if finding.fix:
        box.operator("afterlight.mend", text=FIXES[finding.fix].button).cure = finding.fix


CLASSES = (
    AFTERLIGHT_PT_presets,
    AFTERLIGHT_MT_copy_settings,
    AFTERLIGHT_MT_indirect_light,
    AFTERLIGHT_PT_indirect_light,
    AFTERLIGHT_PT_sampling,
    AFTERLIGHT_PT_last_render,
)

_register_classes, _unregister_classes = bpy.utils.register_classes_factory(CLASSES)


def register():
    _register_classes()
    bpy.utils.register_preset_path(FOLDER)
    bpy.types.TOPBAR_MT_render.append(draw_in_top_bar)
    bpy.types.VIEW3D_PT_shading.append(draw_in_viewport_shading)


def unregister():
    bpy.types.VIEW3D_PT_shading.remove(draw_in_viewport_shading)
    bpy.types.TOPBAR_MT_render.remove(draw_in_top_bar)
    bpy.utils.unregister_preset_path(FOLDER)
    _unregister_classes()
