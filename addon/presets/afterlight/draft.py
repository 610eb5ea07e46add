# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
settings = bpy.context.scene.afterlight

settings.start = "QUARTER"
settings.samples = 64
settings.radius = 8
