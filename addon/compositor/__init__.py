# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes, helper scenes and passes that ticking the box puts into a file, and unticking takes out."""
