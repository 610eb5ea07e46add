# SPDX-License-Identifier: GPL-3.0-or-later
"""Identifiers of render engines: EEVEE's and Afterlight's. They are stored in files and must not change."""

EEVEE = "BLENDER_EEVEE"
LIGHT = "AFTERLIGHT"  # the helper scene's engine, which gathers the light (render/engine.py)
VIEWS = "AFTERLIGHT_SCOUT"  # the engine that places the views, before they are rendered (render/views_engine.py)
REPLAY = "AFTERLIGHT_REPLAY"  # the lit scene's for one render: returns EEVEE's kept passes (render/relight.py)
