# SPDX-License-Identifier: GPL-3.0-or-later
"""What people do to a ticked file: two scenes, two view layers, the compositor edited by hand, unticked, and the
extension switched off and removed while the file is open."""

import numpy as np
import steps


def layers_and_scenes():
    """Two view layers laid over each other, and a second scene that is ticked too."""
    import scenes

    scene = bpy.context.scene
    scenes.layered_tree(scene)
    scene.afterlight.enabled = True
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        bpy.ops.scene.new(type="FULL_COPY")
    window.scene.name = "Other"
    window.scene.afterlight.strength = 0.5


def show(name):
    for window in bpy.context.window_manager.windows:
        window.scene = bpy.data.scenes[name]


def test_two_scenes_of_two_view_layers(window, afterlight):
    """Each is lit with its own settings, as the command line lights it."""
    steps.new_box(window)
    window.run(layers_and_scenes)
    pictures = {}
    for name in ("Scene", "Other"):
        window.run(show, name)
        window.render()
        assert window.value(f"bpy.data.scenes[{name!r}].afterlight.report") == ""
        pictures[name] = steps.result(window, f"scene_{name}", name)
        expected = steps.headless(window, f"headless_{name}", "-S", name)
        assert np.array_equal(pictures[name], expected)
    assert np.mean(pictures["Other"]) < np.mean(pictures["Scene"])


def compositor_open():
    """In place of the timeline; the window with the picture, which may lie over it, is closed."""
    for window in bpy.context.window_manager.windows[1:]:
        with bpy.context.temp_override(window=window):
            bpy.ops.wm.window_close()
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "DOPESHEET_EDITOR":
            area.ui_type = "CompositorNodeTree"


def select_our_mix_node():
    tree = bpy.context.scene.compositing_node_group
    for node in tree.nodes:
        node.select = node.bl_idname == "ShaderNodeMix"
    tree.nodes.active = next(node for node in tree.nodes if node.select)


def mend():
    bpy.ops.afterlight.repair()


def test_compositor_edited_by_hand(window, afterlight):
    """Our Mix node is muted, and the picture is plain; deleted, and the panel says so; mended, and it is lit again."""
    steps.new_box(window)
    window.render()
    plain = steps.result(window, "no_light")
    steps.tick(window)
    window.render()
    lit = steps.result(window, "with_light")
    window.run(compositor_open)
    window.run(select_our_mix_node)
    window.over("NODE_EDITOR")
    window.key("m")
    window.wait("any(node.mute for node in bpy.context.scene.compositing_node_group.nodes)")
    window.render()
    assert np.array_equal(steps.result(window, "muted"), plain)
    window.run(compositor_open)
    window.over("NODE_EDITOR")
    window.key("m")
    window.wait("not any(node.mute for node in bpy.context.scene.compositing_node_group.nodes)")
    window.key("x")
    window.wait("not any(node.bl_idname == 'ShaderNodeMix' for node in bpy.context.scene.compositing_node_group.nodes)")
    window.picture("deleted")
    window.run(mend)
    window.render()
    assert np.array_equal(steps.result(window, "mended"), lit)


def test_untick(window, afterlight):
    """What the box has put into the file goes."""
    steps.new_box(window)
    window.value("remember()")
    steps.tick(window)
    assert window.value("changed()")
    window.render()
    steps.tick(window, on=False)
    # Blender fills in a colour space that a new file names none for, as soon as any format is chosen.
    assert [line for line in window.value("changed()") if "linear_colorspace_settings/name: '' ->" not in line] == []
    window.render()
    assert np.mean(steps.result(window, "unticked")) > 0


def switch(on):
    module = "bl_ext.user_default.afterlight"
    (bpy.ops.preferences.addon_enable if on else bpy.ops.preferences.addon_disable)(module=module)


def uninstall():
    repos = bpy.context.preferences.extensions.repos
    index = next(i for i, repo in enumerate(repos) if repo.module == "user_default")
    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="afterlight")


def test_switched_off_and_removed_with_the_file_open(window, afterlight, package):
    steps.new_box(window)
    window.render()
    plain = steps.result(window, "before_all")
    steps.tick(window)
    window.render()
    lit = steps.result(window, "installed")
    window.run(switch, False)
    window.render()
    assert np.array_equal(steps.result(window, "switched_off"), plain)
    window.run(switch, True)
    window.render()
    assert np.array_equal(steps.result(window, "switched_on"), lit)
    window.run(uninstall)
    window.wait("'bl_ext.user_default.afterlight' not in bpy.context.preferences.addons")
    window.render()
    assert np.array_equal(steps.result(window, "removed"), plain)
    path = window.computer.folder / "without.blend"
    window.run(steps.save_as, path)
    window.run(steps.open_file, path)
    window.render()
    assert np.array_equal(steps.result(window, "reopened_without"), plain)
    steps.install(window, package)
    window.run(steps.open_file, path)
    window.render()
    assert np.array_equal(steps.result(window, "installed_again"), lit)
