"""A mesh with its pins and handles, the weights of these, and where it is when they are on their way."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lietool.deform import distortion, harmonic, poisson, ways
from lietool.lie import polar, quaternion, so3, sym
from lietool.mesh import geodesic
from lietool.mesh.surface import Mesh

from ._probe_look import Look

Array = NDArray[np.float64]
Index = NDArray[np.intp]

WAYS = {name.replace("_", "-"): way for name, way in ways.WAYS.items()}
# Where between the weights 0 and 1 it is measured how far a mesh has turned; the fewest vertices there.
_PLACES, _FEWEST = 32, 6


@dataclass(frozen=True, eq=False)
class Motions:
    """What k handles do, about their centres (k, 3): turn, stretch and go; rotation vectors of any length."""

    centres: Array
    x: Array
    Y: Array
    t: Array

    @classmethod
    def of(cls, centres: Array, A: Array, turns: Array) -> "Motions":
        """Return the motions that transformations (k, 4, 4) with whole turns (k, 3) are."""
        R, S = polar.decompose(A[:, :3, :3])
        moved = (A[:, :3, :3] @ centres[..., None])[..., 0] + A[:, :3, 3]
        return cls(centres, so3.log(R) + 2.0 * np.pi * turns, sym.log(S), moved - centres)

    def at(self, t: float) -> tuple[Array, Array]:
        """Return transformations (k, 4, 4) on a part of the way, and their whole turns (k, 3)."""
        x = t * self.x
        R = so3.exp(x)
        A = np.tile(np.eye(4), (len(x), 1, 1))
        A[:, :3, :3] = R @ sym.exp(t * self.Y)
        A[:, :3, 3] = self.centres + t * self.t - (A[:, :3, :3] @ self.centres[..., None])[..., 0]
        size = np.linalg.norm(x, axis=1, keepdims=True)
        u = x / np.where(size > 0.0, size, 1.0)
        whole = np.rint((size - np.sum(u * so3.log(R), axis=1, keepdims=True)) / (2.0 * np.pi))
        return A, whole * u


@dataclass(frozen=True, eq=False)
class Case:
    """A mesh, which of its vertices are pinned and which are handles, and what these do.

    `painted` are weights (n, k) in place of computed ones; `notes` what is to be said of the mesh; `close`
    the vertices that are seen close by where results are compared, all if there are none.  `join` puts
    the faces together again.
    """

    name: str
    mesh: Mesh
    look: Look
    pins: Index
    names: tuple[str, ...]
    handles: tuple[Index, ...]
    motions: Motions
    painted: Array | None = None
    notes: tuple[str, ...] = ()
    close: Index | None = None
    kept: dict[str, tuple[poisson.Prepared, Array]] = field(default_factory=dict)
    join: poisson.Join = poisson.join

    @cached_property
    def sets(self) -> list[Index]:
        """The handles, and the pins if there are any."""
        return [*self.handles, self.pins] if len(self.pins) else list(self.handles)

    @cached_property
    def free(self) -> NDArray[np.bool_]:
        """The faces with a vertex that is neither pinned nor of a handle; all if there are none."""
        held = np.zeros(len(self.mesh.vertices), bool)
        held[np.concatenate(self.sets)] = True
        found = np.logical_not(held[self.mesh.faces].all(axis=1))
        return found if found.any() else np.ones(len(found), bool)

    def prepared(self, kind: str) -> poisson.Prepared:
        """Return the factored system with the handles' weights of a kind; those that are painted, of any."""
        return self._kept(kind)[0]

    def weights(self, kind: str) -> Array:
        """Return the weights (n, k) of the handles."""
        return self._kept(kind)[1]

    def _kept(self, kind: str) -> tuple[poisson.Prepared, Array]:
        if kind not in self.kept:
            w = self._weights(kind)
            made = poisson.prepare(self.mesh.vertices, self.mesh.faces, self.pins, self.handles, w)
            self.kept[kind] = made, w
        return self.kept[kind]

    def _weights(self, kind: str) -> Array:
        if self.painted is not None:
            return self.painted
        V, F = self.mesh.vertices, self.mesh.faces
        if kind == "geodesic":
            return self._by_distance()
        make = harmonic.biharmonic if kind == "biharmonic" else harmonic.harmonic
        return harmonic.follow(V, F, self.sets, make)[:, : len(self.handles)]

    def _by_distance(self) -> Array:
        """In proportion to the inverse distances along the surface, the pins' among them."""
        d = geodesic.solve(geodesic.prepare(self.mesh.vertices, self.mesh.faces), self.sets)
        for k, own in enumerate(self.sets):
            d[own, k] = 0.0
        # In place of 1 / d_k the product of the others, relative to the largest, which may be infinite.
        far = np.max(np.where(np.isfinite(d), d, 0.0), initial=1e-300)
        near = far / np.maximum(d, 1e-9 * far)
        near[(d <= 0.0).any(axis=1)] = 0.0
        near[d <= 0.0] = 1.0
        total = near.sum(axis=1, keepdims=True)
        return (near / np.where(total > 0.0, total, 1.0))[:, : len(self.handles)]

    def solve(self, kind: str, way: ways.Way, t: float) -> poisson.Result:
        """Return the edit by a way of blending with weights of a kind, on a part of the way."""
        A, turns = self.motions.at(t)
        given = turns if way.whole_turns else None
        return poisson.solve(self.prepared(kind), A, way, turns=given, joined=self.join)


