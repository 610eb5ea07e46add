# SPDX-License-Identifier: GPL-3.0-or-later
"""Which earlier frame's light a frame reuses, in Blender: animations, cuts, the pieces of a render farm, and what it
leaves in the file."""

import bpy
import numpy as np
import pytest

from scenes import box, layered_tree, put, read_rgb, set_format

FRAMES, REBUILT = 5, 9


@pytest.fixture
def scene(fresh):
    """A camera that moves a little, and noisy light of one view."""
    scene = box(fresh, samples=1)
    settings = scene.afterlight
    settings.method, settings.views, settings.draws, settings.bounces = "RADIOSITY", "CAMERA", 2, 1
    settings.enabled = True
    scene.camera.keyframe_insert("location", frame=1)
    scene.camera.location.x += 0.3
    scene.camera.keyframe_insert("location", frame=9)
    set_format(scene, "OPEN_EXR")
    return scene


@pytest.fixture
def gathered(afterlight, monkeypatch):
    """(frame, view layer, mean number of gathers in its light) of all frames that are averaged."""
    found, histories = [], afterlight.addon.render.histories.Histories
    keep = histories.keep

    def spy(self, scene, layer, settings, light):
        found.append((scene.frame_current, layer, float(np.array(light.light.read())[..., 3].mean())))
        keep(self, scene, layer, settings, light)

    monkeypatch.setattr(histories, "keep", spy)
    return found


def animation(scene, folder, first, last, now=99):
    """{frame: image} of an animation that starts while frame `now` is current."""
    scene.frame_start, scene.frame_end = first, last
    scene.frame_set(now)
    scene.render.filepath = f"{folder}/"
    bpy.ops.render.render(animation=True)
    assert scene.afterlight.report == ""
    return {frame: read_rgb(folder / f"{frame:04}.exr") for frame in range(first, last + 1, scene.frame_step)}


def counts(gathered):
    """How many gathers are in each frame's light, roughly: newly visible surfaces have one."""
    return [round(count) for _, _, count in gathered]


def test_frames_go_on_into_the_next(scene, gathered, tmp_path):
    animation(scene, tmp_path, 1, 3)
    assert counts(gathered) == [REBUILT, FRAMES, FRAMES]
    gathered.clear()
    animation(scene, tmp_path, 4, 4)
    assert counts(gathered) == [REBUILT], "another render: anything may have changed"


def test_frame_step_and_subframes(scene, gathered, tmp_path):
    scene.frame_step = 2
    animation(scene, tmp_path, 1, 5)
    assert counts(gathered) == [REBUILT, FRAMES, FRAMES]


def test_a_cut_begins_anew(scene, gathered, tmp_path):
    other = put(scene.camera.data.copy(), (0.2, -3.4, 0.1), (90, 0, 0))
    for frame, camera in ((1, scene.camera), (3, other)):
        scene.timeline_markers.new(f"Shot {frame}", frame=frame).camera = camera
    animation(scene, tmp_path, 1, 4)
    assert counts(gathered) == [REBUILT, FRAMES, REBUILT, FRAMES]


def test_changed_settings_begin_anew_and_strength_does_not(scene, gathered, tmp_path):
    settings = scene.afterlight
    for frame, draws, strength in ((1, 2, 1.0), (3, 4, 0.5)):
        settings.draws, settings.strength = draws, strength
        settings.keyframe_insert("draws", frame=frame)
        settings.keyframe_insert("strength", frame=frame)
    for curve in scene.animation_data.action.layers[0].strips[0].channelbags[0].fcurves:
        if curve.data_path.endswith("draws"):
            for key in curve.keyframe_points:
                key.interpolation = "CONSTANT"
    animation(scene, tmp_path, 1, 4)
    assert counts(gathered) == [REBUILT, FRAMES, REBUILT, FRAMES]


def test_each_view_layer_has_a_history_of_its_own(scene, gathered, tmp_path):
    layered_tree(scene)
    bpy.ops.afterlight.repair()
    animation(scene, tmp_path, 1, 2)
    assert [(frame, layer) for frame, layer, _ in gathered] == [
        (1, "ViewLayer"),
        (1, "Front"),
        (2, "ViewLayer"),
        (2, "Front"),
    ]
    assert counts(gathered) == [REBUILT, REBUILT, FRAMES, FRAMES]


