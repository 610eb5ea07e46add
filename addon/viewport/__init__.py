# SPDX-License-Identifier: GPL-3.0-or-later
"""Indirect light in rendered viewports: what each sees, gathering its light, and adding that below the overlays."""
