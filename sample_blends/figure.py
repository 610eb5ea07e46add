# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that bend: tubes around the bones of an armature, in one mesh whose joints are shared by both bones."""

from math import cos, pi, sin

import bpy
from mathutils import Vector

from parts import mesh, place

SIDES, RINGS = 10, 7
JOINT = 0.3  # share of a bone at whose start its parent still pulls


def body(name, material, bones):
    """An armature object with a skinned mesh. bones: {name: (parent or "", head, tail, thick at the head, at the
    tail)}, parents first; places and radii in metres. Returns the armature object; its pose bones turn about their own
    axes."""
    armature = place(name, bpy.data.armatures.new(name))
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for bone, (parent, head, tail, _, _) in bones.items():
        made = armature.data.edit_bones.new(bone)
        made.head, made.tail = head, tail
        if parent:
            made.parent = armature.data.edit_bones[parent]
    bpy.ops.object.mode_set(mode="OBJECT")

    vertices, faces, weights = [], [], {bone: {} for bone in bones}
    for bone, (parent, head, tail, first, last) in bones.items():
        start = len(vertices)
        for ring in range(RINGS):
            along = ring / (RINGS - 1)
            for vertex in _ring(Vector(head), Vector(tail), along, first, last):
                own = min(1.0, 0.5 + along / JOINT / 2) if parent else 1.0
                weights[bone][len(vertices)] = own
                if own < 1:
                    weights[parent][len(vertices)] = 1 - own
                vertices.append(vertex)
        for ring in range(RINGS - 1):
            for side in range(SIDES):
                a, b = start + ring * SIDES + side, start + ring * SIDES + (side + 1) % SIDES
                faces.append((a, b, b + SIDES, a + SIDES))
        faces += [tuple(range(start, start + SIDES))[::-1], tuple(range(len(vertices) - SIDES, len(vertices)))]
    skin = place(f"{name} skin", mesh(f"{name} skin", vertices, faces, smooth=True), material)
    for bone, shares in weights.items():
        group = skin.vertex_groups.new(name=bone)
        for index, share in shares.items():
            group.add([index], share, "REPLACE")
    skin.modifiers.new("Armature", "ARMATURE").object = armature
    skin.parent = armature
    for bone in armature.pose.bones:
        bone.rotation_mode = "XYZ"
    return armature


def _ring(head, tail, along, first, last):
    """Points around a bone; its ends are rounded, so that a bent joint shows no hole."""
    axis = (tail - head).normalized()
    side = axis.orthogonal().normalized()
    across = axis.cross(side)
    out = 2 * along - 1
    reach = (first + (last - first) * along) * (1 - 0.6 * abs(out) ** 6)
    middle = head + (tail - head) * along + axis * (out**5) * (first if out < 0 else last) * 0.8
    return [
        middle + (side * cos(2 * pi * turn / SIDES) + across * sin(2 * pi * turn / SIDES)) * reach
        for turn in range(SIDES)
    ]
