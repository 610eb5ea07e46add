# SPDX-License-Identifier: GPL-3.0-or-later
"""Our temporary files: they lie in a folder of our own, and only what we wrote is ever removed.

Blender's folder alone would not do: where Blender can't make one it takes the folder of everybody's temporary files.
Ours is made within, with a name that nobody can guess and no access for other users.

Beside our files each Blender holds a lock, which ends with its process however that ends: so the next start knows what
a killed one left. Process numbers would not do: they are used again, containers have their own, and to ask after one on
Windows is to kill it.
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

FOLDER_PREFIX = "afterlight_"  # of our folders
SESSION_PREFIX = "blender_"  # of the folders that Blender makes for its sessions
FILE_NAME = re.compile(r"passes_\d+\.exr")  # the names of our files
LOCK_NAME = ".lock"  # one in each of our folders
MAX_SEARCH_SECONDS = 0.005  # seconds that looking may take: folders that are left then wait for another start

# Whether folders are worked in by their descriptors, so that nobody can put others in their places meanwhile.
BY_DESCRIPTOR = {os.open, os.stat, os.unlink, os.rmdir} <= os.supports_dir_fd and os.listdir in os.supports_fd

_folders = []  # of _Own; the last is the one that is written to


def new(number):
    """The path to write the passes of the scene with this session_uid to; what stood there is removed. Raises OSError
    where there is no place to write to."""
    path = os.path.join(_folder().path, f"passes_{number}.exr")
    with suppress(FileNotFoundError):
        os.unlink(path)
    return path


def remove(path):
    """Remove a file whose path new() gave; no error where it is gone."""
    folder, name = os.path.split(path)
    if FILE_NAME.fullmatch(name) and any(each.path == folder for each in _folders):
        with suppress(OSError):
            os.unlink(path)


def check_regular(path):
    """Raises OSError where there is no regular file at `path`: to read a pipe would wait for ever."""
    if not _is_plain(os.lstat(path), stat.S_ISREG):
        raise OSError("it is no regular file")


def release():
    """Remove all our files and folders."""
    while _folders:
        _folders.pop().remove()


def release_at_exit():
    """As release(), where the process ends without Blender's own clearing up: its folder goes too if it is empty."""
    release()
    session = os.path.normpath(bpy.app.tempdir)
    if os.path.basename(session).startswith(SESSION_PREFIX):
        with suppress(OSError):
            os.rmdir(session)


def clear():
    """Remove what killed Blenders of this user left among the temporary files: never what belongs to one that runs."""
    end = time.perf_counter() + MAX_SEARCH_SECONDS
    with suppress(OSError), _Folder(_base()) as base:
        names = [name for name in base.names() if name.startswith((FOLDER_PREFIX, SESSION_PREFIX))]
        first = random.randrange(len(names) + 1)  # so that every folder has its turn
        for name in names[first:] + names[:first]:
            if time.perf_counter() > end:
                break
            (_remove_abandoned if name.startswith(FOLDER_PREFIX) else _clean_session)(base, name)


class _Folder:
    """A folder to work in. Within another it is only opened where it is this user's, and no link. Raises OSError."""

    def __init__(self, path, within=None):
        if BY_DESCRIPTOR:
            flags = os.O_RDONLY | os.O_DIRECTORY | (os.O_NOFOLLOW if within else 0)
            self._place = os.open(path, flags, dir_fd=within._place if within else None)
        else:
            self._place = os.path.join(within._place, path) if within else path
        found = self.state()
        if within and not (_is_plain(found, stat.S_ISDIR) and _is_own(found)):
            self.close()
            raise PermissionError(f"{path} is another's, or a link")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if BY_DESCRIPTOR:
            os.close(self._place)

    def state(self):
        return os.fstat(self._place) if BY_DESCRIPTOR else os.lstat(self._place)

    def names(self):
        return os.listdir(self._place)

    def call(self, function, name, *arguments, **options):
        """Call a function of `os` that takes a path for something in the folder."""
        if BY_DESCRIPTOR:
            return function(name, *arguments, dir_fd=self._place, **options)
        return function(os.path.join(self._place, name), *arguments, **options)

    def is_file(self, name):
        return _is_plain(self.call(os.stat, name, follow_symlinks=False), stat.S_ISREG)

    def remove_files(self):
        """Remove our files, and nothing else that may be there."""
        for name in self.names():
            if FILE_NAME.fullmatch(name) and self.is_file(name):
                self.call(os.unlink, name)


