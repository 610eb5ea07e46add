# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of settings. Its order is that of the panel and of docs/help.html.

An entry is all that a new setting needs besides its use: Blender's property (properties.py), its row in the panel,
reset, copy, presets, the link to the help and the value for the GPU come from here. Nothing is registered here.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from . import gather
from .scene import needs

MAIN, SAMPLING, VIEWS = "MAIN", "SAMPLING", "VIEWS"  # the panel and its sub-panels
LIGHT, NODES, VIEWPORTS = "LIGHT", "NODES", "VIEWPORTS"  # what a change of a setting changes

# The type of gather's settings, by method.
GATHER_SETTINGS = {"PAPER": gather.PaperSettings, "RADIOSITY": gather.RadiositySettings}
DEFAULT_METHOD = "RADIOSITY"
PAPER, RADIOSITY = frozenset({"PAPER"}), frozenset({"RADIOSITY"})
SEED_STEP = 7919  # from frame to frame; far more than the seeds that one frame derives from its own, by adding


@dataclass(frozen=True)
class Parameter:
    """One setting.

    name: its identifier in Python and in files, and the id of its section in docs/help.html. kind: Blender's function
    for such properties. label, tooltip: what the user reads. options: arguments of `kind`.

    panel: which panel its row is in. methods: those in which it has an effect; in others the row is hidden. active:
    whether it has an effect, given the scene's settings; where it has none the row is greyed out. effect: what a
    change of it changes. in_presets: whether presets store it. gather_field: which field of gather's settings it fills,
    if any; convert: the function from the property's value to that of the field.
    """

    name: str
    kind: Callable
    label: str
    tooltip: str
    options: dict[str, Any] = field(default_factory=dict)
    panel: str = SAMPLING
    methods: frozenset[str] = PAPER | RADIOSITY
    active: Callable[[Any], bool] = lambda _settings: True
    effect: str = LIGHT
    in_presets: bool = True
    gather_field: str = ""
    convert: Callable[[Any], Any] = lambda value: value

    @property
    def is_animatable(self) -> bool:
        """Whether it takes keyframes and drivers. Nodes and passes are those of the render's beginning."""
        return self.effect == LIGHT


