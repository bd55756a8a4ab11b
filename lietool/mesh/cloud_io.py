"""Read clouds of points, which have no faces: .xyz, and .ply without faces."""

import re
from pathlib import Path

import numpy as np

from lietool.lie import checks
from lietool.mesh import _surface_ply, topology
from lietool.mesh.files import Place, read_bytes, read_text
from lietool.mesh.surface import Mesh

_ROW = re.compile(rb"element\s+face\s+([1-9][0-9]*)")


def is_cloud(path: str | Path) -> bool:
    """Return whether a file is a cloud: an .xyz, or a .ply that says it has no faces.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    bool
        False also where there is no such file: who reads it as a mesh says so.
    """
    path = Path(path)
    if path.suffix.lower() == ".xyz":
        return True
    if path.suffix.lower() != ".ply":
        return False
    try:
        with path.open("rb") as file:
            head = file.read(1 << 16).partition(b"end_header")[0]
    except OSError:
        return False
    return head.startswith(b"ply") and not _ROW.search(head)


def read(path: str | Path) -> Mesh:
    """Return a cloud as a mesh without faces, in the order of the file.

    - .xyz: a line for each point with three numbers, separated by blanks or commas; what else stands there,
      such as normals, is left out, as is what follows a #.
    - .ply: with colours and all further numbers of the vertices.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    mesh : Mesh

    Raises
    ------
    ValueError
        If the file is none of these, cannot be read, is broken or has no points, with the line where it is
        known.
    """
    place = Place("cloud_io.read", Path(path))
    ending = place.path.suffix.lower()
    if ending == ".ply":
        mesh = _surface_ply.decode_cloud(place, read_bytes(place))
    elif ending == ".xyz":
        mesh = _decode_xyz(place, read_text(place))
    else:
        place.fail("a cloud, .xyz or .ply", ending or "no ending", remedy="Save it as one of these.")
    bad = np.any(~(np.abs(mesh.vertices) <= topology.LARGEST), axis=1)
    if bad.any():
        (k,) = checks.first(bad)
        place.fail("a cloud of finite points", f"{mesh.vertices[k].tolist()} as point {k}")
    return mesh


def _decode_xyz(place: Place, text: str) -> Mesh:
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition("#")[0].replace(",", " ").replace(";", " ").split()
        if not words:
            continue
        try:
            rows.append([float(word) for word in words[:3]])
        except ValueError:
            # Some programs write how many points there are, or a title, before them.
            if rows or number > 2:
                place.fail("lines of three numbers", repr(line.strip()[:40]), number)
            continue
        if len(words) < 3:
            if number == 1 and len(words) == 1:
                rows.pop()
                continue
            place.fail("lines of three numbers", f"{len(words)}", number)
    if not rows:
        place.fail("a cloud of points", "none")
    return Mesh(np.array(rows), np.zeros((0, 3), np.intp))
