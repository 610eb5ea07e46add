# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame of any size without Blender: a room with boxes and spheres under a lamp, traced exactly by numpy.

    passes, camera = room.frame(light, 1280, 720)        # `light` from opengl.start()
    views = room.views(light, 1280, 720, 4)              # that frame and 4 further views

What a GPU's caches live from is as in a real frame: smooth surfaces, edges between them, shadows, no noise."""

import numpy as np

ROOM = np.array([[-3.0, -1.6, -8.5], [3.0, 1.6, 0.5]])  # opposite corners, m; the camera is at the origin
FIELD_OF_VIEW = 1.2  # across, radians
SPHERES = np.array([[-1.6, -0.9, -5.2, 0.7], [0.6, -1.25, -3.4, 0.35], [2.1, -0.2, -6.8, 0.6]])  # centre, radius
BOXES = np.array(
    [
        [-0.5, -0.7, -7.0, 0.55, 0.9, 0.55, 0.4],
        [1.6, -1.2, -4.6, 0.5, 0.4, 0.5, -0.5],
        [2.1, -1.2, -6.8, 0.7, 0.4, 0.7, 0.1],
    ]
)  # centre, half the sides, turn about y in radians
LAMP = np.array([0.0, 1.3, -4.5])
INTENSITY = 12.0  # W / sr
WALL_COLORS = [[0.75, 0.1, 0.08], [0.7, 0.7, 0.7], [0.7, 0.7, 0.7], [0.12, 0.5, 0.15], [0.7, 0.7, 0.7], [0.7, 0.7, 0.7]]
SOLID_COLORS = [
    [0.8, 0.6, 0.2],
    [0.75, 0.75, 0.75],
    [0.2, 0.35, 0.75],
    [0.7, 0.7, 0.7],
    [0.6, 0.25, 0.5],
    [0.75, 0.75, 0.75],
]
COLORS = np.array(WALL_COLORS + SOLID_COLORS)
SIGN = np.array([[-0.8, 0.4], [0.8, 1.0]])  # part of the far wall that emits light: x and y, m
SIGN_RADIANCE = 3.0, 1.8, 0.6  # W sr^-1 m^-2
ROWS = 1 << 14  # pixels traced at a time
# Further views: place, m, and direction. The first see the room from its corners, the others what those leave out.
EYES = (
    ((-2.7, 1.2, 0.2), (0.6, -0.6, -1)),
    ((2.7, 1.3, -8.2), (-0.7, -0.6, 1)),
    ((-2.7, 0.9, -8.2), (0.8, -0.5, 1)),
    ((2.7, 1.3, -0.3), (-0.7, -0.5, -1)),
    ((0.0, 1.4, -3.0), (0.1, -1, -0.4)),
    ((-1.0, -1.3, -2.0), (0.3, 1, -0.6)),
    ((0.3, 0.0, -5.5), (0.2, 0, 1)),
    ((-2.6, -1.2, -3.5), (1, 0.2, -0.3)),
    ((1.0, 0.2, -8.2), (-1, 0, 0.3)),
)
VIEW_FIELD = np.radians(120)  # of a further view across and up, as in addon/scene/view_cameras.py


def views(light, width, height, further):
    """[light.View]: the frame, and so many further views, of as many pixels, as the add-on renders them."""
    passes, camera = frame(light, width, height)
    return [light.View(passes, camera), *(view(light, width, height, number) for number in range(further))]


def view(light, width, height, number):
    """light.View from one of EYES. Its pixels are not square, since its field of view is."""
    place, towards = EYES[number]
    back = -np.array(towards) / np.linalg.norm(towards)
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    scale = 2 * np.tan(VIEW_FIELD / 2) / np.array([width, height])
    rotation = np.stack([right, np.cross(back, right), back])
    camera = light.Camera(rotation, scale, -scale * (width, height) / 2, position=np.array(place))
    return light.View(*frame(light, width, height, camera))


