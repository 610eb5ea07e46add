# SPDX-License-Identifier: GPL-3.0-or-later
"""How light gets in and out of Blender: the wiring of scenes and compositor, the engine, the passes."""
