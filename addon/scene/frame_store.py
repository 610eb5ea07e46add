# SPDX-License-Identifier: GPL-3.0-or-later
"""The owner of all pass files: each has holders, and is removed as soon as nobody holds it.

    holder                                        held from ... to
    a render job (render/job.py)                  the first save of a frame ... its end, when it is kept or dropped
    a kept frame (render/frames.py)               the end of a frame ... the next render of its scene, another file,
                                                  or removal by the user
    views of a still scene (render/view_reuse.py) the frame that renders one ... the last of the job that can reuse it

A scene's passes always go into the same file, so that its next frame takes no more room than this one.
"""

import os
from collections.abc import Collection, Hashable

import bpy

from ..host import main_thread, put_back, temp_files
from ..host.report import Problem
from .exr import check, one_line

_holders: dict[str, set[Hashable]] = {}  # {path: holders}; global, since frames are kept from one render to the next


def save(scene: bpy.types.Scene) -> str:
    """Write the finished passes of `scene` to a file in our temporary folder and return its path.

    This is the only way to get the pixels of a render out of Blender in Python; an uncompressed multilayer EXR takes
    a tenth of a second at 1280 x 720. Raises Problem if it can't be written, gather.Cancelled if the render is to
    stop."""
    path, why = _write(scene, ("",))
    if why or not os.path.exists(path):
        discard(path)
        raise _not_written(why or "there is no file")
    return path


def save_views(scene: bpy.types.Scene, suffixes: Collection[str]) -> dict[str, str | Problem]:
    """Write the finished passes of the views of a view scene, by the suffixes of those that were rendered, to a file
    each: {suffix: its path, or why there is none}. Raises as save() does."""
    path, why = _write(scene, suffixes)
    found: dict[str, str | Problem] = {}
    for suffix in suffixes:
        found[suffix] = view_path = temp_files.suffixed(path, suffix)
        try:
            # With several views Blender says that no file could be saved, whether they were or not.
            if not os.path.exists(view_path):
                raise _not_written(why or "there is no file")
            check(view_path)
        except Problem as problem:
            discard(view_path)
            found[suffix] = problem
    return found


def _write(scene, suffixes):
    """Have Blender write the finished passes of a scene. Returns the path, and why it says that it failed."""
    try:
        path = temp_files.new(scene.session_uid, suffixes)
    except OSError as error:
        raise _not_written(one_line(error)) from error
    # Blender takes the file format from the scene itself; no copy of its settings can be passed.
    settings = main_thread.run(lambda: _to_multilayer_exr(scene.render))
    try:
        if (image := render_result()) is None:
            raise RuntimeError("it does not have any image data")
        image.save_render(path, scene=scene)
    except (RuntimeError, OSError) as error:
        if "does not have any image data" in str(error):
            raise Problem(
                'There is no render of "{}". Render that scene instead of its helper scene',
                scene.name,
            ) from error
        return path, one_line(error)
    finally:
        main_thread.must_run(lambda: put_back.restore(settings))
    return path, ""


def hold(holder: Hashable, paths: Collection[str]) -> None:
    """Make `holder` (anything hashable) hold exactly these files. Files that nobody holds any more are removed."""
    for path in paths:
        _holders.setdefault(path, set()).add(holder)
    for path in [path for path, holders in _holders.items() if holder in holders and path not in paths]:
        _holders[path].discard(holder)
        if not _holders[path]:
            discard(path)


def release(holder: Hashable) -> None:
    """Make `holder` hold no file any more."""
    hold(holder, ())


def discard(path: str) -> None:
    """Remove a file that save() wrote, whoever holds it. Ignores missing files."""
    _holders.pop(path, None)
    temp_files.remove(path)


def size(path: str) -> int:
    """Bytes of a file that save() wrote, 0 if it is gone."""
    try:
        return os.path.getsize(path)
    except OSError:
        return 0


def render_result() -> bpy.types.Image | None:
    """Blender's image of the finished render, or None: `blender -b` has none before its first frame."""
    return next((image for image in bpy.data.images if image.type == "RENDER_RESULT"), None)


def _to_multilayer_exr(render):
    """Set the image settings that save() needs. Returns the user's own, for put_back.restore()."""
    image_settings = render.image_settings
    # Only settings in use: reading a colour space that was never set makes Blender print a warning.
    linear = image_settings.has_linear_colorspace or image_settings.color_management == "OVERRIDE"
    video = render.ffmpeg if image_settings.media_type == "VIDEO" else None
    saved = put_back.record(image_settings, video, leave=() if linear else ("linear_colorspace_settings",))
    try:
        image_settings.media_type = "MULTI_LAYER_IMAGE"
        image_settings.file_format = "OPEN_EXR_MULTILAYER"
        image_settings.color_depth = "32"
        image_settings.exr_codec = "NONE"
        image_settings.use_exr_interleave = (
            True  # writes in half the time of one part for each pass (docs/blender/rendering.md)
        )
        image_settings.use_preview = False
    except BaseException:
        put_back.restore(saved)
        raise
    return saved


def _not_written(why):
    return Problem(
        "The passes could not be written to {} ({}). Free some space there, or choose another folder in "
        "Preferences > File Paths > Temporary Files and restart Blender",
        bpy.app.tempdir,
        why,
    )
