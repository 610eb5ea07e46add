# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a benchmark in a process of its own: one that brings Blender down leaves the others' numbers alone, and the
peak of its memory is its own."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from . import ROOT


def measured(module, *arguments):
    """The dictionary that `python -m module arguments --into FILE` writes to the file; {"failed": why} where it writes
    none. Blender says a line a frame on stdout, which is not shown; what a person needs to know comes on stderr."""
    with tempfile.TemporaryDirectory(prefix="afterlight-apart-") as folder:
        into = Path(folder) / "entry.json"
        command = [sys.executable, "-m", module, *arguments, "--into", str(into)]
        code = subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL).returncode
        return json.loads(into.read_text()) if into.exists() else {"failed": f"Blender ended with code {code}"}
