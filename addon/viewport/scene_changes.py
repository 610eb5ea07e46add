# SPDX-License-Identifier: GPL-3.0-or-later
"""What has changed in a scene since its viewports were lit, counted from Blender's dependency graph in two kinds: if
only lights changed, the surfaces are where they were."""

from dataclasses import dataclass, replace

from bpy.app.handlers import persistent

from ..host import events

LIGHT_TYPES = {"LIGHT", "WORLD"}


@dataclass(frozen=True)
class ChangeCounts:
    """How often something of each kind has changed."""

    lights: int = 0
    geometry: int = 0


_counts = {}  # by the scene's session_uid; global, since all viewports of a scene ask
_states = {}  # last result of _state(), by the same; global like the counts


def change_counts(scene):
    """ChangeCounts of a scene."""
    return _counts.setdefault(scene.session_uid, ChangeCounts())


@persistent
def follow_edits(scene, depsgraph):
    """Handler: Blender has evaluated what was edited."""
    if depsgraph.mode == "RENDER" or not (scene.afterlight.enabled and scene.afterlight.use_viewport):
        return
    changed = [
        update.id.original
        for update in depsgraph.updates
        if update.id.id_type != "SCENE"  # a scene is reported for a change of any setting
        and (update.is_updated_geometry or update.is_updated_transform or update.is_updated_shading)
    ]
    state = _state(scene, depsgraph)
    lights = [each for each in changed if _is_light(each)]
    trees = [each.node_tree for each in lights if each.id_type in LIGHT_TYPES]
    if any(each not in lights and each not in trees for each in changed) or _states.get(scene.session_uid) not in (
        None,
        state,
    ):
        _count(scene, "geometry")
    elif changed:
        _count(scene, "lights")
    _states[scene.session_uid] = state


@persistent
def follow_frames(scene, *_):
    """Handler: another frame is shown."""
    _count(scene, "geometry")


@persistent
def forget(*_):
    _counts.clear()
    _states.clear()


def _count(scene, kind):
    counts = change_counts(scene)
    _counts[scene.session_uid] = replace(counts, **{kind: getattr(counts, kind) + 1})


def _is_light(datablock):
    return datablock.id_type in LIGHT_TYPES or (datablock.id_type == "OBJECT" and datablock.type == "LIGHT")


def _state(scene, depsgraph):
    """What can change without an update of geometry, transform or shading: which objects are visible, and EEVEE's
    settings."""
    eevee, layer = scene.eevee, depsgraph.view_layer
    return (
        hash(tuple(each.session_uid for each in layer.objects if each.visible_get(view_layer=layer))),
        scene.world and scene.world.session_uid,
        *(
            getattr(eevee, each.identifier)
            for each in eevee.bl_rna.properties
            if each.type in {"BOOLEAN", "INT", "FLOAT", "ENUM"} and not getattr(each, "is_array", False)
        ),
    )


HANDLERS = (("depsgraph_update_post", follow_edits), ("frame_change_post", follow_frames), ("load_post", forget))


def register():
    events.listen(HANDLERS)


def unregister():
    events.ignore(HANDLERS)
    forget()
