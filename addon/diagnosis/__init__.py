# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems of a scene that keep the light out of it, and the buttons that fix them."""
