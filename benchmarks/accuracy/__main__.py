# SPDX-License-Identifier: GPL-3.0-or-later
"""python -m benchmarks.accuracy: accuracy.py."""

from .accuracy import main

if __name__ == "__main__":
    main()
