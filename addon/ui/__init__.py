# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels, operators and the help page."""
