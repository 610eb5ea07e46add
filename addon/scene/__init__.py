# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's scene in numbers: passes, cameras, materials, world."""
