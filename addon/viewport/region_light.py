# SPDX-License-Identifier: GPL-3.0-or-later
"""One region of a rendered viewport, from what it sees to the light that is added to it.

While its view or the scene changes, the light is drafted in every redraw: passes drawn at the size of the depth maps,
few draws, few bounces, averaged with the frames before. When nothing has changed for a moment it is gathered as a
render would, again and again through other places in the pixels, and the mean is shown, until that has as little noise
as the frames of an animation. Then nothing is drawn.
"""

import time
from dataclasses import dataclass, replace

import bpy
from mathutils import Matrix

from .. import gather, properties
from ..gather import interactive
from ..gather.radiosity import start_of
from ..gather.temporal import REBUILT, STRIDE
from ..scene import world_light
from ..scene.pixel_jitter import radical_inverse
from . import blend, offscreen, scene_changes

SETTLE_SECONDS = 0.3  # seconds without a change, after which the light is gathered in full
DRAFT_SECONDS = 0.1  # seconds that a draft may take; where it takes longer, its texels get coarser
VIEWS_PER_REDRAW = 2  # further views that are drawn again in one redraw
DRAFT_GROUPS, DRAFT_BOUNCES = 4, 3  # at most: half the draws of the preset Draft
MAX_TEXEL_SIZE = 4  # pixels of a draft along its base's texels


