# SPDX-License-Identifier: GPL-3.0-or-later
"""The world that a view scene is rendered with.

EEVEE takes a picture of the world for every view, in the world's own resolution, which may take longer than the view
itself. A world of one colour is the same in any resolution: for the time of a frame the view scene has a
copy of it, in the smallest one. So it has a black one where there is no world, of which EEVEE takes a picture as well.
"""

import bpy

from ..host.assign import assign
from ..host.roles import MARK
from . import materials

NAME, KIND = ".Afterlight World", "world"
RESOLUTION = "128"  # Blender's lowest


def give(view_scene: bpy.types.Scene, world: bpy.types.World | None) -> None:
    """Have a view scene rendered under `world`, as it is now. take_back() must follow."""
    take_back(view_scene)
    sky = materials.world_sky(world) if world else None
    if world and (sky is None or sky.image is not None):
        assign(view_scene, "world", world)
        return
    own = world.copy() if world else _black()
    own.name, own[MARK], own.probe_resolution = NAME, KIND, RESOLUTION
    view_scene.world = own


def take_back(view_scene: bpy.types.Scene) -> None:
    """Leave a view scene without a world, and no copy of one in the file."""
    own = view_scene.world
    assign(view_scene, "world", None)
    if own is not None and own.get(MARK) == KIND and not own.users:
        bpy.data.worlds.remove(own)


def _black():
    world = bpy.data.worlds.new(NAME)
    world.node_tree.nodes.clear()
    return world
