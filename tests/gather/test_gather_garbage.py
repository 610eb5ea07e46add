# SPDX-License-Identifier: GPL-3.0-or-later
"""New textures hold what was in the memory before: zeros on OpenGL as a rule, anything on Vulkan."""

import importlib

import numpy as np
import pytest
from test_gather_sums import settings

import gather_fixtures as fixtures


@pytest.mark.parametrize("size", [(64, 36), (61, 47)])
@pytest.mark.parametrize("start", [1, 2, 4])
def test_what_new_textures_hold_does_not_matter(light, monkeypatch, size, start):
    camera, passes = fixtures.camera_for(light, *size), fixtures.random_frame(light, *size)
    chosen = settings(light, start=start, samples=16, radius=8)
    clean = light.gather_indirect(passes, camera, chosen)
    device = importlib.import_module(f"{light.__name__}.device")
    new = device.texture

    def dirty(width, height, format="RGBA32F", data=None):
        made = new(width, height, format, data)
        if data is None and format == light.shader_interface.SURFEL_FORMAT:
            made.clear(format="UINT", value=(0x7FFFFFFF,) * 4)  # a surfel of infinite radiance
        elif data is None:
            made.clear(format="FLOAT", value=(np.nan,) * 4)
        return made

    monkeypatch.setattr(device, "texture", dirty)
    assert np.array_equal(light.gather_indirect(passes, camera, chosen), clean)
