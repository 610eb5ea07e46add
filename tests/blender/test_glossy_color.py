# SPDX-License-Identifier: GPL-3.0-or-later
"""Two properties of EEVEE that the glossy light relies on: Glossy Color is the albedo of the specular lobe, and EEVEE's
reflections include the whole world."""

import bpy
import numpy as np
import pytest

from scenes import put, read, set_format

MATERIALS = [(0.1, 1.0), (0.5, 1.0), (0.8, 1.0), (0.1, 0.0), (0.5, 0.0), (0.8, 0.0)]  # roughness, metallic
SIZE = 96, 16


@pytest.fixture
def scene(fresh):
    """Tiles of six materials, seen from straight above, under a white world of radiance 1."""
    fresh.render.resolution_x, fresh.render.resolution_y = SIZE
    fresh.world = bpy.data.worlds.new("World")
    background = fresh.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (1, 1, 1, 1), 1
    for index, (rough, metallic) in enumerate(MATERIALS):
        material = bpy.data.materials.new("Tile")
        shader = material.node_tree.nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (0.8, 0.5, 0.2, 1)
        shader.inputs["Roughness"].default_value, shader.inputs["Metallic"].default_value = rough, metallic
        mesh = bpy.data.meshes.new("Tile")
        mesh.from_pydata([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)], [], [(0, 1, 2, 3)])
        mesh.materials.append(material)
        put(mesh, (index - 2.5, 0, 0))
    fresh.camera = put(bpy.data.cameras.new("Camera"), (0, 0, 3))
    fresh.camera.data.type, fresh.camera.data.ortho_scale = "ORTHO", 6
    layer = fresh.view_layers[0]
    for name in ("glossy_color", "glossy_direct", "diffuse_color"):
        setattr(layer, f"use_pass_{name}", True)
    return fresh


def passes_of(scene, path, engine):
    """{pass: (6, 3)} at the centres of the tiles."""
    scene.render.engine = engine
    set_format(scene, "OPEN_EXR_MULTILAYER")
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    channels, name = read(path), scene.view_layers[0].name
    return {
        kind: np.array(
            [
                np.stack([channels[f"{name}.{kind}.{axis}"] for axis in "RGB"], -1)[
                    4:12, 16 * k + 4 : 16 * k + 12
                ].mean((0, 1))
                for k in range(6)
            ]
        )
        for kind in ("Glossy Color", "Glossy Direct", "Diffuse Color")
    }


def test_glossy_color_is_the_albedo_of_the_lobe(scene, tmp_path):
    scene.eevee.taa_render_samples, scene.eevee.use_raytracing = 4, False
    ours = passes_of(scene, tmp_path / "eevee.exr", "BLENDER_EEVEE")
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.device = 64, False, "CPU"
    truth = passes_of(scene, tmp_path / "cycles.exr", "CYCLES")
    np.testing.assert_allclose(ours["Glossy Direct"], 1, atol=0.03)  # the world, and all of it
    metal, plastic = slice(0, 3), slice(3, 6)
    np.testing.assert_allclose(ours["Glossy Color"][metal], truth["Glossy Color"][metal], rtol=0.03)
    np.testing.assert_allclose(ours["Glossy Color"][plastic], truth["Glossy Color"][plastic], rtol=0.12, atol=1e-3)
    sent = ours["Glossy Color"] + ours["Diffuse Color"]
    assert sent.max() <= 1 and np.all(sent < np.array([0.8, 0.5, 0.2]) * 1.01 + 0.04), "no more than comes in"
