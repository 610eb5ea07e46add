# SPDX-License-Identifier: GPL-3.0-or-later
"""The one table of parameters: Blender's properties, the uniforms and the tooltips all come from it."""

from dataclasses import dataclass, field

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
    StringProperty,
)

from . import gather
from .compositor import setup, view_scenes
from .host import render_lock, report, roles

VERSION = 0, 4, 0  # the manifest's; what older ones stored otherwise: migration.py


@dataclass(frozen=True)
class Parameter:
    """One setting that a person can change. `options` go to Blender's property as they are. docs/help.html has a
    section with the id `name`."""

    name: str
    kind: callable
    label: str
    tooltip: str
    options: dict = field(default_factory=dict)

    def blender_property(self):
        return self.kind(name=self.label, description=self.tooltip, **{"update": _show} | self.options)


def _show(settings, _context):
    """What lit viewports show has changed: Blender does not know that they depend on it."""
    if settings.enabled and settings.use_viewport:
        from .viewport import draw_handlers  # which needs the settings

        draw_handlers.redraw()


def _rewire(settings, context):
    """The number of views has changed."""
    setup.connect_if_enabled(settings.id_data)
    _show(settings, context)


DEFAULT_VIEWS = "AUTOMATIC"
START = {"FULL": 1, "HALF": 2, "QUARTER": 4}

