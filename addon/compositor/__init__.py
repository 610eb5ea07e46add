# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes, helper scenes and passes that the Indirect Light checkbox adds to a file, and removes again."""