@dataclass(frozen=True)
class Measured:
    """What an edit did to the faces that are free: stretch is the larger of s1 and 1 / s2."""

    mean: float
    most_of: float
    most: float
    flipped: int

    @classmethod
    def of(cls, case: Case, result: poisson.Result) -> "Measured":
        """Measure a result."""
        found = result.distortion
        one = distortion.summarise(found.worst[case.free], found.weights[case.free])
        return cls(one.mean, one.most_of, one.most, int(result.flipped.sum()))

    @property
    def numbers(self) -> dict[str, object]:
        """For the plate's file."""
        return {"mean": self.mean, "95 %": self.most_of, "most": self.most, "flipped": self.flipped}


def turned(case: Case, points: Array) -> tuple[Array, Array]:
    """Return by how many degrees a deformed mesh has turned, where the first handle's weight has some values.

    Measured at the points alone: the rotations that are nearest to what happened to the vertices between
    two values of the harmonic weight.  What counts is their part about the handle's own axis, which is
    followed without jumps from the pins to the handle.
    """
    V = case.mesh.vertices
    place = _places(case.weights("harmonic")[:, 0])
    place[case.pins], place[case.handles[0]] = -1, _PLACES
    found, M = [], []
    for k in range(_PLACES + 1):
        ring = np.flatnonzero(place == k)
        if len(ring) >= _FEWEST:
            P, Q = V[ring], points[ring]
            M.append((Q - Q.mean(axis=0)).T @ (P - P.mean(axis=0)))
            found.append(k)
    return _followed(case, found, M)


def guided(case: Case, result: poisson.Result) -> tuple[Array, Array]:
    """Return the same of what the faces were to do: of meshes that may be crumpled in any way."""
    w = result.prepared.weights[:, 0]
    place = np.where(w >= 1.0 - 1e-12, _PLACES, _places(w))
    found = [k for k in range(_PLACES + 1) if np.any(place == k)]
    return _followed(case, found, [result.guide[place == k].sum(axis=0) for k in found])


def _places(w: Array) -> Index:
    return np.minimum((np.clip(w, 0.0, 1.0) * _PLACES).astype(np.intp), _PLACES - 1)


def _followed(case: Case, places: Sequence[int], M: Sequence[Array]) -> tuple[Array, Array]:
    """The weights of places, and the turns there of the rotations nearest to matrices."""
    U, _, Vt = np.linalg.svd(np.reshape([np.eye(3), *M], (-1, 3, 3)))
    U[..., 2] *= np.linalg.det(U @ Vt)[:, None]
    q = quaternion.from_matrix(U @ Vt, check=False)
    axis = case.motions.x[0]
    size = float(np.linalg.norm(axis))
    angle = np.unwrap(2.0 * np.arctan2(q[:, 1:] @ (axis / size), q[:, 0])) if size > 0.0 else np.zeros(len(q))
    at = np.where(np.equal(places, _PLACES), 1.0, (np.array(places, float) + 0.5) / _PLACES)
    return np.append(0.0, at), np.degrees(angle)
