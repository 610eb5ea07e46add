# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that cannot be lit: one clear message, the plain image if there is one, unchanged settings, no traceback."""

import io
import os
import shutil
import sys

import bpy
import numpy as np
import pytest

from scenes import box, differences, read_rgb, render, set_format, written_down


@pytest.fixture
def scene(fresh):
    scene = box(fresh, samples=1)
    scene.afterlight.enabled = True
    return scene


@pytest.fixture
def handlers(afterlight):
    return afterlight.addon.render.handlers


@pytest.fixture(scope="module")
def plain(afterlight, tmp_path_factory):
    """The box rendered by EEVEE alone."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return read_rgb(render(box(bpy.context.scene, samples=1), tmp_path_factory.mktemp("plain") / "plain.exr"))


@pytest.fixture
def refuse(scene, tmp_path, capfd):
    """Render, and assert that the image has no indirect light, that a message contains `words`, and that nothing else
    changed."""

    def check(*words, picture=None):
        scene.render.filepath = str(tmp_path / "picture.exr")
        set_format(scene)
        before = written_down()
        before.pop("images")
        capfd.readouterr()
        try:
            rendered = read_rgb(render(scene, tmp_path / "picture.exr"))
        except RuntimeError as error:  # Blender's own refusal
            rendered = None
            assert "Traceback" not in str(error)
        after = written_down()
        after.pop("images")
        assert not differences(before, after)
        printed = "".join(capfd.readouterr())
        assert "Traceback" not in printed
        for word in words:
            assert word in scene.afterlight.report, scene.afterlight.report
        assert "Afterlight: " + scene.afterlight.report in printed
        if picture is not None:
            np.testing.assert_array_equal(rendered, picture)
        return rendered

    return check


def test_no_camera(scene, refuse):
    bpy.data.objects.remove(scene.camera)
    assert refuse("no camera", "Add one") is None


@pytest.mark.parametrize("engine", ["CYCLES", "BLENDER_WORKBENCH"])
def test_another_engine(scene, refuse, engine):
    bpy.ops.preferences.addon_enable(module="cycles")
    scene.render.engine = engine
    if engine == "CYCLES":
        scene.cycles.samples = 1
    assert refuse("EEVEE", "Render Engine", engine.split("_")[-1].title()) is not None


def test_panoramic_camera(scene, refuse):
    scene.camera.data.type = "PANO"
    assert refuse("panoramic", "Lens Type") is not None


def test_camera_that_is_none(scene, refuse):
    scene.camera = bpy.data.objects["Lamp"]
    assert refuse("Lamp", "not a camera object") is not None


def test_no_view_layer(scene, refuse):
    scene.view_layers[0].use = False
    refuse("No view layer", "Use for Rendering")


def test_stereo(scene, refuse):
    scene.render.use_multiview = True
    scene.render.image_settings.views_format = "STEREO_3D"
    try:
        refuse("Stereo", "Disable Stereoscopy")
    except (FileNotFoundError, OSError):
        pass  # Blender names stereo files otherwise


def test_ray_tracing_never_doubles_the_light(scene, refuse, tmp_path):
    scene.eevee.use_raytracing = True
    scene.afterlight.enabled = False
    alone = read_rgb(render(scene, tmp_path / "alone.exr"))
    scene.afterlight.enabled = True
    refuse("ray tracing", "already adds", picture=alone)


def test_single_layer(scene, refuse, tmp_path):
    """With Render Single Layer, Blender adds what the helper scene rendered last; the light of another frame must not
    get in."""
    lamp = bpy.data.objects["Lamp"]
    there, lamp.location.x = lamp.location.x, -1
    scene.afterlight.enabled = False
    plain = read_rgb(render(scene, tmp_path / "plain.exr"))
    scene.afterlight.enabled, lamp.location.x = True, there
    render(scene, tmp_path / "lit.exr")
    scene.render.use_single_layer, lamp.location.x = True, -1
    refuse("Single Layer", picture=plain)
    assert not scene.compositing_node_group.nodes["Afterlight"].mute


def test_compositing_switched_off(scene, plain, tmp_path, afterlight):
    """Without a window nobody can press Repair, so it is repaired; with a window the panel reports it."""
    scene.render.use_compositing = False
    (fault,) = afterlight.addon.compositor.faults.find(scene)
    assert "Compositing is disabled" in fault
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert (lit - plain).mean() > 0 and scene.afterlight.report == ""


def test_temporary_folder_cannot_be_written(scene, refuse, plain):
    folder = bpy.app.tempdir.rstrip("/")
    shutil.rmtree(folder)
    open(folder, "w").close()  # tests may run as root, who can write even to a read-only folder, but not to this
    try:
        refuse("could not be written", folder, "Temporary Files", picture=plain)
    finally:
        os.remove(folder)
        os.mkdir(folder)


def test_disk_full(scene, refuse, plain):
    """No space for the passes, though there is for the image."""
    resource = pytest.importorskip("resource", reason="needs a limit for the size of files")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, before[1]))
    try:
        refuse("could not be", "disk", picture=plain)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_openexr_missing(scene, refuse, plain, monkeypatch):
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    refuse("OpenEXR", "install it again", picture=plain)


def test_no_gpu(scene, refuse, plain, afterlight, monkeypatch):
    def no_gpu(*_, **__):
        raise SystemError("GPU functions for drawing are not available in background mode")

    monkeypatch.setattr(afterlight.addon.gather.device.gpu.types, "GPUTexture", no_gpu, raising=True)
    refuse("GPU", "driver", picture=plain)


def test_nan_and_infinity_in_a_pass(scene, plain, afterlight, monkeypatch, tmp_path, capfd):
    engine = afterlight.addon.render.engine
    load = engine.passes.load

    def spoiled(*arguments):
        passes = load(*arguments)
        passes.diffuse_direct[0][5:8, 5:8] = np.nan
        passes.emission[1][20, 30] = np.inf
        passes.normal[2][10:12, 40:42] = np.nan
        return passes

    monkeypatch.setattr(engine.passes, "load", spoiled)
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    gain = lit - plain
    assert np.isfinite(lit).all() and gain.mean() > 0
    # Pixels without a surface get no light; those without direct light only send none, and get that of others.
    assert not gain[10:12, 40:42].any() and gain[9, 40:42].all() and gain[6, 6].all()
    printed = "".join(capfd.readouterr())
    for words in ("9 pixels of diffuse direct", "1 pixels of emission", "4 pixels of normal"):
        assert words in printed
    assert scene.afterlight.report == "" and "Traceback" not in printed


def test_nothing_but_background(scene, tmp_path):
    for thing in [thing for thing in scene.objects if thing.type == "MESH"]:
        bpy.data.objects.remove(thing)
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert not lit.any() and scene.afterlight.report == ""


@pytest.mark.parametrize("size", [(1, 1), (8192, 16)])
def test_odd_sizes(scene, tmp_path, size):
    scene.render.resolution_x, scene.render.resolution_y = (max(4, extent) for extent in size)
    if size == (1, 1):
        scene.render.resolution_percentage = 25
    lit = read_rgb(render(scene, tmp_path / "lit.exr"))
    assert lit.shape == (size[1], size[0], 3) and np.isfinite(lit).all() and scene.afterlight.report == ""


def test_a_good_render_forgets_the_last_message(scene, tmp_path):
    scene.eevee.use_raytracing = True
    render(scene, tmp_path / "picture.exr")
    assert scene.afterlight.report
    scene.eevee.use_raytracing = False
    render(scene, tmp_path / "picture.exr")
    assert scene.afterlight.report == ""


def test_the_helper_scene_says_what_it_is(scene, tmp_path, capfd):
    helper = scene.afterlight.helper
    try:
        bpy.ops.render.render(scene=helper.name)
    except RuntimeError as error:
        assert 'no render of "Scene"' in str(error) and "Render that scene" in str(error)
    else:
        pytest.fail("rendered a scene that serves to light another")
    assert "Traceback" not in "".join(capfd.readouterr())


def ascii_only():
    return io.TextIOWrapper(io.BytesIO(), encoding="ascii")


def closed():
    stream = io.StringIO()
    stream.close()
    return stream


class Odd:
    """An object that another script has put in the place of a stream."""

    def write(self, text):
        raise OSError("the pipe is broken")


@pytest.mark.parametrize("terminal", [ascii_only, closed, Odd, lambda: None])
def test_any_terminal(scene, handlers, monkeypatch, terminal):
    """before_render() must not stop at a message that can't be printed: the light of the previous render must be kept
    out."""
    scene.camera.data.type, scene.camera.name = "PANO", "Kämera"
    stream = terminal()
    monkeypatch.setattr(sys, "stdout", stream)
    monkeypatch.setattr(sys, "stderr", stream)
    handlers.before_render(scene)
    muted = scene.compositing_node_group.nodes["Afterlight"].mute
    handlers.after_render(scene)
    assert muted and "Kämera" in scene.afterlight.report
    if terminal == ascii_only:
        stream.flush()
        assert b'The camera "K\\xe4mera" is panoramic' in stream.buffer.getvalue()


@pytest.mark.parametrize("terminal", [ascii_only, closed, Odd, lambda: None])
def test_any_terminal_for_an_error_of_our_own(scene, afterlight, monkeypatch, tmp_path, terminal):
    def fails(*_, **__):
        raise ValueError("Käse")

    monkeypatch.setattr(afterlight.addon.gather, "gather_indirect", fails)
    monkeypatch.setattr(sys, "stdout", terminal())
    monkeypatch.setattr(sys, "stderr", sys.stdout)
    render(scene, tmp_path / "picture.exr")
    assert "Internal error in Afterlight (Käse)" in scene.afterlight.report


def test_background_render_makes_what_python_saves_passes_through(scene, afterlight):
    """`blender -b -f 1` starts without the image Render Result, which F12 makes and passes are saved through."""
    handlers = afterlight.addon.render.handlers
    while afterlight.addon.scene.frame_store.render_result():
        bpy.data.images.remove(afterlight.addon.scene.frame_store.render_result())
    handlers.before_render(scene)
    assert afterlight.addon.scene.frame_store.render_result() and scene.afterlight.report == ""
