# SPDX-License-Identifier: GPL-3.0-or-later
"""Our temporary files. They lie in a folder of our own, and nothing but what we wrote is ever removed.

Blender's session folder alone is not enough: if Blender can't make one it uses the system's shared temporary folder.
Ours is made inside whichever it is, with an unguessable name and no access for other users.

Beside our files each Blender process holds a file lock, which ends with the process however that ends; so the next
start can tell which folders a killed process left. Process numbers would not do: they are reused, containers have their
own, and on Windows asking for one can kill the process.
"""

import os
import random
import re
import stat
import tempfile
import time
from contextlib import suppress

import bpy

try:
    import fcntl
except ImportError:
    import msvcrt  # Windows

FOLDER_PREFIX = "afterlight_"  # names of our folders begin with it
SESSION_PREFIX = "blender_"  # names of Blender's session folders begin with it
FILE_NAME = re.compile(r"passes_\d+(_\d+)?\.exr")  # names of our files
LOCK_NAME = ".lock"  # name of the lock file in each of our folders
MAX_SEARCH_SECONDS = 0.005  # seconds for removing abandoned folders; the rest is left for another start

# Whether files are addressed by a folder's descriptor, so that nobody can swap the folder in the meantime.
BY_DESCRIPTOR = {os.open, os.stat, os.unlink, os.rmdir} <= os.supports_dir_fd and os.listdir in os.supports_fd

_folders = []  # of _OwnFolder; the last one is written to. Global, as they live until Blender ends


def new(number, suffixes=("",)):
    """The path for the passes of the scene with this session_uid. Blender writes a file for each view of a scene that
    has several, with a suffix to its name; old files there are removed. Raises OSError if no folder can be written
    to."""
    path = os.path.join(_folder().path, f"passes_{number}.exr")
    for each in suffixes:
        with suppress(FileNotFoundError):
            os.unlink(suffixed(path, each))
    return path


def suffixed(path, suffix):
    """The path of a view's file, by the suffix of the view."""
    root, ending = os.path.splitext(path)
    return f"{root}{suffix}{ending}"


def remove(path):
    """Remove a file at a path from new(). Ignores missing files."""
    folder, name = os.path.split(path)
    if FILE_NAME.fullmatch(name) and any(each.path == folder for each in _folders):
        with suppress(OSError):
            os.unlink(path)


def check_regular(path):
    """Raise OSError if there is no regular file at `path`: reading a pipe would wait for ever."""
    if not _is_plain(os.lstat(path), stat.S_ISREG):
        raise OSError("it is no regular file")


def release():
    """Remove all our files and folders."""
    while _folders:
        _folders.pop().remove()


def release_at_exit():
    """Remove all our files and folders when the process ends without Blender's own cleanup, and Blender's session
    folder too if it is empty."""
    release()
    session = os.path.normpath(bpy.app.tempdir)
    if os.path.basename(session).startswith(SESSION_PREFIX):
        with suppress(OSError):
            os.rmdir(session)


def clear():
    """Remove folders that this user's killed Blender processes left among the temporary files, never those of a running
    one."""
    deadline = time.perf_counter() + MAX_SEARCH_SECONDS
    with suppress(OSError), _Folder(_base()) as base:
        names = [name for name in base.names() if name.startswith((FOLDER_PREFIX, SESSION_PREFIX))]
        first = random.randrange(len(names) + 1)  # start anywhere, so that every folder gets its turn
        for name in names[first:] + names[:first]:
            if time.perf_counter() > deadline:
                break
            (_remove_abandoned if name.startswith(FOLDER_PREFIX) else _clean_session)(base, name)


class _Folder:
    """An open folder. Inside another folder it is opened only if it belongs to this user and is no link. Raises
    OSError."""

    def __init__(self, path, within=None):
        if BY_DESCRIPTOR:
            flags = os.O_RDONLY | os.O_DIRECTORY | (os.O_NOFOLLOW if within else 0)
            self._handle = os.open(path, flags, dir_fd=within._handle if within else None)
        else:
            self._handle = os.path.join(within._handle, path) if within else path
        status = self.status()
        if within and not (_is_plain(status, stat.S_ISDIR) and _is_own(status)):
            self.close()
            raise PermissionError(f"{path} is another's, or a link")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if BY_DESCRIPTOR:
            os.close(self._handle)

    def status(self):
        return os.fstat(self._handle) if BY_DESCRIPTOR else os.lstat(self._handle)

    def names(self):
        return os.listdir(self._handle)

    def call(self, function, name, *arguments, **options):
        """Call a function of `os` that takes a path, for a name in this folder."""
        if BY_DESCRIPTOR:
            return function(name, *arguments, dir_fd=self._handle, **options)
        return function(os.path.join(self._handle, name), *arguments, **options)

    def is_file(self, name):
        return _is_plain(self.call(os.stat, name, follow_symlinks=False), stat.S_ISREG)

    def remove_files(self):
        """Remove our files, and nothing else."""
        for name in self.names():
            if FILE_NAME.fullmatch(name) and self.is_file(name):
                self.call(os.unlink, name)


