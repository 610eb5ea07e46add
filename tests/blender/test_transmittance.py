# SPDX-License-Identifier: GPL-3.0-or-later
"""Light through volumes and Blended materials: the bounced light is attenuated like the surface itself, and nothing
else changes."""

from math import radians
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from scenes import box, differences, put, read_rgb, render, simple_tree, wall, written_down


@pytest.fixture
def share(addon):
    return addon.scene.transmittance.transmitted_share


# The formula, on arrays with a known result

HEIGHT, WIDTH, CELL = 48, 64, 8
DEPTH = np.broadcast_to(np.linspace(2, 6, WIDTH), (HEIGHT, WIDTH)).astype(np.float32)


def known(through, surface, volume=0.0, blended=0.0, opacity=0.0):
    """Arguments of transmitted_share(): passes in half precision, as EEVEE's are, and the true transmittance of each
    pixel."""

    def plane(value, *channels):
        return (
            np.broadcast_to(np.asarray(value, float), (HEIGHT, WIDTH, *channels)).astype(np.float16).astype(np.float32)
        )

    surface, volume, blended, opacity = plane(surface, 3), plane(volume, 3), plane(blended, 3), plane(opacity)
    combined = through * surface + (1 - opacity[..., None]) * volume + blended
    return plane(combined, 3), surface, volume, blended, opacity, DEPTH, CELL


def test_clear_air_takes_nothing(share):
    rng = np.random.default_rng(1)
    surface = rng.uniform(0, 1, (HEIGHT, WIDTH, 3))
    surface[:, ::3] = 0  # shadow among light
    np.testing.assert_allclose(share(*known(1.0, surface)), 1, atol=2e-3)
    assert np.all(share(*known(1.0, 0.0)) == 1), "a picture without light tells nothing"


@pytest.mark.parametrize("through", [(0.5, 0.5, 0.5), (0.9, 0.3, 0.0), (1e-3, 1e-3, 1e-3)])
def test_a_volume_is_divided_out(share, through):
    found = share(*known(np.array(through), 0.3, volume=0.2))
    np.testing.assert_allclose(found, np.broadcast_to(through, found.shape), atol=2e-3)


def test_a_black_volume_lets_nothing_through(share):
    surface = np.random.default_rng(2).uniform(0, 1, (HEIGHT, WIDTH, 3))
    assert share(*known(0.0, surface)).max() < 1e-4


@pytest.mark.parametrize("blurred", [False, True])
def test_shadow_is_filled_by_distance(share, blurred):
    """Fog, with a quarter of the image too dark for division."""
    through = np.exp(-0.4 * DEPTH)[..., None] * np.ones(3)
    surface = np.full((HEIGHT, WIDTH, 3), 0.3)
    surface[24:, 16:48] = 0
    found = share(*known(through, surface, volume=0.1), blurred)
    np.testing.assert_allclose(found, through, atol=0.06 if blurred else 0.02)  # of larger cells


def test_dark_things_before_the_smoke_keep_their_light(share):
    """A volume behind them: near pixels are filled from near ones."""
    near = np.zeros((HEIGHT, WIDTH), bool)
    near[30:] = True
    depth = np.where(near, 1.0, 5.0).astype(np.float32)
    through = np.where(near, 1.0, 0.05)[..., None] * np.ones(3)
    surface = np.full((HEIGHT, WIDTH, 3), 0.3)
    surface[30:, :32] = surface[:30, 32:] = 0
    args = list(known(through, surface))
    args[5] = depth
    found = share(*args)
    assert found[32:].min() > 0.98 and found[:30].max() < 0.06


def test_a_blended_material_is_its_opacity_in_the_dark(share):
    opacity = np.zeros((HEIGHT, WIDTH))
    opacity[10:20, 10:20] = 0.95
    found = share(*known((1 - opacity)[..., None], 0.0, opacity=opacity))
    np.testing.assert_allclose(found, np.broadcast_to((1 - opacity)[..., None], found.shape), atol=1e-3)


def test_fog_behind_a_blended_card(share):
    """The fog in front of the card is part of the pass Transparent, the fog behind it is in Volume Direct."""
    found = share(*known(0.5 * 0.3, 0.4, volume=0.2, blended=0.1, opacity=0.5))
    np.testing.assert_allclose(found, 0.15, atol=2e-3)


def test_blur_is_told_by_many_pixels(share):
    """Only Combined is blurred: the shares of single pixels are wrong, but not that of all."""
    surface = np.where(np.arange(WIDTH) % 16 < 8, 0.6, 0.1)[None, :, None] * np.ones((HEIGHT, 1, 3))
    args = list(known(0.5, surface))
    args[0] = np.mean([np.roll(args[0], by, 1) for by in range(-2, 3)], 0)
    assert np.abs(share(*args) - 0.5).max() > 0.2
    np.testing.assert_allclose(share(*args, True), 0.5, atol=0.12)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e30, -5.0])
