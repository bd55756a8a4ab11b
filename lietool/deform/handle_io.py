"""Files of pins and handles of a mesh, TOML or JSON.

Which vertices belong to one is said by their numbers, by balls and boxes, or by what is painted on the mesh;
of several of these every vertex counts.  Pins stay; a handle moves as a probe does, see `probe_io`, about its
centre, which is the mean of its vertices unless it is given::

    [[pin]]
    box = { low = [-1, -1, -0.1], high = [1, 1, 0.1] }

    [[pin]]
    attribute = { name = "held", above = 0.5 }      # above 0.5 unless given

    [[handle]]
    name = "tip"                                    # left out: its number, from 1
    ball = { centre = [0, 0, 2], radius = 0.3 }
    motion = { axis = [0, 0, 1], degrees = 400, translation = [0, 0, 0.5] }

    [[handle]]
    vertices = [17, 18, 21]                         # from 0
    centre = [1, 0, 0]
    motion = { matrix = [[0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]] }

A matrix is the transformation of space itself.  A vertex in a handle and in a pin belongs to the handle.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lietool.deform import probe_io, probe_motion
from lietool.deform.probe_values import Table, named, shown
from lietool.mesh.files import Place
from lietool.mesh.surface import Mesh

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

_PLACES = ("vertices", "ball", "box", "attribute")


@dataclass(frozen=True, eq=False)
class Handles:
    """Pins and handles of a mesh, as `poisson.prepare` and `poisson.solve` take them.

    Parameters
    ----------
    pins : ndarray of int
        All pinned vertices.
    names : tuple of str
        Of the k handles.
    vertices : tuple of ndarray of int
        Of each handle.
    centres : ndarray, shape (k, 3)
    A : ndarray, shape (k, 4, 4)
        What moves them.
    turns : ndarray, shape (k, 3)
        Axis times number of whole turns, on top of the principal rotation.
    """

    pins: Index
    names: tuple[str, ...]
    vertices: tuple[Index, ...]
    centres: Array
    A: Array
    turns: Array


def read(path: str | Path, mesh: Mesh) -> Handles:
    """Return the pins and handles in a file.

    Book: 7.3

    Parameters
    ----------
    path : str or Path
        `.toml` or `.json`, as the head of this module says.
    mesh : Mesh
        Whose vertices they are.

    Returns
    -------
    handles : Handles

    Raises
    ------
    ValueError
        If the file cannot be read, or something in it is wrong: with the pin or handle and the key.
    """
    top = probe_io.content(Place("handle_io.read", Path(path)))
    top.only(("pin", "handle"))
    pins = np.zeros(len(mesh.vertices), bool)
    for i, value in enumerate(top.tables("pin", "[[pin]] tables, or left out") if "pin" in top.data else []):
        entry = top.table("pin", value, f"pin {i + 1}")
        entry.only(_PLACES)
        pins |= _chosen(entry, mesh)
    owned = np.zeros(len(mesh.vertices), np.intp)
    names: list[str] = []
    rows = []
    for i, entry in enumerate(named(top, "handle", "a file of handles, with at least one [[handle]]", names)):
        entry.only(("name", "centre", "motion", *_PLACES))
        chosen = _chosen(entry, mesh)
        if np.any(owned[chosen]):
            k = int(np.flatnonzero(chosen & (owned > 0))[0])
            entry.fail("", "of vertices of its own", f"vertex {k}, which is handle {names[owned[k] - 1]}'s")
        owned[chosen] = i + 1
        rows.append((np.flatnonzero(chosen), *_motion(entry, mesh.vertices[chosen])))
    vertices, centres, A, turns = zip(*rows, strict=True)
    free = np.flatnonzero(pins & (owned == 0))
    return Handles(free, tuple(names), tuple(vertices), np.array(centres), np.array(A), np.array(turns))


def chosen(entry: Table, mesh: Mesh) -> Index:
    """Return the vertices that a table of `vertices`, `ball`, `box` and `attribute` says, and nothing else.

    Parameters
    ----------
    entry : Table
    mesh : Mesh
        Whose vertices they are.

    Returns
    -------
    vertices : (m,), int
        In increasing order, one at least.

    Raises
    ------
    ValueError
        If something in it is wrong: with the key.
    """
    entry.only(_PLACES)
    return np.flatnonzero(_chosen(entry, mesh))


def _chosen(entry: Table, mesh: Mesh) -> Mask:
    """Which vertices (n,) a pin or handle has."""
    V = mesh.vertices
    chosen = np.zeros(len(V), bool)
    if not any(key in entry.data for key in _PLACES):
        entry.fail("", f"given {', '.join(_PLACES[:-1])} or {_PLACES[-1]}", "none of them")
    if "vertices" in entry.data:
        chosen[_numbered(entry, len(V))] = True
    if "ball" in entry.data:
        part = entry.table("ball", entry.data["ball"], f"{entry.label}, ball")
        centre, radius = _pair(part, "centre", "radius", (3,), ())
        if not radius > 0.0:
            part.fail("radius", "above 0", shown(part.data["radius"]))
        chosen |= np.linalg.norm(V - centre, axis=1) <= radius
    if "box" in entry.data:
        part = entry.table("box", entry.data["box"], f"{entry.label}, box")
        low, high = _pair(part, "low", "high", (3,), (3,))
        if not np.all(low <= high):
            part.fail("high", f"at least low, {low.tolist()}", shown(part.data["high"]))
        chosen |= np.all((low <= V) & (high >= V), axis=1)
    if "attribute" in entry.data:
        chosen |= _painted(
            entry.table("attribute", entry.data["attribute"], f"{entry.label}, attribute"), mesh
        )
    if not chosen.any():
        extent = f"{np.round(V.min(axis=0), 4).tolist()} to {np.round(V.max(axis=0), 4).tolist()}"
        entry.fail("", "of at least one vertex", "none", f"The mesh goes from {extent}.")
    return chosen


def _numbered(entry: Table, count: int) -> Index:
    value = entry.data["vertices"]
    good = isinstance(value, list) and all(isinstance(k, int) and not isinstance(k, bool) for k in value)
    if not good:
        entry.fail("vertices", "a list of whole numbers", shown(value))
    for k in value:
        if not 0 <= k < count:
            entry.fail("vertices", f"numbers of the {count} vertices, from 0", f"{k}")
    return np.array(value, np.intp)


def _pair(
    part: Table, one: str, other: str, shape: tuple[int, ...], other_shape: tuple[int, ...]
) -> tuple[Array, Array]:
    part.only((one, other))
    for key in (one, other):
        if key not in part.data:
            part.fail("", f"given {one} and {other}", f"no {key}")
    return part.numbers(one, shape), part.numbers(other, other_shape)


def _painted(part: Table, mesh: Mesh) -> Mask:
    part.only(("name", "above"))
    found = mesh.numbers
    name = part.data.get("name")
    if not isinstance(name, str) or name not in found:
        part.fail(
            "name",
            f"numbers of the mesh's vertices, {', '.join(found) or 'of which it has none'}",
            shown(name),
        )
    least = part.numbers("above", ()) if "above" in part.data else 0.5
    return found[name] > least


def _motion(entry: Table, own: Array) -> tuple[Array, Array, Array]:
    """The centre of a handle with vertices (k, 3), what moves it, and its whole turns."""
    centre = entry.numbers("centre", (3,)) if "centre" in entry.data else own.mean(axis=0)
    motion = entry.table("motion", entry.data.get("motion", {}), f"{entry.label}, motion")
    rest = np.eye(4)
    if "matrix" not in motion.data:
        rest[:3, 3] = centre
    current, turns, _ = probe_motion.read(motion, rest)
    A = current @ np.linalg.inv(rest)
    d = np.linalg.svd(A[:3, :3], compute_uv=False)
    if not (np.linalg.det(A[:3, :3] / max(d[0], 1e-300)) > 0.0 and d[2] > 1e-12 * d[0]):
        motion.fail(
            "matrix", "of positive determinant", f"{np.linalg.det(A[:3, :3]):.3g}", "Reflect no handle."
        )
    return centre, A, turns
