# SPDX-License-Identifier: GPL-3.0-or-later
"""The helper scenes of the views: one that places them, and one through which EEVEE renders them.

Render Layers nodes at the top level of the compositor, in the order in which Blender renders their scenes:

    placement  our engine (render/views_engine.py): reads the finished main view, sets the cameras of the views, and
               says which views this frame needs. There is nothing in the scene, so it takes no time to evaluate
    views      EEVEE, with the lit scene as background set: evaluated once, simplified, and rendered through the camera
               of each view (scene/view_cameras.py)
    light      our engine (render/engine.py): gathers the light from the passes of all views

While nothing renders, all views are left out. The placement engine uses those that the frame needs, and leave_all_out()
leaves them out again: a view that is not needed costs nothing, and neither do the views where the extension is missing.
"""

import bpy
import numpy as np

from ..host import engines, roles
from ..host.assign import assign
from ..host.roles import SCOUT, VIEW
from ..scene import cameras, needs, passes, roughness, view_cameras, view_world
from ..views import placement
from . import nodes, render_order

NAMES = {SCOUT: ".Afterlight Placement ({})", VIEW: ".Afterlight Views ({})"}
MAX_DISTANCE = 1e9  # metres of a stored pose from the world's origin
PLACEMENT_KEY = "placed"  # custom property of the placement scene
SAMPLES = 1  # EEVEE's samples of a view; the gather averages its pixels down anyway
LEAST_POOL = 128  # MB, of shadows, whose resolution stays: half of it made a lamp leak (docs/blender/views.md)
POOL_PIXELS = 1 << 20  # of a picture that a pool of Blender's default size is for
MAX_SUBDIVISIONS = 3  # of Subdivision modifiers in the views

# Properties of the lit scene that affect its geometry and materials. EEVEE's own settings are all mirrored.
_RENDER = (
    "use_high_quality_normals",
    "frame_map_old",
    "frame_map_new",
    "film_transparent",
    "hair_type",
    "hair_subdiv",
    "filter_size",
    "use_texture_cache",
)
_SCENE = ("frame_subframe",)
_LAYER = (
    "material_override",
    "use_solid",
    "use_sky",
    "use_ao",
    "use_strand",
    "use_volumes",
    "use_grease_pencil",
)
_SIMPLIFY = ("simplify_child_particles_render", "simplify_volumes", "use_simplify_normals")
# No pass that is read shows a volume, yet EEVEE renders them: as coarse as can be.
_EEVEE_OVERRIDES = {
    "taa_render_samples": SAMPLES,
    "use_raytracing": False,
    "use_overscan": False,
    "volumetric_tile_size": "16",
    "volumetric_samples": 1,
}


def placement_scene(scene):
    """The scene whose engine places the views of `scene`, or None."""
    return next((each for each in _own(scene) if each.afterlight.role == SCOUT), None)


def view_scene(scene):
    """The scene through which EEVEE renders the views of `scene`, or None."""
    return next((each for each in _own(scene) if each.afterlight.role == VIEW), None)


def views(scene):
    """[view_cameras.View] of `scene`, in order."""
    rendering = view_scene(scene)
    return view_cameras.views(rendering) if rendering else []


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
    for each in _own(scene):
        name = _name(scene, each.afterlight.role)
        if not each.name.startswith(name):  # Blender may have appended a number
            each.name = name


def mirror(scene):
    """Copy the properties of `scene` that decide how its surfaces look to its view scene."""
    each = view_scene(scene)
    if each is None:
        return
    layer = next((layer for layer in scene.view_layers if layer.use), scene.view_layers[0])
    view_layer = each.view_layers[0]
    for source, target, names in (
        (scene, each, _SCENE),
        (scene.render, each.render, _RENDER),
        (layer, view_layer, _LAYER),
    ):
        for name in names:
            assign(target, name, getattr(source, name))
    _simplify(scene.render, each.render)
    overrides = _EEVEE_OVERRIDES | {"shadow_pool_size": _shadow_pool(scene)}
    for prop in scene.eevee.bl_rna.properties:
        if prop.type not in {"POINTER", "COLLECTION"} and not prop.is_readonly:
            name = prop.identifier
            assign(each.eevee, name, overrides.get(name, getattr(scene.eevee, name)))
    assign(each.view_settings, "exposure", scene.view_settings.exposure)  # EEVEE skips lights depending on it
    assign(each, "background_set", scene)
    for switch, _ in (roughness.COLOR, roughness.DIRECT):
        assign(view_layer, switch, needs.glossy_light(scene))


def _shadow_pool(scene):
    """EEVEE's Shadow Pool Size for the views, which is cleared for each. Shadows take room in it as the picture has
    pixels, and the user's is chosen for a whole one."""
    width, height = cameras.window(scene)[0][2:]
    users = int(scene.eevee.shadow_pool_size)
    wanted = max(users * min(1, width * height / POOL_PIXELS), min(users, LEAST_POOL))
    pools = [pool.identifier for pool in scene.eevee.bl_rna.properties["shadow_pool_size"].enum_items]
    return next(pool for pool in pools if int(pool) >= wanted)


