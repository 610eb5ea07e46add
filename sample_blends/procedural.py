# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials and a sky that nodes make, without a picture."""

from math import cos, radians, sin

from parts import aim, glossy, light_data, place, sky

# What a surface that faces a Sky Texture's sun gets from it, in W/m^2 of red, green, blue, as Cycles renders it.
SUN = ((18, 134, 102, 63), (24, 143, 115, 77), (30, 149, 123, 87), (36, 154, 128, 95), (42, 156, 132, 100))


def sky_texture(scene, *, elevation, rotation, strength=1.0):
    """A Sky Texture as the world, angles in degrees. EEVEE draws no disc of it: its sun is a lamp of the same light."""
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    node, background = nodes.new("ShaderNodeTexSky"), sky(scene, (1, 1, 1), strength)
    node.sky_type, node.sun_disc = "MULTIPLE_SCATTERING", False
    node.sun_elevation, node.sun_rotation = radians(elevation), radians(rotation)
    links.new(node.outputs["Color"], background.inputs["Color"])
    light = min(SUN, key=lambda row: abs(row[0] - elevation))[1:]
    lamp = light_data("SUN", "Sun", [each / max(light) for each in light], strength * max(light), angle=node.sun_size)
    up, around = radians(elevation), radians(rotation)
    way = (-cos(up) * sin(around), -cos(up) * cos(around), -sin(up))
    place("Sun", lamp, None, (0, 0, 20), aim((0, 0, 0), way))
    return node


def sky_for_the_camera(scene, color, strength):
    """A bright sky behind the windows that lights nothing: the lamps at the windows do."""
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    background, path, seen = sky(scene, color, 0), nodes.new("ShaderNodeLightPath"), nodes.new("ShaderNodeMath")
    seen.operation, seen.inputs[1].default_value = "MULTIPLY", strength
    links.new(path.outputs["Is Camera Ray"], seen.inputs[0])
    links.new(seen.outputs[0], background.inputs["Strength"])


def sky_panel(name, color, energy, size, location, rotation=(0, 0, 0)):
    """An area lamp of `size` (width, height) in an opening, in place of the sky behind it, and hidden: Cycles would
    show it instead of the opening."""
    data = light_data("AREA", name, color, energy, shape="RECTANGLE", size=size[0], size_y=size[1])
    place(name, data, None, location, rotation).visible_camera = False


def plastered(name, color, bump=0.25, scale=30.0):
    """A rough surface with a bump of procedural noise, and stains of it in the colour."""
    material = glossy(name, color, 0.7)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    source, shader = nodes.new("ShaderNodeTexCoord"), nodes["Principled BSDF"]
    fine, broad, mix = nodes.new("ShaderNodeTexNoise"), nodes.new("ShaderNodeTexNoise"), nodes.new("ShaderNodeMix")
    fine.inputs["Scale"].default_value, broad.inputs["Scale"].default_value = scale, 1.5
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    mix.inputs[0].default_value = 0.35
    mix.inputs[6].default_value = (*color, 1)
    height = nodes.new("ShaderNodeBump")
    height.inputs["Strength"].default_value, height.inputs["Distance"].default_value = bump, 0.01
    for noise in (fine, broad):
        links.new(source.outputs["Object"], noise.inputs["Vector"])
    links.new(broad.outputs["Fac"], mix.inputs[7])
    links.new(mix.outputs[2], shader.inputs["Base Color"])
    links.new(fine.outputs["Fac"], height.inputs["Height"])
    links.new(height.outputs["Normal"], shader.inputs["Normal"])
    return material


def wooden(name, dark, light, roughness=0.4):
    """Wood of procedural grain along x, between two colours."""
    material = glossy(name, light, roughness)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    source, mapping = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeMapping")
    mapping.inputs["Scale"].default_value = (1.2, 14, 14)
    grain, ramp = nodes.new("ShaderNodeTexNoise"), nodes.new("ShaderNodeValToRGB")
    grain.inputs["Scale"].default_value, grain.inputs["Detail"].default_value = 1.6, 6
    grain.inputs["Distortion"].default_value = 0.6
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[0].position = (*dark, 1), 0.35
    ramp.color_ramp.elements[1].color, ramp.color_ramp.elements[1].position = (*light, 1), 0.65
    links.new(source.outputs["Object"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], grain.inputs["Vector"])
    links.new(grain.outputs["Fac"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    return material


def translucent(name, color, through=0.5):
    """Thin cloth or paper: this part of the light comes out at the back."""
    material = glossy(name, color, 0.8)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    back, mix = nodes.new("ShaderNodeBsdfTranslucent"), nodes.new("ShaderNodeMixShader")
    back.inputs["Color"].default_value = (*color, 1)
    mix.inputs["Fac"].default_value = through
    links.new(nodes["Principled BSDF"].outputs["BSDF"], mix.inputs[1])
    links.new(back.outputs["BSDF"], mix.inputs[2])
    links.new(mix.outputs["Shader"], nodes["Material Output"].inputs["Surface"])
    return material
