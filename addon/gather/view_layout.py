# SPDX-License-Identifier: GPL-3.0-or-later
"""The layout of several views: the sizes of their depth maps, the numbers of their records, and the VIEWS block.

The sizes do not depend on the picture's resolution: views and bounces cost the same for all.
"""

import numpy as np

from .shader_interface import RECORDS_WIDTH, VIEWS
from .types import RadiositySettings, View

DEPTHS_ACROSS = 320  # least texels along a depth map's longer side, and emitters along the main view's
EMITTER, RECEIVER = 1, 8  # texels of the depth map along the side of another view's emitters, of any view's receivers
KINDS = "emitters", "receivers"  # of records


def start_of(settings: RadiositySettings, size: tuple[int, int]) -> int:
    """Pixels along a base texel: as in the settings, but no coarser than the depth maps, since small pictures cost
    little."""
    return max(start for start in (1, 2, 4) if start <= min(settings.start, step_of(size)))


def step_of(size: tuple[int, int]) -> int:
    """Pixels along a texel of a depth map, for views of this (width, height) in pixels."""
    return max(1, max(size) // DEPTHS_ACROSS)


def layout(count: int, size: tuple[int, int]) -> np.ndarray:
    """A VIEWS block of so many views, with sizes and record numbers alone. size: (width, height) in pixels."""
    width, height = size
    step, table, first = step_of(size), np.zeros((), VIEWS.dtype), dict.fromkeys(KINDS, 0)
    table["depth_size"], table["depth_step"], table["count"] = (-(-width // step), -(-height // step)), step, count
    for index in range(count):
        for kind, side in zip(KINDS, (step * (EMITTER if index else 1), step * RECEIVER), strict=True):
            across, up = -(-width // side), -(-height // side)
            table["cameras"][kind][index] = first[kind], side, (across, up)
            first[kind] += across * up
    return table


def view_table(
    views: list[View], size: tuple[int, int], settings: RadiositySettings, world: np.ndarray | None = None
) -> np.ndarray:
    """The VIEWS block: cameras, and which records are whose. size: (width, height) of views that are not coarse, in
    pixels. world: as gather_views() has it."""
    table, origin = layout(len(views), size), np.asarray(views[0].camera.position, float)
    if world is not None and settings.visibility:
        table["world"][:, :3] = world
    cameras = table["cameras"]
    for index, view in enumerate(views):
        camera = view.camera
        position = np.asarray(camera.position, float) - origin
        cameras["rotation"][index, :, :3] = camera.rotation
        cameras["rotation"][index, :, 3] = -(camera.rotation @ position)
        cameras["scale"][index] = np.asarray(camera.scale) * (1 if view.coarse else step_of(size))
        cameras["offset"][index] = camera.offset
        cameras["is_orthographic"][index] = camera.orthographic
        cameras["position"][index] = position
    return table


def own_table(view: View, table: np.ndarray) -> np.ndarray:
    """The VIEWS block for passes that read the picture of this view, in whose pixels sizes are counted."""
    if not view.coarse:
        return table
    own = table.copy()
    for kind in KINDS:
        own["cameras"][kind]["side"] //= table["depth_step"]
    own["depth_step"] //= table["depth_step"]
    return own


def has_world(table: np.ndarray) -> bool:
    """Whether the world lights anything."""
    return bool(world_power(table) > 0)


def world_power(table: np.ndarray) -> np.float32:
    """Sum over r, g, b of the world light's mean radiance."""
    return np.abs(table["world"][0]).sum()


def grid_of(table: np.ndarray, kind: str, index: int) -> tuple[int, int]:
    """(across, up) of one view's records of a kind."""
    across, up = table["cameras"][kind]["size"][index]
    return int(across), int(up)


def count_of(table: np.ndarray, kind: str) -> int:
    """Records of a kind, of all views."""
    grids = table["cameras"][kind]
    last = grids[np.argmax(grids["first"])]
    return int(last["first"] + last["size"].prod())


def rows_of(table: np.ndarray, kind: str) -> int:
    """Rows of RECORDS_WIDTH that the records of a kind fill."""
    return -(-count_of(table, kind) // RECORDS_WIDTH)
