"""Key transformations for `pose`: our example, or those in a file of the user."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lietool.deform import pose, pose_keys, probe_io, probe_motion, ways
from lietool.deform.probe_values import Table
from lietool.lie import polar, so3, sym
from lietool.mesh.files import Place

# Of each key: the axis and the angle in degrees of its rotation; the logarithm of its stretch, xx xy xz yy yz
# zz; and where the centre of the shape goes, in sizes of the shape.
_EXAMPLE = (
    ((0.0, 1.0, 0.0), 0.0, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (-0.9, 0.0, -1.45)),
    ((0.1, 1.0, 0.15), 150.0, (0.0, 0.0, 0.3, 0.2, 0.0, 0.0), (-0.8, 0.0, 1.1)),
    ((-0.1, 1.0, 0.2), 240.0, (0.0, -0.3, 0.0, 0.0, 0.0, 0.25), (0.8, 0.0, 1.1)),
    ((-0.3, 0.0, 1.0), 165.0, (0.0, 0.0, -0.25, 0.0, 0.0, 0.0), (0.9, 0.0, -1.45)),
)
# Of keys: each is a shape on the page, three times.
_MOST = 200
# How far a pose may be off, over the size of the shape, and by how much it may stretch.
_FARTHEST = 1e6
_UPPER = np.triu_indices(3)


@dataclass(frozen=True, eq=False)
class Given:
    """Keys A (k, 4, 4) at their times, rotation vectors that some are stated with, and the centre."""

    A: np.ndarray
    times: np.ndarray
    near: dict[int, np.ndarray]
    centre: np.ndarray

    def path(self, name: str, curve: str) -> pose.Path:
        """Return the path in the parameters of a way; ValueError where it has none for a key."""
        way = ways.named(name)
        near = self.near if name in ("phi_so", "phi_se") else None
        return pose.CURVES[curve](pose_keys.followed(way, self.A, self.times, self.centre, near=near))


def example(centre: np.ndarray, size: float) -> Given:
    """Return our keys for a shape of a size about its centre."""
    A, near = [], {}
    for k, (axis, degrees, stretch, place) in enumerate(_EXAMPLE):
        x = np.radians(degrees) * np.array(axis) / np.linalg.norm(axis)
        Y = np.zeros((3, 3))
        Y[_UPPER] = stretch
        A.append(_about(so3.exp(x) @ sym.exp(Y + Y.T - np.diag(np.diag(Y))), centre, size * np.array(place)))
        near[k] = x
    return Given(np.array(A), np.arange(float(len(A))), near, centre)


def read(path: Path, centre: np.ndarray, size: float) -> Given:
    """Return the keys in a file .toml or .json for a shape of a size about a centre.

    Raises
    ------
    ValueError
        It names the key and what is wrong with it.
    """
    place = Place("pose", path)
    top = probe_io.content(place)
    top.only(("centre", "key"))
    c = top.numbers("centre", (3,)) if "centre" in top.data else centre
    rest = np.eye(4)
    rest[:3, 3] = c
    A, times, near = [], [], {}
    tables = top.tables("key", "keys, with at least two [[key]]")
    if len(tables) > _MOST:
        place.fail(f"at most {_MOST} keys", f"{len(tables)}", remedy="Leave some out.")
    for k, value in enumerate(tables):
        label = f"key {k + 1}"
        entry = top.table(label, value, label)
        entry.only(("time", *probe_motion.KEYS))
        times.append(float(entry.numbers("time", ())) if "time" in entry.data else float(k))
        motion = {name: part for name, part in entry.data.items() if name != "time"}
        # A matrix moves space, as that of a handle does, so that 1 leaves a mesh where it is.
        before = np.eye(4) if "matrix" in motion else rest
        frame, turns, stated = probe_motion.read(Table(place, label, motion), before)
        A.append(pose.relative(before, frame))
        _oriented(entry, A[-1])
        _within(entry, A[-1], c, size)
        if stated:
            near[k] = so3.log(polar.rotation(frame[:3, :3])) + 2.0 * np.pi * turns
    _ordered(place, np.array(times))
    return Given(np.array(A), np.array(times), near, c)


def _oriented(entry: Table, A: np.ndarray) -> None:
    """Refuse what no rotation and stretch can be, and also what is that only by rounding."""
    d = np.linalg.svd(A[:3, :3], compute_uv=False)
    d[2] *= np.sign(np.linalg.det(A[:3, :3] / max(d[0], 1e-300)))
    if not d[2] > 1e-12 * d[0]:
        got = f"singular values {', '.join(f'{x:.3g}' for x in d)}"
        entry.fail("matrix", "of positive determinant", got, "Neither reflect nor flatten a pose.")


def _within(entry: Table, A: np.ndarray, centre: np.ndarray, size: float) -> None:
    """Refuse poses of which a picture, and their splines, would show nothing but rounding."""
    factor = np.linalg.norm(A[:3, :3], 2)
    away = np.linalg.norm(A[:3, :3] @ centre + A[:3, 3] - centre) / size
    if factor > _FARTHEST:
        entry.fail("", f"a pose that stretches by at most {_FARTHEST:g}", f"{factor:.3g}")
    if away > _FARTHEST:
        must = f"a pose within {_FARTHEST:g} times the shape's size, {size:.3g}"
        entry.fail("", must, f"{away:.3g} times it", "Write lengths in the shape's unit.")


def _ordered(place: Place, times: np.ndarray) -> None:
    if len(times) < 2:
        place.fail("keys, two or more", "one", remedy="Add another [[key]].")
    late = np.flatnonzero(np.diff(times) <= 0.0)
    if len(late):
        k = int(late[0]) + 1
        got = f"{times[k]:g} after {times[k - 1]:g}"
        place.fail(f"a file in which key {k + 1} has a later time than the one before", got)


def _about(L: np.ndarray, centre: np.ndarray, shift: np.ndarray) -> np.ndarray:
    A = np.eye(4)
    A[:3, :3], A[:3, 3] = L, centre + shift - L @ centre
    return A