@dataclass(frozen=True, eq=False)
class ViewportContext:
    """What is drawn, and where."""

    scene: bpy.types.Scene
    layer: bpy.types.ViewLayer
    space: bpy.types.SpaceView3D
    region: bpy.types.Region
    rv3d: bpy.types.RegionView3D
    depsgraph: bpy.types.Depsgraph

    @property
    def size(self):
        """(width, height) of the picture that EEVEE draws, in pixels."""
        chosen = self.scene.render.preview_pixel_size
        pixel = (
            (2 if bpy.context.preferences.system.pixel_size > 1.5 else 1) if chosen == "AUTO" else int(chosen)
        )  # as Blender has it
        return tuple(max(1, side // pixel) for side in self.extent)

    def shown_state(self):
        """All that decides which surfaces and lamps a viewport shows of a still scene."""
        space, shading = self.space, self.space.shading
        kinds = [name for name in space.bl_rna.properties.keys() if name.startswith("show_object_viewport_")]
        return (
            self.scene.session_uid,
            self.layer.name,
            space.local_view is not None,
            space.use_local_collections,
            shading.use_scene_lights_render,
            shading.use_scene_world_render,
            shading.studio_light,
            shading.studiolight_rotate_z,
            shading.studiolight_intensity,
            *(getattr(space, name) for name in kinds),
        )

    def view_state(self):
        """All that decides what the region sees of a still scene."""
        return (
            *map(tuple, self.rv3d.view_matrix),
            *map(tuple, self.rv3d.window_matrix),
            self.extent,
            self.size,
            *self.shown_state(),
        )

    @property
    def extent(self):
        """(width, height) of the region in pixels."""
        return self.region.width, self.region.height


class RegionLight:
    """further: the Further of its viewport."""

    def __init__(self, further):
        self.view_cache, self._offscreen_picture = further, offscreen.OffscreenPicture()
        self._view_state, self._counts, self._options = None, None, None
        self._changed_at = 0.0  # when something last did
        self._texel_size = 1  # pixels of a draft along its base's texels
        self._drawn, self._camera = None, None  # of the last draft
        self._history, self._mean = gather.History(), interactive.Mean()
        self._gathers, self._wanted = 0, REBUILT
        self._worlds = {}  # world_light.light()'s, until something changes

    def update(self, stage):
        """Bring the light up to date, or nearer to its end, within what one redraw may take. Returns in how many
        seconds there is more to do, None if there is nothing. Raises gather.GpuUnavailable."""
        now, chosen = time.perf_counter(), _settings(stage)
        self._wanted = max(REBUILT, chosen.gathers) if isinstance(chosen, gather.Draws) else REBUILT
        stale = self._look_for_changes(stage)
        if stale is not None:
            self._gather_draft(stage, stale, chosen)
            self._changed_at, self._gathers = time.perf_counter(), 0
            return SETTLE_SECONDS
        if (left := self._changed_at + SETTLE_SECONDS - now) > 0:
            return left
        self.view_cache.place(stage, self._drawn, self._camera)
        if self.view_cache.is_stale():
            with offscreen.drawing(stage):
                self.view_cache.refresh(stage, VIEWS_PER_REDRAW)
            self._gathers = 0
        elif self._gathers < self._wanted:
            self._gather(stage, chosen)
        if self.view_cache.is_stale() or self._gathers < self._wanted:
            return 0.0
        self._offscreen_picture.free()  # it is large: EEVEE has a pool of shadows for each
        return None

    def show(self, stage):
        """Add the light to the picture, if it is of this view."""
        if self._mean.texture is not None and self._view_state == stage.view_state():
            blend.add(self._mean.texture, stage.extent, stage.scene.afterlight.strength)

    def progress(self):
        """(gathers that the picture shows, of how many in the end)."""
        return self._gathers, self._wanted

    def free(self):
        self._offscreen_picture.free()
        self._drawn, self._history = None, gather.History()
        self._mean.clear()

    def _look_for_changes(self, stage):
        """The passes that are to be drawn again, by their names in eevee.ALL; None where nothing has changed."""
        seen, stamps, options = stage.view_state(), scene_changes.change_counts(stage.scene), _options(stage)
        before = self._view_state, self._counts, self._options
        self._view_state, self._counts, self._options = seen, stamps, options
        others = self.view_cache.follow(stage)
        if before[1] != stamps:
            self._worlds.clear()
        if before[0] != seen or before[1].geometry != stamps.geometry:
            return offscreen.ALL_PASSES
        if before[1].lights != stamps.lights:
            return offscreen.LIGHT_PASSES
        return () if others or before[2] != options else None

    def _gather_draft(self, stage, stale, chosen):
        start = time.perf_counter()
        size = interactive.coarse_size(stage.size)
        if self._drawn is None or self._drawn.size != size:
            self._drawn, stale = gather.Drawn(size, {}), offscreen.ALL_PASSES
        with offscreen.drawing(stage):
            camera = self.view_cache.offscreen_picture.draw(
                stage, stage.rv3d.view_matrix, stage.rv3d.window_matrix, self._drawn, stale
            )
            self._camera = camera or self._camera
            self.view_cache.refresh(stage, VIEWS_PER_REDRAW)
        if isinstance(chosen, gather.Draws):
            chosen = replace(
                chosen,
                start=self._texel_size,
                groups=min(chosen.groups, DRAFT_GROUPS),
                bounces=min(chosen.bounces, DRAFT_BOUNCES),
                seed=chosen.seed + int(start * 1e3),
            )
        else:
            chosen = replace(chosen, start=self._texel_size, samples=chosen.samples // 2)
        self._add(stage, gather.View(self._drawn, self._camera, coarse=True), chosen, fresh=True)
        seconds = time.perf_counter() - start
        if seconds > DRAFT_SECONDS:
            self._texel_size = min(2 * self._texel_size, MAX_TEXEL_SIZE)
        elif seconds < DRAFT_SECONDS / 4:
            self._texel_size = max(self._texel_size // 2, 1)

    def _gather(self, stage, chosen):
        """Once more, as a render does, through another place in the pixels."""
        drawn = gather.Drawn(stage.size, {})
        with offscreen.drawing(stage):
            camera = self._offscreen_picture.draw(
                stage, stage.rv3d.view_matrix, _shifted(stage.rv3d.window_matrix, self._gathers, stage.size), drawn
            )
        chosen = replace(chosen, seed=chosen.seed + STRIDE * self._gathers)
        if isinstance(chosen, gather.Draws):
            chosen = replace(chosen, start=start_of(chosen, stage.size))
        self._add(stage, gather.View(drawn, camera), chosen, fresh=self._gathers == 0)
        self._gathers += 1

    def _add(self, stage, main, chosen, fresh):
        """One gather to what is shown, or in its place."""
        views = [main, *self.view_cache.views()]
        history = self._history if main.coarse and stage.scene.afterlight.use_history else None
        found = interactive.indirect(
            views, stage.size, replace(chosen, strength=1.0), _world(stage, self._worlds), history
        )
        if fresh:
            self._mean.clear()
        self._mean.add(found, main.passes.size)


def _settings(stage):
    """gather.Draws or gather.Settings of the scene. What Blender's Denoise node would do in the compositor, smoothing
    does."""
    chosen = properties.light_settings(stage.scene.afterlight, stage.scene.frame_current)
    smoothed = stage.scene.afterlight.denoise != "NONE"
    return replace(chosen, smooth=smoothed) if isinstance(chosen, gather.Draws) else chosen


def _options(stage):
    """All settings that change the light, but for its strength, which is applied as it is shown."""
    chosen = stage.scene.afterlight
    return (*(getattr(chosen, each.name) for each in properties.PARAMETERS if each.name != "strength"),)


def _world(stage, known):
    """The world's light, as gather.gather_views() takes it, where it is the scene's own and its shadow is wanted."""
    if stage.space.shading.use_scene_world_render and stage.scene.afterlight.use_world_shadow:
        return world_light.read(stage.depsgraph, known)
    return None


def _shifted(window_matrix, number, size):
    """A window matrix that sees the pixels of a frame of `size` by another place within them each time, at first by
    their middles."""
    shift = [(radical_inverse(number, base) + 0.5) % 1 - 0.5 for base in (2, 3)]
    move = Matrix.Identity(4)
    for axis in range(2):
        move[axis][3] = 2 * shift[axis] / size[axis]
    return move @ window_matrix
