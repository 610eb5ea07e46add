# SPDX-License-Identifier: GPL-3.0-or-later
"""What Afterlight is measured with; each module's docstring says what it measures and by which command."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Scripts of the repository that the benchmarks share: sample_blends/session.py, tests/scenes.py, tools/extension.py.
sys.path[:0] = [str(ROOT / folder) for folder in ("sample_blends", "tools", "tests")]
