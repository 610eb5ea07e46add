# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers as the page of speeds writes them."""


def ms(seconds):
    """Milliseconds."""
    return three(1000 * seconds)


def three(number):
    """Three digits that count, but whole numbers whole."""
    return f"{number:.0f}" if number >= 100 else f"{number:.3g}"


def span(seconds):
    """The smallest and the largest, ms."""
    return f"{ms(min(seconds))} to {ms(max(seconds))}"
