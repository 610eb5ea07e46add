# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons: what mends a scene, and presets."""

import bpy
from bl_operators.presets import AddPresetBase
from bpy.types import Operator

from .pipeline import wiring
from .settings import PARAMETERS


class _OnEditableScene:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.scene is not None and context.scene.library is None


class AFTERLIGHT_OT_repair(_OnEditableScene, Operator):
    """Put back what Indirect Light needs: the helper scene, the passes and the nodes in the compositor"""

    bl_idname = "afterlight.repair"
    bl_label = "Repair Indirect Light"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.scene.afterlight.enabled

    def execute(self, context):
        wiring.connect(context.scene)
        for fault in wiring.faults(context.scene):
            self.report({"WARNING"}, fault)
        return {"FINISHED"}


class AFTERLIGHT_OT_ray_tracing_off(_OnEditableScene, Operator):
    """Turn off EEVEE's ray tracing, so that bounced light is counted once. Its reflections and refractions go too"""

    bl_idname = "afterlight.ray_tracing_off"
    bl_label = "Turn Off Ray Tracing"

    def execute(self, context):
        context.scene.eevee.use_raytracing = False
        return {"FINISHED"}


class AFTERLIGHT_OT_preset_add(AddPresetBase, Operator):
    """Keep the settings of Indirect Light as a preset, or remove one"""

    bl_idname = "afterlight.preset_add"
    bl_label = "Add Indirect Light Preset"
    preset_menu = "AFTERLIGHT_MT_presets"
    preset_subdir = "afterlight"
    preset_defines = ["settings = bpy.context.scene.afterlight"]
    # Strength and seed belong to the shot, not to the quality.
    preset_values = [f"settings.{parameter.name}" for parameter in PARAMETERS
                     if parameter.name in {"start", "samples", "radius"}]


CLASSES = (AFTERLIGHT_OT_repair, AFTERLIGHT_OT_ray_tracing_off, AFTERLIGHT_OT_preset_add)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
