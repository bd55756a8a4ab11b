"""Loading libraries: the system's, else those that ``run`` unpacked beside the interpreter."""

import ctypes
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

Open = Callable[[str], ctypes.CDLL]


def private_folders() -> list[Path]:
    """Return the library folders under ``sys.prefix/sys``, where ``run`` unpacks packages without root.

    Returns
    -------
    list of Path
        Existing folders, in a fixed order.
    """
    root = Path(sys.prefix, "sys")
    patterns = ("usr/lib/*-linux-gnu*", "lib/*-linux-gnu*", "usr/lib64", "lib64", "usr/lib")
    return [path for pattern in patterns for path in sorted(root.glob(pattern)) if path.is_dir()]


def load(
    names: Sequence[str], folders: Sequence[Path] | None = None, open_library: Open = ctypes.CDLL
) -> ctypes.CDLL:
    """Load a library from the system, else from private folders.

    Parameters
    ----------
    names : sequence of str
        Its names, the best first.
    folders : sequence of Path, optional
        Where to look when the system has none; `private_folders()` if not given.
    open_library : callable
        What opens a library by its name or path; raises OSError when it cannot.

    Returns
    -------
    ctypes.CDLL
        The library.

    Raises
    ------
    OSError
        If no copy can be loaded; the message says why the first one could not.
    """
    folders = private_folders() if folders is None else folders
    without, with_private = [], []
    for name in names:
        try:
            return open_library(name)
        except OSError as error:
            without.append(error)
    for path in (folder / name for folder in folders for name in names):
        if path.is_file():
            try:
                return _load_with_dependencies(path, folders, open_library)
            except OSError as error:
                with_private.append(error)
    raise (with_private or without)[0]


def _load_with_dependencies(path: Path, folders: Sequence[Path], open_library: Open) -> ctypes.CDLL:
    # The dynamic linker looks for dependencies in the system's folders only, but takes any library
    # of the right soname that is already loaded. So what it misses is loaded first, by its path.
    tried: set[str] = set()

    def attempt(target: Path) -> ctypes.CDLL:
        while True:
            try:
                return open_library(str(target))
            except OSError as error:
                missing = re.search(r"(?:^|\s)([\w.+-]+\.so[\w.]*)\b", str(error))
                name = missing[1] if missing else ""
                found = next((f / name for f in folders if name and (f / name).is_file()), None)
                if found is None or name in tried:
                    raise
                tried.add(name)
                attempt(found)

    return attempt(path)
