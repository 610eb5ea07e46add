# SPDX-License-Identifier: GPL-3.0-or-later
"""The helper scenes of the views: one that places them, and one for each view, through which EEVEE renders it.

Render Layers nodes at the top level of the compositor, in the order in which Blender renders their scenes:

    placement  our engine (render/views_engine.py): reads the finished main view, sets the cameras of the views, and
               says which views this frame needs
    view 1..n  EEVEE, each through its own camera (scene/view_cameras.py), with the lit scene as background set
    light      our engine (render/engine.py): gathers the light from the passes of all views

While nothing renders, the view layers of the views are switched off. The placement engine switches on those that
the frame needs, and leave_all_out() switches them off again: a view that is not needed costs nothing, and neither do
the views where the extension is missing.
"""

import bpy
import numpy as np

from ..host import engines, roles
from ..host.assign import assign
from ..host.roles import SCOUT, VIEW
from ..scene import needs, passes, roughness
from ..translations import say
from ..views import placement
from . import nodes, render_order

PLACEMENT_NAME, VIEW_NAME = ".Afterlight Views ({})", ".Afterlight View {} ({})"
MAX_DISTANCE = 1e9  # metres of a stored pose from the world's origin
PLACEMENT_KEY = "placed"  # custom property of the placement scene
SAMPLES = 1  # EEVEE's samples of a view; the gather averages its pixels down anyway

# Properties of the lit scene that affect its geometry and materials. EEVEE's own settings are all mirrored.
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
    """The scenes through which EEVEE renders the views of `scene`, in order."""
    return [each for each in _own(scene) if each.afterlight.role == VIEW]


def connect(scene, tree, helper):
    """Make or remove the view scenes as `scene` needs them, and their nodes in the compositor `tree`, before those of
    `helper`. Leaves alone what is already in place."""
    foreign_scenes = _ensure_scenes(scene)
    mirror(scene)
    ours = _own(scene)
    for node in [node for node in tree.nodes if nodes.role(node) == "view"]:
        if node.scene is None or node.scene in foreign_scenes:
            tree.nodes.remove(node)
    _ensure_nodes(tree, ours)
    if ours:
        render_order.render_after(
            tree,
            [node for node in tree.nodes if nodes.shows(node, helper)],
            [node for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours],
        )


def disconnect(scene):
    """Remove the scenes that connect() made."""
    ours = [*roles.own(scene, SCOUT), *roles.own(scene, VIEW)]
    scene.afterlight.view_scenes.clear()
    for each in ours:
        roles.remove(each)


def follow(scene):
    """Bring the view scenes in line with the name and settings of `scene`."""
    mirror(scene)
    for index, each in enumerate(_own(scene)):
        name = _name(scene, index)
        if not each.name.startswith(name):  # Blender may have appended a number
            each.name = name


