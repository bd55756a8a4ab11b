"""The yes/no columns of Table 2 of Kaji and Ochiai, and what section 6 says, each decided by an experiment.

An experiment looks for a counterexample among transformations with fixed
seeds, and returns the numbers that decide.  Only `blend.WAYS` and, for large
rotations, a parametrisation of `methods` are used; what the paper prints is
in `PRINTED`, to be compared with.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.bench.methods import METHODS, Method
from lietool.lie import aff, blend, polar, se3, so3

Array = NDArray[np.float64]

_EXACT = 1e-8
"""Relative: what is equal but for rounding is far below, what is not is far above."""


@dataclass(frozen=True)
class Finding:
    """What an experiment found: whether the property holds, and the number that says so, in words."""

    holds: bool
    value: float
    unit: str


@dataclass(frozen=True)
class Property:
    """A column of the table."""

    name: str
    says: str
    experiment: Callable[[Method], Finding]


def _rng(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


def _moderate(count: int, seed: int) -> Array:
    """Return transformations that have a real logarithm, turned by less than a right angle."""
    X = np.zeros((count, 4, 4))
    X[:, :3, :] = 0.35 * _rng(seed).normal(size=(count, 3, 4))
    return aff.exp(X)


def _rigid(count: int, seed: int) -> Array:
    return se3.exp(0.5 * _rng(seed).normal(size=(count, 6)))


def _any(count: int, seed: int) -> Array:
    """Return matrices of all of Aff+(3), also with negative eigenvalues."""
    A = np.tile(np.eye(4), (count, 1, 1))
    A[:, :3, :] = _rng(seed).normal(size=(count, 3, 4))
    A[:, :3, 0] *= np.sign(np.linalg.det(A[:, :3, :3]))[:, None]
    return A


def _difference(A: Array, B: Array) -> float:
    """The largest relative difference, in the norm of the linear parts and of the whole."""
    size = np.maximum(1.0, np.linalg.norm(B, axis=(-2, -1)))
    return float(np.max(np.linalg.norm(A - B, axis=(-2, -1)) / size))


def _multiple(method: Method, t: Array, A: Array) -> Array:
    """Return the t-fold of A: the blend with one weight, whose rest belongs to the identity."""
    return blend.WAYS[method.way](np.asarray(t)[..., None], A[..., None, :, :])


def _blend(method: Method, weights: Array, A: Array) -> Array:
    return blend.WAYS[method.way](weights, A)


def surjective(method: Method) -> Finding:
    """Try to write any matrix with positive determinant, and to read it again."""
    A = _any(200, 1)
    B = method.phi(method.psi(A))
    size = np.maximum(1.0, np.linalg.norm(A, axis=(-2, -1)))
    missed = int(np.sum(~(np.linalg.norm(B - A, axis=(-2, -1)) <= _EXACT * size)))
    return Finding(missed == 0, float(missed), "of 200 matrices missed")


def nonsingular(method: Method) -> Finding:
    """Blend two transformations with weights 1 - t and t, for t from -4 to 5, and look at the determinant."""
    A = _moderate(400, 2).reshape(200, 2, 4, 4)
    t = np.tile(np.linspace(-4.0, 5.0, 20), 10)
    weights = np.stack([1.0 - t, t], axis=-1)
    turned = int(np.sum(np.linalg.det(_blend(method, weights, A)[:, :3, :3]) <= 0.0))
    return Finding(turned == 0, float(turned), "of 200 extrapolations with det <= 0")


def associative(method: Method) -> Finding:
    """Compare the a-multiple of the b-multiple with the ab-multiple, for b from 0 to 1 and a from -1 to 2."""
    A = _moderate(100, 3)
    a, b = _rng(4).uniform(-1.0, 2.0, 100), _rng(5).uniform(0.0, 1.0, 100)
    off = _difference(_multiple(method, a, _multiple(method, b, A)), _multiple(method, a * b, A))
    return Finding(off < _EXACT, off, "difference")


def powers(method: Method) -> Finding:
    """Compare the s-multiple after the t-multiple with the (s + t)-multiple."""
    A = _moderate(100, 6)
    s, t = _rng(7).uniform(0.0, 1.0, 100), _rng(8).uniform(0.0, 1.0, 100)
    off = _difference(_multiple(method, s, A) @ _multiple(method, t, A), _multiple(method, s + t, A))
    return Finding(off < _EXACT, off, "difference")


TURN = 860.0
"""Degrees: two turns and 140, which no quaternion tells from 140."""


def _stretched(theta: Array) -> Array:
    """Return a stretched body turned by theta about an axis that is none of the stretch."""
    u = np.array([1.0, 2.0, 2.0]) / 3.0
    A = np.tile(np.eye(4), (len(theta), 1, 1))
    A[:, :3, :3] = so3.exp(theta[:, None] * u) @ np.diag([2.0, 1.0, 0.5])
    return A


def large_rotation(method: Method, degrees: float = TURN) -> Finding:
    """Follow a stretched body through a large turn, then go straight from the first parameters to the last.

    The turn on that straight way is what the parameters know of it.  Where the
    parameters cannot follow, the finding is the turn at which they are lost.
    (The body does not travel: a motion that does has no twist in se(3) at a
    whole turn, and a continuous one goes to infinity there.)
    """
    # At no step of the turn that is looked at unless told otherwise a whole number of turns.
    theta = np.linspace(0.0, np.deg2rad(degrees), 2 + int(abs(degrees) // 17.0))
    path = _stretched(theta)
    first = reference = method.psi(path[0])
    for angle, A in zip(theta, path, strict=True):
        try:
            reference = method.near(A, reference)
            lost = _difference(method.phi(reference), A) > _EXACT
        except ValueError:
            lost = True
        if lost:
            return Finding(False, float(np.rint(np.rad2deg(angle))), "degrees, then lost")
    # An odd number of steps: half-way between opposite rotations is 0, which has no rotation.
    way = first + np.linspace(0.0, 1.0, 200)[:, None] * (reference - first)
    R = polar.rotation(method.phi(way)[:, :3, :3])
    steps = so3.log(np.swapaxes(R[:-1], -1, -2) @ R[1:])
    known = float(np.rad2deg(np.sum(np.linalg.norm(steps, axis=-1))))
    return Finding(abs(known - abs(degrees)) < 1e-4, float(np.rint(known)), f"degrees of {degrees:g}")


def rigid(method: Method) -> Finding:
    """Blend rigid transformations and look whether the result is one."""
    A = _rigid(300, 9).reshape(100, 3, 4, 4)
    L = _blend(method, np.array([0.2, 0.3, 0.5]), A)[:, :3, :3]
    off = float(np.max(np.abs(np.swapaxes(L, -1, -2) @ L - np.eye(3))))
    return Finding(off < _EXACT, off, "off a rotation")


def _invariance(method: Method, A: Array, G: Array) -> Finding:
    weights = np.array([0.2, 0.3, 0.5])
    A, plain = A.reshape(100, 3, 4, 4), _blend(method, weights, A.reshape(100, 3, 4, 4))
    left = _difference(_blend(method, weights, G[:, None] @ A), G @ plain)
    right = _difference(_blend(method, weights, A @ G[:, None]), plain @ G)
    off = max(left, right)
    return Finding(off < _EXACT, off, "difference")


def bi_invariant(method: Method) -> Finding:
    """Compare the blend of G A_i with G times the blend, and the same from the right, in Aff+(3)."""
    return _invariance(method, _moderate(300, 10), _moderate(100, 11))


def bi_invariant_rigid(method: Method) -> Finding:
    """The same among rigid transformations."""
    return _invariance(method, _rigid(300, 12), _rigid(100, 13))


PROPERTIES = (
    Property("Surjectivity", "reaches all of Aff+(3)", surjective),
    Property("Extrapolation", "is never singular", nonsingular),
    Property("Associativity", "a-multiple of b-multiple = ab-multiple", associative),
    Property("Powers", "s-multiple after t-multiple = (s + t)-multiple", powers),
    Property("Large rotation", "tells turns beyond 360 degrees", large_rotation),
    Property("Rigid", "blends of rigid stay rigid", rigid),
    Property("Bi-invariance", "follows changes from both sides", bi_invariant),
    Property("Bi-invariance, SE(3)", "does so among rigid ones", bi_invariant_rigid),
)

PRINTED: Mapping[str, Mapping[str, bool]] = {
    "Ours": {"Surjectivity": True, "Extrapolation": True, "Associativity": False, "Large rotation": True},
    "Alexa/SAM": {
        "Surjectivity": False,
        "Extrapolation": False,
        "Associativity": True,
        "Large rotation": False,
    },
    "Polar+DQ": {
        "Surjectivity": True,
        "Extrapolation": False,
        "Associativity": False,
        "Large rotation": False,
    },
    "Polar+Grassia": {
        "Surjectivity": True,
        "Extrapolation": False,
        "Associativity": False,
        "Large rotation": True,
    },
}
"""Table 2 as it is printed; a truth value where the paper says yes, non-singular, or no."""


def findings() -> dict[str, dict[str, Finding]]:
    """Return what every experiment finds of every method, by the names of both."""
    return {m.name: {p.name: p.experiment(m) for p in PROPERTIES} for m in METHODS}