class _OwnFolder:
    """The folder of this process. path: its own. under: Blender's temporary folder when it was made."""

    def __init__(self):
        self.under = bpy.app.tempdir
        os.makedirs(self.under, mode=0o700, exist_ok=True)  # the system may have cleaned it away
        self.path = tempfile.mkdtemp(prefix=FOLDER_PREFIX, dir=self.under)
        self._status = os.lstat(self.path)
        self._lock = _new_lock(self.path)

    def exists(self):
        """Whether it still exists and was not replaced by another."""
        try:
            return os.path.samestat(os.lstat(self.path), self._status)
        except OSError:
            return False

    def is_current(self):
        """Whether to write to it: Blender may use another folder by now, and the lock file may have been removed."""
        locked = self._lock is None or os.fstat(self._lock).st_nlink > 0
        return self.under == bpy.app.tempdir and locked and self.exists()

    def remove(self):
        if self._lock is not None:
            os.close(self._lock)
        within, name = os.path.split(self.path)
        with suppress(OSError), _Folder(within) as within:
            with _Folder(name, within) as folder:
                if not os.path.samestat(folder.status(), self._status):
                    return
                folder.remove_files()
                with suppress(FileNotFoundError):
                    folder.call(os.unlink, LOCK_NAME)
            within.call(os.rmdir, name)


def _folder():
    """The _OwnFolder to write to, made if necessary. Raises OSError."""
    if not _folders or not _folders[-1].is_current():
        _folders[:] = [each for each in _folders if each.exists() or each.remove()]  # older ones may hold files in use
        _folders.append(_OwnFolder())
    return _folders[-1]


def _base():
    """The system's temporary folder, in which Blender makes its session folder if it can."""
    folder = os.path.normpath(bpy.app.tempdir)
    return os.path.dirname(folder) if os.path.basename(folder).startswith(SESSION_PREFIX) else folder


def _clean_session(base, name):
    with suppress(OSError):
        with _Folder(name, base) as session:
            removed = [
                _remove_abandoned(session, child) for child in session.names() if child.startswith(FOLDER_PREFIX)
            ]
        if any(removed):
            base.call(os.rmdir, name)


def _remove_abandoned(within, name):
    """Remove one of our folders if nobody holds its lock. Returns whether it is gone."""
    try:
        with _Folder(name, within) as folder:
            lock = _open_lock(folder)
            try:
                _acquire(lock)
                folder.remove_files()
            finally:
                os.close(lock)
            folder.call(os.unlink, LOCK_NAME)
        within.call(os.rmdir, name)
        return True
    except OSError:  # no lock file, a held lock, another user's folder, or other files in it
        return False


def _new_lock(path):
    """The descriptor of a new lock file, locked; None if the file system has no locks. A folder without the file is
    never cleared by others."""
    made = os.path.join(path, LOCK_NAME if os.name == "nt" else f"{LOCK_NAME}.new")
    lock = os.open(made, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        _acquire(lock)
        if os.name != "nt":  # Windows can't rename open files
            os.rename(made, os.path.join(path, LOCK_NAME))  # only from here on can others try to lock it
        return lock
    except OSError:
        os.close(lock)
        with suppress(OSError):
            os.unlink(made)
        return None


def _open_lock(folder):
    if not folder.is_file(LOCK_NAME):
        raise OSError("it is no regular file")
    lock = folder.call(os.open, LOCK_NAME, os.O_RDWR | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    if not stat.S_ISREG(os.fstat(lock).st_mode):  # replaced in the meantime
        os.close(lock)
        raise OSError("it is no regular file")
    return lock


def _acquire(lock):
    """Lock an open file without waiting. Raises OSError if it is locked already, by this process or another."""
    if os.name == "nt":
        msvcrt.locking(lock, msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _is_plain(status, is_type):
    """Whether an os.stat_result is of this file type and no kind of link that Windows has."""
    return is_type(status.st_mode) and not getattr(status, "st_file_attributes", 0) & stat.FILE_ATTRIBUTE_REPARSE_POINT


def _is_own(status):
    return not hasattr(os, "geteuid") or status.st_uid == os.geteuid()


def register():
    clear()


def unregister():
    release()
