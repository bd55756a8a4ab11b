"""From the parameters of `global-interp` to moving shapes: constraints, angles, and what is measured."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from lietool.interp import angles, constraint, energy, shape, triangle
from lietool.lie import so2
from lietool.mesh import topology
from lietool.mesh.shapes import Shape

from ._morph_form import LIBRARY, Forms, weights

Array = np.ndarray

HOMOTOPIES = {"logexp": triangle.logexp, "arap": triangle.arap, "linear": triangle.linear}
_ENERGIES = {
    "frobenius": energy.FROBENIUS,
    "point": energy.POINT,
    "similarity": energy.SIMILARITY,
    "point-similarity": energy.POINT_SIMILARITY,
    "symmetric": energy.FROBENIUS,
}
NAMES = {
    "frobenius": "$E^F$",
    "point": "$E^P$",
    "similarity": "$E^R$",
    "point-similarity": "$E^S$",
    "symmetric": "symmetrised $E^F$",
}
# At so many moments of [0, 1] things are measured; half of them is one of them.
MOMENTS = 41
# How high the barycentre is thrown, over the size of the shape.
_THROW = 0.35
# By so many degrees more a given direction turns, half way.
_SWING = 40.0


@dataclass(frozen=True)
class Choice:
    """How to interpolate; as the parameters of the command say."""

    energy: str
    homotopy: str
    angles: str
    constraint: str
    seed: float
    turns: int
    winding: int
    w: float
    weights: str

    @property
    def forgives(self) -> bool:
        """Whether rotations cost nothing, so that something has to say how the whole is turned."""
        return self.energy in ("similarity", "point-similarity") or (
            self.energy == "balanced" and self.w == 0.0
        )


@dataclass(frozen=True, eq=False)
class Line:
    """Two vertices whose line has its direction given, and the vector along it over time."""

    ends: tuple[int, int]
    path: constraint.Path

    def along(self, t: float) -> Array:
        """The direction (2,) at a time."""
        along = np.asarray(self.path(np.array([t])))[0]
        return along / np.linalg.norm(along)

    @property
    def constraint(self) -> constraint.Direction:
        """What it asks of the shape."""
        quarter = np.array([[0.0, 1.0], [-1.0, 0.0]])
        return constraint.Direction(*self.ends, lambda t: np.asarray(self.path(t)) @ quarter)


@dataclass(frozen=True, eq=False)
class Led:
    """What constraints make of the shape: vertices on curves, an edge or its line, the barycentre."""

    constraints: tuple[constraint.Constraint, ...]
    loci: tuple[tuple[int, constraint.Path], ...] = ()
    edge: tuple[int, int] | None = None
    line: Line | None = None
    barycentre: constraint.Path | None = None
    # Whether the edge was asked for, and does not only say how the whole is turned.
    named: bool = False


@dataclass(frozen=True, eq=False)
class Way:
    """One interpolation between the two shapes."""

    pair: Shape
    choice: Choice
    theta: Array
    led: Led
    prepared: shape.Prepared
    forms: Forms = LIBRARY

    def at(self, t: Array) -> shape.Result:
        """The shape at some times."""
        if not self.forms.others(self.choice.energy):
            return shape.solve(self.prepared, t)
        share = weights(self.prepared, self.choice.weights == "equal")
        return self.forms.solve(self.choice.energy, self.prepared, share, t)

    def back(self, t: Array) -> Array:
        """The vertices (T, n, 2) of the way from the target to the source, with time reversed."""
        prepared = _prepared(_swapped(self.pair), self.choice, _reversed(self.led.constraints), -self.theta)
        return shape.solve(prepared, 1.0 - t).vertices

    @cached_property
    def measured(self) -> shape.Result:
        """The shape at all the moments at which it is measured."""
        return self.at(np.linspace(0.0, 1.0, MOMENTS))

    @cached_property
    def area(self) -> Array:
        """The area of the whole over that of the source; turned triangles count against it."""
        weights = topology.areas(self.pair.source, self.pair.faces)
        return self.measured.det @ weights / weights.sum()

    @cached_property
    def energy(self) -> Array:
        """The energy over the area of the source."""
        return self.measured.energy / topology.areas(self.pair.source, self.pair.faces).sum()

    def error(self, similar: bool) -> Array:
        """E^F of the shape at all moments, over the area of the source; or E^R, of which angles are no part.

        One measure for ways that other energies have found.
        """
        maps, weights = self.prepared.maps, topology.areas(self.pair.source, self.pair.faces)
        homotopy, B = HOMOTOPIES[self.choice.homotopy], self.measured.jacobians
        how = energy.SIMILARITY if similar else energy.FROBENIUS
        each = [
            energy.error(b, homotopy(maps, t, self.theta), how) @ weights
            for b, t in zip(B, self.measured.t.tolist(), strict=True)
        ]
        return np.array(each) / weights.sum()

    @cached_property
    def consistent(self) -> Array:
        """The angles of the local maps, consistent over the mesh."""
        return local_angles(self.pair, replace(self.choice, angles="consistent"), self.prepared.maps)

    @cached_property
    def turn(self) -> Array:
        """By which angle the edge that is given has turned since the beginning, degrees."""
        a, b = (self.led.edge if self.led.line is None else self.led.line.ends) or (0, 1)
        z = (self.measured.vertices[:, a] - self.measured.vertices[:, b]) @ np.array([1.0, 1.0j])
        return np.degrees(np.unwrap(np.angle(z / z[0])))

    @cached_property
    def asymmetry(self) -> Array:
        """How far the way back passes from the way there, at most, over the size of the source."""
        far = np.linalg.norm(self.measured.vertices - self.back(self.measured.t), axis=-1).max(axis=1)
        # Of what is the same but for rounding, the rest is noise.
        return np.round(far / np.ptp(self.pair.source, axis=0).max(), 12)

    @property
    def numbers(self) -> dict[str, object]:
        """What the strip and its plots show."""
        found = self.measured
        return {
            "theta": self.theta,
            "least_det": found.det.min(axis=1),
            "flipped": found.flipped.sum(axis=1),
            "area": self.area,
            "energy": self.energy,
        }


def way(pair: Shape, choice: Choice, forms: Forms = LIBRARY) -> Way:
    """Return the interpolation that the parameters ask for; of a film, the same for every frame."""
    own = _way(pair, choice)
    return replace(own, forms=forms) if forms.others(choice.energy) else own


@lru_cache(maxsize=16)
def _way(pair: Shape, choice: Choice) -> Way:
    start = seed_triangle(pair, choice.seed)
    maps = shape.local_maps(pair.source, pair.target, pair.faces)
    theta = local_angles(pair, choice, maps)
    homotopy = HOMOTOPIES[choice.homotopy]
    led = _led(pair, choice, theta, lambda t: homotopy(maps[start], t, theta[start]), start)
    return Way(pair, choice, theta, led, _prepared(pair, choice, led.constraints, theta))


def _prepared(
    pair: Shape, choice: Choice, constraints: tuple[constraint.Constraint, ...], theta: Array
) -> shape.Prepared:
    return shape.prepare(
        pair.source,
        pair.target,
        pair.faces,
        error=energy.balanced(choice.w) if choice.energy == "balanced" else _ENERGIES[choice.energy],
        homotopy=HOMOTOPIES[choice.homotopy],
        constraints=constraints,
        weights=np.ones(len(pair.faces)) if choice.weights == "equal" else None,
        symmetric=choice.energy == "symmetric",
        theta=theta,
    )


def _swapped(pair: Shape) -> Shape:
    return replace(pair, source=pair.target, target=pair.source)


def _reversed(constraints: tuple[constraint.Constraint, ...]) -> tuple[constraint.Constraint, ...]:
    """The same paths, followed backwards."""

    def backwards(path: constraint.Path) -> constraint.Path:
        return lambda t: path(1.0 - t)

    def turned(c: constraint.Constraint) -> constraint.Constraint:
        if not isinstance(c, constraint.Direction):
            return replace(c, path=backwards(c.path))
        return replace(c, normal=backwards(c.normal)) if callable(c.normal) else c

    return tuple(map(turned, constraints))


def seed_triangle(pair: Shape, seed: float) -> int:
    """The triangle at some part of the way from the nose to the tail."""
    return int(np.argmin(np.abs(pair.along[pair.faces].mean(axis=1) - seed)))


def local_angles(pair: Shape, choice: Choice, maps: Array) -> Array:
    """The angle of each local rotation: within half a turn, or consistent over the mesh; and turns added."""
    theta = triangle.principal_angle(maps)
    if choice.angles == "consistent":
        theta = angles.consistent(theta, pair.faces, seed_triangle(pair, choice.seed))
    return theta + 2.0 * np.pi * choice.turns


def apart(pair: Shape, choice: Choice, t: float) -> tuple[Array, Array]:
    """Each triangle by its own map at time t: corners (m, 3, 2), and linear parts (m, 2, 2).

    Its linear part takes it about the shape's middle, and its translation goes straight, in a frame that
    turns with the whole by the mean of the angles.
    """
    maps = shape.local_maps(pair.source, pair.target, pair.faces)
    theta = local_angles(pair, choice, maps)
    at = HOMOTOPIES[choice.homotopy](maps, t, theta)
    first, last = pair.source.mean(axis=0), pair.target.mean(axis=0)
    P, Q = pair.source[pair.faces] - first, pair.target[pair.faces] - last
    mean = float(np.average(theta, weights=topology.areas(pair.source, pair.faces)))
    shift = Q[:, :1] - np.einsum("mij,mkj->mki", maps, P[:, :1])
    # Translations at rest would pull a shape that turns through its own middle.
    turned = t * shift @ so2.exp((1.0 - t) * mean)
    return (1.0 - t) * first + t * last + np.einsum("mij,mkj->mki", at, P) + turned, at


def _led(pair: Shape, choice: Choice, theta: Array, local: Callable[[Array], Array], start: int) -> Led:
    P, Q = pair.source, pair.target
    if choice.constraint == "loci":
        ends = pair.marks["nose"], pair.marks["tail"]
        turning = _turning(pair, choice, theta, *ends)
        middle = constraint.line(*(0.5 * (V[ends[0]] + V[ends[1]]) for V in (P, Q)))
        loci = tuple((v, _beside(middle, turning, half)) for v, half in zip(ends, (0.5, -0.5), strict=True))
        return Led(tuple(constraint.Locus(*locus) for locus in loci), loci)
    center = constraint.line(P.mean(axis=0), Q.mean(axis=0))
    if choice.constraint in ("held", "direction"):
        edge = tuple(pair.marks.get(f"inner {name}", pair.marks[tip]) for name, tip in _HELD)
        edge = edge[0], edge[1]
        center = _thrown(center, _THROW * float(np.ptp(P, axis=0).max()))
        if choice.constraint == "direction":
            vector = _turning(pair, replace(choice, winding=0), theta, *edge)
            line = Line(edge, _swung(vector, np.deg2rad(_SWING)))
            return Led((constraint.Barycentre(center), line.constraint), line=line, barycentre=center)
        held = constraint.Edge(*edge, _turning(pair, choice, theta, *edge))
        return Led((constraint.Barycentre(center), held), edge=edge, barycentre=center, named=True)
    if not choice.forgives:
        return Led((constraint.Barycentre(center),))
    a, b = (int(v) for v in pair.faces[start, :2])
    held = constraint.Edge(a, b, lambda t: local(t) @ (P[a] - P[b]))
    return Led((constraint.Barycentre(center), held), edge=(a, b))


_HELD = (("fore", "nose"), ("hind", "tail"))


def _turning(pair: Shape, choice: Choice, theta: Array, a: int, b: int) -> constraint.Path:
    """The vector from b to a, turning evenly as the local maps do on average, and wound by full turns."""
    first, last = ((V[a] - V[b]) @ np.array([1.0, 1.0j]) for V in (pair.source, pair.target))
    factor = last / first
    mean = float(np.average(theta, weights=topology.areas(pair.source, pair.faces)))
    near = float(np.angle(factor)) + 2.0 * np.pi * np.rint((mean - np.angle(factor)) / (2.0 * np.pi))
    angle = near + 2.0 * np.pi * choice.winding
    return constraint.arc((0.0, 0.0), (first.real, first.imag), angle, abs(factor))


def _beside(middle: constraint.Path, vector: constraint.Path, part: float) -> constraint.Path:
    return lambda t: np.asarray(middle(t)) + part * np.asarray(vector(t))


def _swung(vector: constraint.Path, angle: float) -> constraint.Path:
    """A vector turned by an angle besides, half way."""

    def path(t: Array) -> Array:
        (x, y), swing = np.asarray(vector(t)).T, angle * np.sin(np.pi * t)
        c, s = np.cos(swing), np.sin(swing)
        return np.stack([c * x - s * y, s * x + c * y], axis=-1)

    return path


def _thrown(line: constraint.Path, height: float) -> constraint.Path:
    return lambda t: np.asarray(line(t)) + height * (4.0 * t * (1.0 - t))[..., None] * np.array([0.0, 1.0])
