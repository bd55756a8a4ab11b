"""Files of probes and of sequences of poses, TOML or JSON.

Lengths are in the units of the mesh, angles in degrees.  A file of probes::

    [[probe]]
    name = "root"                   # left out: its number, from 1
    centre = [0, 0, 0]              # it stays at rest: no `current`

    [[probe]]
    name = "tip"
    centre = [0, 0, 2]
    rotation = { axis = [0, 0, 1], degrees = 30 }   # of the frame at rest, or 3 rows of 3 numbers
    current = { axis = [0, 0, 1], degrees = 20, turns = 1, scale = [1, 1, 1.5], translation = [0, 0, 0.5] }

    [[probe]]
    name = "side"
    frame = [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]    # in place of centre and rotation

    [probe.current]
    matrix = [[0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]  # of the frame now

A motion is about the centre at rest: it stretches, turns, and translates.

    axis, degrees   by which it turns, about a direction of space
    turns           whole turns on top, about the axis; also beside `matrix`
    scale           a number, or three along the axes of the frame at rest
    stretch         or a symmetric matrix, 3 rows of 3 numbers, in space
    translation     of the centre, in space
    matrix          or, in place of all but axis and turns, where the frame is now

A sequence has the motions of probes by their names; who is not named stays as
in the pose before, first as in the file of probes::

    fps = 24

    [[pose]]
    tip = { axis = [0, 0, 1], degrees = 180 }

    [[pose]]
    tip = { axis = [0, 0, 1], degrees = 400 }
    side = { translation = [0, 1, 0] }

Motions in words state how far they turn, 400 degrees, and not 40; matrices do
not, and are followed from pose to pose.

A file of probes may also say which vertices of a mesh a probe holds, as
`handle_io` does, and, in a table that is handed on as it is, how it is weighed::

    [[probe]]
    centre = [0, 0, 2]
    handle = { ball = { centre = [0, 0, 2], radius = 0.3 } }

    [weights]
    kind = "harmonic"
"""

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool.deform import probe_motion
from lietool.deform.probe_values import Table, named, shown
from lietool.mesh.files import BROKEN, Place, read_text

Array = NDArray[np.float64]

_REST = ("name", "centre", "rotation", "frame", "handle", "current")


@dataclass(frozen=True)
class Probes:
    """Probes: names, frames (k, 4, 4) at rest and now, and whole turns (k, 3) that `probe.solve` takes.

    What takes a mesh to be understood is handed on: the `handles` of the probes, for `handle_io.chosen`,
    None where a probe has none; and the table of `weights`, if there is one.
    """

    names: tuple[str, ...]
    rest: Array
    current: Array
    turns: Array
    stated: NDArray[np.bool_]
    handles: tuple[Table | None, ...] = ()
    weights: Table | None = None


@dataclass(frozen=True)
class Poses:
    """A sequence: frames (f, k, 4, 4), turns (f, k, 3) and stated (f, k) for `probe.follow`, and fps."""

    frames: Array
    turns: Array
    stated: NDArray[np.bool_]
    fps: float


def read(path: str | Path) -> Probes:
    """Return the probes in a file.

    Book: 7.2

    Parameters
    ----------
    path : str or Path
        `.toml` or `.json`, as the head of this module says.

    Returns
    -------
    probes : Probes

    Raises
    ------
    ValueError
        If the file cannot be read, or something in it is wrong: with the probe and the key.
    """
    place = Place("probe_io.read", Path(path))
    return _probes(content(place))


def read_poses(path: str | Path, probes: Probes) -> Poses:
    """Return the sequence of poses in a file.

    Book: 7.2

    Parameters
    ----------
    path : str or Path
        `.toml` or `.json`, as the head of this module says.
    probes : Probes
        Whose poses they are.

    Returns
    -------
    poses : Poses

    Raises
    ------
    ValueError
        If the file cannot be read, or something in it is wrong: with the pose, the probe and the key.
    """
    top = content(Place("probe_io.read_poses", Path(path)))
    top.only(("pose", "fps"))
    fps = float(top.numbers("fps", ())) if "fps" in top.data else 24.0
    if not 0.0 < fps <= 1000.0:
        top.fail("fps", "above 0 and at most 1000", f"{fps:g}")
    now = [(c, t, s) for c, t, s in zip(probes.current, probes.turns, probes.stated, strict=True)]
    frames = []
    for i, value in enumerate(top.tables("pose", "a sequence, with at least one [[pose]]")):
        label = f"pose {i + 1}"
        pose = top.table(label, value, label)
        pose.only(probes.names)
        for name, motion in pose.data.items():
            k = probes.names.index(name)
            now[k] = probe_motion.read(pose.table(name, motion, f"{label}, probe {name}"), probes.rest[k])
        frames.append(list(now))
    matrices, turns, stated = (np.array([[p[j] for p in frame] for frame in frames]) for j in range(3))
    return Poses(matrices, turns, stated, fps)


