# SPDX-License-Identifier: GPL-3.0-or-later
"""All views on the GPU: their depth maps, and records of the blocks of their pixels that send and receive light."""

from dataclasses import dataclass

import numpy as np

from . import device
from .device import Texture
from .shader_interface import RECORDS_WIDTH
from .stages import Report, frame_block, upload
from .types import GpuPasses, Passes, RadiositySettings, View
from .view_layout import KINDS, grid_of, own_table, rows_of, view_table


@dataclass(frozen=True, eq=False)
class Records:
    """All views on the GPU. table: the VIEWS block. depths: their depth maps, one above the other. emitters, receivers:
    textures of records (shaders/radiosity/emit.glsl)."""

    table: np.ndarray
    depths: Texture
    emitters: Texture
    receivers: Texture


def build_records(
    views: list[View],
    settings: RadiositySettings,
    world: np.ndarray | None = None,
    size: tuple[int, int] | None = None,
    report: Report = lambda stage, fraction: None,
    broken: dict[str, int] | None = None,
) -> tuple[Records, dict[str, Texture], Passes | GpuPasses]:
    """(records of all views, channels and passes of the main view). size: (width, height) of views that are not coarse,
    if it is not the main view's own. One view's passes are held at a time."""
    passes: Passes | GpuPasses | None = views[0].load_passes()
    assert passes is not None
    table = view_table(views, size or passes.size, settings, world)
    width, height = (int(side) for side in table["depth_size"])
    depths = device.texture(width, height * len(views), "RG32F")
    for index, view in enumerate(views):
        report("views", index / len(views) / 2)
        passes = passes or view.load_passes()
        device.dispatch(
            "depths",
            upload(passes, light=False) | {"depths_out": depths},
            device.groups(width, height),
            frame=frame_block(view.camera, passes.size),
            views=own_table(view, table),
            view=index,
        )
        if index + 1 < len(views):
            passes = None  # before the next ones are loaded
    targets = {kind: device.texture(4 * RECORDS_WIDTH, rows_of(table, kind)) for kind in KINDS}
    channels: dict[str, Texture] = {}
    for index in reversed(range(len(views))):  # the main one last: its channels are needed again
        report("views", 1 - (index + 1) / len(views) / 2)
        channels.clear()
        passes = passes or views[index].load_passes()
        channels = upload(passes, None if index else broken)
        _emit(views[index], index, passes, channels | {"depths": depths}, own_table(views[index], table), targets)
        if index:
            passes = None
    assert passes is not None
    return Records(table, depths, **targets), channels, passes


def _emit(
    view: View,
    index: int,
    passes: Passes | GpuPasses,
    textures: dict[str, Texture],
    table: np.ndarray,
    targets: dict[str, Texture],
) -> None:
    """Write one view's records. textures: its channels, and "depths". targets: those of all views' records, by their
    kinds."""
    name = "emit_with_normals" if passes.lacks_normals() else "emit"
    for kind, target in targets.items():
        device.dispatch(
            name,
            textures | {"records_out": target},
            device.groups(*grid_of(table, kind, index)),
            frame=frame_block(view.camera, passes.size),
            views=table,
            view=index,
            receives=kind == "receivers",
        )


def specular_emitters(views: list[View], records: Records) -> Texture:
    """Records of emitters with the specular light of lamps and world in place of the diffuse light, and with Glossy
    Color in place of the albedo; black where a view has none."""
    target = device.texture(4 * RECORDS_WIDTH, rows_of(records.table, "emitters"))
    target.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 0.0))
    for index, view in enumerate(views):
        passes = view.load_specular()
        if passes is not None:
            # Named nowhere here, the channels are freed before the next view's come.
            _emit(view, index, passes, upload(passes) | {"depths": records.depths}, records.table, {"emitters": target})
    return target