def _simplify(render, of_views):
    """Simplify the geometry of the views, and no less than the user does. render, of_views: bpy RenderSettings."""
    prop = render.bl_rna.properties
    for name in _SIMPLIFY:
        assign(of_views, name, getattr(render, name) if render.use_simplify else prop[name].default)
    users = render.simplify_subdivision_render if render.use_simplify else MAX_SUBDIVISIONS
    assign(of_views, "simplify_subdivision_render", min(users, MAX_SUBDIVISIONS))
    assign(of_views, "use_simplify", True)


def is_incomplete(scene):
    """Whether any scene or node that connect() makes is missing."""
    ours = _own(scene)
    if tuple(each.afterlight.role for each in ours) != _wanted_roles(scene):
        return True
    if ours:
        placing, rendering = ours
        has_camera = placing.camera is not None and placing.camera == roles.camera(placing)
        if not has_camera or not view_cameras.is_set_up(rendering, needs.views(scene)):
            return True
    tree = scene.compositing_node_group
    shown_scenes = (
        [node.scene for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours] if tree else []
    )
    return shown_scenes != ours


def is_of_0_3_0(scene):
    """Whether the views of `scene` still have a scene each."""
    return any(each.afterlight.role == VIEW and not each.render.use_multiview for each in _own(scene))


def leave_all_out():
    """Leave out all views; the placement engine uses those that a frame needs."""
    for each in bpy.data.scenes:
        if each.afterlight.role in {VIEW, SCOUT} and each.library is None and roles.lit_scene(each):
            if each.afterlight.role == VIEW:
                view_world.take_back(each)
                for view in view_cameras.views(each):
                    view.use(False)
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
    for view in views(scene):
        view.use(False)
    mirror(scene)
    if each := view_scene(scene):
        view_world.give(each, cameras.first_layer(scene).world_override or scene.world)


def rendered_views(scene):
    """The views that are rendered in this frame, in order."""
    tree = scene.compositing_node_group
    shown = [node.scene for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers" and not node.mute]
    return [each for each in views(scene) if each.scene in shown and each.is_used]


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
    """The placement scene and the view scene of `scene`, in order."""
    return [
        each.scene
        for each in scene.afterlight.view_scenes
        if each.scene is not None
        and roles.lit_scene(each.scene) == scene
        and each.scene.afterlight.role in {SCOUT, VIEW}
    ]


def _wanted_roles(scene):
    """The roles of such scenes that `scene` needs: one places the views, and one renders them; none without views."""
    return (SCOUT, VIEW) if needs.views(scene) else ()


def _ensure_scenes(scene):
    """Make missing scenes and remove superfluous ones: 0.3.0 made one for each view. Returns the scenes that `scene`
    names but that belong to another: the scene that it was copied from."""
    slots, wanted = scene.afterlight.view_scenes, _wanted_roles(scene)
    named = [each.scene for each in slots if each.scene is not None]
    found = {role: roles.own(scene, role) for role in (SCOUT, VIEW)}
    foreign_scenes, ours = set(named).difference(*found.values()), []
    for role, ours_before in found.items():
        for each in ours_before[role in wanted :]:
            roles.remove(each)
    for role in wanted:
        ours.append(found[role][0] if found[role] else _new(scene, role))
    if named != ours or len(slots) != len(ours):
        slots.clear()
        for each in ours:
            slots.add().scene = each
    if ours:
        placing, rendering = ours
        roles.give_camera(placing)
        view_cameras.set_up(rendering, needs.views(scene))
        _follow_passes(rendering.view_layers[0])
        assign(placing, "background_set", None)  # 0.3.0 evaluated the whole scene to place the views
    return foreign_scenes


def _new(scene, role):
    is_view = role == VIEW
    scene_made = roles.new(scene, role, _name(scene, role), engines.EEVEE if is_view else engines.VIEWS)
    layer = scene_made.view_layers[0]
    # Blender 5.2 crashes in -b when the compositor asks for a scene that has never been evaluated. Evaluate it before
    # it gets a background set: a whole scene evaluated here would stay in memory.
    layer.update()
    layer.use = not is_view
    return scene_made


def _follow_passes(layer):
    """Render the passes that the gather reads of a view, and no other."""
    assign(layer, "use_pass_combined", False)
    for _, switch, _, _ in passes.PASSES:
        assign(layer, switch, True)


def _name(scene, role):
    return NAMES[role].format(scene.name)[:240]


def _ensure_nodes(tree, ours):
    view_nodes = [node for node in tree.nodes if nodes.role(node) == "view" and node.scene in ours]
    if [node.scene for node in view_nodes] == ours:
        return
    for node in view_nodes:
        tree.nodes.remove(node)
    for index, each in enumerate(ours):
        node = nodes.new_view_node(tree, each)
        node.location = (-700, -400 - 50 * index)
