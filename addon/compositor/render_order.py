# SPDX-License-Identifier: GPL-3.0-or-later
"""The order in which Blender renders the scenes of a compositor: that in which their Render Layers nodes were
created."""

from .nodes import MARK, new_node, role


def render_after(tree, late, early):
    """Make Blender render the scenes of the nodes `late` after those of `early`. If a late node is too old, all late
    ones are replaced by new copies, which keep everything that the user has set on them."""
    creation_index = {node: index for index, node in enumerate(tree.nodes)}
    if not late or not early or min(map(creation_index.get, late)) > max(map(creation_index.get, early)):
        return
    for old in late:
        _remake(tree, old)


def _remake(tree, old):
    """Replace a Render Layers node by a new one with the same settings and links."""
    new = new_node(tree, old.bl_idname, role(old) or "")
    del new[MARK]
    for name in old.keys():
        new[name] = old[name]
    new.scene, new.layer = old.scene, old.layer
    for name in ("parent", "location", "width", "label", "hide", "mute", "use_custom_color", "color", "select"):
        setattr(new, name, getattr(old, name))
    for output in old.outputs:
        for link in output.links:
            target = new.outputs.get(output.name)
            if target is not None:
                is_muted = link.is_muted
                tree.links.new(target, link.to_socket).is_muted = is_muted
    name, was_active = old.name, tree.nodes.active == old
    tree.nodes.remove(old)
    new.name = name
    if was_active:
        tree.nodes.active = new
