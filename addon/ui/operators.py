# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons: what mends a scene, presets, and settings from scene to scene."""

import webbrowser
from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy.types import Operator
from bpy_extras import anim_utils

from ..compositor import faults, setup
from ..diagnosis.fixes import CURES
from ..host import put_back, roles
from ..properties import PARAMETERS
from ..translations import say
from . import help_page


class _OnEditableScene:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if context.scene is None or context.scene.library is not None:
            cls.poll_message_set(say("The scene is linked from another file and can't be changed here"))
            return False
        return True


class AFTERLIGHT_OT_mend(_OnEditableScene, Operator):
    bl_idname = "afterlight.mend"
    bl_label = "Mend Scene for Indirect Light"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    cure: EnumProperty(
        name="Cure",
        description="What to change in the scene",
        options={"HIDDEN"},
        items=[(name, cure.button, cure.tooltip) for name, cure in CURES.items()],
    )

    @classmethod
    def description(cls, _context, properties):
        return say(CURES[properties.cure].tooltip)

    def execute(self, context):
        CURES[self.cure].apply(context)
        return {"FINISHED"}


class AFTERLIGHT_OT_repair(_OnEditableScene, Operator):
    bl_idname = "afterlight.repair"
    bl_label = "Repair Indirect Light"
    bl_description = "Put back what Indirect Light needs: the helper scene, the passes and the nodes in the compositor"

    @classmethod
    def poll(cls, context):
        if not super().poll(context):
            return False
        if not context.scene.afterlight.enabled:
            cls.poll_message_set(say("Tick Indirect Light first"))
            return False
        return True

    def execute(self, context):
        setup.connect(context.scene)
        for fault in faults.find(context.scene):
            self.report({"WARNING"}, fault)
        return {"FINISHED"}


class AFTERLIGHT_OT_copy_settings(_OnEditableScene, Operator):
    bl_idname = "afterlight.copy_settings"
    bl_label = "Copy Indirect Light Settings"
    bl_description = (
        "Give this scene's settings of Indirect Light to other scenes, as they are in this frame: "
        "keyframes and drivers stay here"
    )

    scene: StringProperty(name="Scene", description="The scene that gets the settings, all other scenes where empty")
    enable: BoolProperty(name="Tick Too", description="Tick Indirect Light in those scenes as well")

    @classmethod
    def poll(cls, context):
        if not super().poll(context):
            return False
        if not other_scenes(context.scene):
            cls.poll_message_set(say("The file has no other scene that can be changed"))
            return False
        return True

    def execute(self, context):
        others = [scene for scene in other_scenes(context.scene) if self.scene in ("", scene.name)]
        if not others:
            self.report({"ERROR"}, say('There is no other scene "{}" that can be changed', self.scene))
            return {"CANCELLED"}
        for scene in others:
            for parameter in PARAMETERS:
                setattr(scene.afterlight, parameter.name, getattr(context.scene.afterlight, parameter.name))
            if self.enable and not scene.afterlight.enabled:
                scene.afterlight.enabled = True
            _warn_of_animation(self, scene)
        self.report({"INFO"}, say("Settings copied to {}", ", ".join(scene.name for scene in others)))
        return {"FINISHED"}


class AFTERLIGHT_OT_reset(_OnEditableScene, Operator):
    bl_idname = "afterlight.reset"
    bl_label = "Reset Indirect Light Settings"
    bl_description = "Set everything in this panel but its checkbox to the defaults. Keyframes and drivers stay"

    def execute(self, context):
        for parameter in PARAMETERS:
            context.scene.afterlight.property_unset(parameter.name)
        setup.connect_if_enabled(context.scene)
        _warn_of_animation(self, context.scene)
        return {"FINISHED"}


class AFTERLIGHT_OT_help(Operator):
    bl_idname = "afterlight.help"
    bl_label = "Indirect Light Help"
    bl_description = "Show the page of help that came with the extension in the web browser. It needs no network"

    section: StringProperty(name="Section", description="Where to open the page", options={"HIDDEN", "SKIP_SAVE"})

    def execute(self, _context):
        webbrowser.open(help_page.address(self.section))
        # Some browsers are shut out of the folder where extensions live, and say nothing that Python could hear.
        self.report({"INFO"}, say("Help is in {}", help_page.PATH))
        return {"FINISHED"}


# Where Blender looks for presets, in each of its folders for them.
SUBDIR = "afterlight"
# Presets that come with the add-on. The numbers are the means of docs/measured/accuracy.md, of light and of frames.
PRESETS = Path(__file__).resolve().parents[1] / "presets" / "afterlight"
TOOLTIPS = {
    "draft": lambda: say(
        "To set up the light of a shot: 4 views at most, 3 bounces. Its light is off by 14 % in the sample scenes, "
        "where EEVEE's ray tracing at its best is off by 61 %. Without a graphics card a frame takes 2.5 times as long "
        "as EEVEE's own 16 samples"
    ),
    "paper": lambda: say(
        "As the paper has it: one bounce between what the camera sees, through whatever stands in between, and no "
        "further views. Its light is off by 60 % in the sample scenes; a frame takes hardly longer than EEVEE's own"
    ),
    "production": lambda: say(
        "For final pictures: 7 views at most, 4 bounces. Its light is off by 10 % in the sample scenes, where EEVEE's "
        "ray tracing at its best is off by 61 %. Without a graphics card a frame takes 3.2 times as long as EEVEE's own"
        " 16 samples"
    ),
    "reference": lambda: say(
        "To judge the others by: 9 views at most, 8 bounces, four times the draws, and every pixel gathers for itself"
    ),
}


