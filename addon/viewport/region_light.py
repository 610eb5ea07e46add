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

REST = 0.3  # seconds without a change, after which the light is gathered in full
SMOOTHLY = 0.1  # seconds that a draft may take; where it takes longer, its texels get coarser
AT_ONCE = 2  # further views that are drawn again in one redraw
DRAFT_DRAWS, DRAFT_BOUNCES = 4, 3  # at most: half the draws of the preset Draft
COARSEST = 4  # pixels of a draft along its base's texels


@dataclass(frozen=True, eq=False)
class Stage:
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

    def shows(self):
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

    def sees(self):
        """All that decides what the region sees of a still scene."""
        return (
            *map(tuple, self.rv3d.view_matrix),
            *map(tuple, self.rv3d.window_matrix),
            self.extent,
            self.size,
            *self.shows(),
        )

    @property
    def extent(self):
        """(width, height) of the region in pixels."""
        return self.region.width, self.region.height


class Region:
    """further: the Further of its viewport."""

    def __init__(self, further):
        self.further, self._film = further, offscreen.Film()
        self._seen, self._stamps, self._options = None, None, None
        self._changed = 0.0  # when something last did
        self._start = 1  # pixels of a draft along its base's texels
        self._drawn, self._camera = None, None  # of the last draft
        self._history, self._mean = gather.History(), interactive.Mean()
        self._gathers, self._wanted = 0, REBUILT
        self._worlds = {}  # world_light.light()'s, until something changes

    def work(self, stage):
        """Bring the light up to date, or nearer to its end, within what one redraw may take. Returns in how many
        seconds there is more to do, None if there is nothing. Raises gather.GpuUnavailable."""
        now, chosen = time.perf_counter(), _settings(stage)
        self._wanted = max(REBUILT, chosen.gathers) if isinstance(chosen, gather.Draws) else REBUILT
        stale = self._look_for_changes(stage)
        if stale is not None:
            self._draft(stage, stale, chosen)
            self._changed, self._gathers = time.perf_counter(), 0
            return REST
        if (left := self._changed + REST - now) > 0:
            return left
        self.further.place(stage, self._drawn, self._camera)
        if self.further.is_stale():
            with offscreen.drawing(stage):
                self.further.refresh(stage, AT_ONCE)
            self._gathers = 0
        elif self._gathers < self._wanted:
            self._gather(stage, chosen)
        if self.further.is_stale() or self._gathers < self._wanted:
            return 0.0
        self._film.free()  # it is large: EEVEE has a pool of shadows for each
        return None

    def show(self, stage):
        """Add the light to the picture, if it is of this view."""
        if self._mean.texture is not None and self._seen == stage.sees():
            blend.add(self._mean.texture, stage.extent, stage.scene.afterlight.strength)

    def progress(self):
        """(gathers that the picture shows, of how many in the end)."""
        return self._gathers, self._wanted

    def free(self):
        self._film.free()
        self._drawn, self._history = None, gather.History()
        self._mean.clear()

    def _look_for_changes(self, stage):
        """The passes that are to be drawn again, by their names in eevee.ALL; None where nothing has changed."""
        seen, stamps, options = stage.sees(), scene_changes.stamps(stage.scene), _options(stage)
        before = self._seen, self._stamps, self._options
        self._seen, self._stamps, self._options = seen, stamps, options
        others = self.further.follow(stage)
        if before[1] != stamps:
            self._worlds.clear()
        if before[0] != seen or before[1].shapes != stamps.shapes:
            return offscreen.ALL
        if before[1].lamps != stamps.lamps:
            return offscreen.LIT
        return () if others or before[2] != options else None

    def _draft(self, stage, stale, chosen):
        start = time.perf_counter()
        size = interactive.coarse_size(stage.size)
        if self._drawn is None or self._drawn.size != size:
            self._drawn, stale = gather.Drawn(size, {}), offscreen.ALL
        with offscreen.drawing(stage):
            camera = self.further.film.draw(stage, stage.rv3d.view_matrix, stage.rv3d.window_matrix, self._drawn, stale)
            self._camera = camera or self._camera
            self.further.refresh(stage, AT_ONCE)
        if isinstance(chosen, gather.Draws):
            chosen = replace(
                chosen,
                start=self._start,
                groups=min(chosen.groups, DRAFT_DRAWS),
                bounces=min(chosen.bounces, DRAFT_BOUNCES),
                seed=chosen.seed + int(start * 1e3),
            )
        else:
            chosen = replace(chosen, start=self._start, samples=chosen.samples // 2)
        self._add(stage, gather.View(self._drawn, self._camera, coarse=True), chosen, fresh=True)
        seconds = time.perf_counter() - start
        if seconds > SMOOTHLY:
            self._start = min(2 * self._start, COARSEST)
        elif seconds < SMOOTHLY / 4:
            self._start = max(self._start // 2, 1)

    def _gather(self, stage, chosen):
        """Once more, as a render does, through another place in the pixels."""
        drawn = gather.Drawn(stage.size, {})
        with offscreen.drawing(stage):
            camera = self._film.draw(
                stage, stage.rv3d.view_matrix, _shifted(stage.rv3d.window_matrix, self._gathers, stage.size), drawn
            )
        chosen = replace(chosen, seed=chosen.seed + STRIDE * self._gathers)
        if isinstance(chosen, gather.Draws):
            chosen = replace(chosen, start=start_of(chosen, stage.size))
        self._add(stage, gather.View(drawn, camera), chosen, fresh=self._gathers == 0)
        self._gathers += 1

    def _add(self, stage, main, chosen, fresh):
        """One gather to what is shown, or in its place."""
        views = [main, *self.further.views()]
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
        return world_light.light(stage.depsgraph, known)
    return None


def _shifted(window_matrix, number, size):
    """A window matrix that sees the pixels of a frame of `size` by another place within them each time, at first by
    their middles."""
    shift = [(radical_inverse(number, base) + 0.5) % 1 - 0.5 for base in (2, 3)]
    move = Matrix.Identity(4)
    for axis in range(2):
        move[axis][3] = 2 * shift[axis] / size[axis]
    return move @ window_matrix
