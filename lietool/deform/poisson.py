"""Poisson editing of a mesh: pins stay, handles are dragged, and faces between them follow both.

Each face has a transformation G, blended from those of the handles by weights.  It acts on the gradients of
the coordinates: that of coordinate a is to become the sum over b of G_ab grad x_b, which tears the faces
apart.  Poisson's equation puts them together again: the coordinates whose gradients are nearest to these,
with the vertices of pins and handles where they are moved to.

The weights are an array, (n, k) for k handles, 1 on a handle and 0 on the others and the pins: harmonic, or
any that fall with the distance (table 7.1).  What they lack of 1 belongs to the pins.  The way of blending
decides how far a handle can turn: quaternions take the shorter way round, no turn above pi; phi_so takes
turns that are stated, beyond 2 pi.  Only linear parts matter here, and so phi_se does what phi_so does
without stated turns.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.deform import distortion, ways
from lietool.deform import turns as turns_of
from lietool.lie import checks
from lietool.mesh import laplacian, topology
from lietool.mesh import solve as systems

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]


WHOLE = 1e-12
"""Weights that lack less of 1 leave nothing to the pins."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """All that does not depend on where the handles are dragged.

    Parameters
    ----------
    vertices : ndarray, shape (n, 3)
    faces : ndarray of int, shape (m, 3)
    pins : ndarray of int
    handles : tuple of ndarray of int
        The vertices of each.
    weights : ndarray, shape (m, k)
        Of the handles at each face, the mean of those at its corners.
    stiffness : sparse array, shape (n, n)
    divergence : sparse array, shape (n, 3 m)
    factor : Factor
    """

    vertices: Array
    faces: Index
    pins: Index
    handles: tuple[Index, ...]
    weights: Array
    stiffness: Any
    divergence: Any
    factor: systems.Factor


Join = Callable[[Prepared, Array, Array], Array]


@dataclass(frozen=True, eq=False)
class Result:
    """The edited mesh.

    Parameters
    ----------
    prepared : Prepared
    vertices : ndarray, shape (n, 3)
    guide : ndarray, shape (m, 3, 3)
        The blended linear maps G of the faces.
    fallback : ndarray of bool, shape (m,)
        Where the polar blend stands in, because a transformation that counts has no real logarithm.
    """

    prepared: Prepared
    vertices: Array
    guide: Array
    fallback: Mask

    @cached_property
    def distortion(self) -> distortion.Distortion:
        """What happened to the faces."""
        return distortion.measure(self.prepared.vertices, self.prepared.faces, self.vertices)

    @cached_property
    def flipped(self) -> Mask:
        """Which faces are turned over against their own G; shape (m,)."""
        rest = self.prepared
        return distortion.flipped_against(rest.vertices, rest.faces, self.vertices, self.guide)

    @cached_property
    def residual(self) -> float:
        """The largest error in an equation of (7.14) at a free vertex, relative to |A| |f| + |b|."""
        A, b = self.prepared.stiffness, _right(self.prepared, self.guide)
        size = np.max(np.abs(A).sum(axis=0)) * np.max(np.abs(self.vertices)) + np.max(np.abs(b))
        free = self.prepared.factor.free
        return float(np.max(np.abs(A @ self.vertices - b)[free], initial=0.0) / size)

    @cached_property
    def energy(self) -> float:
        """The integral of |grad x' - G grad x|^2, summed over the coordinates; what the edit minimises."""
        rest = self.prepared
        G = laplacian.gradient(rest.vertices, rest.faces)
        shape = (len(rest.faces), 3, 3)
        before, after = ((G @ V).reshape(shape) for V in (rest.vertices, self.vertices))
        # Entry (f, b, a) is the derivative of coordinate a along axis b.
        wanted = before @ np.swapaxes(self.guide, 1, 2)
        return float(self.distortion.weights @ np.sum((after - wanted) ** 2, axis=(1, 2)))