def test_a_single_frame_is_as_without(scene, gathered, tmp_path):
    """F12, and the first frame of a script's animation if it is the current frame: it can't be told from F12."""
    scene.frame_set(2)
    scene.render.filepath = str(tmp_path / "on.exr")
    bpy.ops.render.render(write_still=True)
    scene.afterlight.use_history = False
    scene.render.filepath = str(tmp_path / "off.exr")
    bpy.ops.render.render(write_still=True)
    assert np.array_equal(read_rgb(tmp_path / "on.exr"), read_rgb(tmp_path / "off.exr")) and not gathered
    scene.afterlight.use_history = True
    animation(scene, tmp_path, 1, 3, now=1)
    assert counts(gathered) == [REBUILT, FRAMES]
    scene.afterlight.method = "PAPER"
    gathered.clear()
    animation(scene, tmp_path, 1, 2)
    assert not gathered


def test_command_lines_that_render_animations(afterlight, monkeypatch):
    asked = afterlight.addon.render.histories._asked_for_animation
    for line, answer in (
        ("blender -b a.blend -f 1", True),
        ("blender -b a.blend -s 3 -e 5 -a", True),
        ("blender -b a.blend --render-frame 1..4", True),
        ("blender -b a.blend -P render.py", False),
        ("blender -b a.blend -P render.py -- -a", False),
    ):
        monkeypatch.setattr("sys.argv", line.split())
        assert asked() == answer, line


def noise_of(scene, folder, frame):
    """Noise of a single frame: root mean square difference of two seeds, divided by the square root of two."""
    scene.afterlight.use_history, pictures = False, []
    for seed in (100, 200):
        scene.afterlight.seed = seed
        pictures.append(animation(scene, folder, frame, frame)[frame])
    scene.afterlight.use_history, scene.afterlight.seed = True, 0
    return np.sqrt(np.mean((pictures[0] - pictures[1]) ** 2) / 2)


def test_a_farms_pieces_are_the_whole_within_a_frames_noise(scene, tmp_path):
    """And with less noise than that, at a piece's first frame as after it."""
    whole = animation(scene, tmp_path / "whole", 1, 5)
    piece = animation(scene, tmp_path / "piece", 4, 5)
    noise = noise_of(scene, tmp_path / "single", 4)
    apart = [np.sqrt(np.mean((whole[frame] - piece[frame]) ** 2)) for frame in piece]
    assert max(apart) < 0.7 * noise, (apart, noise)


def test_moving_pictures_are_calmer(scene, tmp_path):
    """With a camera at rest: what changes between frames is noise, and an eighth of it is left."""
    scene.camera.animation_data_clear()
    change = {}
    for average in (True, False):
        scene.afterlight.use_history, scene.afterlight.use_animated_seed = average, not average
        frames = animation(scene, tmp_path / str(average), 1, 4)
        change[average] = np.mean([(frames[frame + 1] - frames[frame]) ** 2 for frame in range(1, 4)])
    assert change[True] < change[False] / 8


def test_the_motion_pass_is_switched_on_and_off(scene):
    layer, settings = scene.view_layers[0], scene.afterlight
    assert layer.use_pass_vector
    settings.use_history = False
    assert not layer.use_pass_vector and layer.use_pass_z
    settings.use_history = True
    settings.method = "PAPER"
    assert not layer.use_pass_vector
    settings.method = "RADIOSITY"
    settings.enabled = False
    assert not layer.use_pass_vector and not layer.use_pass_normal and not layer.get("afterlight")
    layer.use_pass_vector = settings.enabled = True
    settings.use_history = False
    assert layer.use_pass_vector, "the user's own"
    settings.enabled = False
    assert layer.use_pass_vector


def test_motion_is_told_by_eevee(scene, afterlight, monkeypatch, tmp_path):
    """A wall that moves sideways by itself. With motion blur there are no motion vectors, and frames render all the
    same."""
    found, load = [], afterlight.addon.scene.passes.load

    def spy(*arguments):
        passes = load(*arguments)
        found.append(passes.motion)
        return passes

    monkeypatch.setattr(afterlight.addon.scene.passes, "load", spy)
    scene.camera.animation_data_clear()
    wall = bpy.data.objects["Wall.002"]
    for frame, x in ((1, 0.0), (5, 0.4)):
        wall.location.x = x
        wall.keyframe_insert("location", frame=frame)
    scene.afterlight.use_history = True
    animation(scene, tmp_path, 3, 3)
    across = np.asarray(found[-1][0])
    assert across.min() < -0.5 and (across == 0).mean() > 0.2, "it was to the left before, and other walls do not move"
    scene.frame_step = 3
    found.clear()
    animation(scene, tmp_path, 3, 3)
    assert np.allclose(found[-1][0], 3 * across, atol=1e-3)
    scene.render.use_motion_blur = True
    animation(scene, tmp_path, 3, 3)
    assert found[-1] is None
