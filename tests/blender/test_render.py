# SPDX-License-Identifier: GPL-3.0-or-later
"""F12 and -a, end to end from the installed zip: what they render, and that disabling leaves everything as before."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from scenes import (
    SIZE,
    TREES,
    box,
    differences,
    layered_tree,
    put,
    read,
    read_rgb,
    render,
    set_format,
    simple_tree,
    written_down,
)

RED, GREEN = 0, 1


@pytest.fixture
def scene(fresh):
    return box(fresh)


@pytest.fixture
def unchanged():
    """Call it before and after: the file must hold the same data, except for the path of the last image and what
    Blender itself keeps of a render (the images Render Result and Viewer Node)."""
    states = []

    def check():
        state = written_down()
        del state["images"]
        states.append(state)
        if len(states) == 2:
            assert not differences(*states)

    return check


@pytest.fixture
def seen(afterlight, monkeypatch):
    """What the engine passed to the gather, one entry for each view layer and frame: (passes, camera, Position
    pass)."""
    import OpenEXR

    engine, found, positions = afterlight.addon.render.engine, [], []
    load, gather = engine.passes.load, engine.gather.gather_indirect

    def spy_load(path, layer, window, step=1):
        loaded = load(path, layer, window, step)
        channels = {
            name: channel.pixels
            for part in OpenEXR.File(path, separate_channels=True).parts
            for name, channel in part.channels.items()
        }
        position = np.stack([channels[f"{layer}.Position.{axis}"] for axis in "XYZ"], axis=-1)
        x, y, width, height = window
        if position.shape[:2] != (height, width):
            top = position.shape[0] - y - height
            position = position[top : top + height, x : x + width]
        positions.append(position)
        return loaded

    def spy_gather(passes, camera, settings, **options):
        found.append((passes, camera, positions[-1]))
        return gather(passes, camera, settings, **options)

    monkeypatch.setattr(engine.passes, "load", spy_load)
    monkeypatch.setattr(engine.gather, "gather_indirect", spy_gather)
    return found


def lit_and_plain(scene, folder):
    """Images with and without our light, (H, W, 3), top row first."""
    plain = read_rgb(render(scene, folder / "plain.exr"))
    scene.afterlight.enabled = True
    lit = read_rgb(render(scene, folder / "lit.exr"))
    assert scene.afterlight.report == ""
    scene.afterlight.enabled = False
    return lit, plain


@pytest.mark.parametrize("kind", TREES)
def test_every_kind_of_compositor_gets_the_light(scene, tmp_path, unchanged, kind):
    TREES[kind](scene)
    if kind == "layered":  # the layer on top shows only its own thing
        front = bpy.data.collections.new("Front")
        scene.collection.children.link(front)
        front.objects.link(bpy.data.objects.new("Ball", bpy.data.meshes.new("Ball")))
    set_format(scene)  # as lit_and_plain() does, so that `unchanged` sees no change of the test's own
    unchanged()
    lit, plain = lit_and_plain(scene, tmp_path)
    gain = lit - plain
    assert gain.min() > -1e-5 and gain.mean() > 0.05 * plain.mean()
    red_side, far_side = gain[:, :20].mean(axis=(0, 1)), gain[:, -20:].mean(axis=(0, 1))
    assert red_side[RED] / red_side[GREEN] > far_side[RED] / far_side[GREEN], "the red wall colours what is near it"
    unchanged()


def test_the_indirect_light_is_a_pass_and_the_picture_is_the_sum(scene, tmp_path):
    tree = simple_tree(scene)
    lit, plain = lit_and_plain(scene, tmp_path)
    scene.afterlight.enabled = True
    light = next(node for node in tree.nodes if node.get("afterlight") == "light")
    output = next(node for node in tree.nodes if node.bl_idname == "NodeGroupOutput")
    tree.links.new(light.outputs["Indirect"], output.inputs[0])
    indirect = read_rgb(render(scene, tmp_path / "indirect.exr"))
    np.testing.assert_allclose(plain + indirect, lit, atol=2e-5)


def test_both_of_blenders_compositors_add_it(scene, tmp_path):
    """The GPU compositor is Blender's default. No other test uses it: see scenes.box()."""
    scene.afterlight.enabled = True
    on_cpu = read_rgb(render(scene, tmp_path / "cpu.exr"))
    scene.render.compositor_device = "GPU"
    on_gpu = read_rgb(render(scene, tmp_path / "gpu.exr"))
    assert scene.afterlight.report == ""
    np.testing.assert_allclose(on_gpu, on_cpu, atol=2e-3)  # the GPU compositor works in half precision by default


