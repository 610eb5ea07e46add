# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies that decided something once; each says at which commit it was run."""
