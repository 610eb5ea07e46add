# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's settings of files and videos are unchanged after each save of the passes."""

import bpy
import pytest

from scenes import box, render


@pytest.fixture(scope="module")
def rendered(afterlight, tmp_path_factory):
    """A scene with a finished render that can be saved."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = box(bpy.context.scene, samples=1)
    scene.afterlight.enabled = True
    render(scene, tmp_path_factory.mktemp("rendered") / "picture.exr")
    return scene


def written_down(*structs):
    """{path: value} of all settings, writable or not."""
    found = {}
    for struct in structs:
        for name, prop in struct.bl_rna.properties.items():
            if name == "rna_type" or prop.type == "COLLECTION":
                continue
            value, path = getattr(struct, name), f"{struct.bl_rna.identifier}.{name}"
            if prop.type == "POINTER":
                found |= written_down(value) if value is not None else {path: None}
            else:
                found[path] = tuple(value) if getattr(prop, "is_array", False) else value
    return found


def check(scene, save):
    """Save, and assert that no setting changed. Returns the settings."""
    render_settings = scene.render
    before = written_down(render_settings.image_settings, render_settings.ffmpeg)
    save(scene)
    after = written_down(render_settings.image_settings, render_settings.ffmpeg)
    changed = {path: (value, after[path]) for path, value in before.items() if after[path] != value}
    assert not changed, before
    return before


def choose(scene, file_format, **settings):
    image = scene.render.image_settings
    image.media_type = {"OPEN_EXR_MULTILAYER": "MULTI_LAYER_IMAGE", "FFMPEG": "VIDEO"}.get(file_format, "IMAGE")
    image.file_format = file_format
    for name, value in settings.items():
        setattr(image, name, value)
    return image


FORMATS = [
    ("PNG", "16"),
    ("JPEG", "8"),
    ("TIFF", "16"),
    ("TIFF", "8"),
    ("HDR", "32"),
    ("DPX", "10"),
    ("OPEN_EXR", "16"),
    ("OPEN_EXR", "32"),
    ("OPEN_EXR_MULTILAYER", "16"),
    ("FFMPEG", "8"),
]


@pytest.mark.parametrize("file_format, depth", FORMATS)
def test_every_colour_space_of_every_format(rendered, afterlight, file_format, depth):
    image = choose(rendered, file_format, color_management="OVERRIDE", color_depth=depth)
    spaces = [each.identifier for each in image.linear_colorspace_settings.bl_rna.properties["name"].enum_items]
    assert len(spaces) > 20
    seen = set()
    for space in spaces:
        image.linear_colorspace_settings.name = space
        found = check(rendered, afterlight.addon.scene.frame_store.save)
        seen.add(found["ColorManagedInputColorspaceSettings.name"])
    assert len(seen) > 20, "they differ"


@pytest.mark.parametrize("file_format, depth", FORMATS)
def test_the_look_the_display_and_stereo(rendered, afterlight, file_format, depth):
    image = choose(rendered, file_format, color_management="OVERRIDE", color_depth=depth)
    image.view_settings.view_transform, image.view_settings.exposure, image.view_settings.gamma = "AgX", 1.5, 0.8
    image.view_settings.look, image.view_settings.use_curve_mapping = "AgX - Punchy", True
    image.display_settings.display_device = "Display P3"
    image.stereo_3d_format.display_mode, image.stereo_3d_format.use_squeezed_frame = "SIDEBYSIDE", True
    found = check(rendered, afterlight.addon.scene.frame_store.save)
    assert found["ColorManagedViewSettings.look"] == "AgX - Punchy"
    if image.has_linear_colorspace:
        image.color_management = "FOLLOW_SCENE"
        check(rendered, afterlight.addon.scene.frame_store.save)


@pytest.mark.parametrize("file_format", ["PNG", "JPEG"])
def test_a_colour_space_without_a_use(rendered, afterlight, file_format):
    """The one setting that is not restored, since reading it makes Blender warn if it was never set: the colour space
    of linear formats, while neither the format nor the scene uses it. The next format sets it anew, with or without a
    save."""
    image = choose(rendered, file_format, color_management="FOLLOW_SCENE")
    linear = image.linear_colorspace_settings

    def then(save):
        choose(rendered, file_format)
        linear.name = space
        if save:
            afterlight.addon.scene.frame_store.save(rendered)
        choose(rendered, "OPEN_EXR")
        return linear.name.replace("scene_linear", "Linear Rec.709")  # another name for it

    for space in [each.identifier for each in linear.bl_rna.properties["name"].enum_items]:
        assert then(save=True) == then(save=False), space


def test_no_warning_of_a_colour_space_that_was_never_chosen(rendered, afterlight, capfd):
    other = bpy.data.scenes.new("Other")
    capfd.readouterr()
    afterlight.addon.host.put_back.restore(afterlight.addon.scene.frame_store._to_multilayer_exr(other.render))
    bpy.data.scenes.remove(other)
    assert "WARNING" not in "".join(capfd.readouterr())


VIDEOS = [
    ("MPEG4", "H264"),
    ("MPEG4", "H265"),
    ("WEBM", "WEBM"),
    ("MKV", "FFV1"),
    ("QUICKTIME", "PRORES"),
    ("AVI", "MPEG4"),
    ("MPEG1", "MPEG1"),
    ("OGG", "THEORA"),
]


@pytest.mark.parametrize("container, codec", VIDEOS)
def test_videos(rendered, afterlight, container, codec):
    choose(rendered, "FFMPEG")
    video = rendered.render.ffmpeg
    video.format, video.codec = container, codec
    video.constant_rate_factor, video.gopsize, video.audio_codec = "LOW", 7, "NONE"
    found = check(rendered, afterlight.addon.scene.frame_store.save)
    assert (found["FFmpegSettings.format"], found["FFmpegSettings.codec"]) == (container, codec)


@pytest.mark.parametrize("views_format", ["INDIVIDUAL", "STEREO_3D"])
def test_the_format_of_views(rendered, afterlight, views_format):
    choose(rendered, "PNG", views_format=views_format)
    check(rendered, afterlight.addon.scene.frame_store.save)


def test_a_whole_render(rendered, tmp_path):
    """Its file is in the colour space that was asked for."""
    image = choose(rendered, "OPEN_EXR", color_management="OVERRIDE")
    image.linear_colorspace_settings.name = "Linear Rec.2020"
    check(rendered, lambda scene: render(scene, tmp_path / "picture.exr", None))
    assert image.linear_colorspace_settings.name == "Linear Rec.2020" and rendered.afterlight.report == ""


def test_a_save_that_fails(rendered, afterlight, monkeypatch):
    passes = afterlight.addon.scene.passes
    choose(rendered, "TIFF", color_depth="16", color_management="OVERRIDE")

    def fails(scene):
        with pytest.raises(passes.Problem, match="could not be written"):
            afterlight.addon.scene.frame_store.save(scene)

    monkeypatch.setattr(afterlight.addon.scene.frame_store.os.path, "exists", lambda path: False)
    check(rendered, fails)