def frame(light, width, height, camera=None):
    """(light.Passes, light.Camera) of width x height pixels. Without a camera: the main view's, at the origin."""
    if camera is None:
        scale = np.full(2, 2 * np.tan(FIELD_OF_VIEW / 2) / width)
        camera = light.Camera(rotation=np.eye(3), scale=scale, offset=-scale * (width, height) / 2)
    scale = camera.scale
    channels = np.empty((13, height, width), np.float32)  # in the order of light.Passes, rows top first
    step = max(1, ROWS // width)
    for first in range(0, height, step):
        rows = np.arange(first, min(first + step, height))
        x, y = np.meshgrid(np.arange(width) + 0.5, height - rows - 0.5)
        ray = np.stack([camera.offset[0] + scale[0] * x, camera.offset[1] + scale[1] * y, np.full(x.shape, -1.0)])
        ray = camera.rotation.T @ ray.reshape(3, -1)
        channels[:, rows] = shade(ray, camera.position[:, None]).reshape(13, *x.shape)
    depth, *others = channels
    return light.Passes(depth, *(tuple(others[k : k + 3]) for k in range(0, 12, 3))), camera


def shade(ray, origin):
    """(13, n): depth, normal, albedo, direct light and emission where rays (3, n) from a camera at origin (3, 1) end.
    Rays are as long as it takes for the planar depth to be 1."""
    depth, thing, normal = trace(origin, ray)
    place = origin + ray * depth
    to_lamp = LAMP[:, None] - place
    square = (to_lamp**2).sum(0)
    facing = np.maximum((normal * to_lamp).sum(0), 0) / np.sqrt(square)
    reach, _, _ = trace(place + 1e-6 * normal, to_lamp)
    direct = INTENSITY / np.pi * facing / square * (reach > 1)
    shining = (thing == 2) & ((place[:2] > SIGN[0][:, None]) & (place[:2] < SIGN[1][:, None])).all(0)
    return np.concatenate(
        [depth[None], normal, COLORS[thing].T, np.tile(direct, (3, 1)), np.outer(SIGN_RADIANCE, shining)]
    )


def trace(origin, ray):
    """Where rays (3, n) first meet something: distance in lengths of the ray, what (index in COLORS), normal (3, n)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        hits = [
            _room(origin, ray),
            *(_sphere(origin, ray, *sphere) for sphere in SPHERES),
            *(_box(origin, ray, *box) for box in BOXES),
        ]
    distance, thing, normal = hits[0]
    for index, (near, other) in enumerate(hits[1:], start=6):
        closer = near < distance
        distance, thing = np.where(closer, near, distance), np.where(closer, index, thing)
        normal = np.where(closer, other, normal)
    return distance, thing, normal


def _room(origin, ray):
    ends = (ROOM[:, :, None] - origin) / ray  # (2, 3, n): the walls of lower and of upper coordinates
    ahead = np.where(ray > 0, ends[1], np.where(ray < 0, ends[0], np.inf))
    axis = ahead.argmin(0)
    upper = np.take_along_axis(ray, axis[None], 0)[0] > 0
    normal = np.where(np.arange(3)[:, None] == axis, np.where(upper, -1.0, 1.0), 0.0)
    return ahead.min(0), axis + 3 * upper, normal  # far wall: axis 2, lower


def _sphere(origin, ray, x, y, z, radius):
    path = origin - np.array([[x], [y], [z]])
    a, b = (ray * ray).sum(0), (path * ray).sum(0)
    distance = (-b - np.sqrt(b * b - a * ((path * path).sum(0) - radius * radius))) / a
    distance = np.where(distance > 0, distance, np.inf)  # NaN, a miss, compares false
    return distance, (path + ray * np.where(np.isfinite(distance), distance, 0)) / radius


def _box(origin, ray, x, y, z, *shape):
    turn = np.array([[np.cos(shape[3]), 0, -np.sin(shape[3])], [0, 1, 0], [np.sin(shape[3]), 0, np.cos(shape[3])]])
    path, ray = turn @ (origin - np.array([[x], [y], [z]])), turn @ ray
    half = np.array(shape[:3])[:, None]
    enter, leave = np.sort([(-half - path) / ray, (half - path) / ray], axis=0)
    near = enter.max(0)
    normal = np.where(np.arange(3)[:, None] == enter.argmax(0), -np.sign(ray), 0.0)
    return np.where((near < leave.min(0)) & (near > 0), near, np.inf), turn.T @ normal
