# SPDX-License-Identifier: GPL-3.0-or-later
"""The things that a scene's settings ask for: the one place that knows which of them a method has."""

import bpy

METHOD_OF_ONE_VIEW = "PAPER"
MAX_VIEWS = 9  # beside the main one


def has_views(settings) -> bool:
    """Whether the method takes light from further views, in several bounces."""
    return settings.method != METHOD_OF_ONE_VIEW


def views(scene: bpy.types.Scene) -> int:
    """Number of further views that a frame of `scene` may need."""
    settings = scene.afterlight
    if not settings.enabled or settings.views == "CAMERA" or not has_views(settings):
        return 0
    return settings.view_count if settings.views == "AUTOMATIC" else min(len(settings.view_cameras), MAX_VIEWS)


def averages_frames(settings) -> bool:
    """Whether the light of an animation's frames is averaged."""
    return settings.use_history and has_views(settings)


def glossy_light(scene: bpy.types.Scene) -> bool:
    """Whether the light off glossy surfaces is to be gathered."""
    settings = scene.afterlight
    return settings.enabled and settings.use_glossy and has_views(settings)


def denoise_node(scene: bpy.types.Scene) -> bool:
    """Whether Blender's Denoise node is to have the light."""
    settings = scene.afterlight
    return settings.enabled and settings.denoise == "NODE" and has_views(settings)