def prepare(
    V: ArrayLike, F: ArrayLike, pins: ArrayLike, handles: Sequence[ArrayLike], weights: ArrayLike
) -> Prepared:
    """Factor the Poisson equation of a mesh with pins and handles.

    Book: (7.12), (7.14)

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    pins : array_like of int
        The vertices that stay, or move together; there may be none.
    handles : sequence of array_like of int
        The vertices of each handle.
    weights : array_like, shape (n, k)
        Of the k handles at the vertices.

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        If a face has no area, a handle no vertex, a vertex two owners or a connected part none, or a number
        is not finite.
    """
    where = "poisson.prepare"
    V, F = laplacian.checked(where, V, F)
    sets = [np.unique(topology.vertex_set(where, "pins", pins, len(V)))]
    if not len(handles):
        topology.fail(where, "handles", "at least one set of vertices", "none")
    for i, handle in enumerate(handles):
        sets.append(np.unique(topology.vertex_set(where, f"handles[{i}]", handle, len(V))))
        if not len(sets[-1]):
            topology.fail(where, f"handles[{i}]", "at least one vertex", "none")
    _disjoint(where, sets, len(V))
    fixed = np.concatenate(sets)
    _held(where, F, len(V), fixed)
    w = checks.array(where, "weights", weights, ())
    if w.shape != (len(V), len(handles)):
        topology.fail(where, "weights", f"an array of shape ({len(V)}, {len(handles)})", f"shape {w.shape}")
    A = laplacian.cotangent(V, F)
    factor = systems.factor(A, fixed)
    D = laplacian.divergence(V, F)
    return Prepared(V, F, sets[0], tuple(sets[1:]), w[F].mean(axis=1), A, D, factor)


def solve(
    prepared: Prepared,
    A: ArrayLike,
    way: ways.Way = ways.PHI_SO,
    *,
    pinned: ArrayLike | None = None,
    turns: ArrayLike | None = None,
    joined: Join | None = None,
) -> Result:
    """Return the mesh with its handles moved.

    Book: (7.12), (7.13), (7.14)

    Parameters
    ----------
    prepared : Prepared
    A : array_like, shape (k, 4, 4), Aff+
        What moves each handle, from its place at rest.
    way : Way
        Of blending: one of `ways.WAYS`.
    pinned : array_like, shape (4, 4), Aff+, optional
        What moves the pins; the identity unless given.
    turns : array_like, shape (k, 3), optional
        Axis times number of whole turns, on top of each handle's principal rotation; for phi_so.
    joined : callable, optional
        What puts the faces together again: `join` unless given.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        If a number is not finite, a matrix not affine or of det <= 0 (but for `linear`), if turns are not
        whole, about another axis than the handle's rotation or given to a way that keeps none, or a blend
        is no transformation.
    """
    where = "poisson.solve"
    count = len(prepared.handles)
    a = checks.array(where, "A", A, (4, 4))
    if a.shape != (count, 4, 4):
        checks.fail(where, "A", f"an array of shape ({count}, 4, 4)", f"shape {a.shape}", None)
    held = checks.array(where, "pinned", np.eye(4) if pinned is None else pinned, (4, 4))
    if held.shape != (4, 4):
        checks.fail(where, "pinned", "an array of shape (4, 4)", f"shape {held.shape}", None)
    moves = np.concatenate([held[None], a])
    params, able = _parameters(where, way, moves, turns)
    guide, fallback = _guide(prepared, params, way), np.zeros(len(prepared.faces), bool)
    if not able.all():
        fallback = _without(prepared, able)
        polar, _ = ways.POLAR_QUATERNION.encode(moves)
        guide = np.where(fallback[:, None, None], _guide(prepared, polar, ways.POLAR_QUATERNION), guide)
    owners = (prepared.pins, *prepared.handles)
    values = [prepared.vertices[own] @ M[:3, :3].T + M[:3, 3] for own, M in zip(owners, moves, strict=True)]
    found = (joined or join)(prepared, guide, np.concatenate(values))
    return Result(prepared, found, guide, fallback)