def test_strength_scales_and_seed_decides(scene, tmp_path):
    settings = scene.afterlight
    settings.samples, settings.radius = 16, 8

    def picture(**values):
        for name, value in values.items():
            setattr(settings, name, value)
        return read_rgb(render(scene, tmp_path / "picture.exr"))

    plain = picture()
    settings.enabled = True
    one = picture(seed=3)
    np.testing.assert_array_equal(picture(seed=3), one, "same seed, same picture")
    assert np.abs(picture(seed=4) - one).max() > 1e-4
    np.testing.assert_allclose(picture(seed=3, strength=2.5) - plain, 2.5 * (one - plain), atol=1e-4)
    np.testing.assert_array_equal(picture(strength=0.0), plain)
    scene.view_settings.exposure = 3  # EEVEE itself samples otherwise then, so it is rendered again
    bright = picture(strength=1.0)
    settings.enabled = False
    gain = (bright - picture()).mean() / (one - plain).mean()
    assert abs(gain - 1) < 0.03, "exposure is none of the light's business"


def test_animation_with_keyframes(scene, tmp_path, unchanged):
    lamp, settings = bpy.data.objects["Lamp"], scene.afterlight
    for frame, x, strength in ((1, -1, 1.0), (3, 1, 0.0)):
        lamp.location.x, settings.strength = x, strength
        lamp.keyframe_insert("location", frame=frame)
        settings.keyframe_insert("strength", frame=frame)
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = str(tmp_path / "plain_")
    scene.render.image_settings.file_format = "OPEN_EXR"
    bpy.ops.render.render(animation=True)
    scene.frame_set(1)
    unchanged()
    settings.enabled = True
    scene.render.filepath = str(tmp_path / "lit_")
    bpy.ops.render.render(animation=True)
    gains = [
        read_rgb(tmp_path / f"lit_{frame:04d}.exr") - read_rgb(tmp_path / f"plain_{frame:04d}.exr")
        for frame in (1, 2, 3)
    ]
    assert np.abs(gains[2]).max() < 1e-3, "strength is 0 in the last frame"
    # Half the strength, and with the lamp in the middle about the same light: between a fifth and nine tenths.
    assert 0.2 < gains[1].mean() / gains[0].mean() < 0.9
    settings.enabled = False
    scene.render.filepath = str(tmp_path / "plain_")
    scene.frame_set(1)
    unchanged()


def test_strength_can_be_driven(scene, tmp_path):
    scene["dim"] = 0.0
    driver = scene.afterlight.driver_add("strength").driver
    variable = driver.variables.new()
    variable.name, variable.type = "dim", "SINGLE_PROP"
    variable.targets[0].id_type, variable.targets[0].id = "SCENE", scene
    variable.targets[0].data_path = '["dim"]'
    driver.expression = "dim"
    scene.frame_set(1)
    lit, plain = lit_and_plain(scene, tmp_path)
    np.testing.assert_array_equal(lit, plain)


@pytest.mark.parametrize("file_format", ["PNG", "OPEN_EXR_MULTILAYER", "JPEG"])
def test_the_output_format_stays_the_users(scene, tmp_path, unchanged, file_format):
    image = scene.render.image_settings
    image.media_type = "MULTI_LAYER_IMAGE" if "MULTI" in file_format else "IMAGE"
    image.file_format = file_format
    image.color_mode = "BW" if file_format == "JPEG" else "RGB" if file_format == "PNG" else "RGBA"
    image.quality, image.compression = 83, 42
    if "MULTI" in file_format:
        image.exr_codec, image.color_depth, image.use_exr_interleave = "PIZ", "16", False
    unchanged()
    scene.afterlight.enabled = True
    path = render(scene, tmp_path / f"picture.{'exr' if 'EXR' in file_format else file_format.lower()}", None)
    assert path.exists() and scene.afterlight.report == ""
    if "MULTI" in file_format:
        channels = read(path)
        composite, plain = channels["Composite.Combined.R"], channels["ViewLayer.Combined.R"]
        assert composite.astype(float).mean() > 1.05 * plain.astype(float).mean()
    scene.afterlight.enabled = False
    unchanged()


@pytest.mark.parametrize("crop", [False, True])
def test_render_border(scene, tmp_path, unchanged, seen, crop):
    scene.view_layers[0].use_pass_position = True
    scene.eevee.taa_render_samples = 1  # so that every pass is sampled at the pixel's centre
    render_settings = scene.render
    render_settings.use_border, render_settings.use_crop_to_border = True, crop
    render_settings.border_min_x, render_settings.border_max_x = 0.26, 0.87
    render_settings.border_min_y, render_settings.border_max_y = 0.13, 0.71
    set_format(scene)
    unchanged()
    lit, plain = lit_and_plain(scene, tmp_path)
    unchanged()
    gain = (lit - plain).sum(axis=-1)
    if crop:
        assert gain.shape == (21, 39) and (gain > 0).all()
    else:
        inside = np.zeros(gain.shape, bool)
        inside[SIZE[1] - 25 : SIZE[1] - 4, 16:55] = True
        assert (gain[inside] > 0).all() and not gain[~inside].any()
    places_agree(seen)


