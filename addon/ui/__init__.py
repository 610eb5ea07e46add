# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels, their buttons and the page of help."""