class _OwnFolder:
    """A folder of this process. path: its own. under: Blender's temporary folder at that time."""

    def __init__(self):
        self.under = bpy.app.tempdir
        os.makedirs(self.under, mode=0o700, exist_ok=True)  # a cleaner of the system's may have removed it
        self.path = tempfile.mkdtemp(prefix=FOLDER_PREFIX, dir=self.under)
        self._made = os.lstat(self.path)
        self._lock = _new_lock(self.path)

    def stands(self):
        """Whether it is still there, and no other in its place."""
        try:
            return os.path.samestat(os.lstat(self.path), self._made)
        except OSError:
            return False

    def is_current(self):
        """Whether to write to it: Blender may have another folder by now, and somebody may have removed the lock."""
        locked = self._lock is None or os.fstat(self._lock).st_nlink > 0
        return self.under == bpy.app.tempdir and locked and self.stands()

    def remove(self):
        if self._lock is not None:
            os.close(self._lock)
        within, name = os.path.split(self.path)
        with suppress(OSError), _Folder(within) as within:
            with _Folder(name, within) as folder:
                if not os.path.samestat(folder.state(), self._made):
                    return
                folder.remove_files()
                with suppress(FileNotFoundError):
                    folder.call(os.unlink, LOCK_NAME)
            within.call(os.rmdir, name)


def _folder():
    """The _Own to write to, made where there is none. Raises OSError."""
    if not _folders or not _folders[-1].is_current():
        _folders[:] = [each for each in _folders if each.stands() or each.remove()]  # others hold files that are in use
        _folders.append(_OwnFolder())
    return _folders[-1]


def _base():
    """The folder of everybody's temporary files, in which Blender makes one for the session where it can."""
    folder = os.path.normpath(bpy.app.tempdir)
    return os.path.dirname(folder) if os.path.basename(folder).startswith(SESSION_PREFIX) else folder


def _clean_session(base, name):
    with suppress(OSError):
        with _Folder(name, base) as session:
            cleared = [_remove_abandoned(session, each) for each in session.names() if each.startswith(FOLDER_PREFIX)]
        if any(cleared):
            base.call(os.rmdir, name)


def _remove_abandoned(within, name):
    """Remove a folder of ours where nobody holds its lock. Returns whether it is gone."""
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
    except OSError:  # no lock, a lock that is held, another user's folder, or other files in it
        return False


def _new_lock(path):
    """The descriptor of a new lock that is held, or None where the file system has no locks: nobody clears a folder
    without the file."""
    made = os.path.join(path, LOCK_NAME if os.name == "nt" else f"{LOCK_NAME}.new")
    lock = os.open(made, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        _acquire(lock)
        if os.name != "nt":  # which renames no open files
            os.rename(made, os.path.join(path, LOCK_NAME))  # only now may others try it
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
    if not stat.S_ISREG(os.fstat(lock).st_mode):  # changed since
        os.close(lock)
        raise OSError("it is no regular file")
    return lock


def _acquire(lock):
    """The lock of an open file, at once. Raises OSError where another holds it, in this process or elsewhere."""
    if os.name == "nt":
        msvcrt.locking(lock, msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _is_plain(found, is_kind):
    """Whether an os.stat_result is of a kind, and of no link of any sort that Windows has."""
    return is_kind(found.st_mode) and not getattr(found, "st_file_attributes", 0) & stat.FILE_ATTRIBUTE_REPARSE_POINT


def _is_own(found):
    return not hasattr(os, "geteuid") or found.st_uid == os.geteuid()


def register():
    clear()


def unregister():
    release()
