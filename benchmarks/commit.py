# SPDX-License-Identifier: GPL-3.0-or-later
"""The commit that a page is measured at. How pages say it: tools/stale.py."""

import subprocess

from . import ROOT


def current():
    """The commit that is checked out, in short, with a word on changes that are not committed, but for pages."""

    def git(*arguments):
        return subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True).stdout.strip()

    changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs")
    return (git("rev-parse", "--short", "HEAD") or "unknown") + (" with changes" if changed else "")
