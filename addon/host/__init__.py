# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a host: its main thread, handlers, temporary files, messages, and which scenes belong to Afterlight."""
