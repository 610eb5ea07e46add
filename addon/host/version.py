# SPDX-License-Identifier: GPL-3.0-or-later
"""The version of Afterlight that runs, as blender_manifest.toml has it. migration.py brings older files up to it."""

VERSION = 0, 4, 0
