# SPDX-License-Identifier: GPL-3.0-or-later
"""The light in rendered viewports while one works: what they see, what is gathered for it, and how it gets under the
overlays."""