def test_broken_pixels_stay_by_themselves(addon, share, value):
    args = list(known(0.5, 0.3))
    finite = addon.scene.transmittance._finite
    for index in range(4):
        args[index][5, 5] = value
        args[index] = finite(args[index])
    found = share(*args)
    assert np.isfinite(found).all() and found.min() >= 0 and found.max() <= 1
    np.testing.assert_allclose(found[20:, 20:], 0.5, atol=0.02)


# Detecting media in a scene


def volume(tree, kind="ShaderNodeVolumeAbsorption", density=1.0, color=(0, 0, 0)):
    node = tree.nodes.new(kind)
    node.inputs["Density"].default_value, node.inputs["Color"].default_value = density, (*color, 1)
    tree.links.new(node.outputs[0], tree.get_output_node("EEVEE").inputs["Volume"])


def fog(scene, **options):
    scene.world = bpy.data.worlds.new("Fog")
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
    scene.eevee.use_volume_custom_range, scene.eevee.volumetric_end = (
        True,
        20,
    )  # without, EEVEE's fog is three times too thick here
    volume(scene.world.node_tree, **options)


def blended(alpha=0.5, method="BLENDED"):
    material = bpy.data.materials.new("Card")
    material.surface_render_method = method
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = 0, 0, 0, 1
    shader.inputs["Alpha"].default_value, shader.inputs["Specular IOR Level"].default_value = alpha, 0
    return material


def cloud(density=200.0, **options):
    material = bpy.data.materials.new("Cloud")
    material.node_tree.nodes.remove(material.node_tree.nodes["Principled BSDF"])
    volume(material.node_tree, density=density, **options)
    return material


def instanced(scene):
    hidden = bpy.data.collections.new("Cards")
    card = wall(blended(), (0, 0, 0), (0, 0, 0))
    scene.collection.objects.unlink(card)
    hidden.objects.link(card)
    instance = put(None)
    instance.instance_type, instance.instance_collection = "COLLECTION", hidden


def by_geometry_nodes(scene):
    tree = bpy.data.node_groups.new("Cards", "GeometryNodeTree")
    tree.nodes.new("GeometryNodeSetMaterial").inputs["Material"].default_value = blended()
    scene.objects["Wall"].modifiers.new("Nodes", "NODES").node_group = tree


def of_another_scene(scene):
    card = wall(blended(), (0, 0, 0), (0, 0, 0))
    scene.collection.objects.unlink(card)
    bpy.data.scenes.new("Other").collection.objects.link(card)


SCENES = {
    "room": (lambda scene: None, False),
    "dithered": (lambda scene: wall(blended(method="DITHERED"), (0, 0, 0), (0, 0, 0)), False),
    "a material nobody has": (lambda scene: blended(), False),
    "another scene's": (of_another_scene, False),
    "blended": (lambda scene: wall(blended(), (0, 0, 0), (0, 0, 0)), True),
    "a volume": (lambda scene: wall(cloud(), (0, 0, 0), (0, 0, 0)), True),
    "a volume object": (lambda scene: put(bpy.data.volumes.new("Smoke")), True),
    "Grease Pencil": (lambda scene: put(bpy.data.grease_pencils.new("Strokes")), True),
    "fog": (fog, True),
    "an instance": (instanced, True),
    "geometry nodes": (by_geometry_nodes, True),
    "fog of a view layer": (
        lambda scene: (
            fog(scene),
            setattr(scene.view_layers[0], "world_override", scene.world),
            setattr(scene, "world", None),
        ),
        True,
    ),
    "an override": (lambda scene: setattr(scene.view_layers[0], "material_override", blended()), True),
}
EXTRA = (
    "use_pass_grease_pencil",
    "use_pass_glossy_color",
    "use_pass_environment",
    "eevee.use_pass_transparent",
    "eevee.use_pass_volume_direct",
)


@pytest.mark.parametrize("kind", SCENES)
def test_passes_are_added_only_where_something_is_in_front(fresh, kind):
    scene, (make, expected) = box(fresh), SCENES[kind]
    simple_tree(scene)
    make(scene)
    before, layer = written_down(), scene.view_layers[0]
    scene.afterlight.enabled = True
    assert [layer.path_resolve(switch) for switch in EXTRA] == [expected] * len(EXTRA)
    scene.afterlight.enabled = False
    assert not differences(before, written_down())


