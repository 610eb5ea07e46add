# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
settings = bpy.context.scene.afterlight

settings.start = "FULL"
settings.samples = 256
settings.radius = 24
