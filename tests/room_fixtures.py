# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of a room of boxes, traced exactly. Needs no Blender: `light` is addon/gather, however it was loaded."""

import numpy as np

AXES = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
EYE = (0.1, 0.05, -0.1)  # of the six cameras, beside the middle of the box, so that nothing is symmetric by accident
ROOM = ((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
# A hall with two rows of pillars, and eyes (place, towards) that see them along: places behind one pillar and before
# another are a small step apart.
HALL = ((-1.0, -6.0, -1.0), (1.0, 6.0, 1.0))
PILLARS = tuple(
    ((x - 0.1, y - 0.1, -1.0), (x + 0.1, y + 0.1, 1.0)) for x in (-0.5, 0.5) for y in np.arange(-5, 5.1, 1.25)
)
ALONG = (
    ((0.05, -5.8, 0.1), (0, 1, 0)),
    ((-0.4, 5.8, 0.3), (0.7, -0.7, 0)),
    ((0.4, 5.7, -0.2), (-0.7, -0.7, 0)),
    ((-0.8, -5.7, 0), (0.7, 0.7, 0)),
    ((0.8, -5.6, 0.5), (-0.7, 0.7, -0.1)),
)


def look(towards, up=(0, 0, 1)):
    """Rotation, world to view, of a camera that looks that way."""
    back = -np.asarray(towards, float) / np.linalg.norm(towards)
    up = (0, 1, 0) if abs(np.dot(up, back)) > 0.9 else up
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(back, right), back])


def camera_at(light, eye, towards, size, *, fov=np.pi / 2, across=None, shift=(0.0, 0.0)):
    """A Camera with square pixels; across: metres, of an orthographic one; shift: of the image, in halves of its
    width."""
    width, height = size
    half = np.tan(fov / 2) if across is None else across / 2
    offset = half * (np.array([-1.0, -height / width]) + shift)
    return light.Camera(look(towards), np.full(2, 2 * half / width), offset, across is not None, np.asarray(eye, float))


def trace(camera, size, room=ROOM, solids=()):
    """(depth, place, normal), bottom row first, of what a camera inside a room of solid boxes, both (low, high),
    sees."""
    width, height = size
    i, j = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    ray = np.stack(
        [camera.offset[0] + camera.scale[0] * i, camera.offset[1] + camera.scale[1] * j, -np.ones(i.shape)], -1
    )
    flat, ahead = ray * (1, 1, 0), np.broadcast_to([0.0, 0.0, -1.0], ray.shape)
    start = camera.position + (flat @ camera.rotation if camera.orthographic else 0 * ray)
    path = (ahead if camera.orthographic else ray) @ camera.rotation
    with np.errstate(divide="ignore", invalid="ignore"):
        leave = np.where(path == 0, np.inf, np.maximum((room[0] - start) / path, (room[1] - start) / path))
    axis, depth = leave.argmin(-1), leave.min(-1)
    normal = -np.sign(path) * (np.arange(3) == axis[..., None])
    for low, high in solids:
        with np.errstate(divide="ignore", invalid="ignore"):
            near, far = np.sort([(low - start) / path, (high - start) / path], axis=0)
        enter, axis = near.max(-1), near.argmax(-1)
        hit = (enter < far.min(-1)) & (enter > 0) & (enter < depth)
        depth = np.where(hit, enter, depth)
        normal = np.where(hit[..., None], -np.sign(path) * (np.arange(3) == axis[..., None]), normal)
    return depth, start + path * depth[..., None], normal


def is_hidden(start, end, solids, thinnest=1e-5):
    """(n,) bool: does a solid lie on the way between two places, (n, 3) each? thinnest: share of the way inside it,
    less than which is grazing."""
    hidden = np.zeros(len(start), bool)
    path = end - start
    for low, high in solids:
        with np.errstate(divide="ignore", invalid="ignore"):
            near, far = np.sort([(low - start) / path, (high - start) / path], axis=0)
        hidden |= np.minimum(far.min(-1), 1) - np.maximum(near.max(-1), 0) > thinnest
    return hidden


def view_of(light, camera, size, *, albedo=0.5, radiance=1.0, room=ROOM, solids=()):
    """A View of the room. albedo, radiance (of the direct light that surfaces send): a number, or a function of
    (place, normal) that gives (H, W, 3)."""
    depth, place, normal = trace(camera, size, room, solids)
    color, sent = (
        (value(place, normal) if callable(value) else np.full_like(normal, value)) for value in (albedo, radiance)
    )

    def split(image):
        return tuple(np.ascontiguousarray(image[::-1, :, c], np.float32) for c in range(3))

    direct = sent / np.where(color > 0, color, 1)
    return light.View(
        light.Passes(
            np.ascontiguousarray(depth[::-1], np.float32),
            split(normal),
            split(color),
            split(np.where(color > 0, direct, 0)),
            split(np.where(color > 0, 0, sent)),
        ),
        camera,
    )


def box_views(light, size=(64, 64), eye=EYE, towards=AXES, **scene):
    """Views of the closed box from one place, by default all of it, as the faces of a cube."""
    return [view_of(light, camera_at(light, eye, axis, size), size, **scene) for axis in towards]


def lamp(place, normal):
    """Direct light of a lamp near the ceiling on walls of different colours: radiance that changes everywhere."""
    path = np.array([0.3, -0.2, 0.7]) - place
    square = (path**2).sum(-1, keepdims=True)
    return np.maximum((normal * path).sum(-1, keepdims=True), 0) / square**1.5 * (0.6 + 0.4 * normal)
