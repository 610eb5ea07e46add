# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's scene as numbers: passes, cameras, materials, world."""
