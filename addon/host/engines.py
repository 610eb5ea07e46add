# SPDX-License-Identifier: GPL-3.0-or-later
"""Identifiers of render engines: EEVEE's, and those of ours. Files hold them, so they stay as they are."""

EEVEE = "BLENDER_EEVEE"
LIGHT = "AFTERLIGHT"  # of helper scenes: gathers (render/engine.py)
VIEWS = "AFTERLIGHT_SCOUT"  # of the scene that comes before the views: places them (render/views_engine.py)
REPLAY = "AFTERLIGHT_REPLAY"  # of a lit scene for a moment: hands EEVEE's passes back (render/relight.py)
