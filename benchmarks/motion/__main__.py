# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m benchmarks.motion` is motion.py."""

import sys

from . import motion, motion_farm

if __name__ == "__main__":
    sys.exit(motion.main(sys.argv[1:], motion_farm))
