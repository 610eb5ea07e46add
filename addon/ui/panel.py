# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel under EEVEE's own in the Render properties, and the menu that it shares with the top bar."""

from pathlib import Path

import blf
import bpy
from bl_ui.utils import PresetPanel
from bpy.types import Menu, Panel

from .. import gather
from ..diagnosis import checks
from ..diagnosis.fixes import CURES
from ..host import report, roles
from ..properties import light_settings
from ..translations import say
from ..viewport import draw_handlers as viewports
from . import operators

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
        for scene in operators.other_scenes(context.scene):
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
    """In the menu Render, where Blender's search (F3) finds what the menu holds: it looks through no panel."""
    menu.layout.separator()
    menu.layout.menu("AFTERLIGHT_MT_indirect_light")


def draw_in_viewport_shading(menu, context):
    """In the pop-over of rendered viewports."""
    if context.space_data.shading.type == "RENDERED" and _InRenderProperties.poll(context):
        row = menu.layout.row()
        row.active = context.scene.afterlight.enabled
        row.prop(context.scene.afterlight, "use_viewport", text="Indirect Light")


class _InRenderProperties:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        # Where the box is ticked the panel stays, to say that another engine can't be lit.
        scene = context.scene
        return scene.render.engine == "BLENDER_EEVEE" or scene.afterlight.enabled or roles.is_helper(scene)


class AFTERLIGHT_PT_indirect_light(_InRenderProperties, Panel):
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
        layout, settings = self.layout, context.scene.afterlight
        layout.use_property_split, layout.use_property_decorate = True, True
        if settings.enabled or roles.is_helper(context.scene):
            for finding in checks.findings(context.scene):
                _draw_finding(layout, finding, context)
        column = layout.column()
        column.active = settings.enabled
        column.prop(settings, "method")
        column.prop(settings, "strength")
        column.prop(settings, "use_viewport")
        if settings.enabled and settings.use_viewport and (problem := viewports.problem(context.scene)):
            _draw_text(layout, problem, "ERROR", context)
        row = layout.row(align=True)
        row.operator("afterlight.update", icon="FILE_REFRESH")
        row.operator("afterlight.free_passes", icon="TRASH", text="")


class AFTERLIGHT_PT_sampling(_InRenderProperties, Panel):
    bl_label = "Sampling"
    bl_parent_id = "AFTERLIGHT_PT_indirect_light"
    bl_order = 1

    def draw(self, context):
        layout, settings = self.layout, context.scene.afterlight
        layout.use_property_split, layout.use_property_decorate = True, True
        layout.active = settings.enabled
        column = layout.column()
        column.prop(settings, "start")
        if settings.method == "PAPER":
            column.prop(settings, "samples")
            column.prop(settings, "radius")
        else:
            column.prop(settings, "draws")
            column.prop(settings, "accumulate")
            column.prop(settings, "use_history")
            column.prop(settings, "denoise")
            column.prop(settings, "bounces")
            column.prop(settings, "use_visibility")
            row = column.row()
            row.active = settings.use_visibility
            row.prop(settings, "use_world_shadow")
            column.prop(settings, "use_glossy")
        column = layout.column(align=True)
        column.active = not gather.is_exact(light_settings(settings, 0))
        column.prop(settings, "seed")
        column.prop(settings, "use_animated_seed")


class AFTERLIGHT_PT_last_render(_InRenderProperties, Panel):
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
            _draw_text(layout, scene.afterlight.report, "ERROR", context)
        stages = report.stages(scene)
        if stages:
            column = layout.column(align=True)
            for stage, seconds in stages.items():
                _draw_row(column, say(report.label(stage)), f"{seconds:.3f} s")
            column.separator()
            _draw_row(column, say("Total time"), f"{sum(stages.values()):.3f} s")
        if memory := report.memory(scene):
            column = layout.column(align=True)
            for name, size in memory.items():
                _draw_row(column, say(report.label(name)), f"{size / 2**20:.1f} MiB")


def wrapped(text, fits):
    """The lines of a text, which labels do not break by themselves. fits(line): whether a line is short enough."""
    lines = [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".lstrip()
        if fits(longer) or not lines[-1]:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _draw_row(layout, name, value):
    split = layout.split(factor=0.6)
    split.label(text=name, translate=False)
    right = split.row()
    right.alignment = "RIGHT"
    right.label(text=value, translate=False)


def _draw_finding(layout, finding, context):
    box = layout.box()
    _draw_text(box, finding.text, "ERROR" if finding.fatal else "INFO", context)
    if finding.cure:
        box.operator("afterlight.mend", text=CURES[finding.cure].button).cure = finding.cure


def _draw_text(layout, text, icon, context):
    scale = context.preferences.system.ui_scale
    blf.size(0, context.preferences.ui_styles[0].widget.points * scale)
    width = context.region.width - 80 * scale  # icon, margins of panel and box, scroll bar
    column = layout.column(align=True)
    column.scale_y = 0.8
    for line in wrapped(text, lambda line: blf.dimensions(0, line)[0] <= width):
        column.label(text=line, icon=icon, translate=False)
        icon = "BLANK1"


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
