# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
settings = bpy.context.scene.afterlight

settings.method = "PAPER"
settings.start = "HALF"
settings.samples = 256
settings.radius = 16
settings.views = "CAMERA"
