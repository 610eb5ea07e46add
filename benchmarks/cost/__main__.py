# SPDX-License-Identifier: GPL-3.0-or-later
"""python -m benchmarks.cost: bench.py."""

from .bench import main

if __name__ == "__main__":
    main()