def test_passes_follow_the_materials(fresh, addon):
    scene = box(fresh)
    card = wall(blended(), (0, 0, 0), (0, 0, 0))
    scene.afterlight.enabled = True
    layer = scene.view_layers[0]
    bpy.data.objects.remove(card)
    addon.compositor.setup.follow(scene)
    assert not any(map(layer.path_resolve, EXTRA))
    wall(cloud(), (0, 0, 0), (0, 0, 0))
    assert not addon.compositor.faults.find(scene)
    addon.render.handlers.before_render(scene)  # nothing else tells of an edited material
    addon.render.handlers.after_render()
    assert all(map(layer.path_resolve, EXTRA))


# In renders of a room, each made once

MIDDLE, DARK = np.s_[16:20, 30:34], np.s_[14:22, 40:46]
_made = {}


def room(scene):
    scene.afterlight.seed = 1
    return box(scene, samples=4)


def beam(scene):
    """The lamp lights only the red wall: everything else is dark except for its bounce."""
    scene = room(scene)
    lamp = bpy.data.objects["Lamp"]
    lamp.data.type = "SPOT"
    lamp.data.energy, lamp.data.spot_size, lamp.data.spot_blend = 1000, radians(30), 0
    lamp.location, lamp.rotation_euler = (1, 0.7, 0), (0, radians(90), 0)
    return scene


CARDS = {0.5: (-1.4, 0.6), 0.95: (0.0, 0.6), 0.99: (1.4, 0.6)}
RED_AT, DITHERED_AT = (-1.0, -0.7), (1.0, -0.7)


def card_at(material, place):
    card = wall(material, (place[0], 1.9, place[1]), (90, 0, 0))
    card.scale, card.visible_shadow = (0.25,) * 3, False


def at(place):
    """The pixels at the middle of a card."""
    scale = 64 / (2 * 0.75 * 5.3)
    row, column = round(18 - place[1] * scale), round(32 + place[0] * scale)
    return np.s_[row - 2 : row + 2, column - 2 : column + 2]


def cards(scene):
    for alpha, place in CARDS.items():
        card_at(blended(alpha), place)
    red = blended()
    shader = red.node_tree.nodes.new("ShaderNodeBsdfTransparent")
    shader.inputs["Color"].default_value = 0.8, 0.0, 0.2, 1
    red.node_tree.links.new(shader.outputs[0], red.node_tree.get_output_node("EEVEE").inputs["Surface"])
    card_at(red, RED_AT)
    return scene


def dithered(scene):
    card_at(blended(method="DITHERED"), DITHERED_AT)
    return scene