PARAMETERS = (
    Parameter(
        "method",
        EnumProperty,
        "Method",
        "How the light is gathered: how close it comes to Cycles, and what it costs",
        {
            "default": "RADIOSITY",
            "options": set(),
            "update": _rewire,
            "items": (
                (
                    "PAPER",
                    "Paper",
                    "One bounce between the surfaces that the camera sees, through whatever stands between "
                    "them: the fastest",
                    0,
                ),
                (
                    "RADIOSITY",
                    "Radiosity",
                    "Several bounces between the surfaces that all views see, which hide one another: "
                    "the closest to Cycles",
                    1,
                ),
            ),
        },
    ),
    Parameter(
        "strength",
        FloatProperty,
        "Strength",
        "Scales the indirect light in the picture. 1 is what the light really does; it is a factor on linear light, "
        "so exposure and view transform do not change its meaning. Costs nothing",
        {"default": 1.0, "min": 0.0, "soft_max": 2.0, "max": 100.0, "precision": 3, "step": 1},
    ),
    Parameter(
        "start",
        EnumProperty,
        "Start Resolution",
        "Finest resolution at which light is gathered. Each step up costs four times as much and sharpens the light "
        "near edges and contacts; it does not change how bright the light is",
        {
            "default": "HALF",
            "items": (
                ("QUARTER", "Quarter", "One texel for 4 x 4 pixels: the fastest, softest near contacts", 0),
                ("HALF", "Half", "One texel for 2 x 2 pixels: four times the cost of Quarter", 1),
                ("FULL", "Full", "One texel a pixel: sixteen times the cost of Quarter", 2),
            ),
        },
    ),
    Parameter(
        "samples",
        IntProperty,
        "Samples",
        "Random samples a texel takes at the finest level, twice as many at each coarser one, where noise shows most. "
        "Time grows in proportion, noise falls with the square root. Where the radius holds fewer texels than that, "
        "each is visited once and there is no noise at all",
        {"default": 256, "min": 16, "max": 1024, "soft_min": 16, "soft_max": 1024},
    ),
    Parameter(
        "radius",
        IntProperty,
        "Radius",
        "Radius of the disk that is sampled at each level, in texels of that level. Larger is closer to the exact "
        "sum over all pixels, but the same samples are spread over more texels and the light gets noisier. Time "
        "depends on the samples far more than on this",
        {"default": 16, "min": 2, "max": 64, "soft_min": 4, "soft_max": 32, "subtype": "PIXEL"},
    ),
    Parameter(
        "draws",
        IntProperty,
        "Draws",
        "Emitters that a texel looks at, each chosen among sixteen. Time grows in proportion, noise falls with "
        "the square "
        "root",
        {"default": 16, "min": 1, "max": gather.MOST_GROUPS, "soft_min": 4},
    ),
    Parameter(
        "bounces",
        IntProperty,
        "Bounces",
        "How often light is passed on from surface to surface. Rooms with bright walls want more. Each adds a little "
        "time, the same for pictures of any size",
        {"default": 4, "min": 1, "max": 8},
    ),
    Parameter(
        "use_visibility",
        BoolProperty,
        "Visibility",
        "Let surfaces hide what lies behind them. Without, light passes through everything, rooms with furniture "
        "get too "
        "bright, and the gather takes about half the time",
        {"default": True},
    ),
    Parameter(
        "use_world_shadow",
        BoolProperty,
        "Shadow World",
        "Take the light of the world away where surfaces stand before it: EEVEE lets it shine through walls. For "
        "worlds of "
        "one colour or of an environment picture; needs Visibility, and costs nothing",
        {"default": True},
    ),
    Parameter(
        "use_glossy",
        BoolProperty,
        "Glossy Light",
        "Let glossy surfaces reflect the bounced light, and the surfaces that the views show. Takes about half as much "
        "time again as the gather without it, and three more passes of EEVEE",
        {"default": False, "options": set(), "update": _rewire},
    ),
    Parameter(
        "views",
        EnumProperty,
        "Views",
        "Which cameras see the surfaces that send light: what none of them sees sends none. Each further view "
        "costs the "
        "time of one sample of EEVEE",
        {
            "default": DEFAULT_VIEWS,
            "options": set(),
            "update": _rewire,
            "items": (
                ("CAMERA", "Camera Only", "Only the picture itself: the fastest, without light from outside it", 0),
                ("AUTOMATIC", "Automatic", "Views are placed in every shot where they see most of what is missing", 1),
                ("MANUAL", "Manual", "The cameras that you list", 2),
            ),
        },
    ),
    Parameter(
        "view_count",
        IntProperty,
        "Views at Most",
        "How many views are placed at most. Fewer are placed, at less cost, where a further one would see little "
        "that is "
        "new",
        {"default": 7, "min": 1, "max": view_scenes.MAX_VIEWS, "options": set(), "update": _rewire},
    ),
    Parameter(
        "use_history",
        BoolProperty,
        "Average Frames",
        "In animations, average the light of each frame with that of the frames before, wherever they show the "
        "same surface. "
        "Noise falls to a third and costs no time, but for a render's first frame, which takes nine gathers "
        "instead of one. Light "
        "that changes arrives within a few frames. Single renders are as they are without",
        {"default": True, "options": set(), "update": _rewire},
    ),
    Parameter(
        "accumulate",
        IntProperty,
        "Accumulate",
        "Gathers that each picture is the mean of. Time grows in proportion, noise falls with the square root",
        {"default": 1, "min": 1, "max": 256, "soft_max": 64},
    ),
    Parameter(
        "denoise",
        EnumProperty,
        "Denoise",
        "How noise is taken out of the light. Costs little beside the gather",
        {
            "default": "SMOOTH",
            "options": set(),
            "update": _rewire,
            "items": (
                ("NONE", "None", "Leave it as it was drawn", 0),
                ("SMOOTH", "Smooth", "Average neighbouring texels along surfaces", 1),
                (
                    "NODE",
                    "Denoise Node",
                    "Blender's Denoise node on the light alone, in the compositor. A tenth closer than Smooth where "
                    "Start Resolution is Full; it leaves the noise of coarser ones",
                    2,
                ),
            ),
        },
    ),
    Parameter(
        "seed",
        IntProperty,
        "Seed",
        "Pattern of the random samples. The same seed gives the same picture, bit for bit. Costs nothing. Without "
        "effect where there are so many samples that there is no noise",
        {"default": 0, "min": 0, "max": 2**31 - 1},
    ),
    Parameter(
        "use_animated_seed",
        BoolProperty,
        "Animate Seed",
        "Use another pattern in every frame, so that the noise does not stick to the picture as the camera moves. "
        "Costs nothing",
        {"default": False},
    ),
)


def light_settings(settings, frame, goes_on=False):
    """The user's settings as the algorithm takes them: gather.Settings of the method Paper, gather.Draws of Radiosity.
    `frame` is the frame number, for an animated seed, as frames need whose average goes on from one to the next."""
    common = {
        "start": START.get(settings.start, START["HALF"]),  # a newer version's file may hold others
        "strength": settings.strength,
        "seed": settings.seed + frame * 7919 if settings.use_animated_seed or goes_on else settings.seed,
    }
    if settings.method == "PAPER":
        return gather.Settings(samples=settings.samples, radius=settings.radius, **common)
    return gather.Draws(
        groups=settings.draws,
        bounces=settings.bounces,
        visibility=settings.use_visibility,
        gathers=settings.accumulate,
        smooth=settings.denoise == "SMOOTH",
        **common,
    )


def is_stored(settings):
    """Whether the file holds anything of Afterlight for this scene: nothing of scenes where nobody has touched it."""
    return any(map(settings.is_property_set, ("enabled", *(parameter.name for parameter in PARAMETERS))))


