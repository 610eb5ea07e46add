# SPDX-License-Identifier: GPL-3.0-or-later
"""Error, flicker, lag and trails in moving shots."""
