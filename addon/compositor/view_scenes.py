# SPDX-License-Identifier: GPL-3.0-or-later
"""The further cameras whose pixels light the picture: a helper scene for each, and how they get into the render.

    Render Layers nodes at the top level, in the order in which Blender renders their scenes:
        scout      our engine (views_engine.py): it sees the finished main view, poses the views, and says which are
        needed view 1..n  EEVEE, each through a camera of its own (view_cameras.py), with the lit scene as background
        set
        light      our engine (engine.py): it gathers from all of them

At rest no view layer of these scenes is rendered. The scout switches on what the frame needs, reset() switches it off
again: a view that is not needed costs nothing, nor does any where the extension is missing.
"""

import bpy
import numpy as np

from ..host import engines, roles
from ..host.assign import assign
from ..host.roles import SCOUT, VIEW
from ..scene import needs, passes, roughness
from ..translations import say
from ..views import placement
from . import nodes

PLACEMENT_NAME, VIEW_NAME = ".Afterlight Views ({})", ".Afterlight View {} ({})"
MAX_VIEWS = needs.MAX_VIEWS
MAX_DISTANCE = 1e9  # metres from the world's origin that a pose may be
PLACEMENT_KEY = "placed"  # custom property of the scout's scene
SAMPLES = 1  # EEVEE's; the pixels are averaged down afterwards

# What of the lit scene decides how its surfaces look and where they are. EEVEE's own settings are mirrored all.
_RENDER = (
    "use_simplify",
    "simplify_subdivision_render",
    "simplify_child_particles_render",
    "simplify_volumes",
    "use_simplify_normals",
    "use_high_quality_normals",
    "frame_map_old",
    "frame_map_new",
    "film_transparent",
    "hair_type",
    "hair_subdiv",
    "filter_size",
    "use_texture_cache",
)
_SCENE = ("world", "frame_subframe")
_LAYER = (
    "material_override",
    "world_override",
    "use_solid",
    "use_sky",
    "use_ao",
    "use_strand",
    "use_volumes",
    "use_grease_pencil",
)
_EEVEE_OVERRIDES = {"taa_render_samples": SAMPLES, "use_raytracing": False, "use_overscan": False}


def placement_scene(scene):
    """The scene whose engine places the views of `scene`, or None."""
    return next((each for each in _own(scene) if each.afterlight.role == SCOUT), None)


def scenes(scene):
    """The scenes through which EEVEE renders the views of `scene`, in their order."""
    return [each for each in _own(scene) if each.afterlight.role == VIEW]


def connect(scene, tree, helper):
    """Make, or take away, what the views of `scene` need: their scenes, and their nodes in the compositor `tree`,
    before those of `helper`. Changes nothing that is in place already."""
    strangers = _ensure_scenes(scene)
    mirror(scene)
    ours = _own(scene)
    for node in [node for node in tree.nodes if nodes.role(node) == "view"]:
        if node.scene is None or node.scene in strangers:
            tree.nodes.remove(node)
    _ensure_nodes(tree, ours)
    if ours:
        nodes.move_behind(
            tree,
            [node for node in tree.nodes if nodes.shows(node, helper)],
            [node for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours],
        )


def disconnect(scene):
    """Take out the scenes that connect() put in."""
    ours = [*roles.own(scene, SCOUT), *roles.own(scene, VIEW)]
    scene.afterlight.view_scenes.clear()
    for each in ours:
        roles.remove(each)


def follow(scene):
    """Bring the view scenes in line with `scene` as it is now: its name, its settings."""
    mirror(scene)
    for index, each in enumerate(_own(scene)):
        name = _name(scene, index)
        if not each.name.startswith(name):  # Blender may have put a number behind it
            each.name = name


def mirror(scene):
    """Give the view scenes what decides how the surfaces of `scene` look."""
    layer = next((layer for layer in scene.view_layers if layer.use), scene.view_layers[0])
    for each in _own(scene):
        own = each.view_layers[0]
        for source, target, names in (
            (scene, each, _SCENE),
            (scene.render, each.render, _RENDER),
            (layer, own, _LAYER),
        ):
            for name in names:
                assign(target, name, getattr(source, name))
        for prop in scene.eevee.bl_rna.properties:
            if prop.type not in {"POINTER", "COLLECTION"} and not prop.is_readonly:
                assign(
                    each.eevee,
                    prop.identifier,
                    _EEVEE_OVERRIDES.get(prop.identifier, getattr(scene.eevee, prop.identifier)),
                )
        assign(each.view_settings, "exposure", scene.view_settings.exposure)  # EEVEE leaves out lights by it
        assign(each, "background_set", scene)
        for switch, _ in (roughness.COLOR, roughness.DIRECT):
            assign(own, switch, each.afterlight.role == VIEW and needs.glossy_light(scene))


def is_incomplete(scene):
    """Whether something of what connect() makes is missing."""
    ours = _own(scene)
    if len(ours) != _scene_count(scene) or any(
        each.camera is None or each.camera != roles.camera(each) for each in ours
    ):
        return True
    tree = scene.compositing_node_group
    found = [node.scene for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours] if tree else []
    return found != ours


def leave_all_out():
    """No view is rendered until the views' engine says so."""
    for each in bpy.data.scenes:
        if each.afterlight.role in {VIEW, SCOUT} and each.library is None and roles.lit_scene(each):
            assign(each.view_layers[0], "use", each.afterlight.role == SCOUT)


