# SPDX-License-Identifier: GPL-3.0-or-later
"""How afterlight_0_1_0.blend was made, by the code of version 0.1.0:

    git worktree add /tmp/old a6f4124 && cd /tmp/old
    python <this file> <path of the .blend>

Two lit scenes: "Kept" with settings of its own and keyframes on Strength in a compositor of its own, "Untouched" with
nothing but the tick. 0.1.0 stored neither a version nor settings that were at their defaults.
"""

import os
import sys

sys.path[:0] = [os.path.join(os.getcwd(), folder) for folder in ("tools", "tests")]
import extension

extension.start()
import bpy

from scenes import box, simple_tree

bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
scene = box(bpy.context.scene)
scene.name = "Kept"
settings = scene.afterlight
settings.samples, settings.radius, settings.seed, settings.use_animated_seed = 99, 9, 5, True
for frame, strength in ((1, 2.0), (11, 0.0)):
    settings.strength = strength
    settings.keyframe_insert("strength", frame=frame)
bpy.ops.scene.new(type="LINK_COPY")
untouched = bpy.context.scene
untouched.name = "Untouched"
untouched.animation_data_clear()
for name in ("samples", "radius", "seed", "use_animated_seed", "strength"):
    untouched.afterlight.property_unset(name)
simple_tree(scene)
for each in (scene, untouched):
    each.afterlight.enabled = True
bpy.context.window.scene = scene
bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(sys.argv[1]), compress=True)
