# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene's settings ask for. Only this module knows which settings apply to which method."""

import bpy

from .. import gather

METHOD_OF_ONE_VIEW = "PAPER"
MAX_VIEWS = gather.MAX_VIEWS - 1  # besides the main one


def has_views(settings) -> bool:
    """Whether the method gathers light from further views, in several bounces."""
    return settings.method != METHOD_OF_ONE_VIEW


def views(scene: bpy.types.Scene) -> int:
    """The number of further views that a frame of `scene` may need."""
    settings = scene.afterlight
    if not settings.enabled or settings.views == "CAMERA" or not has_views(settings):
        return 0
    return settings.view_count if settings.views == "AUTOMATIC" else min(len(settings.view_cameras), MAX_VIEWS)


def averages_frames(settings) -> bool:
    """Whether the light is averaged over the frames of an animation."""
    return settings.use_history and has_views(settings)


def glossy_light(scene: bpy.types.Scene) -> bool:
    """Whether the specular reflection of glossy surfaces is to be gathered."""
    settings = scene.afterlight
    return settings.enabled and settings.use_glossy and has_views(settings)


def denoise_node(scene: bpy.types.Scene) -> bool:
    """Whether Blender's Denoise node is to denoise the light."""
    settings = scene.afterlight
    return settings.enabled and settings.denoise == "NODE" and has_views(settings)
