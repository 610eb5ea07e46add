# SPDX-License-Identifier: GPL-3.0-or-later
"""How afterlight_0_3_0.blend was made, by the code of version 0.3.0:

    git worktree add /tmp/old 4dc2e45 && cd /tmp/old
    python <this file> <path of the .blend>

Two lit scenes: "Views" with two automatic views, glossy light and a compositor tree that 0.3.0 made, "Paper" with one
view in a compositor of the user's own. "Precious" is the user's, with a custom property of the name that 0.3.0 marked
its own scenes by.
"""

import os
import sys

sys.path[:0] = [os.path.join(os.getcwd(), folder) for folder in ("tools", "tests")]
import extension

extension.start()
import bpy

from scenes import box, simple_tree

bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
views = box(bpy.context.scene)
views.name = "Views"
bpy.ops.scene.new(type="LINK_COPY")
paper = bpy.context.scene
paper.name = "Paper"
simple_tree(paper)
settings = views.afterlight
settings.method, settings.view_count, settings.use_glossy = "RADIOSITY", 2, True
precious = bpy.data.scenes.new("Precious")
precious.collection.objects.link(bpy.data.objects["Lamp"])
for each in (views, paper):
    each.afterlight.enabled = True
bpy.context.window.scene = views
precious["afterlight"] = "helper"  # 0.3.0 removes such a scene, and crashes, as soon as it looks at it
bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(sys.argv[1]), compress=True)
