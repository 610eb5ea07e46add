# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender in a window for each GPU backend, kept through all tests of it; no test may leave a traceback behind."""

import os
import shutil

import pytest
import steps
from window import ROOT, Computer, Window

import extension

FOLDER = ROOT / "build" / "desktop"


def pytest_configure():
    if "AFTERLIGHT_DESKTOP" not in os.environ:
        pytest.exit("these tests need a full Blender: run them by 'make desktop-test'", 3)


@pytest.fixture(scope="session")
def package():
    return extension.package()


@pytest.fixture(scope="session")
def empty_folder():
    shutil.rmtree(FOLDER, ignore_errors=True)
    return FOLDER


@pytest.fixture(scope="session", params=["opengl", "vulkan"])
def computer(request, empty_folder):
    return Computer(empty_folder / request.param, request.param)


@pytest.fixture(scope="session")
def session(computer):
    window = Window(computer)
    yield window
    window.close()


@pytest.fixture
def window(session):
    """The running Blender. Whatever a test does with it, Blender may print no traceback and report no error."""
    if session.is_worn_out():
        session.restart_blender()
    session.new_log()
    yield session
    # But for what Blender says of itself, such as that there are no drivers for Cycles here.
    printed = "\n".join(line for line in session.new_log().splitlines() if "| WARNING " not in line)
    assert "Traceback" not in printed and "Error" not in printed, printed


@pytest.fixture
def afterlight(window, package):
    """The extension is installed and enabled, by the window's Blender itself."""
    if not window.value(f"{steps.MODULE!r} in bpy.context.preferences.addons"):
        steps.install(window, package)
