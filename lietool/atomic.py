"""Files that are either the old one or the new one, never half of each."""

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
        The file to write; its folder is made if it is missing.
    data : bytes
        The whole content.

    Raises
    ------
    OSError
        If the folder cannot be made or written; nothing is left behind.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    # In the same folder, since a rename is atomic only within one file system.
    handle, name = tempfile.mkstemp(prefix=f".{path.name[:_STEM]}.", suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        # mkstemp makes private files; a picture should be as readable as any other file.
        umask = os.umask(0)
        os.umask(umask)
        Path(name).chmod(0o666 & ~umask)
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