def join(prepared: Prepared, guide: ArrayLike, values: ArrayLike) -> Array:
    """Return the vertices whose coordinates have the gradients that are nearest to those asked for.

    Book: (7.12), (7.14)

    Parameters
    ----------
    prepared : Prepared
    guide : array_like, shape (m, 3, 3)
        The linear map G of each face: the gradient of coordinate a is to be the sum over b of G_ab grad x_b.
    values : ndarray, shape (k, 3)
        Where the vertices of pins and handles are, in the order of `prepared.factor.fixed`.

    Returns
    -------
    vertices : ndarray, shape (n, 3)

    Raises
    ------
    ValueError
        If a shape does not fit or a number is not finite.
    """
    where, held = "poisson.join", len(prepared.factor.fixed)
    maps = checks.array(where, "guide", guide, (3, 3))
    if maps.shape != (len(prepared.faces), 3, 3):
        checks.fail(where, "guide", f"shape ({len(prepared.faces)}, 3, 3)", f"shape {maps.shape}", None)
    places = checks.array(where, "values", values, (3,))
    if places.shape != (held, 3):
        checks.fail(where, "values", f"shape ({held}, 3)", f"shape {places.shape}", None)
    return prepared.factor.solve(_right(prepared, maps), places)


def _parameters(where: str, way: ways.Way, moves: Array, turns: ArrayLike | None) -> tuple[Array, Mask]:
    """The parameters of the pins, then of the handles, and which there are."""
    params, able = way.encode(moves)
    if turns is None:
        return params, able
    n = checks.array(where, "turns", turns, (3,))
    if n.shape != (len(moves) - 1, 3):
        checks.fail(where, "turns", f"an array of shape ({len(moves) - 1}, 3)", f"shape {n.shape}", None)
    if way.whole_turns:
        params[1:, :3] = turns_of.wound(params[1:, :3], n)
    elif np.any(n != 0.0):
        remedy = "Take phi_so, or state none."
        checks.fail(where, "turns", "0: only phi_so keeps whole turns", f"some, for {way.name}", None, remedy)
    return params, able


def _without(prepared: Prepared, able: Mask) -> Mask:
    """Which faces weigh a transformation that has no parameters."""
    lacking = np.any(prepared.weights[:, ~able[1:]] != 0.0, axis=1)
    if not able[0]:
        # Weights that sum to 1 but for rounding leave nothing to the pins.
        lacking |= np.abs(prepared.weights.sum(axis=1) - 1.0) > WHOLE
    return lacking


def _guide(prepared: Prepared, params: Array, way: ways.Way) -> Array:
    """The blended linear maps of the faces."""
    # What the handles lack of 1 is the pins': so equal parameters give themselves, without rounding.
    mixed = prepared.weights @ (params[1:] - params[0])
    mixed += params[0]
    return way.decode_linear(mixed)


def _right(prepared: Prepared, guide: Array) -> Array:
    """The right side b of (7.14), one column for each coordinate.

    The gradient of coordinate a is to be the row a of G, projected to the face; the hat functions' gradients
    lie in the face, so the divergence takes no notice of what is across it.
    """
    return -(prepared.divergence @ np.swapaxes(guide, 1, 2).reshape(-1, 3))


def _disjoint(where: str, sets: Sequence[Index], count: int) -> None:
    """Refuse a vertex that two of the sets own."""
    owners = np.zeros(count, int)
    for own in sets:
        owners[own] += 1
    if (owners > 1).any():
        k = int(np.argmax(owners > 1))
        names = ["pins" if i == 0 else f"handles[{i - 1}]" for i, own in enumerate(sets) if k in own]
        got = f"{laplacian.named('vertex', owners > 1)} in {' and '.join(names)}"
        topology.fail(where, "pins and handles", "without common vertices", got)


def _held(where: str, F: Index, count: int, fixed: Index) -> None:
    """Refuse connected parts that nothing holds."""
    number, part = topology.parts(F, count)
    first = topology.unheld(number, part, fixed)
    if len(first):
        got = f"none in {len(first)} of {number}, those of {laplacian.listed('vertex', np.sort(first))}"
        remedy = "Pin a vertex in each."
        topology.fail(where, "pins and handles", "a vertex in every connected part", got, remedy)
