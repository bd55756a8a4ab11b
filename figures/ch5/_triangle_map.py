"""The map between the two triangles of `triangle-interp`, its factors, and the ways to it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from lietool.figure import Library
from lietool.interp import triangle
from lietool.lie import so2
from lietool.render import style

AFFINE_MAP = Library("lietool.interp.triangle.affine_map")
ARAP = Library("lietool.interp.triangle.arap")
LOGEXP = Library("lietool.interp.triangle.logexp")
METHODS: Mapping[str, triangle.Homotopy] = {
    "linear": triangle.linear,
    "arap": ARAP,
    "logexp": LOGEXP,
    "matrix-log": triangle.matrix_log,
}
NAMES = {
    "linear": "A^L(t)",
    "arap": "A^P(t)",
    "logexp": "A^E(t)",
    "matrix-log": "A^t",
}
COLORS = {
    "linear": (style.ROUTE_1, style.ROUTE_1_TEXT),
    "arap": (style.RIGHT, style.ALGEBRA_TEXT),
    "logexp": (style.GROUP, style.GROUP_TEXT),
    "matrix-log": (style.ROUTE_2, style.ROUTE_2_TEXT),
}
# What tells the ways apart without colour.
DASHES = {"linear": (3.0, 6.0), "arap": None, "logexp": (22.0, 6.0), "matrix-log": (11.0, 7.0)}
# Triangles with less area than this, relative to the square of their longest side, are lines.
_FLAT = 1e-6


@dataclass(frozen=True, eq=False)
class Map:
    """The linear part A = R S of the map from one triangle to the other, with the angle of R that is wanted.

    Parameters
    ----------
    source : ndarray, shape (3, 2)
        The corners of the triangle at t = 0.
    target : ndarray, shape (3, 2)
        Those at t = 1.
    affine : ndarray, shape (3, 3)
        The map between them.
    angle : float
        Of R, radians, with its full turns.
    ways : mapping from str to callable
        The homotopies by the names of the methods.
    """

    source: np.ndarray
    target: np.ndarray
    affine: np.ndarray
    angle: float
    ways: Mapping[str, triangle.Homotopy] = field(default_factory=lambda: METHODS)

    @property
    def A(self) -> np.ndarray:
        """The linear part."""
        return self.affine[:2, :2]

    @cached_property
    def R(self) -> np.ndarray:
        """The rotation in A = R S."""
        return so2.exp(self.angle)

    @cached_property
    def S(self) -> np.ndarray:
        """The stretch in A = R S."""
        return _symmetric(self.R.T @ self.A)

    @cached_property
    def symmetric(self) -> "Map":
        """The map by S alone."""
        affine = np.eye(3)
        affine[:2, :2] = self.S
        return Map(self.source, self.about_middle @ self.S.T, affine, 0.0, self.ways)

    @cached_property
    def about_middle(self) -> np.ndarray:
        """The corners of the source from their middle; shape (3, 2)."""
        return self.source - self.source.mean(axis=0)

    @property
    def has_log(self) -> bool:
        """Whether A has a real logarithm."""
        return bool(triangle.has_real_log(self.A))

    def exists(self, method: str) -> bool:
        """Return whether a method reaches this map."""
        return method != "matrix-log" or self.has_log

    def at(self, method: str, t: np.ndarray | float) -> np.ndarray:
        """Return A(t) by a method; shape (*t, 2, 2)."""
        return self.ways[method](self.A, t, self.angle)

    def angles(self, method: str, t: np.ndarray) -> np.ndarray:
        """Return the angles of rotation of A(t), without jumps from the 0 of t = 0; radians."""
        t = np.asarray(t, float)
        if method in ("arap", "logexp"):
            return t * self.angle
        turned = t * _turning(self.A) if method == "matrix-log" else 0.0 * t
        a = triangle.coordinates(self.at(method, t))[0]
        # A(t) is never a quarter turn away from an even one.
        return turned + np.where(np.abs(a) > 1e-12, np.angle(a * np.exp(-1j * turned)), 0.0)

    def stretches(self, method: str, t: np.ndarray) -> np.ndarray:
        """Return the symmetric factors of A(t), positive definite or not; shape (*t, 2, 2)."""
        turned = so2.exp(self.angles(method, t))
        return _symmetric(np.swapaxes(turned, -1, -2) @ self.at(method, t))

    def exits(self, method: str) -> np.ndarray:
        """Return the t at which A(t) is singular, in order."""
        if method == "linear":
            values = np.linalg.eigvals(self.A)
            # An eigenvalue 1 stays 1; rounding takes a double one off the real line.
            values = values[np.abs(values.imag) <= 1e-9 * np.abs(values)].real
        elif method == "arap":
            values = np.linalg.eigvalsh(self.S)
        else:
            return np.zeros(0)
        values = values[np.abs(values - 1.0) > 1e-9]
        return np.unique(np.round(1.0 / (1.0 - values), 12))


def read(
    source: tuple[float, ...],
    target: tuple[float, ...],
    turns: int,
    affine_map: Callable[..., np.ndarray] = AFFINE_MAP,
    ways: Mapping[str, triangle.Homotopy] = METHODS,
) -> Map:
    """Return the map between two triangles, each six numbers; the second may be the four of a matrix.

    Raises
    ------
    ValueError
        If a triangle is flat, or one is the mirror image of the other.
    """
    if len(target) not in (4, 6):
        raise ValueError(
            f"target must be six numbers, its corners, or four, a matrix row by row; got {len(target)}. "
            "Write x1,y1,x2,y2,x3,y3 or a,b,c,d"
        )
    p = np.array(source).reshape(3, 2)
    # A matrix moves the corners about their middle, and the result stays there.
    middle = p.mean(axis=0)
    if len(target) == 4:
        q = middle + (p - middle) @ np.array(target).reshape(2, 2).T
    else:
        q = np.array(target).reshape(3, 2)
    areas = [_area("source", p), _area("target", q)]
    if areas[0] * areas[1] < 0.0:
        raise ValueError(
            f"target must not be a mirror image, whose map has det A < 0; got det A = "
            f"{areas[1] / areas[0]:.3g}. Exchange two corners of one triangle"
        )
    affine = affine_map(p, q)
    angle = float(triangle.principal_angle(affine[:2, :2])) + 2.0 * np.pi * turns
    return Map(p, q, affine, angle, ways)


def numbers(given: Map, methods: tuple[str, ...], times: np.ndarray, t: float) -> dict[str, object]:
    """Return what a picture of some methods shows: the map, its factors, and A(t) where it exists."""
    values = np.linalg.eigvals(given.A)
    found: dict[str, object] = {
        "affine": given.affine,
        "R": given.R,
        "S": given.S,
        "angle": np.degrees(given.angle),
        "eigenvalues": np.sort_complex(values).view(float).reshape(2, 2)
        if np.iscomplexobj(values)
        else np.column_stack([np.sort(values), np.zeros(2)]),
        "has_real_log": given.has_log,
    }
    for method in methods:
        if given.exists(method):
            name = method.replace("-", "_")
            found[f"{name}_steps"] = given.at(method, times)
            found[f"{name}_now"] = given.at(method, t)
            found[f"{name}_det"] = np.linalg.det(given.at(method, times))
            found[f"{name}_singular_at"] = given.exits(method)
    return found


def _area(name: str, corners: np.ndarray) -> float:
    sides = np.roll(corners, -1, axis=0) - corners
    area = 0.5 * float(np.linalg.det(sides[:2]))
    if abs(area) <= _FLAT * float(np.sum(sides**2, axis=1).max()):
        raise ValueError(
            f"{name} must be a triangle with area; got area {area:.3g}. Take its corners off one line"
        )
    return area


def _turning(A: np.ndarray) -> float:
    """The angle by which the even part of log A turns, radians."""
    values = np.linalg.eigvals(A)
    a = triangle.coordinates(A)[0]
    if np.abs(values.imag).max() <= 1e-9 * np.abs(values).max():
        return float(np.pi) if a.real < 0.0 else 0.0
    return float(np.copysign(np.abs(np.angle(values)).max(), a.imag))


def _symmetric(S: np.ndarray) -> np.ndarray:
    return (S + np.swapaxes(S, -1, -2)) / 2.0