def stored_placement(scene):
    """The placement.Placement that the file holds for `scene`, or None where it holds none that makes sense."""
    holder = placement_scene(scene)
    return _checked_placement(holder.get(PLACEMENT_KEY)) if holder else None


def store_placement(scene, found):
    """Store a placement in the file: the frames to come begin with it."""
    placement_scene(scene)[PLACEMENT_KEY] = {
        "poses": np.array(found.poses, float).ravel().tolist(),
        "coverage": list(found.coverage),
        "clearance": found.clearance,
    }


def forget_placement(scene):
    """The next frame places the views anew."""
    placement_scene(scene).pop(PLACEMENT_KEY, None)


def prepare(scene):
    """A frame's views are about to be chosen: none is in it as yet, and all look as `scene` does."""
    for view in scenes(scene):
        leave_out(view)
    mirror(scene)


def leave_out(view):
    """Leave a view scene out of this frame."""
    assign(view.view_layers[0], "use", False)


def rendered_views(scene):
    """The view scenes that are rendered in this frame, in their order."""
    tree = scene.compositing_node_group
    shown = [node.scene for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers" and not node.mute]
    return [each for each in scenes(scene) if each in shown and each.view_layers[0].use]


def unusable(thing):
    """Why an object that the user lists can't be a view, as a sentence for people; empty where it can."""
    if thing is None:
        return say("A view in the list has no camera. Choose one, or remove the line")
    if thing.type != "CAMERA":
        return say('The view "{}" is no camera, and is left out. Choose a camera in its place', thing.name)
    if thing.data.type not in {"PERSP", "ORTHO"}:
        return say(
            'The view "{}" is panoramic, and is left out. Set its Lens Type to Perspective or Orthographic', thing.name
        )
    return ""


def _checked_placement(stored):
    """placement.Placement of what a file holds, None where that is no placement: anybody may have written it."""
    try:
        poses = np.array(stored["poses"], float).reshape(-1, 4, 4)
        coverage, clearance = np.array(stored["coverage"], float).ravel(), float(stored["clearance"])
    except (TypeError, KeyError, ValueError, AttributeError):
        return None
    turns = poses[:, :3, :3].clip(-2, 2)
    is_sound = (
        len(poses) <= MAX_VIEWS
        and len(coverage) == len(poses) + 1
        and (np.abs(coverage - 0.5) < 0.51).all()
        and 0 < clearance < MAX_DISTANCE
        and (np.abs(poses[:, :3, 3]) < MAX_DISTANCE).all()
        and np.allclose(turns @ turns.transpose(0, 2, 1), np.eye(3), atol=1e-3)
        and np.array_equal(poses[:, 3], np.tile((0.0, 0, 0, 1), (len(poses), 1)))
    )
    return placement.Placement(list(poses), coverage.tolist(), clearance) if is_sound else None


def _own(scene):
    """The scenes of `scene` in their order: that of the scout, and those of the views."""
    return [
        each.scene
        for each in scene.afterlight.view_scenes
        if each.scene is not None
        and roles.lit_scene(each.scene) == scene
        and each.scene.afterlight.role in {SCOUT, VIEW}
    ]


def _scene_count(scene):
    """How many scenes `scene` needs: the scout, and one for each view."""
    views = needs.views(scene)
    return views + 1 if views else 0


def _ensure_scenes(scene):
    """Make the scenes that are missing, and remove those that are not needed any more. Returns the scenes that `scene`
    names and that are not its own: those of which it is a copy."""
    held, views = scene.afterlight.view_scenes, max(_scene_count(scene) - 1, 0)
    named = [each.scene for each in held if each.scene is not None]
    found = {role: roles.own(scene, role) for role in (SCOUT, VIEW)}
    strangers = set(named) - set(found[SCOUT]) - set(found[VIEW])
    for role, count in ((SCOUT, 1 if views else 0), (VIEW, views)):
        for each in found[role][count:]:
            roles.remove(each)
        del found[role][count:]
        made = [_new(scene, role, len(found[role]) + number) for number in range(count - len(found[role]))]
        found[role] += made
    ours = [*found[SCOUT], *found[VIEW]]
    if named != ours or len(held) != len(ours):
        held.clear()
        for each in ours:
            held.add().scene = each
    for each in ours:
        roles.give_camera(each)
    return strangers


def _new(scene, role, index):
    is_view = role == VIEW
    made = roles.new(
        scene, role, _name(scene, index + 1 if is_view else 0), engines.EEVEE if is_view else engines.VIEWS
    )
    roles.give_camera(made)
    layer = made.view_layers[0]
    for _, switch, _, _ in passes.PASSES:
        setattr(layer, switch, is_view)
    # Blender 5.2 crashes in -b when the compositor asks for a scene that has never been evaluated. It has no
    # background yet: a whole scene evaluated here would stay in memory.
    layer.update()
    layer.use = not is_view
    return made


def _name(scene, index):
    return (VIEW_NAME.format(index, scene.name) if index else PLACEMENT_NAME.format(scene.name))[:250]


def _ensure_nodes(tree, ours):
    found = [node for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours]
    if [node.scene for node in found] == ours:
        return
    for node in found:
        tree.nodes.remove(node)
    for index, each in enumerate(ours):
        node = nodes.new_view_node(tree, each)
        node.location = (-700, -400 - 50 * index)
