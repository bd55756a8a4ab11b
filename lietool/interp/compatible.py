"""One triangulation for two shapes: the same faces, no triangle turned over in either.

The book assumes such a triangulation (6.1, footnote).  Here the triangulations
of both polygons are laid over each other (Aronov, Seidel and Souvaine, On
compatible triangulations of simple polygons, 1993; `compatible_overlay`), and
the result is improved by edits that keep it valid in both (Surazhsky and
Gotsman, High quality compatible triangulations, 2004; Baxter, Barla and
Anjyo, Compatible embedding for 2D shape animation, 2009; `compatible_remesh`).
Every triangle is checked exactly at the end.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.interp import compatible_outlines, compatible_overlay, compatible_remesh
from lietool.interp.compatible_mesh import Mesh
from lietool.interp.compatible_quality import Quality, measure
from lietool.lie import checks
from lietool.mesh import outline
from lietool.mesh.predicates import orientation

Array = NDArray[np.float64]
Ints = NDArray[np.intp]

_DEFAULT = 600


@dataclass(frozen=True, eq=False)
class Compatible:
    """A triangulation of two shapes.

    Attributes
    ----------
    source, target : (n, 2)
        The vertices; the given corners first, in their order and with their exact coordinates.
    faces : (m, 3) of int
        Counter-clockwise in both.
    boundary : (k,) of int
        The vertices of the boundary, counter-clockwise; between given corners there may be
        others, at the same fractions of the edge in both shapes.
    corners : int
        How many vertices were given.
    quality : Quality
    """

    source: Array
    target: Array
    faces: Ints
    boundary: Ints
    corners: int
    quality: Quality


def polygons(
    P: ArrayLike, Q: ArrayLike, *, spacing: float | None = None, triangles: int | None = None
) -> Compatible:
    """Return a triangulation of two simple polygons whose corners correspond one to one.

    Book: 6.1, the assumption; Aronov, Seidel and Souvaine 1993; Surazhsky and Gotsman 2004

    Parameters
    ----------
    P, Q : (n, 2)
        The corners in order, in the same direction in both; corner i of P belongs to corner i of Q.
    spacing : float, optional
        The length of edges wanted, in units of P; in Q it is scaled by the root of the areas.
    triangles : int, optional
        Or how many triangles are wanted (default 600, more for many corners); there are about
        as many, or more where the corners need them.

    Returns
    -------
    mesh : Compatible
        The same every time.

    Raises
    ------
    ValueError
        If P or Q is not a simple polygon, or they do not belong together: other numbers of
        corners, opposite directions.
    """
    return _triangulate("compatible.polygons", P, Q, spacing, triangles, "")


def outlines(
    P: ArrayLike,
    Q: ArrayLike,
    marks: Sequence[tuple[int, int]] | None = None,
    *,
    samples: int = 100,
    spacing: float | None = None,
    triangles: int | None = None,
) -> Compatible:
    """Return a triangulation of two outlines of which only a few points are known to correspond.

    Between marks both are sampled evenly by arc length, each sharp corner of either kept;
    corners of both that come to lie closer than the samples are taken for the same one.

    Parameters
    ----------
    P, Q : (n, 2), (k, 2)
        Points of the outlines in order, in either direction: both are walked counter-clockwise.
    marks : sequence of (int, int), optional
        Point i of P belongs to point j of Q.  Without any, they correspond as where the outlines,
        centred and of the same area, are closest when Q is turned; of almost equal ways that
        by the smallest angle.
    samples : int
        About how many points to sample on each outline; sharp corners may add some.
    spacing, triangles
        As in `polygons`.

    Returns
    -------
    mesh : Compatible
        Its corners are the samples.

    Raises
    ------
    ValueError
        If an outline is not a simple polygon, or crosses itself once sampled, or the marks are
        out of order.
    """
    where = "compatible.outlines"
    P, Q = outline.check(where, "P", P), outline.check(where, "Q", Q)
    first, second = compatible_outlines.sample(where, P, Q, marks, samples)
    return _triangulate(where, first, second, spacing, triangles, f" once sampled at {len(first)} points")


def subdivide(mesh: Compatible, times: int = 1) -> Compatible:
    """Return the same shapes with each triangle cut into four at the midpoints of its edges.

    Parameters
    ----------
    mesh : Compatible
    times : int
        How often.

    Returns
    -------
    mesh : Compatible
        Of the same maps, with 4^times as many triangles; the old vertices come first.
    """
    if isinstance(times, bool) or not isinstance(times, int | np.integer) or not 0 <= times <= 10:
        checks.fail("compatible.subdivide", "times", "a whole number from 0 to 10", repr(times), None)
    for _ in range(times):
        n, F = len(mesh.source), mesh.faces
        ends = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
        key, middle = np.unique(ends[:, 0] * n + ends[:, 1], return_inverse=True)
        i, j = key // n, key % n
        c, a, b = (n + middle).reshape(3, -1)
        faces = np.concatenate(
            [
                np.stack(rows, axis=1)
                for rows in ((F[:, 0], c, b), (c, F[:, 1], a), (b, a, F[:, 2]), (a, b, c))
            ]
        )
        after = np.roll(mesh.boundary, -1)
        rim = np.searchsorted(key, np.minimum(mesh.boundary, after) * n + np.maximum(mesh.boundary, after))
        boundary = np.stack([mesh.boundary, n + rim], axis=1).ravel()
        drawn = [np.concatenate([X, 0.5 * (X[i] + X[j])]) for X in (mesh.source, mesh.target)]
        mesh = _verified("compatible.subdivide", drawn[0], drawn[1], faces, boundary, mesh.corners)
    return mesh


def _triangulate(
    where: str, P: ArrayLike, Q: ArrayLike, spacing: float | None, triangles: int | None, after: str
) -> Compatible:
    remedy = ("Ask for more samples.",) if after else ()
    P, Q = (outline.check(where, name + after, X, *remedy) for name, X in (("P", P), ("Q", Q)))
    n = len(P)
    _check_pair(where, P, Q)
    forwards = outline.area(P) > 0.0
    order = np.arange(n) if forwards else np.arange(n)[::-1]
    # Powers of two, which lose nothing: squares of the coordinates must neither overflow nor vanish.
    scale = [-int(np.frexp(np.ptp(X, axis=0).max())[1]) for X in (P, Q)]
    drawn = [np.ldexp(X[order], s) for X, s in zip((P, Q), scale, strict=True)]
    areas = [outline.area(X) for X in drawn]
    units, coarsest, count = _size(where, n, areas, spacing, triangles, scale[0])
    try:
        first = compatible_overlay.common(*drawn)
    except compatible_overlay.OverlayError:
        _report_narrow(where, P, Q)
    mesh = compatible_remesh.improve(Mesh(*first, list(range(n))), units, coarsest, count)
    rim = [0]
    while mesh.next[rim[-1]] != 0:
        rim.append(mesh.next[rim[-1]])
    if not forwards:
        rim = rim[rim.index(n - 1) :] + rim[: rim.index(n - 1)]  # from the given first corner, too
    number = np.arange(len(mesh.points))
    number[:n] = order
    source, target = (np.ldexp(X, -s) for X, s in zip(mesh.arrays(), scale, strict=True))
    source[:n], target[:n] = P, Q
    return _verified(where, source, target, number[mesh.faces()], number[rim], n)


def _report_narrow(where: str, P: Array, Q: Array) -> NoReturn:
    found = [
        (d / np.ptp(X, axis=0).max(), d, p, name)
        for X, name in ((P, "P"), (Q, "Q"))
        for d, p in (outline.narrowest(X),)
    ]
    _, d, p, name = min(found, key=lambda entry: entry[0])
    got = f"{name} only {d:.3g} wide near ({p[0]:.6g}, {p[1]:.6g})"
    checks.fail(where, "P and Q", "wide enough for their numbers", got, None, "Widen it there.")


def _check_pair(where: str, P: Array, Q: Array) -> None:
    if len(P) != len(Q):
        remedy = "Use compatible.outlines, which samples them." if where.endswith("polygons") else ""
        checks.fail(where, "Q", f"of as many points as P, {len(P)}", f"{len(Q)}", None, remedy)
    for name, X in (("P", P), ("Q", Q)):
        size = np.ptp(X, axis=0).max()
        if abs(outline.area(X)) <= 1e-12 * size**2:
            checks.fail(where, name, "an outline that encloses an area", f"area {outline.area(X):.3g}", None)
    directions = ["counter-clockwise" if outline.area(X) > 0.0 else "clockwise" for X in (P, Q)]
    if directions[0] != directions[1]:
        remedy = "The map would be a reflection: mirror Q, or give its points in reverse with other partners."
        checks.fail(where, "Q", f"{directions[0]} as P is", directions[1], None, remedy)


def _size(
    where: str, n: int, areas: list[float], spacing: float | None, triangles: int | None, scale: int
) -> tuple[tuple[float, float], float, int | None]:
    """Return the spacing in both, how many of it to begin with, and the count wanted."""
    if spacing is not None and triangles is not None:
        checks.fail(where, "spacing", "left out where triangles is given", f"{spacing!r}", None)
    if spacing is None:
        triangles = max(_DEFAULT, 6 * n) if triangles is None else triangles
        if isinstance(triangles, bool) or not isinstance(triangles, int | np.integer) or triangles < 1:
            checks.fail(where, "triangles", "a whole number, at least 1", repr(triangles), None)
        step = 2.0 * np.sqrt(areas[0] / triangles / np.sqrt(3.0))
        wanted, count = int(triangles), int(triangles)
    else:
        if isinstance(spacing, bool) or not isinstance(spacing, int | float | np.number) or not spacing > 0.0:
            checks.fail(where, "spacing", "a positive number", repr(spacing), None)
        step = float(np.ldexp(min(spacing, 1e150), scale))
        wanted, count = int(min(1e18, 4.0 * areas[0] / (np.sqrt(3.0) * max(step, 1e-9) ** 2))), None
    if wanted > compatible_remesh.MOST:
        remedy = "Ask for fewer, then use compatible.subdivide, which makes four of each."
        name = "triangles" if spacing is None else "spacing"
        checks.fail(
            where,
            name,
            f"enough for at most {compatible_remesh.MOST} triangles",
            f"about {wanted}",
            None,
            remedy,
        )
    units = (step, step * np.sqrt(areas[1] / areas[0]))
    return units, 0.25 * float(np.sqrt(areas[0])) / step, count


def _verified(
    where: str, source: Array, target: Array, faces: Ints, boundary: Ints, corners: int
) -> Compatible:
    """Return the record once each triangle is known to be counter-clockwise in both, by exact arithmetic."""
    for name, X in (("P", source), ("Q", target)):
        bad = orientation(*(X[faces[:, k]] for k in range(3))) <= 0
        if bad.any():
            (i,) = checks.first(bad)
            x, y = X[faces[i]].mean(axis=0)
            got = f"a part near ({x:.6g}, {y:.6g}) so thin that a triangle there is flat"
            remedy = "Widen it, or move the shape nearer to the origin."
            checks.fail(where, name, "wide enough for its numbers", got, None, remedy)
    return Compatible(source, target, faces, boundary, corners, measure(source, target, faces))
