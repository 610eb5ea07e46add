# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the further cameras are placed, and the rays that decide it."""
