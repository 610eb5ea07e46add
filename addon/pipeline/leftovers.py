# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that a killed Blender left in the temporary folder, and how the next one knows that they are nobody's.

Beside our files each Blender holds a lock, which ends with its process however that ends. Process numbers would not do:
they are used again, containers have their own, and to ask after one on Windows is to kill it.
"""

import os
import random
import stat
import time

import bpy

try:
    import fcntl
except ImportError:
    import msvcrt  # Windows

PREFIX = "afterlight_"      # of all our files
LOCK = ".afterlight.lock"   # one in each folder that holds some
LONGEST = 0.005             # seconds that looking may take: folders that are left then wait for another start

_lock = None


def claim(folder):
    """Keep other Blenders from clearing `folder`, before a file is written there."""
    global _lock
    path = os.path.join(folder, LOCK)
    if _lock is not None and _lock.name == path and os.path.exists(path):
        return
    release()
    try:
        _lock = open(path, "wb")
        _take(_lock)
    except OSError:  # no locks on this file system: without the file nobody clears the folder
        release()


def release():
    """No files of ours are left there."""
    global _lock
    if _lock is not None:
        _lock.close()
        _remove(_lock.name)
        _lock = None


def clear():
    """Remove what killed Blenders left beside our own temporary folder: never what belongs to one that runs."""
    end = time.perf_counter() + LONGEST
    base = os.path.dirname(os.path.normpath(bpy.app.tempdir))
    try:
        folders = [name for name in os.listdir(base) if name.startswith("blender_")]
    except OSError:
        return
    first = random.randrange(len(folders) + 1)  # so that every folder has its turn
    for folder in folders[first:] + folders[:first]:
        if time.perf_counter() > end:
            break
        _clear(os.path.join(base, folder))


def _clear(folder):
    path = os.path.join(folder, LOCK)
    try:
        if not stat.S_ISREG(os.lstat(path).st_mode):
            return
        with open(path, "r+b") as lock:
            _take(lock)
            for name in os.listdir(folder):
                if name.startswith(PREFIX):
                    _remove(os.path.join(folder, name))
        os.remove(path)
        os.rmdir(folder)
    except OSError:  # no lock, a lock that is held, another user's folder, or other files in it
        pass


def _take(lock):
    """The lock of an open file, at once. Raises OSError where another holds it, in this process or elsewhere."""
    if os.name == "nt":
        msvcrt.locking(lock.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _remove(path):
    try:
        os.remove(path)
    except OSError:
        pass


def register():
    clear()


def unregister():
    release()
