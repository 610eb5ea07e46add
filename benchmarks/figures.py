# SPDX-License-Identifier: GPL-3.0-or-later
"""Matplotlib's figures as small WebP files, and the commit that a page was measured at."""

import subprocess

from . import ROOT


def save(figure, path, *, exact=False, dpi="figure"):
    """Write a figure as WebP and close it. exact: without loss, as plots want it; contact sheets are pictures."""
    from matplotlib import pyplot

    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=dpi, pil_kwargs={"lossless": exact, "quality": 90, "method": 6})
    pyplot.close(figure)


def commit():
    """The commit that is checked out, in short, with a word on changes that are not committed."""

    def git(*arguments):
        return subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True).stdout.strip()

    changed = git("status", "--porcelain", "--untracked-files=no")
    return (git("rev-parse", "--short", "HEAD") or "unknown") + (" with changes" if changed else "")