class AFTERLIGHT_OT_preset(_OnEditableScene, Operator):
    """As Blender loads presets, with a tooltip for each that comes with the add-on."""

    bl_idname = "afterlight.preset"
    bl_label = "Load Indirect Light Preset"
    bl_description = "Set everything in this panel but Strength and Seed as the preset has it"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    filepath: StringProperty(name="File", subtype="FILE_PATH", options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, _context, properties):
        path = Path(properties.filepath)
        return TOOLTIPS[path.stem]() if path.parent == PRESETS and path.stem in TOOLTIPS else say(cls.bl_description)

    def execute(self, context):
        if not _is_preset(self.filepath):
            self.report(
                {"ERROR"},
                say(
                    '"{}" does not lie in a folder of Indirect Light presets, and is not run. Choose '
                    "one from the panel's list of presets",
                    self.filepath,
                ),
            )
            return {"CANCELLED"}
        settings = context.scene.afterlight
        before = [(settings, parameter.name, getattr(settings, parameter.name)) for parameter in PARAMETERS]
        try:
            bpy.utils.execfile(self.filepath)
        except (Exception, SystemExit) as error:
            put_back.restore(before)
            self.report(
                {"ERROR"},
                say(
                    "The preset has an error, and the settings stay as they were: {}",
                    f"{type(error).__name__}: {error}",
                ),
            )
            return {"CANCELLED"}
        bpy.types.AFTERLIGHT_PT_presets.bl_label = bpy.path.display_name(Path(self.filepath).name, title_case=False)
        return {"FINISHED"}


class AFTERLIGHT_OT_preset_add(AddPresetBase, Operator):
    bl_idname = "afterlight.preset_add"
    bl_label = "Add Indirect Light Preset"
    bl_description = "Keep the settings of Indirect Light as a preset, or remove one"
    preset_menu = "AFTERLIGHT_PT_presets"
    preset_subdir = SUBDIR
    preset_defines = ["settings = bpy.context.scene.afterlight"]
    # Strength and seed belong to the shot, not to the quality.
    preset_values = [
        f"settings.{parameter.name}"
        for parameter in PARAMETERS
        if parameter.name not in {"strength", "seed", "use_animated_seed"}
    ]

    def execute(self, context):
        """As Blender does it; but a name is no path to other files, and a disk that is full is no traceback."""
        if self.remove_name and Path(self.name).name != self.name:
            self.report({"ERROR"}, say('There is no preset "{}"', self.name))
            return {"CANCELLED"}
        was_there = self._file()
        try:
            return super().execute(context)
        except (OSError, UnicodeError) as error:
            if not was_there and (begun := self._file()):
                Path(begun).unlink(missing_ok=True)
            self.report(
                {"ERROR"},
                say(
                    "The preset could not be written ({}). Free some space on the disk of "
                    "Blender's user folder, or allow writing there",
                    error,
                ),
            )
            return {"CANCELLED"}

    def _file(self):
        return bpy.utils.preset_find(self.as_filename(self.name), SUBDIR)


def _is_preset(path):
    """Whether a file lies in one of the folders that Blender looks for our presets in. Links are followed."""
    path = Path(path).resolve()
    return (
        path.suffix == ".py"
        and path.is_file()
        and any(path.parent == Path(folder).resolve() for folder in bpy.utils.preset_paths(SUBDIR))
    )


def other_scenes(scene):
    """The scenes of the file that settings can be copied to."""
    return [
        other for other in bpy.data.scenes if other != scene and other.library is None and not roles.is_helper(other)
    ]


def _warn_of_animation(operator, scene):
    animated = [parameter.label for parameter in PARAMETERS if parameter.name in _animated(scene)]
    if animated:
        operator.report(
            {"WARNING"},
            say(
                '{} of "{}" has keyframes or a driver, which set it again in every frame',
                ", ".join(map(say, animated)),
                scene.name,
            ),
        )


def _animated(scene):
    """Names of the settings of `scene` that keyframes or drivers set."""
    data = scene.animation_data
    if data is None:
        return set()
    curves = list(data.drivers)
    if data.action and (bag := anim_utils.action_get_channelbag_for_slot(data.action, data.action_slot)):
        curves += bag.fcurves
    return {
        curve.data_path.removeprefix("afterlight.") for curve in curves if curve.data_path.startswith("afterlight.")
    }


CLASSES = (
    AFTERLIGHT_OT_mend,
    AFTERLIGHT_OT_repair,
    AFTERLIGHT_OT_copy_settings,
    AFTERLIGHT_OT_reset,
    AFTERLIGHT_OT_help,
    AFTERLIGHT_OT_preset,
    AFTERLIGHT_OT_preset_add,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