def mirror(scene):
    """Copy the properties of `scene` that decide how its surfaces look to its view scenes."""
    layer = next((layer for layer in scene.view_layers if layer.use), scene.view_layers[0])
    for each in _own(scene):
        view_layer = each.view_layers[0]
        for source, target, names in (
            (scene, each, _SCENE),
            (scene.render, each.render, _RENDER),
            (layer, view_layer, _LAYER),
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
        assign(each.view_settings, "exposure", scene.view_settings.exposure)  # EEVEE skips lights depending on it
        assign(each, "background_set", scene)
        for switch, _ in (roughness.COLOR, roughness.DIRECT):
            assign(view_layer, switch, each.afterlight.role == VIEW and needs.glossy_light(scene))


def is_incomplete(scene):
    """Whether any scene or node that connect() makes is missing."""
    ours = _own(scene)
    if len(ours) != _scene_count(scene) or any(
        each.camera is None or each.camera != roles.camera(each) for each in ours
    ):
        return True
    tree = scene.compositing_node_group
    shown_scenes = (
        [node.scene for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours] if tree else []
    )
    return shown_scenes != ours


def leave_all_out():
    """Switch off all views; the placement engine switches on those that a frame needs."""
    for each in bpy.data.scenes:
        if each.afterlight.role in {VIEW, SCOUT} and each.library is None and roles.lit_scene(each):
            assign(each.view_layers[0], "use", each.afterlight.role == SCOUT)


def stored_placement(scene):
    """The placement.Placement that the file holds for `scene`; None if it holds none, or none that is valid."""
    holder = placement_scene(scene)
    return _checked_placement(holder.get(PLACEMENT_KEY)) if holder else None


def store_placement(scene, placement_found):
    """Store a placement.Placement in the file. The next frames start from it."""
    placement_scene(scene)[PLACEMENT_KEY] = {
        "poses": np.array(placement_found.poses, float).ravel().tolist(),
        "coverage": list(placement_found.coverage),
        "clearance": placement_found.clearance,
    }


def forget_placement(scene):
    """Make the next frame place the views anew."""
    placement_scene(scene).pop(PLACEMENT_KEY, None)


def prepare(scene):
    """Prepare a frame before its views are chosen: leave all views out, and mirror `scene` to them."""
    for view in scenes(scene):
        leave_out(view)
    mirror(scene)


def leave_out(view):
    """Leave a view scene out of this frame."""
    assign(view.view_layers[0], "use", False)


def rendered_views(scene):
    """The view scenes that are rendered in this frame, in order."""
    tree = scene.compositing_node_group
    shown = [node.scene for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers" and not node.mute]
    return [each for each in scenes(scene) if each in shown and each.view_layers[0].use]


def unusable(camera_object):
    """Why an object from the user's list can't be a view, as a sentence for people; empty if it can."""
    if camera_object is None:
        return say("A view in the list has no camera. Choose one, or remove the entry")
    if camera_object.type != "CAMERA":
        return say('The view "{}" is not a camera object and was left out. Choose a camera instead', camera_object.name)
    if camera_object.data.type not in {"PERSP", "ORTHO"}:
        return say(
            'The view "{}" is panoramic and was left out. Set its Lens Type to Perspective or Orthographic',
            camera_object.name,
        )
    return ""


def _checked_placement(stored):
    """placement.Placement of a custom property, None if the values are invalid: anybody may have written them."""
    try:
        poses = np.array(stored["poses"], float).reshape(-1, 4, 4)
        coverage, clearance = np.array(stored["coverage"], float).ravel(), float(stored["clearance"])
    except (TypeError, KeyError, ValueError, AttributeError):
        return None
    rotations = poses[:, :3, :3].clip(-2, 2)
    is_sound = (
        len(poses) <= needs.MAX_VIEWS
        and len(coverage) == len(poses) + 1
        and (np.abs(coverage - 0.5) < 0.51).all()
        and 0 < clearance < MAX_DISTANCE
        and (np.abs(poses[:, :3, 3]) < MAX_DISTANCE).all()
        and np.allclose(rotations @ rotations.transpose(0, 2, 1), np.eye(3), atol=1e-3)
        and np.array_equal(poses[:, 3], np.tile((0.0, 0, 0, 1), (len(poses), 1)))
    )
    return placement.Placement(list(poses), coverage.tolist(), clearance) if is_sound else None


def _own(scene):
    """The placement scene and the view scenes of `scene`, in order."""
    return [
        each.scene
        for each in scene.afterlight.view_scenes
        if each.scene is not None
        and roles.lit_scene(each.scene) == scene
        and each.scene.afterlight.role in {SCOUT, VIEW}
    ]


def _scene_count(scene):
    """How many such scenes `scene` needs: one for the placement, and one for each view; 0 without views."""
    views = needs.views(scene)
    return views + 1 if views else 0


def _ensure_scenes(scene):
    """Make missing scenes and remove superfluous ones. Returns the scenes that `scene` names but that belong to
    another: the scene that it was copied from."""
    slots, views = scene.afterlight.view_scenes, max(_scene_count(scene) - 1, 0)
    named = [each.scene for each in slots if each.scene is not None]
    by_role = {role: roles.own(scene, role) for role in (SCOUT, VIEW)}
    foreign_scenes = set(named) - set(by_role[SCOUT]) - set(by_role[VIEW])
    for role, count in ((SCOUT, 1 if views else 0), (VIEW, views)):
        for each in by_role[role][count:]:
            roles.remove(each)
        del by_role[role][count:]
        new_scenes = [_new(scene, role, len(by_role[role]) + number) for number in range(count - len(by_role[role]))]
        by_role[role] += new_scenes
    ours = [*by_role[SCOUT], *by_role[VIEW]]
    if named != ours or len(slots) != len(ours):
        slots.clear()
        for each in ours:
            slots.add().scene = each
    for each in ours:
        roles.give_camera(each)
    return foreign_scenes


def _new(scene, role, index):
    is_view = role == VIEW
    scene_made = roles.new(
        scene, role, _name(scene, index + 1 if is_view else 0), engines.EEVEE if is_view else engines.VIEWS
    )
    roles.give_camera(scene_made)
    layer = scene_made.view_layers[0]
    for _, switch, _, _ in passes.PASSES:
        setattr(layer, switch, is_view)
    # Blender 5.2 crashes in -b when the compositor asks for a scene that has never been evaluated. Evaluate it before
    # it gets a background set: a whole scene evaluated here would stay in memory.
    layer.update()
    layer.use = not is_view
    return scene_made


def _name(scene, index):
    return (VIEW_NAME.format(index, scene.name) if index else PLACEMENT_NAME.format(scene.name))[:250]


def _ensure_nodes(tree, ours):
    view_nodes = [node for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours]
    if [node.scene for node in view_nodes] == ours:
        return
    for node in view_nodes:
        tree.nodes.remove(node)
    for index, each in enumerate(ours):
        node = nodes.new_view_node(tree, each)
        node.location = (-700, -400 - 50 * index)
