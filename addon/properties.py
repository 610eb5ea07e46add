# SPDX-License-Identifier: GPL-3.0-or-later
"""What Afterlight stores in scenes and view layers: the settings of parameters.py, and records of its own."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
    StringProperty,
)

from .compositor import setup
from .host import render_lock, report, roles
from .host.version import VERSION
from .parameters import LIGHT, NODES, PARAMETERS, VIEWPORTS
from .parameters import light_settings as light_settings  # part of what this module offers

# Functions of a scene, called when the light that its viewports show has changed, and when it is to be shown or no
# longer. The viewport adds its own: it depends on the settings, not they on it.
on_change, on_switch = [], []


def is_shown(settings):
    """Whether viewports are to show the light of a scene with these settings."""
    return settings.enabled and settings.use_viewport


def announce_switch(scene):
    """Tell those who listen that viewports are to show the light of `scene`, or no longer."""
    for call in on_switch:
        call(scene)


def _light_changed(settings, _context):
    if is_shown(settings):
        for call in on_change:
            call(settings.id_data)


def _nodes_changed(settings, context):
    setup.connect_if_enabled(settings.id_data)
    _light_changed(settings, context)


def _viewports_changed(settings, _context):
    announce_switch(settings.id_data)


UPDATES = {LIGHT: _light_changed, NODES: _nodes_changed, VIEWPORTS: _viewports_changed}


def _blender_property(parameter):
    flags = {} if parameter.is_animatable else {"options": set()}
    return parameter.kind(
        name=parameter.label,
        description=parameter.tooltip,
        update=UPDATES[parameter.effect],
        **parameter.options | flags,
    )


def is_stored(settings):
    """Whether the file holds anything of Afterlight for this scene. It does as soon as somebody changes a setting."""
    return any(map(settings.is_property_set, ("enabled", *(parameter.name for parameter in PARAMETERS))))


def store_all(settings, values=None):
    """Store the settings that are still at their defaults, with the values of the dictionary `values` where it has one.

    Blender stores only what was set, and a default that a later version changes would change the look of old files."""
    for parameter in PARAMETERS:
        if not settings.is_property_set(parameter.name):
            setattr(settings, parameter.name, (values or {}).get(parameter.name, getattr(settings, parameter.name)))


def stamp(settings):
    """Mark settings as of this version, unless they are of a newer one."""
    if tuple(settings.version) <= VERSION:
        store_all(settings)
        settings.version = VERSION


def _enabled_changed(settings, _context):
    scene = settings.id_data
    if roles.is_helper(scene):  # a script that enables all scenes does not mean helper scenes
        if settings.enabled:
            settings.enabled = False
        return
    if scene.library is None and not render_lock.postpones(scene):
        stamp(settings)
        (setup.connect if settings.enabled else setup.disconnect)(scene)
    announce_switch(scene)


def _camera_listed(view, context):
    _nodes_changed(view.id_data.afterlight, context)


class AfterlightView(bpy.types.PropertyGroup):
    """A camera in the list of manual views."""

    camera: PointerProperty(
        type=bpy.types.Object,
        name="Camera",
        update=_camera_listed,
        poll=lambda _view, thing: thing.type == "CAMERA",
        description="A camera that sees surfaces which light the image. The position of a lamp is a good one",
    )


class AfterlightViewScene(bpy.types.PropertyGroup):
    scene: PointerProperty(type=bpy.types.Scene)


class AfterlightSettings(bpy.types.PropertyGroup):
    """`scene.afterlight`: the switch, the settings of PARAMETERS, the list of cameras, and records for ourselves."""

    enabled: BoolProperty(
        name="Indirect Light",
        options=set(),
        update=_enabled_changed,
        description="Add indirect light to EEVEE renders, computed from the passes of the finished frame. It cannot be "
        "animated: to fade the light, animate Strength",
    )
    report: StringProperty(
        name="Last Render",
        get=lambda settings: report.message(settings.id_data),
        description="Why the last render has no indirect light; empty if it succeeded",
    )
    view_cameras: CollectionProperty(
        type=AfterlightView, name="Cameras", description="The cameras that are used as manual views"
    )
    view_camera: IntProperty(name="Active Camera", options={"HIDDEN"})

    version: IntVectorProperty(
        size=3,
        default=(0, 1, 0),
        options={"HIDDEN"},
        description="Version of Afterlight that saved these settings. 0.1.0 stored none",
    )
    role: StringProperty(
        options={"HIDDEN"},
        description="Role of a helper scene: HELPER, SCOUT or VIEW. Empty in the user's scenes",
    )
    serves: PointerProperty(
        type=bpy.types.Scene, options={"HIDDEN"}, description="Scene that this helper scene belongs to"
    )
    own_camera: PointerProperty(
        type=bpy.types.Object, options={"HIDDEN"}, description="Camera that Afterlight created for this helper scene"
    )
    helper: PointerProperty(
        type=bpy.types.Scene,
        options={"HIDDEN"},
        description="Helper scene through which Blender calls Afterlight during a render",
    )
    view_scenes: CollectionProperty(type=AfterlightViewScene, options={"HIDDEN"})
    own_tree: PointerProperty(
        type=bpy.types.NodeTree,
        options={"HIDDEN"},
        description="Compositor tree that Afterlight created because the scene had none in use",
    )
    set_aside: PointerProperty(
        type=bpy.types.NodeTree,
        options={"HIDDEN"},
        description="The user's compositor tree, if compositing was disabled when Afterlight was enabled",
    )
    compositing_was_off: BoolProperty(options={"HIDDEN"})
    holds_lines: BoolProperty(options={"HIDDEN"}, description="Freestyle is disabled until the light has been updated")


class AfterlightLayer(bpy.types.PropertyGroup):
    """`view_layer.afterlight`."""

    passes: StringProperty(
        options={"HIDDEN"},
        description="Passes that Afterlight enabled in this view layer, separated by commas",
    )


AfterlightSettings.__annotations__.update((parameter.name, _blender_property(parameter)) for parameter in PARAMETERS)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (AfterlightView, AfterlightViewScene, AfterlightSettings, AfterlightLayer)
)


def register():
    _register_classes()
    bpy.types.Scene.afterlight = PointerProperty(type=AfterlightSettings)
    bpy.types.ViewLayer.afterlight = PointerProperty(type=AfterlightLayer)


def unregister():
    del bpy.types.ViewLayer.afterlight
    del bpy.types.Scene.afterlight
    _unregister_classes()
