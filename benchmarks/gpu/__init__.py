# SPDX-License-Identifier: GPL-3.0-or-later
"""The gather alone on the GPU, pass by pass."""
