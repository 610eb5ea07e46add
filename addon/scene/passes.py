# SPDX-License-Identifier: GPL-3.0-or-later
"""EEVEE's finished passes and the camera that saw them, out of Blender and into arrays."""

import mmap
import os

import bpy
import numpy as np

from .. import gather
from ..host import main_thread, put_back, temp_files
from ..host.report import Problem
from . import pixel_jitter

_early = {}  # (frame, path) by the scene's session_uid

# What the gather reads: gather.Passes' field, the view layer's switch, the pass and its channels in the file.
PASSES = (
    ("depth", "use_pass_z", "Depth", "Z"),
    ("normal", "use_pass_normal", "Normal", "XYZ"),
    ("diffuse_color", "use_pass_diffuse_color", "Diffuse Color", "RGB"),
    ("diffuse_direct", "use_pass_diffuse_direct", "Diffuse Direct", "RGB"),
    ("emission", "use_pass_emit", "Emission", "RGB"),
)
# Where things come from that move: for the average over frames. It costs EEVEE a look at the frames before and after.
MOTION = ("motion", "use_pass_vector", "Vector", "XY")


def averages_frames(settings):
    """Whether the light of an animation's frames is averaged."""
    return settings.use_history and settings.method == "RADIOSITY"


def needed(settings):
    """Of PASSES and MOTION, what a scene with these settings needs."""
    return (*PASSES, MOTION) if averages_frames(settings) else PASSES


def is_on(layer, switch):
    """Whether a view layer renders a pass. switch: the path of a property from the view layer."""
    return layer.path_resolve(switch)


def turn(layer, switch, on):
    """Let a view layer render a pass, or not. switch: as is_on() has it."""
    owner, _, name = switch.rpartition(".")
    setattr(layer.path_resolve(owner) if owner else layer, name, on)


def save(scene):
    """Write the finished passes of `scene` to a file in our temporary folder and return its path: always the same one,
    unless the folder changes.

    Blender hands the pixels of a render to Python in no other way: a multilayer EXR, uncompressed, takes a tenth of
    a second at 1280 x 720. Raises Problem where it can't be written, gather.Cancelled where the render is to stop.
    """
    try:
        path = temp_files.new(scene.session_uid)
    except OSError as error:
        raise _not_written(_text(error)) from error
    # Blender takes the format from the scene whose passes it writes, and lets no copy be given.
    saved = main_thread.run(lambda: _to_multilayer_exr(scene.render))
    try:
        render_result().save_render(path, scene=scene)
    except (RuntimeError, OSError) as error:
        discard(path)
        if "does not have any image data" in str(error):
            raise Problem(
                'There is no render of "{}". Render that scene instead of its helper scene',
                scene.name,
            ) from error
        raise _not_written(_text(error)) from error
    finally:
        main_thread.surely(lambda: put_back.restore(saved))
    if not os.path.exists(path):
        raise _not_written("there is no file")
    return path


def save_early(scene):
    """As save(), for an engine that comes before the last that needs the file of this frame: see save_once()."""
    path = save(scene)
    _early[scene.session_uid] = scene.frame_current, path
    return path


def save_once(scene):
    """As save(), where save_early() has not written this very frame already."""
    frame, path = _early.pop(scene.session_uid, (None, ""))
    return path if frame == scene.frame_current and os.path.exists(path) else save(scene)


def discard_early(*_):
    """A render begins or is over: what save_early() wrote for nobody goes."""
    while _early:
        discard(_early.popitem()[1][1])


def render_result():
    """Blender's image that stands for finished renders, or None: `blender -b` has none before its first frame."""
    return next((image for image in bpy.data.images if image.type == "RENDER_RESULT"), None)


def load(path, layer, window, step=1):
    """The passes of one view layer from a file that save() wrote. step: frames from the one before to this.

    window: (x, y, width, height) in pixels, from the bottom left: the part of the full frame that is rendered. A
    render border without crop leaves black around it in the file; it is cut off here.
    Returns gather.Passes, whose arrays are the file's own memory: it stays in use, removed or not, as long as they do.
    Raises Problem where OpenEXR, the file or one of the passes can't be had.
    """
    cut = read(path, window)
    try:
        found = {field: tuple(cut(f"{layer}.{name}.{axis}") for axis in axes) for field, _, name, axes in PASSES}
    except KeyError as error:
        raise Problem(
            "The render has no pass {}. Press Repair in the Indirect Light panel, then render again", _text(error)
        ) from error
    (found["depth"],) = found["depth"]
    return gather.Passes(**found, motion=_motion(cut, layer, step))


