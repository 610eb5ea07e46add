# SPDX-License-Identifier: GPL-3.0-or-later
"""A minute of user actions in random order, and of files with random claims. `make fuzz` runs for an hour."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]


@pytest.mark.parametrize("kind, examples", [("machine", 4), ("claims", 25), ("files", 60)])
def test_fuzz(afterlight, tmp_path, kind, examples):
    """In a process of its own, since Blender may crash: the journal then tells what led to it."""
    journal = tmp_path / "journal.txt"
    run = subprocess.run(
        [
            sys.executable,
            "-X",
            "faulthandler",
            "-m",
            "fuzz",
            kind,
            afterlight.__name__,
            "--seed",
            "0",
            "--examples",
            str(examples),
            "--journal",
            str(journal),
        ],
        capture_output=True,
        text=True,
        cwd=TESTS,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), str(TESTS.parent / "tools")])},
    )
    steps = journal.read_text().splitlines()[-40:] if journal.exists() else []
    assert run.returncode == 0, "\n".join([*steps, run.stdout[-3000:], run.stderr[-6000:]])