def store_all(settings, values=None):
    """Write down the settings that still are at their defaults: with `values` by name where given, else as they are.

    Blender stores only what was set; a default that another version changes would change the pictures of old files."""
    for parameter in PARAMETERS:
        if not settings.is_property_set(parameter.name):
            setattr(settings, parameter.name, (values or {}).get(parameter.name, getattr(settings, parameter.name)))


def stamp(settings):
    """Make settings say that they are this version's, unless they are a newer one's."""
    if tuple(settings.version) <= VERSION:
        store_all(settings)
        settings.version = VERSION


def _switch(settings, _context):
    scene = settings.id_data
    if roles.is_helper(
        scene
    ):  # a script that ticks the box of all scenes does not mean those that only serve to light one
        if settings.enabled:
            settings.enabled = False
        return
    if scene.library is None and not render_lock.postpones(scene):
        stamp(settings)
        (setup.connect if settings.enabled else setup.disconnect)(scene)
    _switch_viewports(settings, _context)


def _switch_viewports(settings, _context):
    from .viewport import draw_handlers  # which needs the settings

    draw_handlers.switched(settings.id_data)


def _listed(view, context):
    _rewire(view.id_data.afterlight, context)


class AfterlightView(bpy.types.PropertyGroup):
    """A camera that the user lists as a view."""

    camera: PointerProperty(
        type=bpy.types.Object,
        name="Camera",
        update=_listed,
        poll=lambda _view, thing: thing.type == "CAMERA",
        description="A camera that sees surfaces which light the picture. The place of a lamp is a good one",
    )


class AfterlightViewScene(bpy.types.PropertyGroup):
    scene: PointerProperty(type=bpy.types.Scene)


class AfterlightSettings(bpy.types.PropertyGroup):
    """`scene.afterlight`. What the user sets is in PARAMETERS; the rest is what the wiring must remember."""

    enabled: BoolProperty(
        name="Indirect Light",
        options=set(),
        update=_switch,
        description="Add one bounce of indirect light to EEVEE's renders, gathered from the passes of the finished "
        "frame. To fade it in an animation, put keyframes on Strength",
    )
    use_viewport: BoolProperty(
        name="Viewport",
        options=set(),
        update=_switch_viewports,
        description="Show the indirect light in viewports with rendered shading, while you work. "
        "Each change draws EEVEE's passes "
        "again, five small pictures; at rest the light is gathered as a render does until its noise is gone, and then "
        "nothing more is drawn. Glossy light is left to renders",
    )
    report: StringProperty(
        name="Last Render",
        get=lambda settings: report.message(settings.id_data),
        description="What kept the last render of this scene from being lit, empty where nothing did",
    )

    version: IntVectorProperty(
        size=3,
        default=(0, 1, 0),
        options={"HIDDEN"},
        description="The version of Afterlight that these settings are of. 0.1.0 stored none",
    )
    role: StringProperty(
        options={"HIDDEN"},
        description="How this scene helps to light another: HELPER, SCOUT or VIEW. Empty in scenes of the user's own",
    )
    serves: PointerProperty(
        type=bpy.types.Scene, options={"HIDDEN"}, description="The scene that this one helps to light"
    )
    own_camera: PointerProperty(
        type=bpy.types.Object, options={"HIDDEN"}, description="The camera that Afterlight made for this scene"
    )
    helper: PointerProperty(
        type=bpy.types.Scene,
        options={"HIDDEN"},
        description="The scene through which Blender calls Afterlight while it renders this one",
    )
    view_cameras: CollectionProperty(
        type=AfterlightView, name="Cameras", description="The views, where they are manual"
    )
    view_camera: IntProperty(name="Active Camera", options={"HIDDEN"})
    view_scenes: CollectionProperty(type=AfterlightViewScene, options={"HIDDEN"})
    own_tree: PointerProperty(
        type=bpy.types.NodeTree,
        options={"HIDDEN"},
        description="The compositor tree Afterlight made where the scene had none in use",
    )
    set_aside: PointerProperty(
        type=bpy.types.NodeTree,
        options={"HIDDEN"},
        description="The user's own compositor tree, while compositing was switched off for it",
    )
    compositing_was_off: BoolProperty(options={"HIDDEN"})
    holds_lines: BoolProperty(options={"HIDDEN"}, description="Freestyle is off only until the light has been updated")


class AfterlightLayer(bpy.types.PropertyGroup):
    """`view_layer.afterlight`."""

    passes: StringProperty(
        options={"HIDDEN"},
        description="Switches of the passes that Afterlight turned on in this view layer, with commas between them",
    )


AfterlightSettings.__annotations__.update((parameter.name, parameter.blender_property()) for parameter in PARAMETERS)


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
