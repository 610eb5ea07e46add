# SPDX-License-Identifier: GPL-3.0-or-later
"""A case again and again, and a series of cases as far as patience goes: the same for both methods."""

import sys
import time
from statistics import median

from . import opengl

REPEATS = 9  # after one frame to warm up
FEWEST = 3  # of slow frames
PATIENCE = 20.0  # seconds: a case that needs more for FEWEST frames is left out


def frames(light, gather, found, patience=PATIENCE, wall=False, between=lambda: None):
    """Fill found["gpu"], one number a frame, and found["passes"], {pass: {"dispatches", "seconds": one number a frame}}
    with the GPU's seconds of REPEATS calls of gather(), or of FEWEST if they take longer than `patience` seconds.

    wall: fill found["wall"] too, with the seconds on the clock of calls of their own, without timers. between():
    something to measure in turn with the frames. The first call warms up and must have been made."""
    found |= {"gpu": [], "wall": [], "passes": {}}
    first, counts = time.perf_counter(), {}
    while len(found["gpu"]) < REPEATS:
        if len(found["gpu"]) >= FEWEST and time.perf_counter() - first > patience:
            break
        between()
        with opengl.timed(light) as dispatches:
            gather()
        found["gpu"].append(sum(map(sum, dispatches.values())))
        for name, seconds in dispatches.items():
            found["passes"].setdefault(name, {"dispatches": 0, "seconds": []})["seconds"].append(sum(seconds))
            counts.setdefault(name, []).append(len(seconds))
        if wall:
            start = time.perf_counter()
            gather()
            found["wall"].append(time.perf_counter() - start)
    for name, each in counts.items():
        found["passes"][name]["dispatches"] = sorted(each)[len(each) // 2]  # a slow moment makes more, shorter bands
    return found


def series(cases, patience=PATIENCE):
    """The runs of a series, cheapest first, as far as patience goes. cases: (what it is, in words; cost, in any unit;
    function that runs it; whether that only looks up what has been run)."""
    runs, slow = [], 0.0
    for name, cost, run, is_known in cases:
        if not is_known and slow * cost > patience / FEWEST:
            say(f"left out: {name} would take {slow * cost:.1f} s a frame")
            break
        runs.append(run())
        slow = median(runs[-1]["gpu"]) / cost
    return runs


def say(text):
    print(text, file=sys.stderr, flush=True)
