# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's calls while it draws viewports, and asking it to draw them again."""

import blf
import bpy
from bpy.app.handlers import persistent

from .. import gather, properties
from ..diagnosis import checks
from ..host import events, main_thread, report, roles
from ..translations import say
from . import blend, scene_changes
from .region_light import RegionLight, ViewportContext
from .view_cache import ViewCache

TEXT_POINTS = 11  # height of the text

# Global, since Blender calls us once for each region that it draws, and keeps nothing for us with it.
_region_lights, _view_caches = {}, {}  # by the address of the region, and of its 3D viewport
_waiting = set()  # global: addresses of regions to be drawn again
_refused = {}  # global: why a scene's viewports are not lit, by its session_uid
_handles = []  # global: Blender's handles of our functions, until they are removed


def problem(scene):
    """Why the viewports of `scene` are not lit although they should be, as a sentence for people; empty if nothing is
    wrong."""
    if scene.session_uid in _refused:
        return _refused[scene.session_uid]
    if checks.counts_twice(scene):
        return say("EEVEE's ray tracing already adds indirect light. Disable either ray tracing or Indirect Light")
    return ""


def switched(scene):
    """The light in the viewports of `scene` was switched on or off."""
    _refused.pop(scene.session_uid, None)
    redraw()


def redraw():
    """Redraw all viewports."""
    # In the main thread, since scripts may change settings in a render's thread.
    main_thread.later(lambda: [area.tag_redraw() for area in _areas()])


def is_lit(scene, space):
    """Whether a viewport shows the light of `scene`: only the combined image, drawn by EEVEE."""
    shading = space.shading
    return (
        scene.afterlight.enabled
        and scene.afterlight.use_viewport
        and scene.render.engine == "BLENDER_EEVEE"
        and shading.type == "RENDERED"
        and shading.render_pass == "COMBINED"
        and not roles.is_helper(scene)
        and not problem(scene)
    )


def _before_drawing():
    """Blender begins to draw a viewport."""
    context = bpy.context
    if context.space_data and is_lit(context.scene, context.space_data):
        blend.remember()


def _after_drawing():
    """Blender has drawn a viewport."""
    context = bpy.context
    scene, space, region = context.scene, context.space_data, context.region
    address = region.as_pointer()
    if not is_lit(scene, space):
        _let_go(address)
        return
    try:
        _light(
            ViewportContext(
                scene, context.view_layer, space, region, context.region_data, context.evaluated_depsgraph_get()
            ),
            address,
        )
    except gather.GpuUnavailable as error:
        _refuse(scene, say(*error.args))
    except Exception as error:  # a bug of ours must not break the viewport
        report.print_traceback()
        _refuse(
            scene,
            say("Internal error in Afterlight ({}). Please report it with the details in the terminal", error),
        )
    finally:
        blend.forget()


def _light(viewport, address):
    if address not in _region_lights:
        _prune()
        _region_lights[address] = RegionLight(_view_caches.setdefault(viewport.space.as_pointer(), ViewCache()))
    region = _region_lights[address]
    if not bpy.app.is_job_running("RENDER"):  # a render needs the GPU, and changes settings that viewports must not see
        seconds_left = region.update(viewport)
        if seconds_left is not None:
            _redraw_region(address, seconds_left)
        gather.device.settle()  # other windows have their own GPU contexts
    region.show(viewport)
    if viewport.space.overlay.show_overlays and viewport.space.overlay.show_text:
        _write(viewport.region, say("Indirect Light {} / {}", *region.progress()))


def _write(region, text):
    scale = bpy.context.preferences.system.ui_scale
    blf.size(0, TEXT_POINTS * scale)
    blf.color(0, 1.0, 1.0, 1.0, 0.8)
    blf.enable(0, blf.SHADOW)
    blf.shadow(0, 3, 0.0, 0.0, 0.0, 0.6)
    blf.position(0, region.width / 2 - blf.dimensions(0, text)[0] / 2, TEXT_POINTS * scale, 0)
    blf.draw(0, text)
    blf.disable(0, blf.SHADOW)


def _refuse(scene, text):
    """Light no viewport of `scene` any more, and say why, until the checkbox is ticked again."""
    _refused[scene.session_uid] = text
    free()
    report.pop_up(text, say("Afterlight: the viewport has no indirect light"))
    bpy.app.timers.register(redraw, first_interval=0.0)


def _redraw_region(address, seconds):
    """Redraw a region after some seconds, by a timer: while it is being drawn, Blender ignores requests to redraw
    it."""
    if not _waiting:
        bpy.app.timers.register(_tag_waiting, first_interval=seconds)
    _waiting.add(address)


def _tag_waiting():
    for area in _areas():
        for region in area.regions:
            if region.as_pointer() in _waiting:
                region.tag_redraw()
    _waiting.clear()
    _prune()


def _areas():
    return [
        area for window in bpy.context.window_manager.windows for area in window.screen.areas if area.type == "VIEW_3D"
    ]


def _prune():
    """Free what belongs to regions and viewports that are no longer shown."""
    shown = {region.as_pointer() for area in _areas() for region in area.regions}
    for address in _region_lights.keys() - shown:
        _let_go(address)


def _let_go(address):
    region = _region_lights.pop(address, None)
    if region is not None:
        region.free()
    caches_in_use = {id(each.view_cache) for each in _region_lights.values()}
    for space in [space for space, view_cache in _view_caches.items() if id(view_cache) not in caches_in_use]:
        _view_caches.pop(space).free()


@persistent
def free(*_):
    """Free everything that viewports hold on the GPU."""
    for address in list(_region_lights):
        _let_go(address)
    _waiting.clear()


@persistent
def forget(*_):
    """Another file is loaded."""
    free()
    _refused.clear()


HANDLERS = (("load_pre", forget),)


def _changed(_scene):
    redraw()


def register():
    properties.on_change.append(_changed)
    properties.on_switch.append(switched)
    scene_changes.register()
    events.listen(HANDLERS)
    if not bpy.app.background:
        for call, moment in ((_before_drawing, "PRE_VIEW"), (_after_drawing, "POST_PIXEL")):
            _handles.append(bpy.types.SpaceView3D.draw_handler_add(call, (), "WINDOW", moment))


def unregister():
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
    events.ignore(HANDLERS)
    scene_changes.unregister()
    properties.on_switch.remove(switched)
    properties.on_change.remove(_changed)
    forget()
    blend.release()