PARAMETERS = (
    Parameter(
        "method",
        EnumProperty,
        "Method",
        "How indirect light is computed. Determines accuracy and render time",
        {
            "default": DEFAULT_METHOD,
            "items": (
                (
                    "PAPER",
                    "Paper",
                    "One bounce between surfaces that the camera sees, without occlusion. Fastest",
                    0,
                ),
                (
                    "RADIOSITY",
                    "Radiosity",
                    "Several bounces between surfaces that any of the views sees, with occlusion. Closest to Cycles",
                    1,
                ),
            ),
        },
        panel=MAIN,
        effect=NODES,
    ),
    Parameter(
        "strength",
        FloatProperty,
        "Strength",
        "Factor on the indirect light. 1 is physically correct. It is applied to linear light, so exposure and view "
        "transform do not change its meaning. No cost",
        {"default": 1.0, "min": 0.0, "soft_max": 2.0, "max": 100.0, "precision": 3, "step": 1},
        panel=MAIN,
        in_presets=False,
        gather_field="strength",
    ),
    Parameter(
        "use_viewport",
        BoolProperty,
        "Viewport",
        "Show indirect light in viewports with Rendered shading. After each change EEVEE's passes are drawn again as "
        "five small images and the light is refined until it is free of noise; after that there is no cost. Glossy "
        "Light is not shown",
        {"default": False},
        panel=MAIN,
        effect=VIEWPORTS,
        in_presets=False,
    ),
    Parameter(
        "start",
        EnumProperty,
        "Start Resolution",
        "Finest resolution at which indirect light is computed. Each step up takes four times as long and sharpens "
        "the light near edges and contacts. It does not change the brightness",
        {
            "default": "HALF",
            "items": (
                ("QUARTER", "Quarter", "One texel per 4 x 4 pixels. Fastest, blurry where objects touch", 0),
                ("HALF", "Half", "One texel per 2 x 2 pixels. Four times the cost of Quarter", 1),
                ("FULL", "Full", "One texel per pixel. Sixteen times the cost of Quarter", 2),
            ),
        },
        gather_field="start",
        convert=lambda start: {"FULL": 1, "HALF": 2, "QUARTER": 4}.get(start, 2),  # a newer file may hold others
    ),
    Parameter(
        "samples",
        IntProperty,
        "Samples",
        "Random samples per texel at the finest level, twice as many at each coarser level, where noise is most "
        "visible. Time is proportional, noise falls with the square root. Where the radius holds fewer texels, each "
        "is sampled once and there is no noise",
        {"default": 256, "min": 16, "max": 1024, "soft_min": 16, "soft_max": 1024},
        methods=PAPER,
        gather_field="samples",
    ),
    Parameter(
        "radius",
        IntProperty,
        "Radius",
        "Radius of the disk that is sampled at each level, in texels of that level. A larger radius is closer to the "
        "exact sum over all pixels but noisier, since the samples are spread over more texels. Time depends mostly on "
        "Samples",
        {"default": 16, "min": 2, "max": 64, "soft_min": 4, "soft_max": 32, "subtype": "PIXEL"},
        methods=PAPER,
        gather_field="radius",
    ),
    Parameter(
        "draws",
        IntProperty,
        "Draws",
        "Visibility-tested light samples per texel; each is picked from 16 candidates. Time is proportional, noise "
        "falls with the square root",
        {"default": 16, "min": 1, "max": gather.MAX_GROUPS, "soft_min": 4},
        methods=RADIOSITY,
        gather_field="groups",
    ),
    Parameter(
        "accumulate",
        IntProperty,
        "Accumulate",
        "Number of independent gathers averaged per frame. Time is proportional, noise falls with the square root",
        {"default": 1, "min": 1, "max": 256, "soft_max": 64},
        methods=RADIOSITY,
        gather_field="gathers",
    ),
    Parameter(
        "use_history",
        BoolProperty,
        "Average Frames",
        "In animations, average the light of each frame with that of the frames before, where they show the same "
        "surface. Noise falls to a third at no cost, except for the first frame of a render, which takes nine gathers "
        "instead of one. Changes of the light take a few frames to show in full. Single renders are not affected",
        {"default": True},
        methods=RADIOSITY,
        effect=NODES,
    ),
    Parameter(
        "denoise",
        EnumProperty,
        "Denoise",
        "How noise is removed from the indirect light. Takes little time compared to the gather",
        {
            "default": "SMOOTH",
            "items": (
                ("NONE", "None", "Leave the noise in", 0),
                ("SMOOTH", "Smooth", "Average neighboring texels along surfaces", 1),
                (
                    "NODE",
                    "Denoise Node",
                    "Blender's Denoise node for the indirect light, in the compositor. The error is a tenth lower than "
                    "with Smooth if Start Resolution is Full. Noise of coarser resolutions remains",
                    2,
                ),
            ),
        },
        methods=RADIOSITY,
        effect=NODES,
        gather_field="smooth",
        convert=lambda denoise: denoise == "SMOOTH",
    ),
    Parameter(
        "bounces",
        IntProperty,
        "Bounces",
        "Number of bounces of indirect light. Rooms with bright walls need more. Each takes a little time, regardless "
        "of the resolution. Automatic views are placed for the first 4 bounces",
        {"default": 4, "min": 1, "max": 8},
        methods=RADIOSITY,
        gather_field="bounces",
    ),
    Parameter(
        "use_visibility",
        BoolProperty,
        "Visibility",
        "Let surfaces block indirect light. Without it light passes through everything and furnished rooms get too "
        "bright, but the gather takes about half the time",
        {"default": True},
        methods=RADIOSITY,
        gather_field="visibility",
    ),
    Parameter(
        "use_world_shadow",
        BoolProperty,
        "Shadow World",
        "Let surfaces block the light of the world, which EEVEE lets through walls. Works for worlds with a single "
        "color or an environment texture. Needs Visibility. No cost",
        {"default": True},
        methods=RADIOSITY,
        active=lambda settings: settings.use_visibility,
    ),
    Parameter(
        "use_glossy",
        BoolProperty,
        "Glossy Light",
        "Let glossy surfaces reflect indirect light and the surfaces that the views see. Adds half to the time of the "
        "gather, and three passes to EEVEE",
        {"default": False},
        methods=RADIOSITY,
        effect=NODES,
    ),
    Parameter(
        "seed",
        IntProperty,
        "Seed",
        "Pattern of the noise. The same seed gives exactly the same image. Has no effect if there are enough samples "
        "to leave no noise. No cost",
        {"default": 0, "min": 0, "max": 2**31 - 1},
        active=lambda settings: has_noise(settings),
        in_presets=False,
        gather_field="seed",
    ),
    Parameter(
        "use_animated_seed",
        BoolProperty,
        "Animate Seed",
        "Change the pattern of the noise in each frame, so that it does not stick to the image when the camera moves. "
        "No cost",
        {"default": False},
        active=lambda settings: has_noise(settings),
        in_presets=False,
    ),
    Parameter(
        "views",
        EnumProperty,
        "Views",
        "Which cameras capture light-emitting surfaces. Surfaces that no camera sees emit nothing. Each further view "
        "costs the time of one EEVEE sample",
        {
            "default": "AUTOMATIC",
            "items": (
                ("CAMERA", "Camera Only", "The scene's camera alone. Fastest, without light from outside the image", 0),
                ("AUTOMATIC", "Automatic", "Place further views in each shot where they capture most missing light", 1),
                ("MANUAL", "Manual", "The cameras in the list", 2),
            ),
        },
        panel=VIEWS,
        methods=RADIOSITY,
        effect=NODES,
    ),
    Parameter(
        "view_count",
        IntProperty,
        "Views at Most",
        "Maximum number of automatic views. Fewer are placed, at less cost, if another one would capture little new "
        "light",
        {"default": 7, "min": 1, "max": needs.MAX_VIEWS},
        panel=VIEWS,
        methods=RADIOSITY,
        active=lambda settings: settings.views == "AUTOMATIC",
        effect=NODES,
    ),
)


def method_of(settings):
    """The method of a scene's settings, the default where a newer version's file holds another."""
    return settings.method if settings.method in GATHER_SETTINGS else DEFAULT_METHOD


def rows(settings, panel):
    """The parameters that a panel shows with the method that is set."""
    method = method_of(settings)
    return [parameter for parameter in PARAMETERS if parameter.panel == panel and method in parameter.methods]


def light_settings(settings, frame, goes_on=False):
    """A scene's settings as gather takes them, of the type in GATHER_SETTINGS.

    frame: its number. goes_on: whether the frame is averaged with others, which need seeds of their own."""
    method = method_of(settings)
    values = {
        each.gather_field: each.convert(getattr(settings, each.name))
        for each in PARAMETERS
        if each.gather_field and method in each.methods
    }
    if settings.use_animated_seed or goes_on:
        values["seed"] += frame * SEED_STEP
    return GATHER_SETTINGS[method](**values)


def has_noise(settings):
    """Whether the light depends on the seed."""
    return not gather.is_exact(light_settings(settings, 0))
