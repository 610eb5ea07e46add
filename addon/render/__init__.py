# SPDX-License-Identifier: GPL-3.0-or-later
"""A render job from its first handler to its last: the engines that Blender calls, and what goes from frame to
frame."""