def places_agree(seen, tolerance=2e-3):
    """Compare the gather's world position of each pixel with EEVEE's own Position pass."""
    assert seen
    for passes, camera, position in seen:
        height, width = passes.depth.shape
        i, j = np.meshgrid(np.arange(width) + 0.5, np.arange(height)[::-1] + 0.5)
        ray = camera.offset + camera.scale * np.stack([i, j], axis=-1)
        depth = passes.depth[..., None].astype(float)
        place = np.concatenate([ray if camera.orthographic else ray * depth, -depth], axis=-1) @ camera.rotation
        there = passes.depth < 1e9
        # The pass is relative to the world, ours to the camera: they differ by one vector, its place.
        shift = (position - place)[there]
        assert there.any() and np.abs(shift - np.median(shift, axis=0)).max() < tolerance


CAMERAS = {
    "perspective": {},
    "lens shift": {"shift_x": 0.2, "shift_y": -0.15},
    "vertical fit": {"sensor_fit": "VERTICAL", "shift_x": 0.1},
    "orthographic": {"type": "ORTHO", "ortho_scale": 3.5, "shift_x": 0.1},
}


@pytest.mark.parametrize("kind", CAMERAS)
def test_the_camera_is_understood(scene, tmp_path, unchanged, seen, kind):
    scene.view_layers[0].use_pass_position = True
    scene.eevee.taa_render_samples = 1
    scene.camera.rotation_euler = (1.5, 0.1, 0.2)
    scene.camera.scale = (2, 2, 2)
    scene.render.resolution_percentage, scene.render.pixel_aspect_x = 75, 1.5
    for name, value in CAMERAS[kind].items():
        setattr(scene.camera.data, name, value)
    set_format(scene)
    unchanged()
    lit, plain = lit_and_plain(scene, tmp_path)
    unchanged()
    assert lit.shape[:2] == (27, 48) and (lit - plain).mean() > 0
    places_agree(seen)


def test_cameras_that_move_or_are_bound_to_markers(scene, tmp_path, seen):
    scene.view_layers[0].use_pass_position = True
    scene.view_layers.new("Second").use_pass_position = True
    layered_tree(scene)
    scene.eevee.taa_render_samples = 1
    rig = put(None)
    for frame, x, turn in ((1, 0, 0), (3, 1, 0.4)):
        rig.location.x, rig.rotation_euler.z = x, turn
        rig.keyframe_insert("location", frame=frame)
        rig.keyframe_insert("rotation_euler", frame=frame)
    first = scene.camera
    second = put(bpy.data.cameras.new("Second"), (0.5, -3, 0.5), (80, 0, 10))
    first.parent = second.parent = rig
    for frame, camera in ((1, first), (2, second)):
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    scene.frame_start, scene.frame_end = 1, 3
    scene.afterlight.enabled = True
    scene.render.filepath = str(tmp_path / "frame_")
    scene.render.image_settings.file_format = "PNG"
    scene.frame_set(3)
    bpy.ops.render.render(animation=True)
    assert len(seen) == 6 and scene.afterlight.report == ""
    places_agree(seen)


def test_film_transparent(scene, tmp_path, unchanged):
    bpy.data.objects["Wall.002"].hide_render = True
    scene.render.film_transparent = True
    set_format(scene)
    scene.render.image_settings.color_mode = "RGBA"
    unchanged()
    lit, plain = lit_and_plain(scene, tmp_path)
    unchanged()
    alpha_lit, alpha_plain = (read(tmp_path / f"{name}.exr")["A"] for name in ("lit", "plain"))
    np.testing.assert_array_equal(alpha_lit, alpha_plain)
    gain = (lit - plain).sum(axis=-1)
    assert (alpha_plain == 0).any() and not gain[alpha_plain == 0].any() and gain[alpha_plain == 1].mean() > 0
    scene.render.filepath = ""
    scene.render.image_settings.file_format = "PNG"


def test_units_do_not_matter(scene, tmp_path):
    lit, _ = lit_and_plain(scene, tmp_path)
    scene.unit_settings.system, scene.unit_settings.scale_length = "IMPERIAL", 0.001
    again, _ = lit_and_plain(scene, tmp_path)
    np.testing.assert_array_equal(lit, again)


