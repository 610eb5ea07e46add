# SPDX-License-Identifier: GPL-3.0-or-later
"""python -m benchmarks.motion: motion.py."""

from .motion import main

if __name__ == "__main__":
    main()
