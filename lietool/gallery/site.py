"""The folder of a page: every file is the old one or the new one, and what is not ours is never touched.

Pictures and numbers have a part of their digest in their names, so those of an old and of a new page can
lie side by side. They are written first, the page that names them last, and what it does not name is
removed after that: a run killed at any moment leaves the old page or the new one, whole.
"""

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from lietool import atomic

PAGE = "index.html"
# Its presence says that the folder is ours, also after a first run that was killed.
MARK = ".lietool-gallery"
_MARK_TEXT = (
    b"Written by `lietool figures gallery`, which removes from this folder what its page does not name.\n"
)
_ASSET = re.compile(r"[A-Za-z0-9][A-Za-z0-9.-]*\.[0-9a-f]{10}\.(png|json)")
_FOLDERS = ("pictures", "numbers")


def named(folder: str, stem: str, data: bytes, ending: str) -> str:
    """Return the path of an asset within the page's folder, made from its content."""
    return f"{folder}/{stem}.{hashlib.sha256(data).hexdigest()[:10]}.{ending}"


def stranger(folder: Path) -> str:
    """Return why a folder must not be written into; empty if it may.

    Parameters
    ----------
    folder : Path
        Where a page is to go; it need not exist.

    Returns
    -------
    str
        What is in it that no page of ours has.
    """
    if not folder.exists():
        return ""
    if not folder.is_dir():
        return "it is a file"
    inside = sorted(folder.iterdir())
    if inside and not (folder / MARK).is_file():
        return f"it holds {inside[0].name} and was not made by `lietool figures gallery`"
    for path in inside:
        parts = sorted(path.iterdir()) if path.name in _FOLDERS and path.is_dir() else [path]
        for part in parts:
            # What is removed later are files: a folder with the name of one holds somebody else's.
            folded = part.is_dir() and part.relative_to(folder).as_posix() not in _FOLDERS
            if folded or not _is_ours(part.relative_to(folder)):
                return f"it holds {part.relative_to(folder)}, which no gallery has"
    return ""


def publish(folder: Path, page: bytes, assets: Mapping[str, bytes]) -> list[Path]:
    """Write a page with its assets, and remove what an older one left.

    The caller has seen that the folder is no stranger's, and lets no other gallery write to it.  But
    drawing takes minutes: what somebody has put there meanwhile stays.

    Parameters
    ----------
    folder : Path
        Where to.
    page : bytes
        The page.
    assets : Mapping[str, bytes]
        By `named`.

    Returns
    -------
    list of Path
        What was removed.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    atomic.write_bytes(folder / MARK, _MARK_TEXT)
    for name, data in assets.items():
        path = folder / name
        # The name holds the digest: what is there and whole need not be written again.
        if not path.is_file() or path.read_bytes() != data:
            atomic.write_bytes(path, data)
    atomic.write_bytes(folder / PAGE, page)
    kept = {PAGE, MARK, *assets}
    old = [
        path
        for path in sorted(folder.rglob("*"))
        if path.is_file() and _is_ours(path.relative_to(folder)) and _name(path, folder) not in kept
    ]
    for path in old:
        path.unlink(missing_ok=True)
    return old


def _name(path: Path, folder: Path) -> str:
    return path.relative_to(folder).as_posix()


def _is_ours(path: Path) -> bool:
    name = PurePosixPath(path.as_posix())
    if name.suffix == ".part" and name.name.startswith("."):
        return True
    if len(name.parts) == 1:
        # A folder that holds nothing yet.
        return name.name in (PAGE, MARK, *_FOLDERS)
    return len(name.parts) == 2 and name.parts[0] in _FOLDERS and _ASSET.fullmatch(name.name) is not None