def _motion(cut, layer, step):
    """gather.Passes.motion: None where the view layer has no such pass, and where it is empty, as with motion blur."""
    _, _, name, axes = MOTION
    try:
        motion = tuple(cut(f"{layer}.{name}.{axis}") for axis in axes)
    except KeyError:
        return None
    return tuple(step * axis for axis in motion) if any(axis.any() for axis in motion) else None


def read(path, window):
    """A function from the name of a channel ("ViewLayer.Normal.X") of a file that save() wrote to its (H, W) float32,
    rows top first, or KeyError. window, Problem: as load() has them."""
    channels = _channels(path)

    def cut(name):
        pixels = channels[name]
        x, y, width, height = window
        if pixels.shape != (height, width):
            top = pixels.shape[0] - y - height
            pixels = pixels[top : top + height, x : x + width]
        return np.asarray(pixels, np.float32)

    return cut


def contents(path, layers):
    """{view layer: [(pass, its channels in Blender's order)]} of a file that save() wrote."""
    found = {}
    for name in _channels(path):
        of, kind, channel = ("", *name.rsplit(".", 2))[-3:]  # names of passes have no dots: Blender replaces them
        if of in layers:  # the file holds the compositor's picture as well
            found.setdefault(of, {}).setdefault(kind, []).append(channel)
    order = "RGBXYZWUVA"
    return {
        layer: [
            (kind, "".join(sorted(channels, key=lambda channel: order.find(channel.upper()))))
            for kind, channels in of.items()
        ]
        for layer, of in found.items()
    }


def _channels(path):
    """{channel: (height, width) float32, rows top first} of a file that save() wrote. Raises Problem."""
    try:
        import OpenEXR
    except ImportError as error:
        raise Problem(
            "The OpenEXR module can't be imported ({}). It comes with the extension: remove Afterlight in "
            "Preferences > Get Extensions and install it again from its zip",
            _text(error),
        ) from error
    try:
        temp_files.check(path)
        channels = _mapped(path, OpenEXR.File(path, separate_channels=True, header_only=True).header())
        if channels is None:
            parts = OpenEXR.File(path, separate_channels=True).parts
            channels = {name: channel.pixels for part in parts for name, channel in part.channels.items()}
        if not channels:  # OpenEXR only prints why
            raise EOFError("it holds no whole pass")
        return channels
    except Exception as error:  # OpenEXR raises bare RuntimeError, ValueError and its own for a truncated file
        raise Problem(
            "The passes could not be read back from {} ({}). The disk of the temporary folder may be full: free some "
            "space there",
            path,
            _text(error),
        ) from error


def discard(path):
    """Remove a file that save() wrote; no error where it is gone."""
    temp_files.remove(path)


def size(path):
    """Bytes of a file that save() wrote, 0 where it is gone."""
    try:
        return os.path.getsize(path)
    except OSError:
        return 0


def window(scene):
    """(x, y, width, height): the pixels that are rendered, counted from the bottom left of the full frame, and the
    full frame's (width, height). Rounded as Blender rounds."""
    render = scene.render
    full = tuple(
        max(1, int(size * render.resolution_percentage / 100)) for size in (render.resolution_x, render.resolution_y)
    )
    if not render.use_border:
        return (0, 0, *full), full

    def pixel(share, size):
        return int(np.float32(share) * np.float32(size))

    x, y = pixel(render.border_min_x, full[0]), pixel(render.border_min_y, full[1])
    return (x, y, pixel(render.border_max_x, full[0]) - x, pixel(render.border_max_y, full[1]) - y), full


def first_layer(scene):
    """The first view layer that is rendered."""
    return next(layer for layer in scene.view_layers if layer.use)


def camera(evaluated, depsgraph, scene, layer=None):
    """gather.Camera of an evaluated camera object, for the part of `scene`'s frame that is rendered. layer: name of
    the view layer, by default the first that is rendered.

    From Blender's own projection matrix, so that lens, sensor fit, shift and pixel aspect are all in it.
    """
    (x, y, _, _), full = window(scene)
    aspect = scene.render.pixel_aspect_x, scene.render.pixel_aspect_y
    layer = scene.view_layers[layer] if layer else first_layer(scene)
    return camera_at(
        evaluated.matrix_world, evaluated, depsgraph, (x, y), full, aspect, pixel_jitter.middle(scene, layer)
    )


def camera_at(matrix, lens, depsgraph, corner, full, aspect, middle=(0.0, 0.0)):
    """gather.Camera at `matrix` with the lens of the camera object `lens`, for the part of a frame of `full` pixels
    (width, height) that begins at `corner`. middle: where in its pixels the depth was sampled, as pixel_jitter.py has
    it."""
    (x, y), (width, height) = corner, full
    projection = np.array(lens.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=aspect[0], scale_y=aspect[1]))
    axes = np.array(matrix.to_3x3())
    to_world = axes / np.linalg.norm(axes, axis=0)  # Blender renders as if a scaled camera were not
    return camera_through(
        projection,
        np.linalg.inv(to_world),
        matrix.translation,
        np.array([x, y]) + middle,
        (width, height),
        orthographic=lens.data.type == "ORTHO",
    )


