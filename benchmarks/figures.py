# SPDX-License-Identifier: GPL-3.0-or-later
"""Matplotlib's figures as small WebP files."""


def save(figure, path, *, exact=False, dpi="figure"):
    """Write a figure as WebP and close it. exact: without loss, as plots want it; contact sheets are pictures."""
    from matplotlib import pyplot

    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=dpi, pil_kwargs={"lossless": exact, "quality": 90, "method": 6})
    pyplot.close(figure)
