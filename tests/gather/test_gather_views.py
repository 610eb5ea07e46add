# SPDX-License-Identifier: GPL-3.0-or-later
"""The light between several views: every stage against float64, what hides what, the estimator, and the furnace."""

from dataclasses import dataclass, replace

import gpu
import numpy as np
import pytest

import gather_fixtures as fixtures
import room_fixtures as rooms
from reference import paper as reference
from reference import radiosity as views_64

TURNED = np.array([[0, 1, 0], [-0.6, 0, 0.8], [0.8, 0, 0.6]])
SURFACE = np.s_[..., :3]


def radiosity(light, **changes):
    return light.RadiositySettings(**dict(start=2, bounces=1) | changes)


@dataclass
class Stages:
    """The records of gather_views(), on the GPU, and the float64 cameras of the same views."""

    records: object
    cameras: list

    @property
    def table(self):
        return self.records.table

    @property
    def depths(self):
        return self.records.depths

    @property
    def emitters(self):
        return self.records.emitters

    @property
    def receivers(self):
        return self.records.receivers

    def grid(self, kind, index):
        """(first, across, up, side) of a view's records."""
        grid = self.table["cameras"][kind][index]
        return [int(number) for number in (grid["first"], *grid["size"], grid["side"])]


def stages(light, views, chosen):
    records, *_ = light.records.build_records(views, chosen)
    return Stages(records, views_64.cameras_of(views, int(records.table["depth_step"])))


def rows(texture, count, parts=1):
    """(count, parts, 4) of a texture of records."""
    return np.array(texture.read(), np.float64).reshape(-1, parts, 4)[:count]


def sent_by(light, staged, irradiance=None):
    """What emitters send when receivers have gathered `irradiance`, a texture, or nothing."""
    if irradiance is None:
        irradiance = light.device.texture(
            light.shader_interface.RECORDS_WIDTH, light.view_layout.rows_of(staged.table, "receivers")
        )
        irradiance.clear(format="FLOAT", value=(0.0, 0.0, 0.0, 0.0))
    return light.radiosity.radiate(staged.emitters, irradiance, staged.table)


def random_views(light, size=(45, 30)):
    """Frames without any order seen by turned cameras of both kinds, close together."""
    cameras = [
        light.Camera(camera.rotation, camera.scale, camera.offset, camera.orthographic, np.array(place))
        for place, camera in (
            ((1e3, -2e3, 3.0), fixtures.camera_for(light, *size, shift=(0.1, -0.2), rotation=TURNED)),
            ((1e3 + 0.1, -2e3, 3.1), fixtures.camera_for(light, *size, fov_x=1.3, rotation=TURNED)),
            ((1e3, -2e3, 2.9), fixtures.camera_for(light, *size, rotation=TURNED, orthographic_width=4.0)),
        )
    ]
    made = []
    for seed, camera in enumerate(cameras):
        passes = fixtures.random_frame(light, *size, seed)
        world = np.stack(passes.normal, -1) @ camera.rotation  # random_frame has them in view space
        passes.normal = tuple(np.ascontiguousarray(world[..., axis], np.float32) for axis in range(3))
        made.append(light.View(passes, camera))
    return made


SOLIDS = [((-0.6, -0.3, -1.0), (-0.2, 0.2, 0.1)), ((0.2, 0.3, -1.0), (0.7, 0.6, -0.5))]


def room_views(light, size=(48, 36)):
    """A box with two solids from three places, one of them orthographic; sizes are no multiples of blocks."""
    cameras = [
        rooms.camera_at(light, (0.1, -0.9, 0.17), (0, 1, -0.1), size, shift=(0.1, 0.05)),
        rooms.camera_at(light, (-0.8, 0.7, 0.6), (1, -0.8, -0.7), size),
        rooms.camera_at(light, (0.9, -0.1, 0.2), (-1, 0.2, -0.3), size, across=1.6),
    ]
    return [rooms.view_of(light, camera, size, albedo=0.6, radiance=rooms.lamp, solids=SOLIDS) for camera in cameras]


FRAMES = {"random": random_views, "room": room_views, "box": rooms.box_views}


@pytest.fixture(scope="module", params=["random", "room"])
def frame(request, light):
    return FRAMES[request.param](light)


def mostly(measured, expected, relative=1e-4, outliers=0.003):
    """Do arrays of records (n, ...) agree, but for the few whose place lies within rounding of the edge of a texel?"""
    scale = np.abs(expected).reshape(len(expected), -1).max() if expected.size else 1
    wrong = (np.abs(measured - expected) > relative * scale).reshape(len(expected), -1).any(-1)
    assert wrong.mean() <= outliers, f"{wrong.sum()} of {len(wrong)}"


