# SPDX-License-Identifier: GPL-3.0-or-later
"""The light of one region of a rendered viewport, from what it sees to the light that is added to it.

While the view or the scene changes, each redraw gathers a draft: passes at the size of the depth maps, few samples, few
bounces, averaged with the frames before. After a moment without changes the light is gathered as in a render, again and
again with other subpixel offsets, and the mean is shown, until it has as little noise as the frames of an animation.
Then nothing is drawn any more.
"""

import time
from dataclasses import dataclass, replace

import bpy
from mathutils import Matrix

from .. import gather, parameters
from ..gather import interactive
from ..gather.temporal import REBUILT, SEED_STRIDE
from ..gather.view_layout import start_of
from ..scene import world_light
from ..scene.pixel_jitter import radical_inverse
from . import blend, offscreen, scene_changes

SETTLE_SECONDS = 0.3  # without a change, until the light is gathered in full
DRAFT_SECONDS = 0.1  # that a draft may take; if it takes longer its texels get coarser
VIEWS_PER_REDRAW = 2  # views drawn again in one redraw, at most
DRAFT_GROUPS, DRAFT_BOUNCES = 4, 3  # at most; half the samples of the preset Draft
MAX_TEXEL_SIZE = 4  # pixels of a draft along one of its base texels


@dataclass(frozen=True, eq=False)
class ViewportContext:
    """The region that is being drawn, and what it shows."""

    scene: bpy.types.Scene
    layer: bpy.types.ViewLayer
    space: bpy.types.SpaceView3D
    region: bpy.types.Region
    rv3d: bpy.types.RegionView3D
    depsgraph: bpy.types.Depsgraph

    @property
    def size(self):
        """(width, height) of the image that EEVEE draws, in pixels."""
        pixel_size = self.scene.render.preview_pixel_size
        if pixel_size == "AUTO":  # as Blender decides it
            pixel = 2 if bpy.context.preferences.system.pixel_size > 1.5 else 1
        else:
            pixel = int(pixel_size)
        return tuple(max(1, side // pixel) for side in self.extent)

    def shown_state(self):
        """Everything that decides which surfaces and lights the viewport shows of a scene that doesn't change."""
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
        """Everything that decides what the region sees of a scene that doesn't change."""
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
    """The light of one region. view_cache: the ViewCache of its viewport."""

    def __init__(self, view_cache):
        self.view_cache, self._offscreen_picture = view_cache, offscreen.OffscreenPicture()
        self._view_state, self._counts, self._options = None, None, None
        self._changed_at = 0.0  # time of the last change
        self._texel_size = 1  # pixels of a draft along one of its base texels
        self._drawn, self._camera = None, None  # of the last draft
        self._history, self._mean = gather.History(), interactive.Mean()
        self._gathers, self._gathers_wanted = 0, REBUILT
        self._worlds = {}  # cache for world_light.read(), until something changes

    def update(self, viewport):
        """Bring the light up to date, or closer to its final state, within the time that one redraw may take. Returns
        the seconds until there is more to do, None if there is nothing. Raises gather.GpuUnavailable."""
        now, settings = time.perf_counter(), _settings(viewport)
        self._gathers_wanted = (
            max(REBUILT, settings.gathers) if isinstance(settings, gather.RadiositySettings) else REBUILT
        )
        stale = self._look_for_changes(viewport)
        if stale is not None:
            self._gather_draft(viewport, stale, settings)
            self._changed_at, self._gathers = time.perf_counter(), 0
            return SETTLE_SECONDS
        if (seconds_left := self._changed_at + SETTLE_SECONDS - now) > 0:
            return seconds_left
        self.view_cache.place(viewport, self._drawn, self._camera)
        if self.view_cache.is_stale():
            with offscreen.drawing(viewport):
                self.view_cache.refresh(viewport, VIEWS_PER_REDRAW)
            self._gathers = 0
        elif self._gathers < self._gathers_wanted:
            self._gather(viewport, settings)
        if self.view_cache.is_stale() or self._gathers < self._gathers_wanted:
            return 0.0
        self._offscreen_picture.free()  # it is large: EEVEE keeps a pool of shadows with each
        return None

    def show(self, viewport):
        """Add the light to the image if it belongs to the current view."""
        if self._mean.texture is not None and self._view_state == viewport.view_state():
            blend.add(self._mean.texture, viewport.extent, viewport.scene.afterlight.strength)

    def progress(self):
        """(gathers that the image shows, final number of gathers)."""
        return self._gathers, self._gathers_wanted

    def free(self):
        self._offscreen_picture.free()
        self._drawn, self._history = None, gather.History()
        self._mean.clear()

    def _look_for_changes(self, viewport):
        """Names, in offscreen.ALL_PASSES, of the passes to draw again; None if nothing has changed."""
        view_state, options = viewport.view_state(), _options(viewport)
        counts = scene_changes.change_counts(viewport.scene)
        previous = self._view_state, self._counts, self._options
        self._view_state, self._counts, self._options = view_state, counts, options
        views_changed = self.view_cache.follow(viewport)
        if previous[1] != counts:
            self._worlds.clear()
        if previous[0] != view_state or previous[1].geometry != counts.geometry:
            return offscreen.ALL_PASSES
        if previous[1].lights != counts.lights:
            return offscreen.LIGHT_PASSES
        return () if views_changed or previous[2] != options else None

    def _gather_draft(self, viewport, stale, settings):
        start = time.perf_counter()
        size = interactive.coarse_size(viewport.size)
        if self._drawn is None or self._drawn.size != size:
            self._drawn, stale = gather.GpuPasses(size, {}), offscreen.ALL_PASSES
        with offscreen.drawing(viewport):
            camera = self.view_cache.offscreen_picture.draw(
                viewport, viewport.rv3d.view_matrix, viewport.rv3d.window_matrix, self._drawn, stale
            )
            self._camera = camera or self._camera
            self.view_cache.refresh(viewport, VIEWS_PER_REDRAW)
        if isinstance(settings, gather.RadiositySettings):
            settings = replace(
                settings,
                start=self._texel_size,
                groups=min(settings.groups, DRAFT_GROUPS),
                bounces=min(settings.bounces, DRAFT_BOUNCES),
                seed=settings.seed + int(start * 1e3),
            )
        else:
            settings = replace(settings, start=self._texel_size, samples=settings.samples // 2)
        self._add(viewport, gather.View(self._drawn, self._camera, coarse=True), settings, fresh=True)
        seconds = time.perf_counter() - start
        if seconds > DRAFT_SECONDS:
            self._texel_size = min(2 * self._texel_size, MAX_TEXEL_SIZE)
        elif seconds < DRAFT_SECONDS / 4:
            self._texel_size = max(self._texel_size // 2, 1)

    def _gather(self, viewport, settings):
        """Gather once more as in a render, with another subpixel offset."""
        drawn = gather.GpuPasses(viewport.size, {})
        with offscreen.drawing(viewport):
            camera = self._offscreen_picture.draw(
                viewport,
                viewport.rv3d.view_matrix,
                _shifted(viewport.rv3d.window_matrix, self._gathers, viewport.size),
                drawn,
            )
        settings = replace(settings, seed=settings.seed + SEED_STRIDE * self._gathers)
        if isinstance(settings, gather.RadiositySettings):
            settings = replace(settings, start=start_of(settings, viewport.size))
        self._add(viewport, gather.View(drawn, camera), settings, fresh=self._gathers == 0)
        self._gathers += 1

    def _add(self, viewport, main, settings, fresh):
        """Gather and add the light to the mean; if `fresh`, replace the mean."""
        views = [main, *self.view_cache.views()]
        history = self._history if main.coarse and viewport.scene.afterlight.use_history else None
        light = interactive.indirect(
            views, viewport.size, replace(settings, strength=1.0), _world(viewport, self._worlds), history
        )
        if fresh:
            self._mean.clear()
        self._mean.add(light, main.load_passes().size)


def _settings(viewport):
    """gather.RadiositySettings or gather.PaperSettings of the scene. Smoothing takes the place of the compositor's
    Denoise node."""
    settings = parameters.light_settings(viewport.scene.afterlight, viewport.scene.frame_current)
    is_smoothed = viewport.scene.afterlight.denoise != "NONE"
    return replace(settings, smooth=is_smoothed) if isinstance(settings, gather.RadiositySettings) else settings


def _options(viewport):
    """All settings that change the light, except its strength, which is applied when it is shown."""
    settings = viewport.scene.afterlight
    return (*(getattr(settings, each.name) for each in parameters.PARAMETERS if each.name != "strength"),)


def _world(viewport, cache):
    """The world's light, as gather.gather_views() takes it, if the viewport shows the scene's world and its shadow is
    wanted."""
    if viewport.space.shading.use_scene_world_render and viewport.scene.afterlight.use_world_shadow:
        return world_light.read(viewport.depsgraph, cache)
    return None


def _shifted(window_matrix, number, size):
    """A window matrix with a subpixel offset, for frames of `size` pixels: another one for each number, none for 0."""
    shift = [(radical_inverse(number, base) + 0.5) % 1 - 0.5 for base in (2, 3)]
    shift_matrix = Matrix.Identity(4)
    for axis in range(2):
        shift_matrix[axis][3] = 2 * shift[axis] / size[axis]
    return shift_matrix @ window_matrix
