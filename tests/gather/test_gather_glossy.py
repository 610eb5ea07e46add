# SPDX-License-Identifier: GPL-3.0-or-later
"""The specular light: the lobe and its samples, rays against exact ones, the furnace, the sum over a room,
the world."""

import numpy as np
import pytest
from test_gather_views import (
    FRAMES,
    SOLIDS,
    WORLD,
    base_receivers,
    mostly,
    radiosity,
    room_views,
    rows,
    sent_by,
    stages,
)

import room_fixtures as rooms
from reference import glossy as glossy_64
from reference import radiosity as views_64

OUTGOING = [(0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (0.0, -0.98, 0.199)]


def numbers(count, seed=0):
    """(count, 3) of the sequence that the rays follow."""
    return np.modf(np.random.default_rng(seed).random(3) + np.arange(count)[:, None] * glossy_64.R3)[0]


@pytest.mark.parametrize("alpha", [0.01, 0.25, 0.64])
@pytest.mark.parametrize("outgoing", OUTGOING)
def test_the_lobe_integrates_to_its_albedo(outgoing, alpha):
    """The mean weight of sampled directions is the integral of the BRDF times the cosine: no lobe sends back more than
    it gets. And samples follow the lobe: their mean direction is the integral's."""
    outgoing = np.array(outgoing) / np.linalg.norm(outgoing)
    facets, facet_steradians = glossy_64.hemisphere(1500, alpha)
    cosine = facets @ outgoing
    towards = 2 * cosine[:, None] * facets - outgoing
    # The same integral over microfacets: d towards = 4 (outgoing.facet) d facet.
    share = np.where(cosine > 0, glossy_64.lobe(outgoing, towards, alpha) * 4 * cosine * facet_steradians, 0)
    albedo, leaning = share.sum(), (share[:, None] * towards).sum(0) / share.sum()
    assert albedo <= 1 + 2e-3
    random = numbers(200_000)
    facet = glossy_64.visible_normal(
        np.broadcast_to(outgoing, (len(random), 3)), np.full(len(random), alpha), random[:, :2]
    )
    away = 2 * (facet @ outgoing)[:, None] * facet - outgoing
    weight = glossy_64.lobe_weight(outgoing[2], away[:, 2], alpha)
    assert weight.mean() == pytest.approx(albedo, abs=3e-3)
    np.testing.assert_allclose((weight[:, None] * away).sum(0) / weight.sum(), leaning, atol=3e-3)


def gloss_of(light, passes, color=0.5, roughness=0.3):
    width, height = passes.size
    return light.Gloss(
        tuple(np.full((height, width), color, np.float32) for _ in range(3)),
        np.full((height, width), roughness, np.float32),
    )


def gathered(light, views, gloss, world=None, **changes):
    """The picture of the glossy light, top row last."""
    light.gather_views(views, radiosity(light, **dict(groups=32) | changes), world, gloss=gloss)
    return gloss.picture


@pytest.mark.parametrize("roughness", [0.0, 0.1, 0.4, 0.8])
def test_furnace(light, roughness):
    """In a closed box that shines with 1 everywhere, every surface sends its Glossy Color back."""
    views = rooms.box_views(light, albedo=0.0)
    picture = gathered(light, views, gloss_of(light, views[0].load_passes(), 0.5, roughness))
    assert abs(picture.mean() / 0.5 - 1) < 0.01
    assert picture.max() < 0.5 * 1.01 and np.mean(picture < 0.5 * 0.9) < 0.03


def test_diffuse_and_gloss_together_send_no_more_than_they_get(light):
    """Of a surface whose colours sum to 0.9: eight bounces of a furnace whose walls keep a tenth."""
    views = rooms.box_views(light, albedo=0.6)
    gloss = gloss_of(light, views[0].load_passes(), 0.3, 0.4)
    both = light.gather_views(views, radiosity(light, bounces=8), gloss=gloss) + gloss.picture
    own, sent = 1.0, (1 - 0.6**8) / (1 - 0.6)  # of each wall, and with seven diffuse bounces
    assert abs(both.mean() / (0.9 * sent) - 1) < 0.01
    assert (both + own).mean() < sent / (1 - 0.3) * 1.01  # no more than if gloss were passed on as well


def staged_base(light, views, chosen):
    """What the pass "reflect" is given, on the GPU and in float64."""
    staged = stages(light, views, chosen)
    sent = sent_by(light, staged)
    base, level, places, normals = base_receivers(light, views, chosen)
    step = int(staged.table["depth_step"])
    grids = [(*staged.grid("emitters", index), step) for index in range(len(views))]
    count = light.view_layout.count_of(staged.table, "emitters")
    return (
        staged,
        base,
        {"emitters": staged.emitters, "radiance": sent, "depths": staged.depths},
        grids,
        rows(staged.emitters, count, 4),
        rows(sent, count)[:, 0],
        places,
        normals,
        level.area.ravel(),
    )


def reflected(light, base, table, textures, roughness, rays, seed=0):
    """(texels, 4) that the pass "reflect" gives for one roughness everywhere."""
    across, up = base.size
    surface = np.zeros((up, across, 4), np.float32)
    surface[...] = roughness, 1, 0, 0
    target, shine = light.device.texture(across, up), light.device.texture(across, up, data=surface)
    textures = textures | {"surfels": base.surfels, "gloss": shine}
    light.glossy.reflect(base, table, radiosity(light, groups=2 * rays, seed=seed), textures, target)
    return np.array(target.read(), float).reshape(-1, 4)


def shifts_of(across, up, seed=0):
    """(texels, 3) random numbers as the shader has them."""

    def output(state):
        word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737 & 0xFFFFFFFF
        return (word >> 22) ^ word

    def following(state):
        return (state * 747796405 + 2891336453) & 0xFFFFFFFF

    y, x = (index.ravel().astype(np.uint64) for index in np.mgrid[:up, :across])
    state, found = np.full(len(x), seed, np.uint64), []
    for value in (0, y, x):
        state = output(following((state + value) & 0xFFFFFFFF))
    for _ in range(3):
        state = following(state)
        found.append((output(state) >> 8) / 2.0**24)
    return np.stack(found, -1)


@pytest.mark.parametrize("roughness", [0.05, 0.5])
@pytest.mark.parametrize("world", [0, 1])
def test_reflections_agree_with_float64(light, roughness, world):
    """Ray by ray: the same samples, the same hits and the same radiance, but for rays that graze an edge."""
    views = room_views(light)
    staged, base, textures, grids, emitters, sent, places, normals, areas = staged_base(light, views, radiosity(light))
    staged.table["world"][:, :3] = world * WORLD
    measured = reflected(light, base, staged.table, textures, roughness, 3)
    _, _, across, up = base.boxes[0]
    expected = glossy_64.reflect(
        staged.cameras,
        grids,
        emitters,
        sent,
        places,
        normals,
        areas,
        np.full(len(places), roughness),
        shifts_of(across, up),
        3,
        light.glossy.reach_of(staged.table, staged.depths),
        world * WORLD,
    )
    expected[areas == 0] = 0
    assert (expected[:, 3] > 0).mean() > 0.6
    mostly(measured, expected, 2e-3, 0.03)


@pytest.mark.parametrize("name", ["random", "room"])
def test_smoothing_agrees_with_float64(light, name):
    views, chosen = FRAMES[name](light), radiosity(light)
    base, level, _, _ = base_receivers(light, views, chosen)
    up, across = level.area.shape
    rng = np.random.default_rng(5)
    found, gloss = rng.random((up, across, 4)).astype(np.float32), np.zeros((up, across, 4), np.float32)
    gloss[..., 0], gloss[..., 1] = rng.uniform(0, 0.9, (up, 1)), rng.random((up, across)) > 0.2
    found[..., 3] *= 2  # distances of half a metre and more
    total = light.device.texture(across, up)
    light.device.dispatch(
        "smooth_gloss",
        {
            "surfels": base.surfels,
            "gloss": light.device.texture(across, up, data=gloss),
            "irradiance": light.device.texture(across, up, data=found),
            "total_out": total,
        },
        light.device.groups(across, up),
        frame=base.frame,
    )
    measured, expected = (
        np.array(total.read(), float),
        glossy_64.smooth_gloss(level, found.astype(float), gloss.astype(float)),
    )
    assert not measured[..., 3].any()
    mostly(measured[..., :3].reshape(-1, 3), expected.reshape(-1, 3), 1e-4)
    assert np.abs(expected - found[..., :3]).mean() > 0.02


def exact_hits(start, towards, solids, room=rooms.ROOM):
    """(n,) metres to the walls of a room or the solids in it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        far = np.maximum((room[0] - start) / towards, (room[1] - start) / towards).min(-1)
        for low, high in solids:
            near, leave = np.sort([(low - start) / towards, (high - start) / towards], axis=0)
            enter = near.max(-1)
            far = np.where((enter < leave.min(-1)) & (enter > 1e-6) & (enter < far), enter, far)
    return far


def all_around(light, size=(96, 96)):
    """A lit box with two solids, from the middle and from four corners: what none of these shows is next to nothing."""
    corners = [
        ((x, y, z), (-x, -y, -0.9 * np.sign(z)))
        for x, y, z in ((-0.9, -0.9, 0.7), (0.9, 0.9, 0.7), (0.9, -0.9, -0.3), (-0.9, 0.9, -0.3))
    ]
    return rooms.box_views(light, size, radiance=rooms.lamp, albedo=0.0, solids=SOLIDS) + [
        rooms.view_of(
            light, rooms.camera_at(light, eye, towards, size), size, radiance=rooms.lamp, albedo=0.0, solids=SOLIDS
        )
        for eye, towards in corners
    ]


def test_mirrors_meet_what_exact_rays_meet(light):
    """How far the rays of a mirror go in a box with two solids."""
    views = all_around(light)
    chosen = radiosity(light, start=1)
    staged, base, textures, _, _, _, places, normals, areas = staged_base(light, views, chosen)
    measured = reflected(light, base, staged.table, textures, 0.0, 1)[:, 3]
    eye = views_64.direction(views_64.to_camera(staged.cameras[0], places))
    towards = 2 * (eye * normals).sum(-1, keepdims=True) * normals - eye
    origin = views[0].camera.position
    expected = exact_hits(places + origin + 1e-6 * normals, towards, SOLIDS)
    found = (areas > 0) & (measured > 0)
    assert found.sum() > 0.95 * (areas > 0).sum()
    error = np.abs(1 / np.where(found, measured, 1) / expected - 1)[found]
    assert np.median(error) < 0.005 and np.mean(error > 0.05) < 0.06  # those that graze the solids


@pytest.mark.parametrize("roughness, limit", [(0.1, 0.08), (0.3, 0.06), (0.6, 0.05)])
def test_the_sum_over_a_room(light, roughness, limit):
    """A lit box with solids, against the lobe's integral by exact rays in float64: error and energy."""
    views = all_around(light)
    picture = gathered(light, views, gloss_of(light, views[0].load_passes(), 1.0, roughness), start=1)
    camera, size = views[0].camera, (96, 96)
    _, place, normal = rooms.trace(camera, size, solids=SOLIDS)
    pick = np.random.default_rng(1).permutation(96 * 96)[:1500]
    place, normal = place.reshape(-1, 3)[pick], normal.reshape(-1, 3)[pick]
    eye = views_64.direction(camera.position - place)
    total, weights = np.zeros((len(place), 3)), np.zeros(len(place))
    for random in numbers(256, 3):
        towards, weight = glossy_64.rays_of(
            place, normal, eye, np.full(len(place), roughness), np.broadcast_to(random[:2], (len(place), 2))
        )
        weight = np.where((towards * normal).sum(-1) > 0, weight, 0)
        far = exact_hits(place + 1e-6 * normal, towards, SOLIDS)
        met = place + far[:, None] * towards
        total += weight[:, None] * rooms.lamp(met, normal_at(met, towards))
        weights += weight
    expected = total / weights[:, None]
    measured = picture.reshape(-1, 3)[pick]
    assert abs(measured.sum() / expected.sum() - 1) < 0.02
    assert np.abs(measured - expected).sum() / expected.sum() < limit


def normal_at(place, towards):
    """Normal of the room's wall or of the solid's side that a place lies on, against `towards`."""
    normal, best = np.zeros_like(place), np.full(len(place), np.inf)
    for low, high in (rooms.ROOM, *SOLIDS):
        for axis in range(3):
            for side in (low, high):
                off = np.abs(place[:, axis] - side[axis])
                within = np.all((place > np.array(low) - 1e-4) & (place < np.array(high) + 1e-4), -1)
                nearer = within & (off < best)
                normal[nearer] = np.eye(3)[axis]
                best = np.where(nearer, off, best)
    return normal * -np.sign((normal * towards).sum(-1, keepdims=True))


def test_a_thin_wall_does_not_hide_what_its_other_side_reflects(light):
    """A hall of 4 m halved by a wall of 15 mm, its left half bright and its right half dark; views see the wall's left
    side, others look along its right side, where a texel of a depth map is thicker than the wall."""

    def bright(place, normal):
        return np.broadcast_to(place[..., :1] < 0, place.shape).astype(float)

    size, hall, wall = (96, 96), ((-2, -2, -2), (2, 2, 2)), [((-0.0075, -2, -2), (0.0075, 2, 2))]
    eyes = [
        ((-1.9, 0.1, -0.2), (1, 0, 0)),
        ((-0.2, 0, 0.1), (-1, 0.1, 0)),
        ((-1.9, 1.9, 0), (1, -1, 0)),
        ((-1.9, -1.9, 0), (1, 1, 0)),
        ((0.4, -1.9, -0.2), (-0.1, 1, 0)),
        ((0.4, 1.9, 0.3), (-0.1, -1, 0)),
        ((0.3, 0.1, 1.9), (-0.1, 0, -1)),
    ]
    views = [
        rooms.view_of(
            light,
            rooms.camera_at(light, eye, towards, size, fov=2.2 if index else np.pi / 2),
            size,
            radiance=bright,
            albedo=0.0,
            room=hall,
            solids=wall,
        )
        for index, (eye, towards) in enumerate(eyes)
    ]
    picture = gathered(light, views, gloss_of(light, views[0].load_passes(), 1.0, 0.3), start=1)
    _, place, _ = rooms.trace(views[0].camera, size, hall, wall)
    seen = picture[np.abs(place[..., 0] + 0.0075) < 1e-3]
    assert len(seen) > 3000 and seen.mean() > 0.99 and np.mean(seen < 0.5) < 0.002


def floor_view(light, size=(64, 48)):
    camera = rooms.camera_at(light, (0, 0, 2), (0, 1, -0.7), size)
    view = rooms.view_of(light, camera, size, room=((-6, -6, 0), (6, 6, 60)))
    far = view.load_passes().normal[2] < 0.5  # walls and ceiling are not there
    view.load_passes().depth[far] = 1e10
    return view


@pytest.mark.parametrize("world", [None, WORLD])
def test_where_nothing_is_met_nothing_changes(light, world):
    """A floor under the sky: it keeps what EEVEE has reflected of the world."""
    view = floor_view(light)
    assert not gathered(light, [view], gloss_of(light, view.load_passes(), 1.0, 0.3), world).any()


def test_a_closed_room_reflects_nothing_of_the_world(light):
    """EEVEE's reflections hold all of the world. What stands before it takes it away, and shows itself."""
    views = rooms.box_views(light, albedo=0.0)
    even = np.zeros((4, 3))
    even[0] = 0.7, 0.5, 0.2
    picture = gathered(light, views, gloss_of(light, views[0].load_passes(), 0.5, 0.3), even)
    np.testing.assert_allclose(picture.mean((0, 1)), 0.5 * (1 - even[0]), rtol=0.02)


def test_only_what_shines_gets_light(light):
    """Glossy Color 0 and background stay black, and what is not finite costs no more than itself."""
    views = rooms.box_views(light, albedo=0.0)
    gloss = gloss_of(light, views[0].load_passes())
    for channel in gloss.color:
        channel[:, :20] = 0
    gloss.color[0][30, 40] = np.nan
    gloss.roughness[32, 50] = np.inf
    views[0].load_passes().depth[:10] = 1e10
    picture = gathered(light, views, gloss)[::-1]
    assert (
        np.isfinite(picture).all()
        and not picture[:, :20].any()
        and not picture[:10].any()
        and not picture[30, 40].any()
    )
    assert picture[20:60, 25:60].mean() == pytest.approx(0.5, rel=0.03)


def test_the_diffuse_light_does_not_depend_on_gloss(light):
    views = rooms.box_views(light, radiance=rooms.lamp)
    plain = light.gather_views(views, radiosity(light))
    shining = light.gather_views(views, radiosity(light), gloss=gloss_of(light, views[0].load_passes()))
    np.testing.assert_array_equal(plain, shining)


@pytest.mark.parametrize(
    "shines, averages, gathers",
    [(True, False, 1), (False, False, 1), (False, True, 1), (True, True, 1), (False, True, 3), (True, False, 2)],
)
@pytest.mark.parametrize("size, start", [((640, 360), 2), ((960, 544), 4), ((400, 300), 1)])
def test_memory_is_what_the_textures_take(light, monkeypatch, size, start, shines, averages, gathers):
    """A whole frame, with textures that only count themselves."""
    held = most = 0

    class Texture:
        def __init__(self, width, height, format="RGBA32F", data=None):
            nonlocal held, most
            self.width, self.height, self.format = width, height, format
            self.bytes = width * height * {"RGBA32F": 16, "RGBA32UI": 16, "RG32F": 8, "R32F": 4}[format]
            held += self.bytes
            most = max(most, held)

        def __del__(self):
            nonlocal held
            held -= self.bytes

        def clear(self, **_):
            pass

    monkeypatch.setattr(light.device, "texture", Texture)
    for name in ("dispatch", "wait", "run_band"):
        monkeypatch.setattr(light.device, name, lambda *_, **__: None)
    monkeypatch.setattr(
        light.device,
        "read",
        lambda texture: np.ones((texture.height, texture.width, 2 if texture.format == "RG32F" else 4), np.float32),
    )
    plane = np.ones(size[::-1], np.float32)
    passes = light.Passes(plane, *[(plane,) * 3] * 4)
    camera = light.Camera(np.eye(3), np.ones(2), np.zeros(2))
    views = [light.View(passes, camera, lambda: passes)] * 3
    chosen = radiosity(light, start=start, bounces=2, gathers=gathers)
    past = light.History() if averages else None
    for _ in range(2):
        most = held
        light.gather_views(views, chosen, history=past, gloss=light.Gloss((plane,) * 3, plane) if shines else None)
    assert light.gpu_bytes(*size, chosen, 2, shines=shines, averages=averages) == most
    del past
    assert held == 0


def test_gloss_shows_the_gloss_that_it_meets(light):
    """Walls that send 1 of their own, and a gloss of 0.5 beside that of which lamps make 0.6: others see 1.6 in their
    gloss, and with the light that the walls have gathered, pi, half of that more."""
    views = rooms.box_views(light, albedo=0.0)
    shining = [
        light.View(
            view.source,
            view.camera,
            lambda view=view: rooms.view_of(light, view.camera, (64, 64), albedo=0.5, radiance=0.6).source,
        )
        for view in views
    ]
    for bounces, sent in ((1, 1.6), (2, 1.6 + 0.5)):
        picture = gathered(light, shining, gloss_of(light, views[0].load_passes()), bounces=bounces)
        assert picture.mean() == pytest.approx(0.5 * sent, rel=0.02)
