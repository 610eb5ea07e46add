# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons that fix a scene, load and keep presets, and open the help."""

import webbrowser
from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import EnumProperty, StringProperty
from bpy.types import Operator

from ..compositor import faults, setup
from ..diagnosis.fixes import FIXES
from ..host import put_back
from ..parameters import PARAMETERS
from ..translations import say
from . import help_page


class OnEditableScene:
    """An operator that changes the scene, and can be undone."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if context.scene is None or context.scene.library is not None:
            cls.poll_message_set(say("The scene is linked from another file and cannot be edited here"))
            return False
        return True


class AFTERLIGHT_OT_mend(OnEditableScene, Operator):
    bl_idname = "afterlight.mend"
    bl_label = "Fix Scene for Indirect Light"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    cure: EnumProperty(
        name="Fix",
        description="What to change in the scene",
        options={"HIDDEN"},
        items=[(name, fix.button, fix.tooltip) for name, fix in FIXES.items()],
    )

    @classmethod
    def description(cls, _context, properties):
        return say(FIXES[properties.cure].tooltip)

    def execute(self, context):
        FIXES[self.cure].apply(context)
        return {"FINISHED"}


class AFTERLIGHT_OT_repair(OnEditableScene, Operator):
    bl_idname = "afterlight.repair"
    bl_label = "Repair Indirect Light"
    bl_description = "Restore the helper scene, passes and compositor nodes that Indirect Light needs"

    @classmethod
    def poll(cls, context):
        if not super().poll(context):
            return False
        if not context.scene.afterlight.enabled:
            cls.poll_message_set(say("Enable Indirect Light first"))
            return False
        return True

    def execute(self, context):
        setup.connect(context.scene)
        for fault in faults.find(context.scene):
            self.report({"WARNING"}, fault)
        return {"FINISHED"}


class AFTERLIGHT_OT_help(Operator):
    bl_idname = "afterlight.help"
    bl_label = "Indirect Light Help"
    bl_description = "Open the help page of this version in the web browser. No internet connection is needed"

    section: StringProperty(name="Section", description="Section to open", options={"HIDDEN", "SKIP_SAVE"})

    def execute(self, _context):
        webbrowser.open(help_page.address(self.section))
        # Some browsers may not read the folder of extensions, and give no error that Python could see.
        self.report({"INFO"}, say("Help page: {}", help_page.PATH))
        return {"FINISHED"}


# The folder of our presets, in each of Blender's folders for presets.
SUBDIR = "afterlight"
# Presets that come with the add-on. The numbers are the means of docs/measured/accuracy.md, of light and of frames.
PRESETS = Path(__file__).resolve().parents[1] / "presets" / "afterlight"
TOOLTIPS = {
    "draft": lambda: say(
        "For lighting a shot: up to 4 views, 3 bounces. In the sample scenes the indirect light has an error of 14 %; "
        "EEVEE's ray tracing has 61 % at its best. Without a graphics card a frame takes 2.5 times as long as EEVEE "
        "alone with 16 samples"
    ),
    "paper": lambda: say(
        "The published method: one bounce between surfaces that the camera sees, without occlusion or further views. "
        "In the sample scenes the indirect light has an error of 60 %; a frame takes little longer than with EEVEE "
        "alone"
    ),
    "production": lambda: say(
        "For final images: up to 7 views, 4 bounces. In the sample scenes the indirect light has an error of 10 %; "
        "EEVEE's ray tracing has 61 % at its best. Without a graphics card a frame takes 3.2 times as long as EEVEE "
        "alone with 16 samples"
    ),
    "reference": lambda: say(
        "Ground truth for comparing presets: up to 9 views, 8 bounces, four times the draws, full resolution"
    ),
}


class AFTERLIGHT_OT_preset(OnEditableScene, Operator):
    """Blender's own operator for presets, with tooltips, with limits to what it runs, and without half a preset."""

    bl_idname = "afterlight.preset"
    bl_label = "Load Indirect Light Preset"
    bl_description = "Load the settings of this preset. Strength, Viewport and the seed are kept"
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
                    '"{}" is not in a folder of Indirect Light presets and was not run. Choose a preset from the list '
                    "in the panel",
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
                    "The preset has an error and no setting was changed: {}",
                    f"{type(error).__name__}: {error}",
                ),
            )
            return {"CANCELLED"}
        bpy.types.AFTERLIGHT_PT_presets.bl_label = bpy.path.display_name(Path(self.filepath).name, title_case=False)
        return {"FINISHED"}


class AFTERLIGHT_OT_preset_add(AddPresetBase, Operator):
    bl_idname = "afterlight.preset_add"
    bl_label = "Add Indirect Light Preset"
    bl_description = "Save the Indirect Light settings as a preset, or remove a preset"
    preset_menu = "AFTERLIGHT_PT_presets"
    preset_subdir = SUBDIR
    preset_defines = ["settings = bpy.context.scene.afterlight"]
    preset_values = [f"settings.{parameter.name}" for parameter in PARAMETERS if parameter.in_presets]

    def execute(self, context):
        """Like Blender's own, but names cannot be paths to other files, and a full disk gives a message."""
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
                    "The preset could not be saved ({}). Free some space on the disk of Blender's user folder, or "
                    "make the folder writable",
                    error,
                ),
            )
            return {"CANCELLED"}

    def _file(self):
        return bpy.utils.preset_find(self.as_filename(self.name), SUBDIR)


def _is_preset(path):
    """Whether a path is that of a file in one of the folders of our presets. Links are followed."""
    path = Path(path).resolve()
    return (
        path.suffix == ".py"
        and path.is_file()
        and any(path.parent == Path(folder).resolve() for folder in bpy.utils.preset_paths(SUBDIR))
    )


CLASSES = (
    AFTERLIGHT_OT_mend,
    AFTERLIGHT_OT_repair,
    AFTERLIGHT_OT_help,
    AFTERLIGHT_OT_preset,
    AFTERLIGHT_OT_preset_add,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
