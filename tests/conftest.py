# SPDX-License-Identifier: GPL-3.0-or-later
"""What every test stands on: the extension, packaged and installed as a user would, and an empty Blender file."""

import pytest

import extension

# At import, because test modules import bpy at their top and pytest imports this file before them.
USER_FOLDER = extension.use_temporary_preferences()

try:
    import bpy
except ImportError as error:
    pytest.exit(f"Blender's module does not load: {error}. 'make setup' installs what is missing, or names it.", 3)


@pytest.fixture(scope="session")
def gpu_ready():
    """The `gpu` module usable without any render. Fails readably where there is no OpenGL at all."""
    import gpu

    try:
        gpu.init()
    except SystemError as error:
        pytest.fail(f"Blender found no GPU, not even a software one: {error}. 'make setup' installs Mesa, or says how.")


@pytest.fixture(scope="session")
def package(tmp_path_factory):
    """Path of the zip, built from the working tree as `make package` does. Cheap: 0.3 s once the wheels are there."""
    return extension.package(tmp_path_factory.mktemp("package"))


@pytest.fixture(scope="session")
def afterlight(package, gpu_ready):
    """The package module bl_ext.user_default.afterlight, installed from the zip and enabled."""
    return extension.install(package)


@pytest.fixture
def fresh(afterlight):
    """The one scene of an empty file: no objects, factory settings, the extension still enabled."""
    # Not read_factory_settings: that resets the preferences as well, and with them the extension is off.
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return bpy.context.scene


@pytest.fixture
def scene(fresh):
    """A box with a lamp and a camera, one sample."""
    import scenes

    return scenes.box(fresh, samples=1)


@pytest.fixture
def addon(afterlight):
    """The add-on's own package, bl_ext.user_default.afterlight.addon."""
    return afterlight.addon


@pytest.fixture(scope="module")
def light(afterlight):
    """addon.gather of the installed extension, with a GPU context to run it in.

    Outside a render Blender leaves whatever context was last active: none after a render by an engine in Python, its
    own after one by EEVEE or Workbench."""
    import gpu  # which exists only once bpy is in

    import scenes

    try:
        gpu.types.GPUTexture((1, 1))
    except RuntimeError:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        scene = bpy.context.scene
        scene.render.engine, scene.camera = "BLENDER_WORKBENCH", scenes.put(bpy.data.cameras.new("Camera"))
        scene.render.resolution_x = scene.render.resolution_y = 4
        bpy.ops.render.render()
    return afterlight.addon.gather


def pytest_sessionfinish():
    """Blender's GPU ends before Python does: let go of what tests keep on it."""
    import gather_fixtures

    gather_fixtures.halves_shader.cache_clear()
