# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m benchmarks.cost` is bench.py."""

import sys

from . import bench

if __name__ == "__main__":
    sys.exit(bench.main())
