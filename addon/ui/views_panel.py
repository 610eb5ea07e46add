# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel Views: which views there are, how much of the light they see, and the buttons of the list."""

import bpy
import numpy as np
from bpy.types import Operator, Panel, UIList
from mathutils import Matrix

from .. import parameters
from ..compositor import setup, view_scenes
from ..host import report
from ..scene import needs, view_cameras
from ..translations import say
from .drawing import InRenderProperties, draw_settings, draw_text, draw_value
from .operators import OnEditableScene


class AFTERLIGHT_UL_views(UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property):
        problem = view_cameras.unusable(item.camera)
        layout.prop(item, "camera", text="", emboss=False, icon="ERROR" if problem else "CAMERA_DATA")


class AFTERLIGHT_PT_views(InRenderProperties, Panel):
    bl_label = "Views"
    bl_parent_id = "AFTERLIGHT_PT_indirect_light"
    bl_order = 2

    @classmethod
    def poll(cls, context):
        return super().poll(context) and bool(parameters.rows(context.scene.afterlight, parameters.VIEWS))

    def draw(self, context):
        layout, scene = self.layout, context.scene
        settings = scene.afterlight
        layout.use_property_split, layout.use_property_decorate = True, False
        layout.active = settings.enabled
        draw_settings(layout.column(), settings, parameters.VIEWS)
        if settings.views == "AUTOMATIC":
            layout.operator("afterlight.place_views")
        elif settings.views == "MANUAL":
            row = layout.row()
            row.template_list("AFTERLIGHT_UL_views", "", settings, "view_cameras", settings, "view_camera", rows=3)
            column = row.column(align=True)
            column.operator("afterlight.view_add", icon="ADD", text="")
            column.operator("afterlight.view_remove", icon="REMOVE", text="")
        if settings.views != "CAMERA" and (found := report.coverage(scene)):
            shares, seconds = found
            column = layout.column(align=True)
            draw_value(column, say("Seen by the Camera"), f"{shares[0]:.0%}")
            draw_value(column, say("Seen with {} Views", len(shares) - 1), f"{shares[-1]:.0%}")
            draw_value(column, say("Placing"), f"{seconds:.2f} s")
        for text in report.warnings(scene):
            draw_text(layout, text, "INFO", context)


class AFTERLIGHT_OT_place_views(OnEditableScene, Operator):
    bl_idname = "afterlight.place_views"
    bl_label = "Keep Views as Cameras"
    bl_description = (
        "Create a camera for each automatic view of the last render and set Views to Manual with these cameras, so "
        "that you can adjust them. From then on all frames have the same views, on every computer of a render farm"
    )

    @classmethod
    def poll(cls, context):
        if not super().poll(context):
            return False
        found = view_scenes.stored_placement(context.scene) if view_scenes.placement_scene(context.scene) else None
        if found is None or not found.poses:
            cls.poll_message_set(
                say("No views have been placed in this scene yet. Set Views to Automatic and press F12")
            )
            return False
        return True

    def execute(self, context):
        scene = context.scene
        found, settings = view_scenes.stored_placement(scene), scene.afterlight
        collection = bpy.data.collections.new(f"{scene.name}: {say('Views')}")
        scene.collection.children.link(collection)
        settings.view_cameras.clear()
        for index, pose in enumerate(found.poses, 1):
            data = bpy.data.cameras.new(f"{say('View')} {index}")
            data.angle, data.clip_start = view_cameras.FIELD, found.clearance / 4
            data.clip_end = max(data.clip_end, scene.camera.data.clip_end if scene.camera else 0)
            camera = bpy.data.objects.new(data.name, data)
            camera.matrix_world = Matrix(np.asarray(pose).tolist())
            collection.objects.link(camera)
            settings.view_cameras.add().camera = camera
        settings.views = "MANUAL"
        return {"FINISHED"}


class AFTERLIGHT_OT_view_add(OnEditableScene, Operator):
    bl_idname = "afterlight.view_add"
    bl_label = "Add View"
    bl_description = "Add the selected cameras to the list of views, or an empty slot if no camera is selected"

    @classmethod
    def poll(cls, context):
        if not super().poll(context):
            return False
        if len(context.scene.afterlight.view_cameras) >= needs.MAX_VIEWS:
            cls.poll_message_set(say("There can be at most {} views. Remove one first", needs.MAX_VIEWS))
            return False
        return True

    def execute(self, context):
        scene, settings = context.scene, context.scene.afterlight
        listed = {each.camera for each in settings.view_cameras} | {scene.camera}
        chosen = [thing for thing in context.selected_objects if thing.type == "CAMERA" and thing not in listed]
        for camera in (chosen or [None])[: needs.MAX_VIEWS - len(settings.view_cameras)]:
            settings.view_cameras.add().camera = camera
        settings.view_camera = len(settings.view_cameras) - 1
        setup.connect_if_enabled(scene)
        return {"FINISHED"}


class AFTERLIGHT_OT_view_remove(OnEditableScene, Operator):
    bl_idname = "afterlight.view_remove"
    bl_label = "Remove View"
    bl_description = "Remove the active camera from the list of views. It stays in the scene"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and len(context.scene.afterlight.view_cameras) > 0

    def execute(self, context):
        settings = context.scene.afterlight
        settings.view_cameras.remove(min(settings.view_camera, len(settings.view_cameras) - 1))
        settings.view_camera = max(0, settings.view_camera - 1)
        setup.connect_if_enabled(context.scene)
        return {"FINISHED"}


CLASSES = (
    AFTERLIGHT_UL_views,
    AFTERLIGHT_PT_views,
    AFTERLIGHT_OT_place_views,
    AFTERLIGHT_OT_view_add,
    AFTERLIGHT_OT_view_remove,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
