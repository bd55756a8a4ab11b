"""Files that are either the old one or the new one, never half of each."""

import errno
import os
import tempfile
from pathlib import Path

# Of the name, in the temporary one: a name may be 255 bytes long, and a character takes up to four.
_STEM = 40


def write_bytes(path: Path, data: bytes) -> None:
    """Write `data` to `path` so that a kill at any moment leaves no torn file.

    Parameters
    ----------
    path : Path
        The file to write; its folder is made if it is missing.  Behind a link it is
        the file that the link leads to, and a file that is there keeps its mode.
    data : bytes
        The whole content.

    Raises
    ------
    OSError
        If the folder cannot be made or written, or `path` is a device, a pipe or a
        loop of links; nothing is left behind.
    """
    path, mode = target(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    # In the same folder, since a rename is atomic only within one file system.
    handle, name = tempfile.mkstemp(prefix=f".{path.name[:_STEM]}.", suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        Path(name).chmod(mode)
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def target(path: Path) -> tuple[Path, int]:
    """Return the file that writing to `path` replaces, and the mode that it will have.

    Parameters
    ----------
    path : Path
        As for `write_bytes`.

    Returns
    -------
    tuple of Path and int
        The file behind all links, and its permission bits.

    Raises
    ------
    OSError
        If it is read-only, a device, a pipe, a folder or a loop of links.
    """
    path = _ordinary(path)
    return path, _mode(path)


def _ordinary(path: Path) -> Path:
    """Follow links, and refuse what a rename would destroy: /dev/null has to stay a device."""
    try:
        target = path.resolve()
    except RuntimeError:
        target = path
    if target.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), str(path))
    if target.exists() and not target.is_file():
        if target.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        raise OSError(errno.EINVAL, "It is a device or a pipe, and no ordinary file", str(path))
    return target


def _mode(path: Path) -> int:
    """The mode of the file that is there, or that of any new file: a temporary one is private."""
    if path.exists():
        # A rename asks only for the folder; who made a file read-only wants it kept.
        if not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return path.stat().st_mode & 0o777
    umask = os.umask(0)
    os.umask(umask)
    return 0o666 & ~umask
