"""A golden folder as a whole: who may write to it, and what in it belongs to nobody."""

import contextlib
import errno
import os
from collections.abc import Collection, Iterator
from pathlib import Path

from lietool.golden import store


@contextlib.contextmanager
def lock(root: Path) -> Iterator[None]:
    """Keep other writers out of a golden folder until the block ends or the process dies, however it dies.

    The lock is on the folder itself, so there is no file to ignore or to leave behind.

    Parameters
    ----------
    root : Path
        The golden folder; made if it is missing.
    """
    root.mkdir(parents=True, exist_ok=True)
    try:
        import fcntl
    except ImportError:
        # Windows, where no renderer is canonical and so nothing is accepted.
        yield
        return
    handle = os.open(root, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX)
        except OSError as error:
            # A network folder without locks: better unguarded than unusable.
            if error.errno not in (errno.ENOLCK, errno.ENOTSUP, errno.EINVAL):
                raise
        yield
    finally:
        os.close(handle)


def unregistered(root: Path, places: Collection[store.Place]) -> list[Path]:
    """List the pictures and numbers in a golden folder that belong to no plate.

    Parameters
    ----------
    root : Path
        The golden folder.
    places : Collection of Place
        All plates that there are.

    Returns
    -------
    list of Path
        Sorted; labels and other kinds of files are not looked at.
    """
    known = {path for place in places for path in (place.png, place.json)}
    found = (path for ending in ("png", "json") for path in root.rglob(f"*.{ending}"))
    return sorted(p for p in found if p not in known and p.relative_to(root).parts[0] != store.LABELS)


def sweep(root: Path, places: Collection[store.Place]) -> list[Path]:
    """Remove the labels that no golden refers to; finish or remove what a killed writer left behind.

    The caller holds `lock`.  Nothing is removed unless all goldens are whole: one that is
    not may refer to any label.

    Parameters
    ----------
    root : Path
        The golden folder.
    places : Collection of Place
        All plates that there are.

    Returns
    -------
    list of Path
        The labels removed.
    """
    for left in root.rglob(".*.part"):
        left.unlink(missing_ok=True)
    for place in places:
        store.settle(place)
    try:
        used = {key for place in places for key in store.label_keys(store.provenance(place))}
    except store.GoldenError:
        return []
    # A golden without a plate may be one of a figure that is being renamed.
    if unregistered(root, places):
        return []
    unused = sorted(path for path in (root / store.LABELS).glob("*.png") if path.stem not in used)
    for path in unused:
        path.unlink(missing_ok=True)
    return unused