def black_cube(scene):
    mesh = bpy.data.meshes.new("Cloud")
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    mesh.from_pydata(corners, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    mesh.materials.append(cloud())
    put(mesh, (0, 0.5, 0))
    return scene


def stroke(scene):
    """Black ink over the middle of the image."""
    strokes = bpy.data.grease_pencils.new("Strokes")
    drawing = strokes.layers.new("Ink").frames.new(1).drawing
    drawing.add_strokes([2])
    for point, x in zip(drawing.strokes[0].points, (-1, 1)):
        point.position, point.radius, point.opacity = (x, 0, 0), 0.3, 1
    ink = bpy.data.materials.new("Ink")
    bpy.data.materials.create_gpencil_data(ink)
    ink.grease_pencil.color = 0, 0, 0, 1
    strokes.materials.append(ink)
    put(strokes)
    return scene


def foggy(scene, **options):
    fog(scene, **options)
    return scene


PICTURES = {
    "bare": room,
    "cards": lambda scene: cards(room(scene)),
    "dithered": lambda scene: dithered(room(scene)),
    "dithered and cards": lambda scene: cards(dithered(room(scene))),
    "black cube": lambda scene: black_cube(room(scene)),
    "stroke": lambda scene: stroke(room(scene)),
    "mist": lambda scene: foggy(room(scene), density=0.2, color=(0.8, 0.5, 0)),
    "thick": lambda scene: foggy(room(scene), kind="ShaderNodeVolumeScatter", density=1.0, color=(1, 1, 1)),
    "beam": beam,
    "beam, cards": lambda scene: cards(beam(scene)),
    "beam, mist": lambda scene: foggy(beam(scene), density=0.2, color=(0.8, 0.5, 0)),
}


@pytest.fixture
def pictures(fresh, addon, tmp_path, monkeypatch):
    """The render of one of PICTURES: lit, plain and light, (H, W, 3), top row first; and surface, EEVEE's S."""

    def made(name):
        if name not in _made:
            if _made:
                bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
            engine, found = addon.render.engine.AfterlightEngine, SimpleNamespace()
            hand_back = engine._hand_back

            def spy(self, shot, pictures):
                found.light = pictures["Indirect"][::-1].copy()
                hand_back(self, shot, pictures)

            with monkeypatch.context() as patch:
                patch.setattr(engine, "_hand_back", spy)
                scene = PICTURES[name](bpy.context.scene)
                scene.afterlight.enabled = True
                found.lit = read_rgb(render(scene, tmp_path / "lit.exr"))
                assert scene.afterlight.report == ""
                found.again = None
                if name == "mist":
                    first = found.light
                    assert bpy.ops.afterlight.update() == {"FINISHED"}
                    found.again, found.light = found.light, first
            path, layer = addon.render.frames.kept(scene).path, scene.view_layers[0].name
            cut = addon.scene.exr.read(path, addon.scene.cameras.window(scene)[0])
            color, direct, found.plain = (
                np.stack([cut(f"{layer}.{kind}.{axis}") for axis in "RGB"], -1).astype(float)
                for kind in ("Diffuse Color", "Diffuse Direct", "Combined")
            )
            found.surface = color * direct
            _made[name] = found
        return _made[name]

    return made


def test_blended_cards_let_their_share_through(pictures):
    bare, found = pictures("bare").light, pictures("cards").light
    for alpha, place in CARDS.items():
        ratio = found[at(place)].mean() / bare[at(place)].mean()
        assert ratio == pytest.approx(1 - alpha, abs=0.01), alpha
    red = found[at(RED_AT)].mean((0, 1)) / bare[at(RED_AT)].mean((0, 1))
    np.testing.assert_allclose(red, (0.8, 0.0, 0.2), atol=0.02)
    beside = np.s_[8:28, :14]
    np.testing.assert_allclose(found[beside], bare[beside], rtol=0.01, atol=1e-4)


def test_cards_in_the_dark_let_their_share_through(pictures):
    dark, found = pictures("beam"), pictures("beam, cards").light
    for alpha, place in CARDS.items():
        assert dark.surface[at(place)].max() < 1e-3 and dark.light[at(place)].mean() > 0.005, "dark but for its bounce"
        assert found[at(place)].mean() / dark.light[at(place)].mean() == pytest.approx(1 - alpha, abs=0.01), alpha


def test_dithered_cards_are_not_taken_twice(pictures):
    alone, found = pictures("dithered").light, pictures("dithered and cards").light
    here = at(DITHERED_AT)
    assert 0.1 < alone[here].mean() / pictures("bare").light[here].mean() < 0.9
    np.testing.assert_allclose(found[here], alone[here], rtol=0.02, atol=1e-3)


def test_a_black_volume_stays_black(pictures):
    found = pictures("black cube")
    assert found.plain[MIDDLE].max() < 1e-4 and pictures("bare").light[MIDDLE].min() > 0.05
    assert found.lit[MIDDLE].max() < 1e-3


def test_grease_pencil_stays_black(pictures):
    found = pictures("stroke")
    assert found.plain[MIDDLE].max() < 1e-4 and found.lit[MIDDLE].max() < 1e-3
    assert found.light[:6].mean() > 0.05, "beside the stroke"


PARTS = MIDDLE, np.s_[10:14, 22:42], np.s_[22:26, 22:42]


def test_fog_takes_of_the_bounce_as_of_the_surface(pictures):
    """Fog that emits no light attenuates the bounce as much as the plain image, in each channel."""
    found, bare = pictures("mist"), pictures("bare")
    for part in PARTS:
        taken = found.plain[part].mean((0, 1)) / bare.plain[part].mean((0, 1))
        assert 0.05 < taken[2] < taken[1] < taken[0] < 0.95
        np.testing.assert_allclose(found.light[part].mean((0, 1)) / bare.light[part].mean((0, 1)), taken, rtol=0.03)


def test_thick_fog_that_glows_hides_the_bounce(pictures):
    found = pictures("thick")
    assert found.plain[MIDDLE].min() > 0.01 and pictures("bare").light[MIDDLE].min() > 0.05
    assert found.light[MIDDLE].max() < 1e-3


def test_shadows_in_fog_take_it_from_around(pictures):
    dark, found = pictures("beam"), pictures("beam, mist")
    assert dark.surface[DARK].max() < 1e-3 and dark.light[DARK].mean() > 0.005
    taken = pictures("mist").plain[DARK].mean((0, 1)) / pictures("bare").plain[DARK].mean((0, 1))
    np.testing.assert_allclose(found.light[DARK].mean((0, 1)) / dark.light[DARK].mean((0, 1)), taken, rtol=0.2)


def test_an_update_is_the_render(pictures):
    mist = pictures("mist")
    np.testing.assert_array_equal(mist.again, mist.light)
