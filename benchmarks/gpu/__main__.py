# SPDX-License-Identifier: GPL-3.0-or-later
"""python -m benchmarks.gpu: speed.py."""

from .speed import main

if __name__ == "__main__":
    main()
