# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the error comes from: rays that must arrive or must not, sums with known visibility, a table that adds up."""

import sys
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest

import gather_fixtures as fixtures
import scenes
from reference import paper as reference

sys.path.append(str(Path(__file__).resolve().parents[2]))

from benchmarks.accuracy import causes

CORNERS = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-3, 0.5)]
WALLS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4)]
SIZE = 16, 9


def mesh(name, vertices, faces):
    made = bpy.data.meshes.new(name)
    made.from_pydata(vertices, [], faces)
    return scenes.put(made)


@pytest.fixture
def box(fresh, light):
    """(scene, passes, camera) of light_fixtures.box_frame(): what it traces, as a scene."""
    mesh("Walls", CORNERS, WALLS)
    fresh.camera = scenes.put(bpy.data.cameras.new("Camera"))
    return fresh, *fixtures.box_frame(light, *SIZE)


def divide(top):
    """Put up a wall across the box at x = 0, from its floor to y = `top`; the camera stands in its plane and sees
    nothing of it."""
    mesh("Divider", [(0, y, z) for y in (-1, top) for z in (-3, 0.5)], [(0, 1, 3, 2)])


def prepared(scene, passes, camera, start=1):
    tree = causes.tree_of(scene, camera)
    guide, base = reference.pack(passes, camera, start)
    return base, causes.Surfaces(tree, *causes.points_shown(tree, passes, camera), guide, camera, start)


def known_visibility(base, top):
    """(texels, texels) bool, from where the line between two places crosses x = 0."""
    x, y, _ = base.position.reshape(-1, 3).T
    across = np.multiply.outer(x, x) < 0
    share = np.divide.outer(x, np.ones_like(x)) / np.where(across, np.subtract.outer(x, x), 1)
    crossing = y[:, None] - share * np.subtract.outer(y, y)
    return ~across | (crossing > top)


def forms(base):
    place, vector_area = base.position.reshape(-1, 3), base.vector_area.reshape(-1, 3)
    return reference.form_factor(
        place[:, None], reference.direction(vector_area)[:, None], place, base.area.ravel(), vector_area
    )


@pytest.mark.parametrize("start", [1, 2])
def test_an_empty_box_hides_nothing(box, start):
    """No ray is stopped, so that true visibility changes nothing, to rounding; not even where depth and normal are
    those of another point of the pixel, or of the pixel beside it."""
    scene, passes, camera = box
    elsewhere = 1 + np.random.default_rng(0).uniform(-0.01, 0.01, passes.depth.shape)
    beside = tuple(np.roll(axis, 1, 1) for axis in passes.normal)
    passes = replace(passes, depth=passes.depth * elsewhere, normal=beside)
    base, surfaces = prepared(scene, passes, camera, start)
    everything, halves = causes.sums(base, base.radiance, surfaces, seed=0)
    assert np.allclose(everything[..., [0, 1, 2, 6]], reference.all_pairs(base), rtol=1e-9)
    assert np.median(everything[..., 6]) > 0.2
    assert np.allclose(halves, everything, rtol=1e-12)


@pytest.mark.parametrize("top, stopped", [(1.0, 1), (0.01, 0.5)])
def test_rays_are_stopped_where_the_wall_stands_and_nowhere_else(box, top, stopped):
    """Every pair of texels that send to each other, by a full wall and by one of half the height, which stops half."""
    divide(top)
    base, surfaces = prepared(*box)
    expected = known_visibility(base, top)
    receivers, emitters = np.nonzero(forms(base) > 0)
    seen = surfaces.see(receivers, emitters, np.random.default_rng(0))
    assert np.array_equal(seen, expected[receivers, emitters])
    across = np.sign(base.position[..., 0].ravel()[receivers]) != np.sign(base.position[..., 0].ravel()[emitters])
    assert 1 - seen[across].mean() == pytest.approx(stopped, abs=0.02) and seen[~across].all()


def test_behind_a_wall_it_is_dark(box):
    """Only what lies left of the wall sends: right of it exactly nothing arrives, and left of it as much as without."""
    divide(1.0)
    base, surfaces = prepared(*box)
    left = base.position[..., 0] < 0
    base.radiance = np.where(left[..., None], base.radiance, 0)
    everything, halves = causes.sums(base, base.radiance, surfaces, seed=0)
    arrived = halves.mean(0)[..., :3]
    assert everything[..., :3][~left].mean() > 0.1 * everything[..., :3][left].mean()
    assert np.abs(arrived[~left].mean()) < 0.01 * arrived[left].mean()


def test_half_a_wall_without_bias(box):
    """Over 200 seeds both halves come within 4 standard errors of the sum over all pairs with known visibility, texel
    by texel and as a whole, for both radiances and the form factors. A bias of few rays would be large: hence 8."""
    top = 0.01
    divide(top)
    base, surfaces = prepared(*box)
    other = base.radiance[:, ::-1] ** 2
    sent = np.concatenate([np.pi * base.radiance, np.pi * other, np.ones((*base.area.shape, 1))], -1).reshape(-1, 7)
    exact = ((forms(base) * known_visibility(base, top)) @ sent).reshape(*base.area.shape, 7)
    runs = np.concatenate([causes.sums(base, other, surfaces, seed, rays=8)[1] for seed in range(200)])
    wholes = runs.mean((1, 2)) / exact.mean((0, 1))
    assert np.all(np.abs(wholes.mean(0) - 1) < 4 * wholes.std(0) / np.sqrt(len(runs)))
    assert wholes.std(0).max() < 0.05
    error = (runs.mean(0) - exact) / np.maximum(runs.std(0) / np.sqrt(len(runs)), 1e-9 * exact.max())
    assert (np.abs(error) < 4).mean() > 0.995


