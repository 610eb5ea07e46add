# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever people do to a file, in any order, and what must hold after each step: nothing of the user's is altered,
nothing of ours is left behind, no exception, and each picture is lit or plain."""

import os
import tempfile
from contextlib import contextmanager

import bpy
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from scenes import box, compositor, layers_node, read_rgb, set_format

from . import digest

INDEX = st.integers(0, 7)
SETTINGS = st.sampled_from(
    [
        ("method", "PAPER"),
        ("method", "RADIOSITY"),
        ("views", "CAMERA"),
        ("views", "AUTOMATIC"),
        ("views", "MANUAL"),
        ("view_count", 1),
        ("view_count", 2),
        ("use_glossy", True),
        ("use_glossy", False),
        ("denoise", "NODE"),
        ("denoise", "SMOOTH"),
        ("use_history", True),
        ("use_history", False),
        ("strength", 0.5),
        ("seed", 3),
    ]
)
COPIES = st.sampled_from(["NEW", "EMPTY", "LINK_COPY", "FULL_COPY"])


class FileMachine(RuleBasedStateMachine):
    """One file, edited by somebody who does not care. journal: a file that gets each step before it is made, for
    crashes."""

    journal = None
    module = None  # the extension

    def __init__(self):
        super().__init__()
        self.folder = tempfile.mkdtemp(prefix="afterlight-fuzz-")

    def note(self, text):
        if self.journal:
            with open(self.journal, "a") as file:
                file.write(text + "\n")

    @initialize(radiosity=st.booleans(), own_tree=st.booleans())
    def start(self, radiosity, own_tree):
        self.note(f"--- start radiosity={radiosity} own_tree={own_tree}")
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        scene = box(bpy.context.scene, samples=1)
        scene.render.resolution_x, scene.render.resolution_y = 32, 18
        settings = scene.afterlight
        settings.method = "RADIOSITY" if radiosity else "PAPER"
        settings.view_count, settings.draws, settings.bounces, settings.samples, settings.radius = 1, 1, 2, 16, 4
        if own_tree:
            tree = compositor(scene)
            tree.links.new(layers_node(tree, scene).outputs["Image"], tree.nodes.new("NodeGroupOutput").inputs[0])
        bpy.ops.ed.undo_push(message="start")

    # Who does what.

    @contextmanager
    def by_afterlight(self, what):
        """A step of ours: of the user's nothing changes."""
        self.note(what)
        before = digest.of_the_user()
        yield
        self.settle()
        self.compare(before, what)

    @contextmanager
    def by_the_user(self, what):
        """A step of the user's: what it left stays so when we have followed it."""
        self.note(what)
        yield
        before = digest.of_the_user()
        self.settle()
        self.compare(before, what)

    def compare(self, before, what):
        lost = digest.lost(before, digest.of_the_user())
        assert not lost, f"{what}: {lost}"

    def settle(self):
        bpy.context.view_layer.update()
        self.module.addon.render.handlers.follow_all()  # which a timer does in a window
        bpy.ops.ed.undo_push(message="step")

    def scenes(self):
        return sorted((scene for scene in bpy.data.scenes if not scene.afterlight.role), key=lambda scene: scene.name)

    def scene(self, index):
        found = self.scenes()
        return found[index % len(found)]

    def node(self, index):
        found = [node for tree in bpy.data.node_groups for node in tree.nodes]
        return found[index % len(found)] if found else None

    # Steps.

    @rule(index=INDEX)
    def tick(self, index):
        with self.by_afterlight(f"tick {index}"):
            self.scene(index).afterlight.enabled = True

    @rule(index=INDEX)
    def untick(self, index):
        with self.by_afterlight(f"untick {index}"):
            self.scene(index).afterlight.enabled = False

    @rule()
    def tick_all(self):
        with self.by_afterlight("tick all"):
            for scene in bpy.data.scenes:
                scene.afterlight.enabled = True

    @rule(index=INDEX, setting=SETTINGS)
    def set(self, index, setting):
        with self.by_afterlight(f"set {index} {setting}"):
            setattr(self.scene(index).afterlight, *setting)

    @rule(index=INDEX, operator=st.sampled_from(["repair", "reset", "copy_settings", "free_passes"]))
    def press(self, index, operator):
        bpy.context.window.scene = self.scene(index)
        with self.by_afterlight(f"press {index} {operator}"):
            if getattr(bpy.ops.afterlight, operator).poll():
                getattr(bpy.ops.afterlight, operator)()

    @rule(index=INDEX)
    def press_all_cures(self, index):
        """Cures change what they say; nothing else is lost, and no cure leads nowhere."""
        scene = bpy.context.window.scene = self.scene(index)
        self.note(f"cures {index}")
        for _ in range(4):
            for finding in self.module.addon.diagnosis.checks.findings(scene) if scene.afterlight.enabled else ():
                if finding.fix:
                    bpy.ops.afterlight.mend(cure=finding.fix)
        self.settle()

    @rule(how=COPIES, index=INDEX)
    def new_scene(self, how, index):
        if len(self.scenes()) < 4:
            with self.by_the_user(f"new scene {how} {index}"):
                bpy.context.window.scene = self.scene(index)
                bpy.ops.scene.new(type=how)

    @rule(how=COPIES, index=INDEX)
    def copy_helper(self, how, index):
        ours = [scene for scene in bpy.data.scenes if scene.afterlight.role]
        if ours and len(bpy.data.scenes) < 12:
            with self.by_the_user(f"copy helper {how} {index}"):
                bpy.context.window.scene = original = ours[index % len(ours)]
                bpy.ops.scene.new(type=how)
                copy = bpy.context.window.scene
                for _ in range(2):
                    bpy.context.view_layer.update()
                    self.module.addon.render.handlers.follow_all()
                assert copy.name in bpy.data.scenes
                bpy.context.window.scene = self.scenes()[0]  # a copy is the user's to remove, and what came with it
                for thing in [
                    thing for thing in copy.collection.objects if thing.name not in original.collection.objects
                ]:
                    bpy.data.cameras.remove(thing.data)
                bpy.data.scenes.remove(copy)

    @rule(index=INDEX)
    def remove_scene(self, index):
        if len(self.scenes()) > 1:
            with self.by_the_user(f"remove scene {index}"):
                doomed = self.scene(index)
                bpy.context.window.scene = next(scene for scene in self.scenes() if scene != doomed)
                bpy.data.scenes.remove(doomed)

    @rule(index=INDEX)
    def remove_helper(self, index):
        ours = [scene for scene in bpy.data.scenes if scene.afterlight.role]
        if ours:
            with self.by_the_user(f"remove helper {index}"):
                doomed = ours[index % len(ours)]
                camera = doomed.afterlight.own_camera
                bpy.data.scenes.remove(doomed)
                if camera:  # left by the user's deed
                    bpy.data.cameras.remove(camera.data)

    @rule(index=INDEX, name=st.sampled_from(["Shot", "Scene", ".Afterlight (Scene)", '{0} %s "', "Szene ß 景"]))
    def rename(self, index, name):
        with self.by_the_user(f"rename {index} {name}"):
            self.scene(index).name = name

    @rule(index=INDEX, change=st.sampled_from(["add", "remove", "rename", "use"]))
    def layers(self, index, change):
        scene = self.scene(index)
        with self.by_the_user(f"layer {index} {change}"):
            layer = scene.view_layers[index % len(scene.view_layers)]
            if change == "add" and len(scene.view_layers) < 3:
                scene.view_layers.new("View.Layer")
            elif change == "remove" and len(scene.view_layers) > 1:
                scene.view_layers.remove(layer)
            elif change == "rename":
                layer.name = layer.name + ".Normal"
            elif change == "use":
                layer.use = not layer.use

    @rule(index=INDEX, into=st.booleans())
    def add_layers_node(self, index, into):
        scene = self.scene(index)
        tree = scene.compositing_node_group
        if tree is not None and len(tree.nodes) < 20:
            with self.by_the_user(f"add layers node {index} {into}"):
                node = layers_node(tree, scene, scene.view_layers[-1].name)
                output = next((each for each in tree.nodes if each.bl_idname == "NodeGroupOutput"), None)
                if into and output and output.inputs:
                    tree.links.new(node.outputs["Image"], output.inputs[0])
                else:
                    tree.links.new(node.outputs["Image"], tree.nodes.new("CompositorNodeViewer").inputs[0])

    @rule(index=INDEX, change=st.sampled_from(["mute", "rename", "remove", "move", "mute link", "remove link"]))
    def edit_node(self, index, change):
        node = self.node(index)
        if node is None:
            return
        with self.by_the_user(f"node {index} {change}"):
            tree = node.id_data
            if change == "mute":
                node.mute = not node.mute
            elif change == "rename":
                node.name = "Renamed"
            elif change == "remove":
                tree.nodes.remove(node)
            elif change == "move":
                node.location.x += 10
            elif tree.links:
                link = tree.links[index % len(tree.links)]
                if change == "mute link":
                    link.is_muted = not link.is_muted
                else:
                    tree.links.remove(link)

    @rule(index=INDEX)
    def group(self, index):
        """The picture comes from a group from now on."""
        scene = self.scene(index)
        tree = scene.compositing_node_group
        output = next((each for each in tree.nodes if each.bl_idname == "NodeGroupOutput"), None) if tree else None
        if output and output.inputs and len(bpy.data.node_groups) < 5:
            with self.by_the_user(f"group {index}"):
                inner = bpy.data.node_groups.new("Inner", "CompositorNodeTree")
                inner.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
                inner.links.new(
                    layers_node(inner, scene).outputs["Image"], inner.nodes.new("NodeGroupOutput").inputs[0]
                )
                node = tree.nodes.new("CompositorNodeGroup")
                node.node_tree = inner
                tree.links.new(node.outputs[0], output.inputs[0])

    @rule(index=INDEX, change=st.sampled_from(["tree", "none", "off", "on"]))
    def switch_compositor(self, index, change):
        scene = self.scene(index)
        with self.by_the_user(f"compositor {index} {change}"):
            if change == "tree" and len(bpy.data.node_groups) < 5:
                tree = compositor(scene)
                tree.use_fake_user = True
                tree.links.new(layers_node(tree, scene).outputs["Image"], tree.nodes.new("NodeGroupOutput").inputs[0])
            elif change == "none":
                if scene.compositing_node_group:
                    scene.compositing_node_group.use_fake_user = True
                scene.compositing_node_group = None
            else:
                scene.render.use_compositing = change == "on"

    @rule(index=INDEX)
    def link_into_helper(self, index):
        ours = [scene for scene in bpy.data.scenes if scene.afterlight.role]
        if ours:
            with self.by_the_user(f"link into helper {index}"):
                holder, thing = ours[index % len(ours)].collection, bpy.data.objects["Lamp"]
                if thing.name not in holder.objects:
                    holder.objects.link(thing)
            with self.by_the_user("and out again"):
                if thing.name in holder.objects:
                    holder.objects.unlink(thing)

    @rule(steps=st.integers(1, 3), redo=st.booleans())
    def undo(self, steps, redo):
        self.note(f"undo {steps} {redo}")
        for _ in range(steps):
            if bpy.ops.ed.undo.poll():
                bpy.ops.ed.undo()
        if redo:
            try:
                bpy.ops.ed.redo()
            except RuntimeError:
                pass  # nothing to redo
        bpy.context.view_layer.update()

    @rule()
    def save_and_load(self):
        with self.by_afterlight("save and load"):
            path = os.path.join(self.folder, "file.blend")
            for thing in (*bpy.data.scenes, *bpy.data.node_groups, *bpy.data.objects):
                if thing.users == 0:
                    thing.use_fake_user = True
            bpy.ops.wm.save_as_mainfile(filepath=path)
            bpy.ops.wm.open_mainfile(filepath=path)

    @precondition(lambda self: len(self.scenes()) < 4)
    @rule(index=INDEX, update=st.booleans())
    def render(self, index, update):
        """Lit, or plain with a reason; unticked it is plain."""
        scene = bpy.context.window.scene = self.scene(index)
        settings = scene.afterlight
        if not settings.enabled or scene.camera is None or not any(layer.use for layer in scene.view_layers):
            return
        set_format(scene)
        scene.render.filepath = os.path.join(self.folder, "picture.exr")
        with self.by_afterlight(f"render {index} {update}"):
            lit = self.picture(scene)
            report = settings.report
            if update and not report and bpy.ops.afterlight.update.poll():
                bpy.ops.afterlight.update()
        with self.by_afterlight(f"plain {index}"):
            settings.enabled = False
            plain = self.picture(scene)
        with self.by_afterlight(f"tick again {index}"):
            settings.enabled = True
        if lit is None or plain is None:
            return
        assert (lit >= plain - 2e-3).all() or settings.method == "RADIOSITY", "darker than the plain picture"
        if report:
            assert abs(lit - plain).max() < 2e-3, f"neither lit nor plain: {report}"

    def picture(self, scene):
        path = scene.render.filepath
        if os.path.exists(path):
            os.remove(path)
        try:
            bpy.ops.render.render(write_still=True, scene=scene.name)
        except RuntimeError:
            return None  # Blender's own refusal
        return read_rgb(path) if os.path.exists(path) else None

    # What must hold at all times.

    @invariant()
    def nothing_is_left_behind(self):
        if not any(scene.afterlight.enabled for scene in bpy.data.scenes):
            assert not digest.of_ours(), digest.of_ours()

    @invariant()
    def our_scenes_are_as_many_as_they_should(self):
        for scene in self.scenes():
            served = [each for each in bpy.data.scenes if self.module.addon.host.roles.lit_scene(each) == scene]
            wanted = 1 + max(self.module.addon.scene.needs.views(scene), 0) + 1
            assert len(served) <= (wanted if scene.afterlight.enabled else 0), [each.name for each in served]
        assert not [scene for scene in bpy.data.scenes if scene.afterlight.role and scene.afterlight.enabled]

    @invariant()
    def findings_can_be_asked_for(self):
        for scene in bpy.data.scenes:
            self.module.addon.diagnosis.checks.findings(scene)
