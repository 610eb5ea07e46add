import bpy
settings = bpy.context.scene.afterlight

settings.start = "FULL"
settings.samples = 1024
settings.radius = 16