def camera_through(projection, rotation, position, corner, full, *, orthographic):
    """gather.Camera of a projection matrix (4, 4) float64. corner: of the picture, within the frame of `full` pixels,
    in pixels."""
    # ndc = (P00 q + P02 * -1) / 1 in perspective, P00 q + P03 in orthographic; ndc = 2 pixel / size - 1.
    shift = -projection[:2, 3] if orthographic else projection[:2, 2]
    focus, size = projection[(0, 1), (0, 1)], np.array(full, float)
    return gather.Camera(
        rotation=rotation,
        scale=2 / size / focus,
        offset=(2 * np.asarray(corner) / size - 1 + shift) / focus,
        orthographic=orthographic,
        position=np.array(position, float),
    )


def positions(frame, seen, flat):
    """(N, 3) float64, in the world: where the pixels of gather.Passes with these flat indices lie, through
    gather.Camera."""
    width, height = frame.size
    row, column = np.divmod(flat, width)
    ray = seen.offset + seen.scale * np.stack([column + 0.5, height - row - 0.5], axis=-1)
    depth = frame.depth[row, column].astype(float)[:, None]
    local = np.concatenate([ray * (1 if seen.orthographic else depth), -depth], axis=1)
    return local @ seen.rotation + seen.position  # the inverse of the rotation is its transpose


def project(places, size, seen):
    """(rows, columns, depths) of world positions (N, 3) in a frame of `size` (width, height) seen through
    gather.Camera; rows and columns are -1 where a position is not in the frame."""
    width, height = size
    local = (places - seen.position) @ seen.rotation.T
    depth = -local[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        ray = local[:, :2] if seen.orthographic else local[:, :2] / depth[:, None]
    column, up = np.nan_to_num((ray - seen.offset) / seen.scale, nan=-1.0, posinf=-1.0, neginf=-1.0).T
    inside = (depth > 0) & (column >= 0) & (column < width) & (up >= 0) & (up < height)
    row = np.where(inside, height - 1 - np.floor(up).clip(0, height - 1), -1).astype(int)
    return row, np.where(inside, np.floor(column), -1).astype(int), depth


def _mapped(path, header):
    """{channel: (H, W) float32, rows top first} in the file's own memory, or None where it is not laid out as save()
    asks for it: OpenEXR must then read it, or say what is wrong with it.

    OpenEXR's reader copies every pass of every layer; here only what is used is touched, and copied once, on its way to
    the GPU. In a file of one part without compression each row is its number, its size in bytes, and its channels.
    """
    channels = header["channels"]
    (left, top), (right, bottom) = header["dataWindow"]
    width, height = int(right - left + 1), int(bottom - top + 1)
    line = 8 + 4 * width * len(channels)
    with open(path, "rb") as file:
        pages = mmap.mmap(
            file.fileno(), 0, access=mmap.ACCESS_COPY
        )  # what is written to the arrays stays out of the file
    data = np.frombuffer(pages, np.uint8)
    start = data.size - height * line
    if start <= 0:
        return None
    lines = data[start:].reshape(height, line)
    numbers, sizes = lines[:, :8].copy().view("<i4").T
    if not np.array_equal(numbers, np.arange(top, bottom + 1)) or np.any(sizes != line - 8):
        return None
    if hasattr(mmap, "MADV_DONTNEED"):  # for a row's number the system has mapped what is around it as well
        pages.madvise(mmap.MADV_DONTNEED)
    planes = lines[:, 8:].view("<f4").reshape(height, len(channels), width)
    return {channel.name: planes[:, index] for index, channel in enumerate(channels)}


def _to_multilayer_exr(render):
    """Image settings for save(). Returns the user's own, for put_back.restore()."""
    image_settings = render.image_settings
    # Only what is in use: to read a name that was never chosen makes Blender print a warning.
    linear = image_settings.has_linear_colorspace or image_settings.color_management == "OVERRIDE"
    video = render.ffmpeg if image_settings.media_type == "VIDEO" else None
    saved = put_back.record(image_settings, video, leave=() if linear else ("linear_colorspace_settings",))
    try:
        image_settings.media_type = "MULTI_LAYER_IMAGE"
        image_settings.file_format = "OPEN_EXR_MULTILAYER"
        image_settings.color_depth = "32"
        image_settings.exr_codec = "NONE"
        image_settings.use_exr_interleave = (
            True  # half the time to write of one part a pass (docs/blender/rendering.md)
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


def _text(error):
    return " ".join(str(error).split())
