"""Where lietool keeps what it can make again: compiled shaders, labels of a user's own parameters.

A cache is a convenience: whatever is wrong with the folder (no home, read-only
disk, another user's files), the answer is another folder or none, never an error.
"""

import os
import stat
import sys
from pathlib import Path


def wanted() -> Path:
    """Return the folder that the environment asks for, whether or not it can be used.

    ``LIETOOL_CACHE_DIR``, else ``lietool`` in the system's place for caches.

    Returns
    -------
    Path
        An absolute path; nothing is made.
    """
    if own := os.environ.get("LIETOOL_CACHE_DIR"):
        try:
            return Path(own).absolute()
        except FileNotFoundError:
            # Relative to a folder that has been removed under us.
            return _temporary()
    # The XDG specification says that a relative path is to be ignored.
    xdg = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if xdg.is_absolute():
        return xdg / "lietool"
    try:
        home = Path.home()
    except RuntimeError:
        return _temporary()
    if not home.is_absolute():
        return _temporary()
    if sys.platform == "darwin":
        return home / "Library" / "Caches" / "lietool"
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or home, "lietool", "cache")
    return home / ".cache" / "lietool"


def folder(name: str = "") -> Path | None:
    """Return the cache folder, or the folder `name` in it, made and writable.

    Parameters
    ----------
    name : str
        The part of the cache, such as ``"labels"``; empty for the whole.

    Returns
    -------
    Path or None
        The wanted folder, else one in the folder for temporary files, else None.
    """
    root = wanted()
    if _usable(root / name):
        return root / name
    root = _temporary()
    # In a folder that everybody can write, only one that is ours alone can be trusted.
    if _usable(root) and _ours(root) and _usable(root / name):
        return root / name
    return None


def _temporary() -> Path:
    import tempfile

    user = os.getuid() if hasattr(os, "getuid") else "user"
    try:
        return Path(tempfile.gettempdir(), f"lietool-{user}")
    except FileNotFoundError:
        return Path(os.sep, f"lietool-{user}")


def _usable(path: Path) -> bool:
    try:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(path, os.R_OK | os.W_OK | os.X_OK)


def _ours(path: Path) -> bool:
    if not hasattr(os, "getuid"):
        return True
    status = path.lstat()
    return stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid() and not status.st_mode & 0o022