@pytest.mark.parametrize("step", [1, 3])
def test_depth_maps(light, frame, monkeypatch, step):
    """The middle pixel's depth, and how far its surface reaches within the texel."""
    monkeypatch.setattr(light.view_layout, "DEPTHS_ACROSS", frame[0].load_passes().size[0] // step)
    staged = stages(light, frame, radiosity(light))
    width, height = (int(side) for side in staged.table["depth_size"])
    count = int(staged.table["count"])
    assert (staged.table["depth_step"], count) == (step, len(frame))
    measured = np.array(staged.depths.read(), np.float64).reshape(count, height, width, -1)
    for eye, depths in zip(staged.cameras, measured):
        assert np.abs(depths[..., 0] / eye.depths[..., 0] - 1).max() < 1e-6
        mostly((depths[..., 1] / eye.depths[..., 1]).ravel(), np.ones(width * height), 1e-5)


@pytest.mark.parametrize("step", [1, 2])
@pytest.mark.parametrize("kind", ["emitters", "receivers"])
def test_records_agree_with_float64(light, frame, monkeypatch, kind, step):
    """Place, areas, mean normal, radiance and albedo of every block, and with the areas the shares between views."""
    monkeypatch.setattr(light.view_layout, "DEPTHS_ACROSS", frame[0].load_passes().size[0] // step)
    staged = stages(light, frame, radiosity(light))
    measured = rows(getattr(staged, kind), light.view_layout.count_of(staged.table, kind), 4)
    for index in range(len(frame)):
        first, across, up, side = staged.grid(kind, index)
        expected = views_64.emit(frame, staged.cameras, index, side, step, kind == "receivers").reshape(-1, 4, 4)
        assert len(expected) == across * up
        mine = measured[first : first + across * up]
        for part in range(4):
            mostly(mine[:, part, :3], expected[:, part, :3], 2e-4)
        for part in (0, 1):
            mostly(mine[:, part, 3], expected[:, part, 3], 2e-4)


def many_views(light, size=(64, 64)):
    """The closed box from the middle, from elsewhere, by an orthographic camera, and one of the first once more."""
    flat = rooms.camera_at(light, (0.4, 0.1, 0), (-1, 0.1, 0.2), size, across=1.5)
    views = rooms.box_views(light, size)
    return [
        *views,
        *rooms.box_views(light, size, eye=(-0.5, 0.3, 0.2), towards=[(1, 1, 0.3), (-1, 0.5, 0.2)]),
        rooms.view_of(light, flat, size),
        views[2],
    ]


def test_shares_of_a_surface_sum_to_one(light):
    """Whoever shows a point has a share of it, and all shares make 1, in float64 as in the shader (which agrees:
    test_records_agree_with_float64)."""
    views = many_views(light)
    eyes = views_64.cameras_of(views, 1)
    places, normals = surfaces(views)
    total, seen = np.zeros(len(places)), np.zeros(len(places), int)
    for index, eye in enumerate(eyes):
        projected = views_64.project(eye, places)
        shown = (views_64.depth_at(eye, projected) > 0) & views_64.shows(
            eye, places, normals, views_64.to_camera(eye, places), projected
        )
        share = views_64.own_share(eyes, index, places, normals, np.where(shown, projected[..., 2], 1))
        total += np.where(shown, share, 0)
        seen += shown
    assert all((seen == count).sum() > 20 for count in (1, 2, 3))
    assert np.abs(total[seen > 0] - 1).max() < 1e-9


def own_area(light, views):
    staged = stages(light, views, radiosity(light))
    return rows(staged.emitters, light.view_layout.count_of(staged.table, "emitters"), 4)[:, 0, 3].sum()


def test_a_closed_box_counts_once(light):
    """24 m^2 of a box of 2 m, to 0.2 %, from the six faces of a cube and however many cameras are added, of any
    kind."""
    views = many_views(light)
    for count in range(6, len(views) + 1):
        assert own_area(light, views[:count]) == pytest.approx(24, rel=0.002)


@pytest.mark.parametrize("name", ["random", "room"])
def test_what_emitters_send(light, name):
    """Radiance: the emitter's own, and albedo / pi of its receiver's irradiance; none where that is no finite
    number."""
    views = FRAMES[name](light)
    staged = stages(light, views, radiosity(light))
    count = light.view_layout.count_of(staged.table, "receivers")
    irradiance = np.random.default_rng(3).random(
        (light.view_layout.rows_of(staged.table, "receivers"), light.shader_interface.RECORDS_WIDTH, 4)
    )
    irradiance.reshape(-1, 4)[[1, 3, 4], [0, 1, 2]] = np.nan, np.inf, -np.inf  # of this, nothing is sent on
    texture = light.device.texture(*irradiance.shape[1::-1], data=np.ascontiguousarray(irradiance, np.float32))
    emitters = rows(staged.emitters, light.view_layout.count_of(staged.table, "emitters"), 4)
    owners = np.concatenate(
        [
            views_64.receiver_of(staged.grid("emitters", index), staged.grid("receivers", index))
            for index in range(len(views))
        ]
    )
    assert owners.max() < count and len(np.unique(owners)) > count // 2
    expected = views_64.radiate(emitters, irradiance.reshape(-1, 4)[owners, :3])
    lost = ~np.isfinite(irradiance.reshape(-1, 4)[owners, :3]).all(-1)
    assert 2 < lost.sum() < len(lost) / 2 and not expected[lost, :3].any()
    measured = rows(sent_by(light, staged, texture), len(emitters))[:, 0]
    assert np.abs(measured - expected).max() < 1e-5 * np.abs(expected).max()


def test_the_table_holds_emitters_in_proportion_to_their_pdf(light, monkeypatch):
    """By power and area. Each entry is sampled from its own part of the whole: no count is off by more than two."""
    views = room_views(light)
    staged = stages(light, views, radiosity(light))
    sent = sent_by(light, staged)
    exact = rows(sent, light.view_layout.count_of(staged.table, "emitters"))[:, 0]
    made = light.radiosity.emitter_table(sent, staged.table, 5)
    entries = np.array(made["table"].read()).ravel().astype(int)
    counts = np.bincount(entries, minlength=len(exact))
    pdfs = views_64.pdfs(exact, light.radiosity.BY_AREA)
    assert pdfs.sum() == pytest.approx(1)
    expected = views_64.pdf_factors(exact, light.radiosity.BY_AREA)
    assert np.array(made["starts"].read()).reshape(-1, 4)[0, 2:] == pytest.approx(expected, rel=1e-4)
    assert np.abs(counts - len(entries) * pdfs).max() < 2
    other = light.radiosity.emitter_table(sent, staged.table, 6)["table"]
    assert not np.array_equal(entries, np.array(other.read()).ravel())


# Visibility: shaders/radiosity/shadow_ray.glsl, called directly.

SHADOW_RAYS = """
void main()
{
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x < textureSize(segments, 0).x) {
    bool blocked = is_blocked(texelFetch(segments, ivec2(at.x, 0), 0).xyz, texelFetch(segments, ivec2(at.x, 1), 0).xyz,
                              texelFetch(segments, ivec2(at.x, 0), 0).w, SHADOW_STEPS);
    imageStore(found, ivec2(at.x, 0), vec4(blocked));
  }
}
"""
SHADOW_RAY_FILES = "common/common", "radiosity/views", "radiosity/visibility", "radiosity/shadow_ray"


def is_blocked(light, staged, starts, ends, jitter):
    """(n,) bool of the shader, positions relative to the main camera."""
    device, interface = light.device, light.shader_interface
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(light.std140.typedefs([interface.VIEWS]))
    info.uniform_buf(0, "Views", "views")
    for name, value in interface.DEFINES.items():
        info.define(name, str(value))
    info.define("SHADOW_STEPS", str(light.radiosity.SHADOW_STEPS))
    info.sampler(0, "FLOAT_2D", "segments")
    info.sampler(1, "FLOAT_2D", "depths")
    info.image(0, "RGBA32F", "FLOAT_2D", "found", qualifiers={"WRITE"})
    info.local_group_size(64, 1, 1)
    files = [(device.SHADERS / f"{file}.glsl").read_text() for file in SHADOW_RAY_FILES]
    info.compute_source("\n".join([*files, SHADOW_RAYS]))
    shader = gpu.shader.create_from_info(info)
    segments = np.zeros((2, len(starts), 4), np.float32)
    segments[0, :, :3], segments[1, :, :3], segments[0, :, 3] = starts, ends, jitter
    source, found = device.texture(len(starts), 2, data=segments), device.texture(len(starts), 1)
    block = gpu.types.GPUUniformBuf(staged.table.tobytes())
    shader.bind()
    shader.uniform_block("views", block)
    shader.uniform_sampler("segments", source.handle)
    shader.uniform_sampler("depths", staged.depths.handle)
    shader.image("found", found.handle)
    gpu.compute.dispatch(shader, -(-len(starts) // 64), 1, 1)
    gpu.shader.unbind()
    return np.array(found.read())[0, :, 0] > 0


def surfaces(views, per_view=60, seed=2):
    """(places, normals) of random pixels of all views, relative to the main camera."""
    rng, places, normals = np.random.default_rng(seed), [], []
    for view in views:
        width, height = view.load_passes().size
        depth = view.load_passes().depth[::-1].astype(float)
        row, column = rng.integers(0, height, per_view), rng.integers(0, width, per_view)
        place = reference.view_position(view.camera, np.stack([column, row], -1) + 0.5, depth[row, column])
        place = place @ view.camera.rotation + view.camera.position - views[0].camera.position
        surface = depth[row, column] < reference.FARTHEST
        places.append(place[surface])
        normals.append(np.stack(view.load_passes().normal, -1)[::-1][row, column][surface])
    return np.concatenate(places), np.concatenate(normals)


def test_blocked_segments_agree_with_float64(light, frame):
    """4,000 segments between surfaces, of which many are blocked: the same answers, but for rounding."""
    staged = stages(light, frame, radiosity(light))
    places, _ = surfaces(frame)
    rng = np.random.default_rng(1)
    start, end = (places[rng.integers(0, len(places), 4000)] for _ in range(2))
    jitter = rng.random(4000).astype(np.float32)
    expected = views_64.is_blocked(staged.cameras, start, end, jitter.astype(float), light.radiosity.SHADOW_STEPS)
    assert 0.1 < expected.mean() < 0.98
    assert np.mean(is_blocked(light, staged, start, end, jitter) != expected) < 0.005


def hall(light, eyes, wall, size=(64, 64)):
    """A hall, 4 x 4 x 4 m, with a wall across it that leaves 1.5 m below the ceiling, as cameras see it that stand at
    `eyes` and look along x."""
    return [
        rooms.view_of(
            light,
            rooms.camera_at(light, eye, towards, size),
            size,
            room=((-2, -2, -2), (2, 2, 2)),
            solids=wall_of(wall),
        )
        for eye, towards in eyes
    ]


def wall_of(thickness):
    return [((-thickness / 2, -2, -2), (thickness / 2, 2, 0.5))]


LEFT, RIGHT = ((-1.8, 0.1, -0.2), (1, 0, 0)), ((1.8, -0.1, -0.3), (-1, 0, 0))
AWAY = ((-1.8, 0.1, -0.2), (-1, 0, 0))


@pytest.mark.parametrize(
    "eyes, wall, blocked",
    [
        ([LEFT], 0.2, 1),
        ([LEFT], 0.01, 1),
        ([RIGHT], 0.01, 1),
        ([LEFT, RIGHT], 0.2, 1),
        ([LEFT, RIGHT], 0.05, 1),
        ([LEFT, RIGHT], 0.02, 1),
        ([LEFT, RIGHT], 0.01, 1),
        ([LEFT, AWAY], 0.01, 1),
        ([AWAY], 0.2, 0),
    ],
)  # no view shows the wall: it blocks nothing
def test_a_wall_between_two_places(light, eyes, wall, blocked):
    """Segments through the wall, from behind it and from in front of it, and segments above it, which are free."""
    views = hall(light, eyes, wall)
    staged = stages(light, views, radiosity(light))
    rng = np.random.default_rng(0)
    left, right = (
        rng.uniform((-1.2, -1, -1), (-0.6, 1, 0.3), (200, 3)) * (side, 1, 1) - views[0].camera.position
        for side in (1, -1)
    )
    jitter = rng.random(200)
    for start, end in ((left, right), (right, left)):
        assert is_blocked(light, staged, start, end, jitter).mean() == blocked
    above = np.array([0, 0, 1.95 - 0.3])
    over = is_blocked(light, staged, left * (1, 1, 0) + above, right * (1, 1, 0) + above, jitter)
    assert not over.any()


@pytest.mark.parametrize("steps, blocked", [(0.2, 0), (1.5, 1), (3, 1)])
def test_the_ends_of_a_segment_do_not_count(light, steps, blocked):
    """A hundredth at each, which is a quarter of a step: a segment that ends, or starts, less than that behind a wall
    is free; one with a point there that counts, and another in front of the wall, is blocked."""
    views = rooms.box_views(light, towards=rooms.AXES[:1])  # looks at the wall x = 1 from 0.9 m
    staged = stages(light, views, radiosity(light))
    assert light.radiosity.SHADOW_STEPS == 24
    jitter = np.concatenate([np.arange(0.005, 1, 0.01)] * 5)
    sides = np.repeat(np.linspace(-0.3, 0.3, 5), 100)
    behind, before = (
        np.stack([np.full(500, x), sides, 0.5 * sides], -1)
        for x in (0.9 + steps * 0.6 / light.radiosity.SHADOW_STEPS, 0.3 + steps * 0.6 / light.radiosity.SHADOW_STEPS)
    )
    for start, end in ((behind, before), (before, behind)):
        assert is_blocked(light, staged, start, end, jitter).mean() == blocked


def segments_between(views, count=16_000, per_view=300):
    """(starts, ends) of random segments between surfaces that face each other, relative to the main camera."""
    places, normals = surfaces(views, per_view)
    start, end = np.random.default_rng(4).integers(0, len(places), (2, count))
    path = places[end] - places[start]
    facing = ((path * normals[start]).sum(-1) > 1e-3) & ((path * normals[end]).sum(-1) < -1e-3)
    assert facing.mean() > 0.4
    return places[start[facing]], places[end[facing]]


def test_in_a_closed_box_all_segments_are_free(light):
    """All views see it from inside: nothing hides anything, on edges and in corners either."""
    views = rooms.box_views(light)
    start, end = segments_between(views)
    assert not is_blocked(
        light, stages(light, views, radiosity(light)), start, end, np.random.default_rng(5).random(len(start))
    ).any()


OVER = [
    ((-1, 0.3, 1.5), (1, 0.1, -0.5)),
    ((1.2, -0.3, 1.6), (-1, 0.1, -0.6)),
    ((-0.4, 0.1, 0), (-1, 0.1, 0.2)),
    ((0.4, 0.1, 0), (1, -0.1, -0.1)),
    ((-0.3, 0.2, 1.2), (0.3, 1, 0.3)),
    ((0.3, 0.1, 1.1), (-0.3, -1, 0.3)),
]
AROUND = [
    ((0.1, -0.9, 0.17), (0, 1, -0.1)),
    ((-0.8, 0.7, 0.6), (1, -0.8, -0.7)),
    ((0.8, 0.8, 0.5), (-1, -1, -0.6)),
    ((-0.8, -0.8, -0.6), (1, 0.7, 0.3)),
    ((0.85, -0.7, -0.7), (-0.6, 1, 0.4)),
    ((0, 0.05, 0.9), (0.05, 0.05, -1)),
]


def furnished(light, size=(96, 72)):
    """The room of room_views(), as six cameras around it see it."""
    return [
        rooms.view_of(light, rooms.camera_at(light, eye, towards, size), size, solids=SOLIDS) for eye, towards in AROUND
    ], SOLIDS


def halved(light, wall):
    """hall() as eight cameras see it, two of them above the wall, and the solid that its wall is."""
    return hall(light, [LEFT, RIGHT, *OVER], wall), wall_of(wall)


def colonnade(light, size=(128, 72)):
    """A hall with two rows of pillars, seen along them."""
    cameras = [rooms.camera_at(light, *eye, size, fov=np.radians(100)) for eye in rooms.ALONG]
    return [
        rooms.view_of(light, camera, size, room=rooms.HALL, solids=rooms.PILLARS) for camera in cameras
    ], rooms.PILLARS


@pytest.mark.parametrize(
    "made, most_blocked, most_free",
    [
        pytest.param(furnished, 0.02, 0.045, id="solids"),
        pytest.param(lambda light: halved(light, 0.2), 0.005, 0.05, id="wall of 20 cm"),
        pytest.param(colonnade, 0.036, 0.09, id="pillars"),
        pytest.param(lambda light: halved(light, 0.05), 0.006, 0.035, id="5 cm"),
        pytest.param(lambda light: halved(light, 0.01), 0.02, 0.08, id="1 cm"),
    ],
)
def test_segments_against_exact_rays(light, made, most_blocked, most_free):
    """Of the free segments between visible surfaces, next to none is taken for blocked. Of the blocked ones, few are
    taken for free: they graze an edge, are blocked within a step of their end, or no view shows where they enter."""
    views, solids = made(light)
    staged = stages(light, views, radiosity(light))
    start, end = segments_between(views)
    origin = views[0].camera.position
    true, jitter = rooms.is_hidden(start + origin, end + origin, solids), np.random.default_rng(5).random(len(start))
    measured = is_blocked(light, staged, start, end, jitter)
    assert true.mean() > 0.1
    assert measured[~true].mean() < most_blocked
    assert 1 - measured[true].mean() < most_free


# The estimator.


def base_receivers(light, views, chosen):
    """(Pyramid, places, normals, surface) of the main view's base, as its surfels hold them, in world space."""
    camera, passes = views[0].camera, views[0].load_passes()
    base = light.pack(light.upload(passes), passes, camera, chosen)
    level = reference.unpack_surfel(fixtures.bits_of(base.surfels), camera, chosen.start)
    place, normal = (
        image.reshape(-1, 3) @ camera.rotation for image in (level.position, reference.direction(level.vector_area))
    )
    return base, level, place, normal


def sampled(light, staged, base, chosen):
    """(n, 3): the irradiance of the base's texels, before smoothing."""
    target = light.device.texture(*base.size)
    light.radiosity.sample_emitters(
        "sample_base",
        chosen,
        staged.records,
        sent_by(light, staged),
        target,
        {"surfels": base.surfels},
        frame=base.frame,
    )
    return np.array(target.read(), np.float64).reshape(-1, 4)[:, :3]


WORLD = np.array([(0.3, 0.4, 0.6), (0.1, -0.1, 0.0), (0.0, 0.05, 0.1), (0.2, 0.25, 0.4)])  # brighter from above


@pytest.mark.parametrize(
    "name, groups, candidates, visibility, world",
    [
        ("random", 1, 1, False, 0),
        ("random", 1, 16, False, 0),
        ("random", 7, 3, False, 0),
        ("room", 1, 1, False, 0),
        ("room", 16, 16, False, 0),
        ("room", 4, 8, True, 0),
        ("room", 4, 8, False, 1),
        ("room", 4, 8, True, 1),
    ],
)
def test_samples_are_unbiased(light, monkeypatch, name, groups, candidates, visibility, world):
    """The mean over 500 seeds lies within 3 standard errors of the sum over all pairs for the frame as a whole, and
    for its ninths within 4.5 (of these 27 numbers, two may lie beyond 3)."""
    monkeypatch.setattr(light.radiosity, "ENTRIES", 1 << 12)  # whatever the table's size
    monkeypatch.setattr(light.view_layout, "EMITTER", 2)  # nor does theirs matter, but for the seconds of the sum
    views = FRAMES[name](light, (24, 18))
    chosen = radiosity(light, groups=groups, candidates=candidates, visibility=visibility)
    staged = stages(light, views, chosen)
    staged.table["world"][:, :3] = world * WORLD
    base, level, place, normal = base_receivers(light, views, chosen)
    surface = level.area.ravel() > 0
    emitters = rows(staged.emitters, light.view_layout.count_of(staged.table, "emitters"), 4)
    sent = rows(sent_by(light, staged), len(emitters))[:, 0]
    free = (
        views_64.share_free(staged.cameras, place, normal, emitters, light.radiosity.SHADOW_STEPS)
        if visibility
        else 1.0
    )
    expected = views_64.all_pairs(place, normal, emitters, sent, free, world * WORLD) * surface[:, None]
    if visibility and not world:
        assert expected.mean() < 0.95 * views_64.all_pairs(place, normal, emitters, sent).mean()
    runs = np.array(
        [
            sampled(
                light,
                staged,
                base,
                radiosity(light, groups=groups, candidates=candidates, visibility=visibility, seed=seed),
            )
            for seed in range(500)
        ]
    )

    def ninths(image):
        return image.reshape(*image.shape[:-2], 3, 3, 3, 4, 3).mean((-4, -2))

    for reduce, most, furthest in ((lambda image: image.mean(-2), 0, 3), (ninths, 2, 4.5)):
        values, true = reduce(runs), reduce(expected)
        # 1e-5: what float32 may differ by
        error = values.std(0, ddof=1) / np.sqrt(len(values)) + 1e-5 * np.abs(true).max()
        deviation = np.abs(values.mean(0) - true) / error
        assert (deviation > 3).sum() <= most and deviation.max() < furthest, np.sort(deviation.ravel())[-3:]


def test_what_blocks_receive_is_unbiased(light, monkeypatch):
    """Each view's receivers, whose light is passed on: the mean over 1,000 seeds against the sum over all pairs. Of
    the 27 x 3 numbers two may lie beyond 3 standard errors, none beyond 4.5; all these errors are under 1 % of the
    mean."""
    monkeypatch.setattr(light.radiosity, "ENTRIES", 1 << 12)
    staged = stages(light, room_views(light, (24, 18)), radiosity(light, visibility=False))
    count = light.view_layout.count_of(staged.table, "receivers")
    receivers = rows(staged.receivers, count, 4)
    emitters = rows(staged.emitters, light.view_layout.count_of(staged.table, "emitters"), 4)
    sent = sent_by(light, staged)
    normals = reference.direction(receivers[:, 1, :3])
    expected = views_64.all_pairs(receivers[:, 0, :3], normals, emitters, rows(sent, len(emitters))[:, 0])
    runs = []
    for seed in range(1000):
        target = light.device.texture(
            light.shader_interface.RECORDS_WIDTH, light.view_layout.rows_of(staged.table, "receivers")
        )
        chosen = radiosity(
            light,
            visibility=False,
            seed=seed,
            groups=light.radiosity.BOUNCE_GROUPS,
            candidates=light.radiosity.BOUNCE_CANDIDATES,
        )
        light.radiosity.sample_emitters(
            "sample_blocks", chosen, staged.records, sent, target, {"receivers": staged.receivers}
        )
        runs.append(rows(target, count)[:, 0, :3])
    error = np.std(runs, 0, ddof=1) / np.sqrt(len(runs)) + 1e-5 * expected.max()
    deviation = np.abs(np.mean(runs, 0) - expected) / error
    assert error.max() < 0.01 * expected.mean()
    assert (deviation > 3).sum() <= 2 and deviation.max() < 4.5


@pytest.mark.parametrize("name, world", [("random", 0), ("room", 0), ("room", 1)])
def test_smoothing_agrees_with_float64(light, name, world):
    views = FRAMES[name](light)
    chosen = radiosity(light, start=1, groups=2, candidates=2)
    base, level, _, normal = base_receivers(light, views, chosen)
    table = light.view_layout.view_table(views, views[0].load_passes().size, chosen)
    table["world"][:, :3] = world * WORLD
    noise = np.random.default_rng(6).random((*level.area.shape, 4)).astype(np.float32) - np.float32(4 * world)
    spots = noise.copy()
    spots[8::16, 8::16, :3] = 300.0
    for given in (noise, spots):
        total = light.radiosity.smooth(base, light.device.texture(*noise.shape[1::-1], data=given), table, chosen)
        measured = np.array(total.read())[..., :3]
        lit = views_64.world_light(WORLD, normal).reshape(*level.area.shape, 3) if world else None
        expected = views_64.smooth(level, given[..., :3].astype(float), lit)
        assert np.abs(measured - expected)[level.area > 0].max() < 1e-3 * max(1, np.abs(expected).max())


def test_a_spot_is_not_spread(light):
    """One texel of a hundred times the light of all others is taken for a firefly; two are a light."""
    views = FRAMES["room"](light)
    chosen = radiosity(light, start=1)
    base, level, _, _ = base_receivers(light, views, chosen)
    table = light.view_layout.view_table(views, views[0].load_passes().size, chosen)
    middle = level.area.shape[0] // 2, level.area.shape[1] // 2
    greatest = {}
    for wide in (1, 2):
        given = np.ones((*level.area.shape, 4), np.float32)
        given[middle[0] : middle[0] + wide, middle[1] : middle[1] + wide] = 100
        found = light.device.read(
            light.radiosity.smooth(base, light.device.texture(*given.shape[1::-1], data=given), table, chosen)
        )
        greatest[wide] = found[..., :3].max()
    assert 1 < greatest[1] < 2 and greatest[2] > 10, greatest


def test_one_view_without_visibility_is_the_papers_sum(light):
    """Energy of the picture within 2 % of the sum over all pairs of pixels (tests/reference.py)."""
    passes, camera = fixtures.box_frame(light, 48, 36)
    guide, base = reference.pack(passes, camera, 1)
    sums = reference.all_pairs(base)
    sums[..., 3] = 0  # without the bound of a hemisphere
    true = reference.composite(passes, guide, base, sums, camera, 1, 1.0)
    pictures = [
        light.gather_views([light.View(passes, camera)], radiosity(light, start=1, visibility=False, seed=seed))
        for seed in range(4)
    ]
    assert np.mean(pictures) == pytest.approx(true.mean(), rel=0.02)


# The furnace: in a closed box of albedo rho that sends 1 everywhere, n bounces add rho + ... + rho^n everywhere.


def series(albedo, bounces):
    return albedo * (1 - albedo**bounces) / (1 - albedo)


@pytest.mark.parametrize(
    "size, albedo, bounces, within", [(64, 0.5, 1, 0.01), (64, 0.5, 8, 0.015), (64, 0.9, 60, 0.05)]
)
def test_furnace(light, size, albedo, bounces, within):
    """All light, direct and bounced: 1 + rho after one bounce, twice as much as sent at albedo 0.5, ten times at
    0.9."""
    views = rooms.box_views(light, (size, size), albedo=albedo)
    bounced = np.mean(
        [
            light.gather_views(views, radiosity(light, start=4, bounces=bounces, seed=100 * seed)).mean()
            for seed in range(4)
        ]
    )
    assert 1 + bounced == pytest.approx(1 + series(albedo, bounces), rel=within)
    if bounces > 1:
        assert 1 + bounced == pytest.approx(1 / (1 - albedo), rel=within)


def in_the_world(place, normal):
    """Direct light of EEVEE's world on albedo 0.5."""
    return 0.5 * views_64.world_light(WORLD, normal)


def test_a_closed_room_keeps_nothing_of_the_world(light):
    """EEVEE's world shines through its walls; what the walls send while they are lit by it goes as well."""
    views = rooms.box_views(light, radiance=in_the_world)
    picture = light.gather_views(views, radiosity(light, groups=128, bounces=8), WORLD)
    direct = np.stack(views[0].load_passes().diffuse_direct, -1)[::-1] * 0.5
    assert direct.min() > 0.02 and np.all(picture >= -1.001 * direct)
    assert picture.mean((0, 1)) == pytest.approx(-direct.mean((0, 1)), rel=0.03)
    assert np.abs(picture + direct).mean() < 0.05 * direct.mean()


def test_the_world_lights_what_nothing_covers(light):
    """A wall alone keeps all of it, and so does a room whose surfaces hide nothing of each other by choice."""
    views = rooms.box_views(light, radiance=in_the_world)
    alone = light.gather_views(views[:1], radiosity(light, bounces=2), WORLD)
    assert np.abs(alone).max() < 1e-6
    chosen = radiosity(light, bounces=2, visibility=False)
    assert np.array_equal(light.gather_views(views, chosen, WORLD), light.gather_views(views, chosen))


def test_furnace_everywhere(light):
    """Not in the mean alone: nine in ten pixels are within 12 % of what one bounce adds."""
    picture = light.gather_views(rooms.box_views(light), radiosity(light, groups=64))
    assert np.quantile(np.abs(picture / 0.5 - 1), 0.9) < 0.12


def test_the_same_camera_twice_changes_nothing(light):
    """By less than 1 %, for the mean of 4 seeds."""
    views = rooms.box_views(light, radiance=rooms.lamp, albedo=0.6)
    once, twice = (
        np.mean([light.gather_views(seen, radiosity(light, bounces=2, seed=seed)).mean((0, 1)) for seed in range(4)], 0)
        for seed in [0]
        for seen in (views, views + views[:3])
    )
    assert twice == pytest.approx(once, rel=0.01)


def test_views_that_turn_by_a_pixel_change_little(light):
    """In a hall with pillars a few texels wide, where visibility is hardest to judge: all further views turn at once,
    and blocks of 8 x 8 pixels change by little more than another seed changes them, 0.033."""
    size = 320, 180

    def pixel_on(camera):
        sine, cosine = np.sin(camera.scale[0]), np.cos(camera.scale[0])
        turn = np.array([(cosine, 0, sine), (0, 1, 0), (-sine, 0, cosine)])
        return replace(camera, rotation=turn @ camera.rotation)

    def lamps(place, normal):
        path = np.array([(0, -4, 0.7), (0, 0, 0.7), (0, 4, 0.7)])[:, None, None] - place
        square = (path**2).sum(-1, keepdims=True)
        return (np.maximum((normal * path).sum(-1, keepdims=True), 0) / square**1.5).sum(0) * (0.6 + 0.4 * normal)

    def blocks(turned):
        cameras = [rooms.camera_at(light, *eye, size, fov=np.radians(100)) for eye in rooms.ALONG]
        cameras[1:] = [pixel_on(camera) if turned else camera for camera in cameras[1:]]
        views = [
            rooms.view_of(light, camera, size, room=rooms.HALL, solids=rooms.PILLARS, radiance=lamps)
            for camera in cameras
        ]
        return light.gather_views(views, radiosity(light, bounces=4))[:176].reshape(22, 8, 40, 8, 3).mean((1, 3))

    before, after = blocks(False), blocks(True)
    assert after.mean() == pytest.approx(before.mean(), rel=0.04)
    assert np.abs(after - before).mean() < 0.06 * before.mean()


def test_an_orthographic_main_view(light):
    """Its wall in the furnace, lit by what perspective views see, and as a further view it changes nothing."""
    views = rooms.box_views(light)
    flat = rooms.view_of(light, rooms.camera_at(light, (0.2, 0.1, 0), (0, 1, 0), (64, 64), across=1.2), (64, 64))
    picture = light.gather_views([flat, *views], radiosity(light, groups=32))
    assert picture.mean() == pytest.approx(0.5, rel=0.02)
    mean, with_it = (
        np.mean([light.gather_views(seen, radiosity(light, seed=seed)).mean() for seed in range(4)])
        for seen in (views, [*views, flat])
    )
    assert with_it == pytest.approx(mean, rel=0.01)


# What must hold whatever comes in.


def coloured(light, size=(40, 27), count=3):
    return rooms.box_views(light, size, towards=rooms.AXES[:count], albedo=0.6, radiance=rooms.lamp)


def moved(light, views, by=0.0, scale=1.0):
    """The same scene elsewhere and of another size."""
    made = []
    for view in views:
        passes = light.Passes(
            view.load_passes().depth * np.float32(scale),
            view.load_passes().normal,
            view.load_passes().diffuse_color,
            view.load_passes().diffuse_direct,
            view.load_passes().emission,
        )
        camera = view.camera
        across = scale if camera.orthographic else 1
        made.append(
            light.View(
                passes,
                light.Camera(
                    camera.rotation,
                    camera.scale * across,
                    camera.offset * across,
                    camera.orthographic,
                    camera.position * scale + by,
                ),
            )
        )
    return made


def test_scenes_anywhere_and_of_any_scale_look_alike(light):
    """100 km from the origin; a box of 2 mm, and one of 2,000 km: the same picture to float32."""
    flat = rooms.camera_at(light, (0.25, 0, 0), (1, 0.1, 0), (40, 27), across=1.5)
    views = [*coloured(light), rooms.view_of(light, flat, (40, 27), albedo=0.6, radiance=rooms.lamp)]
    chosen = radiosity(light, bounces=2)
    picture = light.gather_views(views, chosen)
    for other in (
        moved(light, views, by=2.0**17),
        moved(light, views, scale=2.0**-10),
        moved(light, views, scale=2.0**20),
    ):
        different = np.abs(light.gather_views(other, chosen) - picture) > 1e-4 * picture.max()
        assert different.mean() < 0.01  # a place within rounding of a texel's edge can change which surface hides it


def test_the_same_seed_is_the_same_picture(light):
    views = coloured(light)
    pictures = [
        light.gather_views(views, radiosity(light, bounces=3, seed=seed)) for seed in (7, 7, 8, 7 + (1 << 32), -1)
    ]
    assert np.array_equal(pictures[0], pictures[1]) and np.array_equal(pictures[0], pictures[3])
    assert np.mean(np.any(pictures[0] != pictures[2], -1)) > 0.9 and np.isfinite(pictures[4]).all()


def test_strength_scales_and_nothing_else(light):
    one, half = (light.gather_views(coloured(light), radiosity(light, strength=strength)) for strength in (1.0, 0.5))
    assert np.array_equal(half, one * np.float32(0.5)) and one.any()


@pytest.mark.parametrize("size", [(1, 1), (3, 7), (65, 33), (1300, 5), (5, 300)])
def test_frames_of_any_shape(light, size):
    for start in (1, 4):
        picture = light.gather_views(
            coloured(light, size), radiosity(light, start=start, bounces=2, groups=2, candidates=4)
        )
        assert picture.shape == (*size[::-1], 3) and picture.dtype == np.float32
        assert np.isfinite(picture).all() and picture.any()


def test_as_many_views_as_there_can_be(light):
    """Ten: the same light as six that see all."""
    views = rooms.box_views(light)
    assert light.MAX_VIEWS == 10
    ten = views + rooms.box_views(light, eye=(-0.4, 0.2, 0.3), towards=rooms.AXES[:4])
    few, many = (light.gather_views(seen, radiosity(light, groups=32)).mean() for seen in (views, ten))
    assert many == pytest.approx(few, rel=0.015)


def test_the_most_groups_lose_no_light(light):
    """Mesa's software driver ends a shader's loops after 65,535 rounds in all, and the rest of the light is missing."""
    views = rooms.box_views(light) + rooms.box_views(light, eye=(-0.4, 0.2, 0.3), towards=rooms.AXES[:4])
    few, most = (light.gather_views(views, radiosity(light, groups=groups)).mean() for groups in (16, light.MAX_GROUPS))
    assert most == pytest.approx(few, rel=0.015)
    with pytest.raises(ValueError, match="at most"):
        radiosity(light, groups=light.MAX_GROUPS + 1)


def test_views_of_nothing(light):
    """A further view that shows no surface changes nothing; a main view that shows none gets nothing."""
    views = coloured(light)
    sky = moved(light, views[:1])[0]
    sky.load_passes().depth[:] = fixtures.BACKGROUND
    assert np.array_equal(
        light.gather_views([*views, sky], radiosity(light, bounces=2)),
        light.gather_views(views, radiosity(light, bounces=2)),
    )
    assert not light.gather_views([sky, *views], radiosity(light, bounces=2)).any()
    assert not light.gather_views([sky], radiosity(light, bounces=2)).any()


def test_a_black_scene_is_black(light):
    assert not light.gather_views(rooms.box_views(light, (20, 15), radiance=0.0), radiosity(light, bounces=3)).any()


def test_lamps_of_negative_power_take_light_away(light):
    """One channel negative, or all: the negative picture, and channels that cancel out are not taken for darkness."""

    def sent(signs):
        views = rooms.box_views(light, (48, 48), radiance=lambda place, normal: np.ones(place.shape) * signs)
        return light.gather_views(views, radiosity(light, bounces=2)).mean((0, 1))

    plain = sent((1, 1, 1))
    assert sent((-1, -1, -1)) == pytest.approx(-plain, rel=1e-5)
    assert sent((1, 1, -1)) == pytest.approx(plain * (1, 1, -1), rel=0.01)
    assert sent((1, 1, -2)) == pytest.approx(plain * (1, 1, -2), rel=0.05)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_broken_pixels_do_not_spread(light, value):
    """A broken pixel in each pass of the main view and of another: all others get what they get without it, to
    noise."""
    names = ["depth", "normal", "diffuse_color", "diffuse_direct", "emission"]
    broken, absent = coloured(light), coloured(light)
    for number, name in enumerate(names):
        for view in (0, 1):
            broken[view].load_passes().channels()[name][0][3 + 4 * number, 5 + 6 * number] = value
            absent[view].load_passes().depth[3 + 4 * number, 5 + 6 * number] = fixtures.BACKGROUND
    counted = {}
    picture = light.gather_views(broken, radiosity(light, bounces=2), broken=counted)
    expected = light.gather_views(absent, radiosity(light, bounces=2))
    assert counted == dict.fromkeys(names, 1)
    assert np.isfinite(picture).all()
    assert picture.mean() == pytest.approx(expected.mean(), rel=0.01)
    assert np.quantile(np.abs(picture - expected), 0.95) < 0.2 * expected.max()


@pytest.mark.parametrize("name", ["diffuse_color", "diffuse_direct", "emission"])
def test_one_huge_pixel_does_not_black_out_the_picture(light, name):
    """Finite values whose bounces overflow: what is shown stays finite, and is not lost."""
    views = coloured(light)
    views[1].load_passes().channels()[name][0][10, 10] = 1e30
    picture = light.gather_views(views, radiosity(light, bounces=3))
    assert np.isfinite(picture).all() and (picture[..., 1] != 0).mean() > 0.9


def test_surfaces_without_normals_send_light(light):
    """Materials of pure emission write the normal (0, 0, 0): such a surface lights the others as it would with one."""

    def lit(has_normals):
        views = rooms.box_views(
            light,
            albedo=lambda place, normal: np.where(normal[..., 2:] == -1, 0.0, 0.6) * np.ones(3),
            radiance=lambda place, normal: (normal[..., 2:] == -1) * np.ones(3),
        )
        if not has_normals:
            for view in views:
                bare = view.load_passes().normal[2] == -1
                for channel in view.load_passes().normal:
                    channel[bare] = 0
        return light.gather_views(views, radiosity(light)).mean()

    assert lit(True) > 0.05
    assert lit(False) == pytest.approx(lit(True), rel=0.05)


def test_progress_and_cancel(light, monkeypatch):
    """Stages come in order with a share that never falls; a true answer cancels at once."""
    monkeypatch.setattr(light.device, "band", lambda _: 40 * 16 * 16 * 8)
    views, calls = coloured(light), []
    chosen = radiosity(light, start=1, bounces=3)
    banded = light.gather_views(views, chosen, progress=lambda *call: bool(calls.append(call)))
    assert [stage for k, (stage, _) in enumerate(calls) if k == 0 or calls[k - 1][0] != stage] == [
        "views",
        "bounces",
        "gather",
        "upsample",
    ]
    for stage in ("views", "bounces", "gather", "upsample"):
        shares = [share for named, share in calls if named == stage]
        assert shares == sorted(shares) and 0 <= shares[0] and shares[-1] <= 1
    monkeypatch.undo()
    assert np.array_equal(banded, light.gather_views(views, chosen))
    monkeypatch.setattr(light.device, "band", lambda _: 40 * 16 * 16 * 8)
    for stop_at in range(len(calls)):
        count = iter(range(stop_at + 1))
        with pytest.raises(light.Cancelled):
            light.gather_views(views, chosen, progress=lambda *_: next(count) == stop_at)


def test_timings_name_every_stage(light):
    timings = {}
    light.gather_views(coloured(light), radiosity(light, bounces=2), timings=timings)
    assert list(timings) == ["views", "bounces", "gather", "upsample", "read_back"]
    assert all(seconds >= 0 for seconds in timings.values())


@pytest.mark.parametrize("changes", [dict(start=3), dict(groups=0), dict(candidates=0), dict(bounces=0)])
def test_settings_out_of_range_are_refused(light, changes):
    with pytest.raises(ValueError):
        radiosity(light, **changes)
