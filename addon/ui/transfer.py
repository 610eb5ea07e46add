# SPDX-License-Identifier: GPL-3.0-or-later
"""Copy and reset the settings of a scene."""

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Operator
from bpy_extras import anim_utils

from .. import properties
from ..compositor import setup
from ..host import roles
from ..parameters import PARAMETERS
from ..translations import say
from .operators import OnEditableScene


class AFTERLIGHT_OT_copy_settings(OnEditableScene, Operator):
    bl_idname = "afterlight.copy_settings"
    bl_label = "Copy Indirect Light Settings"
    bl_description = (
        "Copy the Indirect Light settings of this scene to other scenes, with their values in the current frame. "
        "Keyframes and drivers are not copied, nor cameras in the list of views that are not in the other scene"
    )

    scene: StringProperty(name="Scene", description="Scene to copy the settings to; all other scenes if empty")
    enable: BoolProperty(name="Also Enable", description="Enable Indirect Light in those scenes as well")

    @classmethod
    def poll(cls, context):
        if not super().poll(context):
            return False
        if not other_scenes(context.scene):
            cls.poll_message_set(say("The file has no other scene that can be edited"))
            return False
        return True

    def execute(self, context):
        others = [scene for scene in other_scenes(context.scene) if self.scene in ("", scene.name)]
        if not others:
            self.report({"ERROR"}, say('There is no other scene "{}" that can be edited', self.scene))
            return {"CANCELLED"}
        for scene in others:
            _copy(context.scene.afterlight, scene)
            if self.enable and not scene.afterlight.enabled:
                scene.afterlight.enabled = True
            _warn_of_animation(self, scene)
        self.report({"INFO"}, say("Settings copied to {}", ", ".join(scene.name for scene in others)))
        return {"FINISHED"}


class AFTERLIGHT_OT_reset(OnEditableScene, Operator):
    bl_idname = "afterlight.reset"
    bl_label = "Reset Indirect Light Settings"
    bl_description = (
        "Set all settings in this panel to their defaults, except the checkbox in its header. The list of cameras is "
        "kept, and so are keyframes and drivers"
    )

    def execute(self, context):
        scene = context.scene
        for parameter in PARAMETERS:
            scene.afterlight.property_unset(parameter.name)
        setup.connect_if_enabled(scene)
        properties.announce_switch(scene)
        _warn_of_animation(self, scene)
        return {"FINISHED"}


def other_scenes(scene):
    """The scenes of the file that settings can be copied to."""
    return [
        other for other in bpy.data.scenes if other != scene and other.library is None and not roles.is_helper(other)
    ]


def _copy(settings, scene):
    """Give `scene` these settings, and of their list of cameras those that it contains as well. Where it contains none
    of them its own list stays."""
    there = set(scene.objects)
    shared = [each.camera for each in settings.view_cameras if each.camera in there]
    if shared:
        scene.afterlight.view_cameras.clear()
        for camera in shared:
            scene.afterlight.view_cameras.add().camera = camera
    for parameter in PARAMETERS:
        setattr(scene.afterlight, parameter.name, getattr(settings, parameter.name))


def _warn_of_animation(operator, scene):
    animated = [parameter.label for parameter in PARAMETERS if parameter.name in _animated(scene)]
    if animated:
        operator.report(
            {"WARNING"},
            say(
                '{} in scene "{}" has keyframes or a driver, which override it in every frame',
                ", ".join(map(say, animated)),
                scene.name,
            ),
        )


def _animated(scene):
    """Names of the settings of `scene` that have keyframes or drivers."""
    data = scene.animation_data
    if data is None:
        return set()
    curves = list(data.drivers)
    if data.action and (bag := anim_utils.action_get_channelbag_for_slot(data.action, data.action_slot)):
        curves += bag.fcurves
    return {
        curve.data_path.removeprefix("afterlight.") for curve in curves if curve.data_path.startswith("afterlight.")
    }


register, unregister = bpy.utils.register_classes_factory((AFTERLIGHT_OT_copy_settings, AFTERLIGHT_OT_reset))
