# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of several benchmarks' pages share."""

import pytest


@pytest.fixture
def machine():
    """A machine as benchmarks.gpu writes it down."""
    return {
        "renderer": "A GPU",
        "vendor": "A vendor",
        "version": "4.6",
        "processor": "A processor",
        "cores": 8,
        "timer": "timer queries",
    }
