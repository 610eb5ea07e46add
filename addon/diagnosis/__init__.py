# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a scene, and the buttons that fix it."""
