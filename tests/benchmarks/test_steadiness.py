# SPDX-License-Identifier: GPL-3.0-or-later
"""The measure of steadiness: an error that stays is none, one that jumps shows where it jumps."""

import numpy as np
import pytest

from benchmarks.motion import steadiness


def cells(row):
    return [cell.strip() for cell in row.strip("|").split("|")]


def test_blocks_are_means():
    picture = np.random.default_rng(0).random((20, 33, 3))
    found = steadiness.blocks(picture)
    assert found.shape == (2, 4, 3)
    assert np.allclose(found[1, 2], picture[8:16, 16:24].mean((0, 1)))


def test_only_what_changes_counts():
    """Light of 2; an error of 0.5 that stays, one that jumps by 0.2 when the views change, in the third frame of
    four."""
    stays = np.full((4, 2, 3, 3), 0.5)
    jumps = np.where(np.arange(4)[:, None, None, None] < 2, 0.0, 0.2) * np.ones((4, 2, 3, 3))
    rows = steadiness.table(
        {"stays": stays, "jumps": jumps},
        np.zeros((4, 2, 3, 3)),
        2.0,
        {"stays": [[1.0]] * 4, "jumps": [[1.0]] * 2 + [[3.0]] * 2},
    )
    name, error, median, largest, moved, there = cells(rows[2])
    assert (name, float(error), float(median), float(largest), moved, there) == ("stays", 0.25, 0, 0, "–", "–")
    name, error, median, largest, moved, there = cells(rows[3])
    assert (float(error), float(median), float(largest), moved, float(there)) == (pytest.approx(0.05), 0, 0.1, "3", 0.1)
