# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
settings = bpy.context.scene.afterlight

settings.method = "RADIOSITY"
settings.start = "QUARTER"
settings.draws = 8
settings.accumulate = 1
settings.use_history = True
settings.denoise = "SMOOTH"
settings.bounces = 3
settings.use_visibility = True
settings.use_world_shadow = True
settings.views = "AUTOMATIC"
settings.view_count = 4
