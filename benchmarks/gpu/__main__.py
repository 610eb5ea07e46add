# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m benchmarks.gpu` is speed.py."""

import sys

from . import speed

if __name__ == "__main__":
    sys.exit(speed.main())
