# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes of a view layer: those that Afterlight reads are switched on, and off again when nobody needs them."""

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
    """(switch, pass) of all that the gather reads of a view layer."""
    settings = scene.afterlight
    shines = settings.use_glossy and needs.has_views(settings)
    return [*((switch, name) for _, switch, name, _ in needed(settings)), *(roughness.needed(layer) if shines else ())]


def wanted(scene, layer):
    """(switch, pass) of all that is read of a view layer."""
    return [*for_gather(scene, layer), *transmittance.needed(scene), *freestyle.needed(scene, layer)]


def switch(scene, layer, read):
    """Switch on the passes in `read`, (switch, pass) each, and off those that we once switched on and that are not
    among them, but for passes that the user's own nodes have come to use."""
    ours, wanted_now = _ours(layer), {each for each, _ in read}
    unwanted = ours - wanted_now
    used = nodes.used_passes(scene, layer.name) if unwanted else ()
    for each, name in _ALL.items():
        if each in wanted_now and not passes.is_on(layer, each):
            ours.add(each)
            passes.set_enabled(layer, each, True)
        elif each in unwanted and name not in used:
            passes.set_enabled(layer, each, False)
    assign(layer.afterlight, "passes", ",".join(sorted(ours - unwanted)))


def adopt(scene):
    """Take over the record of a file of 0.1.0 to 0.3.0: a custom property that lists switches."""
    for layer in scene.view_layers:
        found = layer.get(MARK)
        if isinstance(found, list) and found and all(isinstance(each, str) and each in _ALL for each in found):
            assign(layer.afterlight, "passes", ",".join(found))
            del layer[MARK]


def _ours(layer):
    return set(_ALL).intersection(layer.afterlight.passes.split(","))
