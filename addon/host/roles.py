# SPDX-License-Identifier: GPL-3.0-or-later
"""Which scenes of the file are ours: the helper scenes that Afterlight made to render another scene, and their cameras.

A scene is ours only if two sources agree: its own mark (`afterlight.role`, and `afterlight.serves`, the scene that it
helps to light), and a record (the lit scene names it, or it was ours earlier in this process). A pointer that was
remapped, a copied scene or a custom property of the same name is only a claim; such scenes belong to the user and stay
as they are.

Roles: HELPER, the scene whose engine gathers the light; SCOUT, the scene whose engine places the views; VIEW, the scene
through which EEVEE renders them, each with a camera of its own. They are stored in files and must not change.
"""

from itertools import count, takewhile

import bpy

HELPER, SCOUT, VIEW = "HELPER", "SCOUT", "VIEW"
FRAME_SIDE = 4  # resolution stored in our scenes, in pixels, by which they are known; they render at the lit scene's
MARK = "afterlight"  # custom property of our nodes, trees and cameras, and of the scenes of 0.1.0 to 0.3.0

# session_uids of scenes that were ours at some time in this process; global, since the file alone can be made up.
_seen = set()


def is_helper(scene):
    """Whether a scene claims to help light another one. Also true of a user's copy of such a scene."""
    return bool(scene.afterlight.role)


def lit_scene(scene):
    """The scene that `scene` helps to light; None if `scene` is not ours."""
    lit = scene.afterlight.serves
    if lit is None or not is_helper(scene) or not _has_our_size(scene):
        return None
    if scene not in recorded(lit) and scene.session_uid not in _seen:
        return None
    _seen.add(scene.session_uid)
    return lit


def recorded(lit):
    """The scenes that `lit` names as its helper and view scenes, whether they are ours or not."""
    settings = lit.afterlight
    return [scene for scene in (settings.helper, *(each.scene for each in settings.view_scenes)) if scene is not None]


def own(lit, role):
    """Our scenes that serve `lit` in this role; those that it names come first, in its order."""
    named = recorded(lit)
    scenes = [scene for scene in bpy.data.scenes if scene.afterlight.role == role and lit_scene(scene) == lit]
    return sorted(scenes, key=lambda scene: named.index(scene) if scene in named else len(named))


def new(lit, role, name, engine):
    """Make a scene that serves `lit`. It counts as ours from now on."""
    scene = bpy.data.scenes.new(name)
    scene.afterlight.role, scene.afterlight.serves = role, lit
    _seen.add(scene.session_uid)
    scene.render.engine = engine
    scene.render.resolution_x = scene.render.resolution_y = FRAME_SIDE
    return scene


def give_camera(scene):
    """Make one of our scenes use a camera of its own. Does nothing if it already does."""
    if camera(scene) is None:
        scene.afterlight.own_camera = _new_camera(scene, scene.name)
    if scene.camera != camera(scene):
        scene.camera = camera(scene)


def give_cameras(scene, number):
    """Make one of our scenes have `number` cameras of its own, as cameras() gives them, and use the first. Does nothing
    if it already does."""
    if len(cameras(scene)) == number and scene.camera == scene.afterlight.own_camera:
        return
    for each in [each for each in scene.collection.objects if _is_intact(each, scene)]:
        _remove_camera(each)
    name = next(
        name
        for name in (f"{scene.name[:240]}{index or ''}" for index in count())
        if not any(name + suffix(index) in bpy.data.objects for index in range(number))
    )
    made = [_new_camera(scene, name + suffix(index)) for index in range(number)]
    scene.afterlight.own_camera = scene.camera = made[0]


def suffix(index):
    """The end of the name of a camera, by its index among those of its scene: Blender's multi-view finds them by it."""
    return f"_{index + 1}"


def camera(scene):
    """The camera that we made for one of our scenes, the first of several; None if it was deleted or the user replaced
    or changed it."""
    own_camera = scene.afterlight.own_camera
    return own_camera if _is_intact(own_camera, scene) else None


def cameras(scene):
    """The cameras that give_cameras() made for one of our scenes, up to the first that was deleted or changed."""
    first = camera(scene)
    if first is None or not first.name.endswith(suffix(0)):
        return []
    named = (scene.collection.objects.get(first.name.removesuffix(suffix(0)) + suffix(index)) for index in count())
    return list(takewhile(lambda each: _is_intact(each, scene), named))


def remove(scene):
    """Remove one of our scenes and its cameras. A scene that holds anything of the user's is handed over to the user
    instead."""
    ours = {scene.afterlight.own_camera, *(each for each in scene.collection.objects if _is_intact(each, scene))}
    if _holds_things_of_the_user(scene, ours):
        _hand_over(scene)
        return
    for each in ours:
        if _is_our_camera(each) and len(each.users_collection) < 2:
            _remove_camera(each)
    bpy.data.scenes.remove(scene)


def orphans():
    """Our scenes whose lit scene was deleted."""
    return [
        scene
        for scene in bpy.data.scenes
        if scene.session_uid in _seen and is_helper(scene) and scene.afterlight.serves is None and scene.library is None
    ]


def adopt(lit):
    """Take over the scenes, and their cameras, of a file from 0.1.0 to 0.3.0, where a custom property marks them."""
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
        camera_object = scene.camera
        if (
            camera_object
            and camera_object.type == "CAMERA"
            and list(scene.collection.all_objects) == [camera_object]
            and camera_object.data.users == 1
        ):
            camera_object[MARK] = camera_object.data[MARK] = "camera"
            scene.afterlight.own_camera = camera_object


def _has_our_size(scene):
    return scene.render.resolution_x == scene.render.resolution_y == FRAME_SIDE


def _is_our_camera(camera_object):
    return camera_object is not None and camera_object.type == "CAMERA" and camera_object.get(MARK) == "camera"


def _is_intact(camera_object, scene):
    """Whether a camera that we made for `scene` is there, and nobody has changed it."""
    return (
        _is_our_camera(camera_object)
        and camera_object.data.get(MARK) == "camera"
        and camera_object.data.users == 1
        and scene in camera_object.users_scene
    )


def _new_camera(scene, name):
    data = bpy.data.cameras.new(name)
    camera_object = bpy.data.objects.new(name, data)
    camera_object[MARK] = data[MARK] = "camera"
    scene.collection.objects.link(camera_object)
    return camera_object


def _remove_camera(camera_object):
    data = camera_object.data
    bpy.data.objects.remove(camera_object)
    if data.get(MARK) == "camera" and not data.users:
        bpy.data.cameras.remove(data)


def _holds_things_of_the_user(scene, ours):
    """Whether removing a scene would lose something of the user's. ours: its cameras."""
    collections = {scene.collection, *scene.collection.children_recursive}
    all_collections = [*bpy.data.collections, *(each.collection for each in bpy.data.scenes)]
    elsewhere = {
        child for parent in all_collections if parent not in collections for child in parent.children_recursive
    }
    return bool(
        collections - elsewhere - {scene.collection}
        or scene.compositing_node_group
        or scene.sequence_editor
        or any(
            thing not in ours
            and not (set(thing.users_collection) - collections or elsewhere.intersection(thing.users_collection))
            for thing in scene.collection.all_objects
        )
    )


def _hand_over(scene):
    settings = scene.afterlight
    _seen.discard(scene.session_uid)
    settings.role, settings.serves, settings.own_camera = "", None, None
    scene.render.engine = "BLENDER_EEVEE"
    scene.background_set = None
    scene.name = scene.name.removeprefix(".")  # Blender's menus hide names with a leading dot