def test_normals_that_emission_leaves_out_come_from_the_scene(box):
    scene, passes, camera = box
    bare = replace(passes, normal=tuple(np.where(passes.normal[1] > 0.5, 0, axis) for axis in passes.normal))
    _, normal = causes.points_shown(causes.tree_of(scene, camera), bare, camera)
    found = causes.with_normals(bare, normal, camera).normal
    assert not np.array_equal(bare.normal, passes.normal)
    assert np.abs(np.subtract(found, passes.normal)).max() < 1e-5


def an_instance(scene):
    group = bpy.data.collections.new("Group")
    group.objects.link(bpy.data.objects.new("Square", square()))
    scenes.put(None).instance_type = "COLLECTION"
    scene.objects["Empty"].instance_collection = group


def a_modifier(scene):
    """Only a render has it."""
    thing = scenes.put(square(), (-10, 0, 0))
    array = thing.modifiers.new("Array", "ARRAY")
    array.use_relative_offset, array.use_constant_offset, array.constant_offset_displace = False, True, (10, 0, 0)
    array.show_viewport = False


def a_text(scene):
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.size, text.align_x, text.align_y = "I", 8, "CENTER", "CENTER"
    scenes.put(text)


def a_curve(scene):
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.2
    line = curve.splines.new("POLY")
    line.points.add(1)
    line.points[0].co, line.points[1].co = (-2, 0, 0, 1), (2, 0, 0, 1)
    scenes.put(curve)


def square():
    made = bpy.data.meshes.new("Square")
    made.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    return made


@pytest.mark.parametrize("blocker", [an_instance, a_modifier, a_text, a_curve])
def test_whatever_is_rendered_blocks(fresh, light, blocker):
    """The ray straight down the view, before and after; a thing that renders leave out does not block."""
    fresh.camera = scenes.put(bpy.data.cameras.new("Camera"), (0.02, 0.01, 7))
    scenes.put(square(), (0, 0, -5))
    scenes.put(square(), (0, 0, 3)).hide_render = True
    camera = fixtures.camera_for(light, *SIZE)

    def distance():
        return causes.tree_of(fresh, camera).ray_cast((0, 0, 0), (0, 0, -1))[3]

    fresh.render.engine = "CYCLES"
    assert distance() == pytest.approx(12)
    blocker(fresh)
    assert distance() == pytest.approx(7, abs=0.3)
    assert fresh.render.engine == "CYCLES"


def table(afterlight, light, box, **changes):
    scene, passes, camera = box
    direct = np.stack(passes.diffuse_direct, -1)
    chosen = light.PaperSettings(start=1, samples=16, radius=4, seed=0, strength=1.0)
    truth = np.random.default_rng(0).uniform(0.1, 1, (2, *direct.shape)).astype(np.float32)
    given = (
        dict(
            settings=chosen,
            cycles_direct=direct,
            one_bounce=truth[0],
            n_bounces=truth[1],
            mask=np.random.default_rng(1).random(direct.shape[:2]) > 0.3,
        )
        | changes
    )
    rows = causes.measure(afterlight, scene, passes, camera, **given)
    return rows, {row["name"]: row for row in rows}


def test_the_causes_add_up_to_the_total(afterlight, light, box):
    """In a divided box, where every cause has something to say."""
    divide(1.0)
    _, passes, _ = box
    rows, named = table(afterlight, light, box, cycles_direct=1.3 * np.stack(passes.diffuse_direct, -1))
    assert [row["name"] for row in rows] == [name for name, _ in (*causes.CAUSES, causes.TOTAL, causes.RAY_NOISE)]
    steps, total = rows[: len(causes.CAUSES)], named["total"]
    assert sum(row["gain"] for row in steps) == pytest.approx(total["gain"], abs=1e-6)
    assert total["gain"] == pytest.approx(total["energy"] - 1, abs=1e-6)
    assert sum(row["share"] for row in steps) >= total["share"]
    for row in rows:
        assert row["share"] >= abs(row["gain"]) and row["share"] > 0 and row["explanation"]
    assert named["missing visibility"]["gain"] > 5 * named["noise of the visibility rays"]["share"]
    assert named["EEVEE's direct light"]["energy"] == pytest.approx(1 / 1.3, rel=1e-5)


def test_a_cause_that_is_absent_shows_nothing(afterlight, light, box):
    """An empty box without noise, and lit alike by both: only the hierarchy and what the reference adds are left."""
    exhaustive = light.PaperSettings(start=1, samples=0, radius=4, seed=0, strength=1.0)
    _, named = table(afterlight, light, box, settings=exhaustive)
    for name in ("sampling noise", "missing visibility", "EEVEE's direct light", "noise of the visibility rays"):
        assert named[name]["share"] < 1e-6, name
    for name in ("hierarchy", "off screen and hidden surfaces", "later bounces"):
        assert named[name]["share"] > 1e-3, name


def test_a_black_reference_gives_no_numbers(afterlight, light, box):
    _, passes, _ = box
    black = np.zeros((*passes.depth.shape, 3), np.float32)
    _, named = table(afterlight, light, box, n_bounces=black)
    assert named["total"]["share"] is named["total"]["gain"] is named["total"]["energy"] is None
    assert named["hierarchy"]["energy"] > 0
