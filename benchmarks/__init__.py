# SPDX-License-Identifier: GPL-3.0-or-later
"""What Afterlight is measured with; each module's docstring says what it measures and by which command."""
