"""Arrays that take seconds to make, kept in the cache folder and in memory."""

import hashlib
import io
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import numpy as np

from lietool import atomic, cache

Arrays = dict[str, np.ndarray]


SOLIDS = tuple(
    Path(__file__).with_name(f"{name}.py")
    for name in ("_creatures", "_even", "_flesh", "_implicit", "_sculptures", "solids", "topology")
)
"""What the solids are made by."""


@lru_cache(maxsize=4)
def _edition(makers: tuple[Path, ...]) -> str:
    """What the makers are made of: where a line of them changes, nothing kept before is used."""
    digest = hashlib.sha256()
    for file in makers:
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def kept(
    name: str, make: Callable[[], Arrays], part: str = "solids", makers: tuple[Path, ...] = SOLIDS
) -> Arrays:
    """Return the arrays kept under a name, made if there are none; a cache that does not work is as none.

    Parameters
    ----------
    name : str
        Says everything that the arrays depend on, in characters fit for a file's name.
    make : callable
    part : str
        Of the cache folder.
    makers : tuple of Path
        The files whose contents they depend on too.

    Returns
    -------
    dict of ndarray
        Not writable.
    """
    folder = cache.folder(part)
    file = folder / f"{name}-{_edition(makers)}.npz" if folder else None
    arrays = _read(file) if file else None
    if arrays is None:
        arrays = make()
        if file:
            _write(file, arrays)
    for array in arrays.values():
        array.setflags(write=False)
    return arrays


def _read(file: Path) -> Arrays | None:
    import zipfile

    try:
        # From memory: of a torn file NumPy would leave the handle open.
        with np.load(io.BytesIO(file.read_bytes()), allow_pickle=False) as stored:
            return {key: stored[key] for key in stored.files}
    except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile):
        return None


def _write(file: Path, arrays: Arrays) -> None:
    data = io.BytesIO()
    np.savez(data, **arrays)  # type: ignore[arg-type]
    try:
        atomic.write_bytes(file, data.getvalue())
    except OSError:
        return
