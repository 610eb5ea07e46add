# SPDX-License-Identifier: GPL-3.0-or-later
"""What a lit frame costs beside EEVEE's own."""