def from_words(words: list[str]) -> Probes:
    """Return probes that are written on a line each: `name=tip centre=0,0,2 axis=0,0,1 degrees=380`.

    The keys are those of a file, of the probe and of its motion together; lists have commas.

    Book: 7.2

    Parameters
    ----------
    words : list of str

    Returns
    -------
    probes : Probes

    Raises
    ------
    ValueError
        If something is wrong: with the probe and the key.
    """
    place = Place("probe_io.from_words", Path("--probe"))
    entries = [_words(place, i, line) for i, line in enumerate(words)]
    return _probes(Table(place, "", {"probe": entries}))


def _words(place: Place, i: int, line: str) -> dict[str, Any]:
    """Return the table that a line of key=value stands for."""
    entry: dict[str, Any] = {}
    motion: dict[str, Any] = {}
    for word in line.split():
        key, equals, text = word.partition("=")
        known = ("name", "centre", *probe_motion.KEYS)
        if not equals or key not in known:
            Table(place, f"probe {i + 1}", {}).fail("", f"key=value with {', '.join(known)}", repr(word))
        if key in entry or key in motion:
            Table(place, f"probe {i + 1}", {}).fail(key, "given once", "it twice")
        part = entry if key in _REST else motion
        part[key] = text if key == "name" else _value(text)
    return {**entry, "current": motion} if motion else entry


def _value(text: str) -> object:
    """Return a number, a list of numbers, or the text if it is neither."""
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        return text
    return numbers if len(numbers) > 1 else numbers[0]


def content(place: Place) -> Table:
    """Return the outermost table of a file .toml or .json, for whoever reads such files.

    Parameters
    ----------
    place : Place

    Returns
    -------
    table : Table

    Raises
    ------
    ValueError
        If the file has another ending, cannot be read or is broken.
    """
    ending = place.path.suffix.lower()
    if ending not in (".toml", ".json"):
        place.fail("a file .toml or .json", ending or "no ending", remedy="Name it after what it holds.")
    text = read_text(place)
    try:
        data = tomllib.loads(text) if ending == ".toml" else json.loads(text, object_pairs_hook=_once)
    except BROKEN as error:
        place.fail(f"a {ending[1:].upper()} file", place.cause(error))
    return Table(place, "", {}).table("", data, "")


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return a table of JSON, whose reader would keep the last of several values without a word."""
    table = dict(pairs)
    if len(table) < len(pairs):
        keys = [key for key, _ in pairs]
        raise ValueError(f"the key {next(key for key in keys if keys.count(key) > 1)!r} twice in a table")
    return table


def _probes(top: Table) -> Probes:
    top.only(("probe", "weights"))
    names: list[str] = []
    rows, handles = [], []
    for entry in named(top, "probe", "a file of probes, with at least one [[probe]]", names):
        rest = _rest(entry)
        motion = entry.table("current", entry.data.get("current", {}), f"{entry.label}, current")
        rows.append((rest, *probe_motion.read(motion, rest)))
        handles.append(_table(entry, "handle", f"{entry.label}, handle"))
    rest, current, turns, stated = (np.array([row[j] for row in rows]) for j in range(4))
    weights = _table(top, "weights", "weights")
    return Probes(tuple(names), rest, current, turns, stated, tuple(handles), weights)


def _table(entry: Table, key: str, label: str) -> Table | None:
    return entry.table(key, entry.data[key], label) if key in entry.data else None


def _rest(entry: Table) -> Array:
    """Return the frame of a probe at rest."""
    entry.only(_REST)
    if "frame" in entry.data:
        for key in ("centre", "rotation"):
            if key in entry.data:
                entry.fail(key, "left out beside frame", shown(entry.data[key]))
        frame = entry.frame("frame")
        d = np.linalg.svd(frame[:3, :3], compute_uv=False)
        if not d[2] > 1e-12 * d[0]:
            entry.fail("frame", "invertible", f"singular values {d.tolist()}")
        return frame
    if "centre" not in entry.data:
        entry.fail("", "given a centre or a frame", "neither")
    frame = np.eye(4)
    frame[:3, 3] = entry.numbers("centre", (3,))
    if "rotation" in entry.data:
        frame[:3, :3] = probe_motion.rotation(entry, "rotation")
    return frame
