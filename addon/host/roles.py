# SPDX-License-Identifier: GPL-3.0-or-later
"""Which scenes of the file are ours: those that Afterlight made to render another one, and their cameras.

A scene is ours only if two sides say so: its own mark (`afterlight.role`, and `afterlight.serves`, the scene that it
helps to light), and a record: the lit scene names it, or this process has seen it being ours. A pointer that somebody
remapped, a copy, or a custom property of the same name is no more than a claim; such scenes are the user's and stay as
they are.
"""

import bpy

HELPER, SCOUT, VIEW = "HELPER", "SCOUT", "VIEW"
FRAME_SIDE = 4  # pixels along a side of the frame of our scenes: they are rendered at the lit scene's
MARK = "afterlight"  # custom property of our nodes, trees and cameras, and of the scenes of 0.1.0 to 0.3.0

_seen = set()  # session_uids of scenes that were ours at some moment of this session


def is_helper(scene):
    """Whether the scene says that it only helps to light another. True of the copies that a user makes, too."""
    return bool(scene.afterlight.role)


def lit_scene(scene):
    """The scene that `scene` helps to light if it is ours, else None."""
    lit = scene.afterlight.serves
    if lit is None or not is_helper(scene) or not _has_our_size(scene):
        return None
    if scene not in recorded(lit) and scene.session_uid not in _seen:
        return None
    _seen.add(scene.session_uid)
    return lit


def recorded(lit):
    """The scenes that `lit` names as its own, ours or not."""
    settings = lit.afterlight
    return [scene for scene in (settings.helper, *(each.scene for each in settings.view_scenes)) if scene is not None]


def own(lit, role):
    """Our scenes that serve `lit` in a role, those first that it names."""
    named = recorded(lit)
    found = [scene for scene in bpy.data.scenes if scene.afterlight.role == role and lit_scene(scene) == lit]
    return sorted(found, key=lambda scene: named.index(scene) if scene in named else len(named))


def new(lit, role, name, engine):
    """A scene that serves `lit`. It is ours as soon as `lit` names it."""
    scene = bpy.data.scenes.new(name)
    scene.afterlight.role, scene.afterlight.serves = role, lit
    _seen.add(scene.session_uid)
    scene.render.engine = engine
    scene.render.resolution_x = scene.render.resolution_y = FRAME_SIDE
    return scene


def give_camera(scene):
    """Let one of our scenes look through a camera of its own. Does nothing where it does."""
    if camera(scene) is None:
        data = bpy.data.cameras.new(scene.name)
        made = bpy.data.objects.new(scene.name, data)
        made[MARK] = data[MARK] = "camera"
        scene.collection.objects.link(made)
        scene.afterlight.own_camera = made
    if scene.camera != camera(scene):
        scene.camera = camera(scene)


def camera(scene):
    """The camera that we made for one of our scenes; None where it is gone, or where the user put another in its
    place."""
    found = scene.afterlight.own_camera
    is_whole = _is_our_camera(found) and found.data.get(MARK) == "camera" and found.data.users == 1
    return found if is_whole and scene in found.users_scene else None


def remove(scene):
    """Remove one of our scenes and its camera. Where the user has put things into it, it becomes the user's instead."""
    ours = scene.afterlight.own_camera
    if _holds_things_of_the_user(scene, ours):
        _hand_over(scene)
        return
    data = ours.data if _is_our_camera(ours) else None
    if data is not None and len(ours.users_collection) < 2:
        bpy.data.objects.remove(ours)
        if data.get(MARK) == "camera" and not data.users:
            bpy.data.cameras.remove(data)
    bpy.data.scenes.remove(scene)


def orphans():
    """The scenes that were ours and whose lit scene has been deleted."""
    return [
        scene
        for scene in bpy.data.scenes
        if scene.session_uid in _seen and is_helper(scene) and scene.afterlight.serves is None and scene.library is None
    ]


def adopt(lit):
    """Take over the scenes of a file of 0.1.0 to 0.3.0, which marked them by a custom property, and their cameras."""
    views = [each.scene for each in lit.afterlight.view_scenes]
    for scene, role in [(lit.afterlight.helper, HELPER), *zip(views, (SCOUT, *(VIEW,) * len(views)))]:
        if (
            scene is None
            or is_helper(scene)
            or scene.get(MARK) != role.lower()
            or not _has_our_size(scene)
            or not scene.name.startswith(".Afterlight")
        ):
            continue
        scene.afterlight.role, scene.afterlight.serves = role, lit
        del scene[MARK]
        found = scene.camera
        if found and found.type == "CAMERA" and list(scene.collection.all_objects) == [found] and found.data.users == 1:
            found[MARK] = found.data[MARK] = "camera"
            scene.afterlight.own_camera = found


def _has_our_size(scene):
    return scene.render.resolution_x == scene.render.resolution_y == FRAME_SIDE


def _is_our_camera(thing):
    return thing is not None and thing.type == "CAMERA" and thing.get(MARK) == "camera"


def _holds_things_of_the_user(scene, ours):
    """Whether something would be lost with the scene."""
    here = {scene.collection, *scene.collection.children_recursive}
    others = [*bpy.data.collections, *(each.collection for each in bpy.data.scenes)]
    elsewhere = {child for parent in others if parent not in here for child in parent.children_recursive}
    return bool(
        here - elsewhere - {scene.collection}
        or scene.compositing_node_group
        or scene.sequence_editor
        or any(
            thing != ours and not (set(thing.users_collection) - here or elsewhere.intersection(thing.users_collection))
            for thing in scene.collection.all_objects
        )
    )


def _hand_over(scene):
    settings = scene.afterlight
    _seen.discard(scene.session_uid)
    settings.role, settings.serves, settings.own_camera = "", None, None
    scene.render.engine = "BLENDER_EEVEE"
    scene.background_set = None
    scene.name = scene.name.removeprefix(".")  # Blender's menus leave out names with a leading dot
