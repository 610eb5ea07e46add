# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes of a view layer: Afterlight switches on those that it reads, and off again when nobody needs them."""

from ..host.assign import assign
from ..scene import needs, passes, roughness, transmittance
from ..scene.passes import MOTION, PASSES, needed
from . import freestyle, nodes
from .nodes import MARK

_ALL = dict(
    (
        *((switch, name) for _, switch, name, _ in (*PASSES, MOTION)),
        roughness.COLOR,
        roughness.DIRECT,
        roughness.MATERIAL,
        *transmittance.PASSES,
        freestyle.LINE_PASS,
    )
)


def for_gather(scene, layer):
    """(switch, pass) of each pass of a view layer that the gather reads. switch: property path from the view layer."""
    settings = scene.afterlight
    is_glossy = settings.use_glossy and needs.has_views(settings)
    return [
        *((switch, name) for _, switch, name, _ in needed(settings)),
        *(roughness.needed(layer) if is_glossy else ()),
    ]


def wanted(scene, layer):
    """(switch, pass) of each pass of a view layer that Afterlight reads."""
    return [*for_gather(scene, layer), *transmittance.needed(scene), *freestyle.needed(scene, layer)]


def switch(scene, layer, needed_passes):
    """Switch on the needed passes, (switch, pass) each, and off those that we once switched on and that are no longer
    needed, except for passes that the user's own nodes have come to use."""
    ours, needed_paths = _ours(layer), {path for path, _ in needed_passes}
    no_longer_needed = ours - needed_paths
    used = nodes.used_passes(scene, layer.name) if no_longer_needed else ()
    for path, name in _ALL.items():
        if path in needed_paths and not passes.is_on(layer, path):
            ours.add(path)
            passes.set_enabled(layer, path, True)
        elif path in no_longer_needed and name not in used:
            passes.set_enabled(layer, path, False)
    assign(layer.afterlight, "passes", ",".join(sorted(ours - no_longer_needed)))


def adopt(scene):
    """Take over the record of a file from 0.1.0 to 0.3.0: a custom property that lists switches."""
    for layer in scene.view_layers:
        paths = layer.get(MARK)
        if isinstance(paths, list) and paths and all(isinstance(path, str) and path in _ALL for path in paths):
            assign(layer.afterlight, "passes", ",".join(paths))
            del layer[MARK]


def _ours(layer):
    return set(_ALL).intersection(layer.afterlight.passes.split(","))
