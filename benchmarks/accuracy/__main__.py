# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m benchmarks.accuracy` is accuracy.py."""

import sys

from . import accuracy

if __name__ == "__main__":
    sys.exit(accuracy.main(sys.argv[1:]))
