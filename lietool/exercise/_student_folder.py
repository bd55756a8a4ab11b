"""The folder that a student's process runs in: its own, looked at while it runs, and removed."""

import contextlib
import functools
import os
import shutil
import tempfile
import time
from pathlib import Path

_PREFIX = "lietool-student-"
# Seconds: a younger one may belong to a grader that has not yet come to lock it.
_YOUNG = 60.0


class Folder:
    """A folder of its own for one process.

    It is locked while the grader lives, so that a later one knows what a killed one has left, and removes it.
    """

    def __init__(self) -> None:
        _sweep()
        self.path = os.path.realpath(tempfile.mkdtemp(prefix=_PREFIX))
        self._lock: int | None = os.open(self.path, os.O_RDONLY)
        _locks(self._lock)

    def written(self) -> tuple[int, int]:
        """Return how many bytes are in it, and how many files."""
        size = count = 0
        for folder, folders, files in os.walk(self.path):
            count += len(folders) + len(files)
            for name in files:
                with contextlib.suppress(OSError):
                    size += os.lstat(f"{folder}/{name}").st_size
        return size, count

    def remove(self) -> None:
        """Remove it and what is in it."""
        if self._lock is not None:
            shutil.rmtree(self.path, ignore_errors=True)
            os.close(self._lock)
            self._lock = None


def _locks(number: int) -> bool:
    """Lock an open folder; return whether nobody else has."""
    import fcntl

    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


@functools.cache
def _sweep() -> None:
    """Remove what graders have left that were killed."""
    for path in Path(tempfile.gettempdir()).glob(_PREFIX + "*"):
        with contextlib.suppress(OSError):
            found = path.lstat()
            if found.st_uid != os.getuid() or time.time() - found.st_mtime < _YOUNG:
                continue
            number = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_DIRECTORY)
            try:
                if _locks(number):
                    shutil.rmtree(path, ignore_errors=True)
            finally:
                os.close(number)
