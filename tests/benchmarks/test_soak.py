# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing stays behind: the soak itself in short, and that each thing left would show. `make soak` is the long one."""

import pytest

from benchmarks import soak

UPDATES = 80


def test_nothing_stays_behind(tmp_path):
    """Each frame of the mix once, and the last lit again and again: to tell a leak from what Blender's memory does with
    EEVEE's frames takes more of them than there is time for here."""
    found = soak.measure(len(soak.MIX), UPDATES, True, tmp_path)
    assert len(found["resident"]) == len(soak.MIX) and len(found["in use by updates"]) == UPDATES
    assert max(found["textures made"]) > 0 and max(found["files"]) == 1 + soak.VIEWS, "the soak must see what it counts"
    assert not list(soak.faults(found))


@pytest.fixture
def clean():
    """What a long run finds where all is well: memory goes up and down with the frames, and up at first."""
    count = 20 * len(soak.MIX)
    counts = count + UPDATES
    return {
        "resident": [1e9 + 1e8 * (number % len(soak.MIX)) for number in range(count)],
        "seconds": 60,
        "in use": [6e8, 9e8] + [1e9, 1.01e9] * 9,
        "in use by updates": [1.2e9 + 1e4 * number for number in range(UPDATES)],
        "textures": [0] * counts,
        "descriptors": [7] * counts,
        "files": [1] * counts,
        "files left": [],
        "left over": [],
        "images": [["Render Result"], ["Render Result"]],
        "exit code": 0,
    }


def test_no_fault_where_nothing_stays(clean):
    assert not list(soak.faults(clean))
    assert "Nothing stays behind." in soak.page(clean, clean, "a command")


def leak_memory(found):
    found["in use"] = [memory + 1.5e6 * number for number, memory in enumerate(found["in use"])]


def leak_in_updates(found):
    found["in use by updates"] = [memory + 6e4 * number for number, memory in enumerate(found["in use by updates"])]


@pytest.mark.parametrize(
    "leak, words",
    [
        (leak_memory, "memory grew by 2."),
        (leak_in_updates, "each time the light was updated"),
        (lambda found: found["textures"].__setitem__(5, 1), "1 textures"),
        (lambda found: found["files"].__setitem__(5, 4), "4 files of passes"),
        (lambda found: found["files left"].append("afterlight_1.exr"), "afterlight_1.exr"),
        (lambda found: found["left over"].append("/cameras/Camera.001"), "/cameras/Camera.001"),
        (lambda found: found["images"][1].append("Render Result.001"), "Render Result.001"),
        (lambda found: found["descriptors"].__setitem__(-1, 8), "open files: 7, then 8"),
        (lambda found: found.update({"exit code": -11}), "exit code -11"),
    ],
)
def test_each_fault_shows(clean, leak, words):
    leak(clean)
    (fault,) = soak.faults(clean)
    assert words in fault
    assert f"**Missed:** {fault}." in soak.page(clean, clean, "a command")
