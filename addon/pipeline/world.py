# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's light as EEVEE has it in Diffuse Direct: the same for all surfaces that face one way, whatever stands
before them."""

import numpy as np

from . import materials, nodes


def mirror(scene, helper):
    """Let `helper`'s depsgraph hold what shines on `scene`, so that it can be looked at as it is in a frame."""
    nodes.assign(helper, "world", scene.world)
    for layer, own in zip(scene.view_layers, helper.view_layers):
        nodes.assign(own, "world_override", layer.world_override)


def light(depsgraph):
    """(4, 3), as light.gather_views() wants it, of the world of a depsgraph's view layer; None where there is none, or
    where more than one colour decides."""
    world = depsgraph.view_layer.world_override or depsgraph.scene.world
    color = materials.plain_sky(world.evaluated_get(depsgraph)) if world else None
    return None if color is None or not any(color) else np.concatenate([[color], np.zeros((3, 3))])