def test_emission_lights_the_room(scene, tmp_path):
    bpy.data.objects["Lamp"].hide_render = True
    sign = bpy.data.materials["Red"].node_tree.nodes["Principled BSDF"]
    sign.inputs["Emission Color"].default_value = (0, 0, 1, 1)
    sign.inputs["Emission Strength"].default_value = 2
    lit, plain = lit_and_plain(scene, tmp_path)
    white_wall = (lit - plain)[:, 30:34]
    assert white_wall[..., 2].mean() > 0.02 and white_wall[..., 1].max() < 1e-6


def test_passes_are_read_alike_from_any_layout(scene, tmp_path, afterlight, monkeypatch):
    """Mapped from a file in save()'s layout; read by OpenEXR from any other, which also finds the damage."""
    import OpenEXR

    passes, reader, read_by_openexr = afterlight.addon.scene.passes, OpenEXR.File, []

    def spy(*arguments, **options):
        read_by_openexr.append(not options.get("header_only"))
        return reader(*arguments, **options)

    def load(path):
        read_by_openexr.clear()
        found = passes.load(str(path), scene.view_layers[0].name, afterlight.addon.scene.cameras.window(scene)[0])
        return any(read_by_openexr), found.channels()

    def channels(kind=np.float32):
        return {name: np.ascontiguousarray(pixels, kind) for name, pixels in expected.items()}

    def part(name, pixels):
        return OpenEXR.Part(
            {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage}, {name: pixels}, name
        )

    scene.afterlight.enabled = True
    render(scene, tmp_path / "picture.exr")
    ours = Path(afterlight.addon.scene.frame_store.save(scene))
    expected = read(ours)
    plain = {"compression": OpenEXR.NO_COMPRESSION}
    others = {
        "compressed": reader({"compression": OpenEXR.ZIP_COMPRESSION}, channels()),
        "half": reader(plain, channels(np.float16)),
        "bottom row first": reader(plain | {"lineOrder": OpenEXR.DECREASING_Y}, channels()),
        "a part a channel": reader([part(*each) for each in channels().items()]),
    }
    for name, file in others.items():
        file.write(str(tmp_path / name))
    monkeypatch.setattr(OpenEXR, "File", spy)
    for path in (ours, *(tmp_path / name for name in others)):
        by_openexr, found = load(path)
        assert by_openexr == (path != ours), path
        for field, _, name, axes in passes.PASSES:
            for axis, pixels in zip(axes, found[field], strict=True):
                true = expected[f"{scene.view_layers[0].name}.{name}.{axis}"]
                assert pixels.dtype == np.float32
                assert np.array_equal(pixels, true.astype(np.float16) if path.name == "half" else true)
    whole = open(ours, "rb").read()
    for length in (len(whole) - 1, len(whole) // 2, 100, 0):
        (tmp_path / "cut short").write_bytes(whole[:length])
        with pytest.raises(passes.Problem, match="could not be read back.*disk"):
            load(tmp_path / "cut short")
    afterlight.addon.scene.frame_store.discard(ours)


def test_no_file_is_left_in_the_temporary_folder(scene, tmp_path):
    """Except for the passes of the last frame, until they are freed."""
    layered_tree(scene)
    scene.afterlight.enabled = True

    def files():
        return sorted(
            path
            for path in Path(bpy.app.tempdir).rglob("*")  # our folder and its lock go with the session
            if path.name != ".lock" and not path.name.startswith("afterlight_")
        )

    before = files()
    for _ in range(2):
        render(scene, tmp_path / "picture.exr")
    assert len(files()) == len(before) + 1
    assert bpy.ops.afterlight.free_passes() == {"FINISHED"}
    assert files() == before


def test_a_file_renders_without_the_extension(scene, tmp_path, afterlight):
    plain = read_rgb(render(scene, tmp_path / "plain.exr"))
    scene.afterlight.enabled = True
    scene.afterlight.samples = 99
    path = str(tmp_path / "ticked.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    module = afterlight.__name__
    bpy.ops.preferences.addon_disable(module=module)
    try:
        assert not hasattr(bpy.types.Scene, "afterlight")
        np.testing.assert_array_equal(read_rgb(render(scene, tmp_path / "disabled.exr")), plain)
        bpy.ops.wm.open_mainfile(filepath=path)
        np.testing.assert_array_equal(read_rgb(render(bpy.context.scene, tmp_path / "loaded.exr")), plain)
    finally:
        bpy.ops.preferences.addon_enable(module=module)
    scene = bpy.context.scene
    assert scene.afterlight.enabled and scene.afterlight.samples == 99
    assert (read_rgb(render(scene, tmp_path / "again.exr")) - plain).mean() > 0
