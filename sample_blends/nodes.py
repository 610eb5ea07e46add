# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry Nodes of the sample scenes: what would be too much to store is made when the file is opened."""

import bpy


class Tree:
    """A node group with a Geometry input and output, as a modifier of an object."""

    def __init__(self, thing, name):
        self.group = bpy.data.node_groups.new(name, "GeometryNodeTree")
        self.group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        self.group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        self.start, self.end = self.node("NodeGroupInput"), self.node("NodeGroupOutput")
        modifier = thing.modifiers.new(name, "NODES")
        modifier.node_group = self.group

    def node(self, kind, **values):
        """A node; settings by their names in Python, inputs by their labels."""
        made = self.group.nodes.new(kind)
        for name, value in values.items():
            if hasattr(made, name):
                setattr(made, name, value)
            else:
                made.inputs[name.replace("_", " ")].default_value = value
        return made

    def link(self, source, target):
        self.group.links.new(source, target)

    def random(self, low, high, seed):
        """A vector drawn for each element, its socket."""
        made = self.node("FunctionNodeRandomValue", data_type="FLOAT_VECTOR")
        for name, value in (("Min", low), ("Max", high)):
            made.inputs[name].default_value = value
        made.inputs["Seed"].default_value = seed
        return made.outputs["Value"]


def instances(thing, what, *, scale, seed, turn=((0, 0, 0), (1.2, 1.2, 6.283))):
    """Show the object `what` at each vertex of `thing`, turned and scaled at random."""
    tree = Tree(thing, "Scatter")
    info = tree.node("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = what
    info.inputs["As Instance"].default_value = True
    scatter = tree.node("GeometryNodeInstanceOnPoints")
    tree.link(tree.start.outputs[0], scatter.inputs["Points"])
    tree.link(info.outputs["Geometry"], scatter.inputs["Instance"])
    tree.link(tree.random(*turn, seed), scatter.inputs["Rotation"])
    size = tree.node("FunctionNodeRandomValue", data_type="FLOAT", Min=scale[0], Max=scale[1], Seed=seed + 1)
    tree.link(size.outputs["Value"], scatter.inputs["Scale"])
    tree.link(scatter.outputs["Instances"], tree.end.inputs[0])
    return tree


def hair(thing, count, spread, seed):
    """Make `count` hairs of each guide, drawn apart by up to `spread` metres, less at the root than at the tip."""
    tree = Tree(thing, "Hair")
    copies = tree.node("GeometryNodeDuplicateElements", domain="SPLINE", Amount=count)
    tree.link(tree.start.outputs[0], copies.inputs["Geometry"])
    on_curve = tree.node("GeometryNodeFieldOnDomain", domain="CURVE", data_type="FLOAT_VECTOR")
    tree.link(tree.random((-spread,) * 3, (spread,) * 3, seed), on_curve.inputs[0])
    along = tree.node("GeometryNodeSplineParameter")
    grow = tree.node("ShaderNodeMapRange")
    grow.inputs["To Min"].default_value = 0.45
    tree.link(along.outputs["Factor"], grow.inputs["Value"])
    part = tree.node("ShaderNodeVectorMath", operation="SCALE")
    tree.link(on_curve.outputs[0], part.inputs[0])
    tree.link(grow.outputs[0], part.inputs["Scale"])
    move = tree.node("GeometryNodeSetPosition")
    tree.link(copies.outputs["Geometry"], move.inputs["Geometry"])
    tree.link(part.outputs[0], move.inputs["Offset"])
    tree.link(move.outputs[0], tree.end.inputs[0])
    return tree
