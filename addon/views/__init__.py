# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the further views (helper cameras) are placed, and the rays that decide it."""
