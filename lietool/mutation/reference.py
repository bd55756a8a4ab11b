"""A plate as it is without any mistake: what it is made of, its picture, and which sources it depends on."""

import hashlib
import io
import json
import platform
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib import metadata
from pathlib import Path

import numpy as np

from lietool import atomic, paths
from lietool.golden import numbers as numbers_
from lietool.mutation.scene import Shape

# What a plate shows does not depend on these.
_APART = ("lietool.verbs", "lietool.mutation", "lietool.cli", "lietool.gallery", "lietool.__main__")


@dataclass(frozen=True, eq=False)
class Reference:
    """A plate without a mistake.

    Parameters
    ----------
    plate : str
    shape : Shape
        What the picture is made of.
    numbers : Mapping[str, object]
        What it shows.
    image : (h, w, 3) uint8
    seconds : tuple of float
        How long drawing and rendering took.
    made_of : Mapping[str, str]
        The files that it depends on, and more, each with what it was.
    renderer : str
    """

    plate: str
    shape: Shape
    numbers: Mapping[str, object]
    image: np.ndarray
    seconds: tuple[float, float]
    made_of: Mapping[str, str]
    renderer: str

    @property
    def edition(self) -> str:
        """A digest of all that it depends on."""
        text = json.dumps([dict(self.made_of), self.renderer], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @property
    def current(self) -> bool:
        """Whether all that it depends on is still as it was."""
        return all(_now(name) == was for name, was in self.made_of.items())


def made_of(extra: Iterable[Path] = ()) -> dict[str, str]:
    """Say what everything that was drawn in this process depends on.

    Parameters
    ----------
    extra : iterable of Path
        Files beside those of the modules and shaders.

    Returns
    -------
    dict
        Names of files and packages, and digests or versions.
    """
    files = {Path(path) for path in extra if Path(path).is_file()}
    files |= {path for path in (paths.PACKAGE / "render" / "shaders").rglob("*") if path.is_file()}
    for name, module in list(sys.modules.items()):
        ours = name.startswith(("lietool.", "lietool_project.")) and not name.startswith(_APART)
        if ours and (file := getattr(module, "__file__", None)):
            files.add(Path(file))
    names = [*map(str, sorted(files)), "python", "numpy", "scipy"]
    return {name: _now(name) for name in names}


def write(file: Path, reference: Reference) -> None:
    """Keep a reference.

    Parameters
    ----------
    file : Path
    reference : Reference

    Raises
    ------
    OSError
        If it cannot be written; nothing is left behind.
    """
    about = {
        "plate": reference.plate,
        "size": list(reference.shape.size),
        "numbers": numbers_.dumps(reference.numbers),
        "seconds": list(reference.seconds),
        "made of": dict(reference.made_of),
        "renderer": reference.renderer,
    }
    arrays = {f"leaf {name}": array for name, array in reference.shape.leaves.items()}
    arrays |= {f"points {name}": array for name, array in reference.shape.points.items()}
    data = io.BytesIO()
    np.savez(data, about=np.array(json.dumps(about)), image=reference.image, **arrays)  # type: ignore[arg-type]
    atomic.write_bytes(file, data.getvalue())


def read(file: Path) -> Reference | None:
    """Read a reference that was kept; None where there is none, or what is there is none.

    Parameters
    ----------
    file : Path

    Returns
    -------
    Reference or None
    """
    import zipfile

    try:
        with np.load(io.BytesIO(file.read_bytes()), allow_pickle=False) as stored:
            arrays = {key: stored[key] for key in stored.files}
        about = json.loads(str(arrays["about"]))
        parts = {
            kind: {key.removeprefix(kind): a for key, a in arrays.items() if key.startswith(kind)}
            for kind in ("leaf ", "points ")
        }
        width, height = about["size"]
        drawing, rendering = about["seconds"]
        return Reference(
            about["plate"],
            Shape(parts["leaf "], parts["points "], (width, height)),
            numbers_.loads(about["numbers"]),
            arrays["image"],
            (drawing, rendering),
            about["made of"],
            about["renderer"],
        )
    except (OSError, ValueError, EOFError, KeyError, TypeError, zipfile.BadZipFile):
        return None


@lru_cache(maxsize=4096)
def _now(name: str) -> str:
    """What a file or a package is now; this process looks once."""
    if name == "python":
        return platform.python_version()
    if not name.startswith("/") and not Path(name).is_absolute():
        return metadata.version(name)
    try:
        return hashlib.sha256(Path(name).read_bytes()).hexdigest()[:16]
    except OSError:
        return "missing"
