"""Hard inputs, by class: what a function must stand, with fixed seeds."""

from collections.abc import Callable, Mapping, Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from lietool.bench import exact

Array = NDArray[np.float64]
Classes = Mapping[str, Array]

ANGLES: Mapping[str, tuple[float, ...]] = {
    "angle near 0": (0.0, 1e-300, 1e-12, 1e-8, 1e-5),
    "ordinary angle": (0.01, 0.3, 1.0, 1.6, 2.1, 3.0),
    "angle near pi": (*(np.pi - 10.0**-k for k in range(3, 16)), np.pi),
    "angle to 2 pi": (3.3, 4.7, 6.0, 2.0 * np.pi - 1e-9),
}
"""Those to 2 pi are beyond what is promised."""

CONDITIONS = (1.0, 1e1, 1e3, 1e6, 1e9, 1e12)
SCALES = (1e-50, 1e-20, 1e20, 1e50)
GAPS = (1e-15, 1e-12, 1e-8, 1e-4)


def _axes(count: int) -> Array:
    """Axes of all kinds: of coordinates, with small components, and any."""
    hard = [(0, 0, 1), (-1, 0, 0), (1, -1, 1e-9), (1, 1e-200, 0), (1, 1, 1), (0, -1, 0)]
    rng = np.random.default_rng(16)
    u = np.concatenate([rng.normal(size=(2, 3)), hard, rng.normal(size=(64, 3))])[:count]
    return u / np.linalg.norm(u, axis=-1, keepdims=True)


def _rotations(count: int, seed: int) -> Array:
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(count, 3, 3)))
    return q * np.linalg.det(q)[:, None, None]


def _each(f: Callable, elements: Array, blocks: Callable) -> Array:
    """Apply an exact function to each element and round its only value."""
    return np.array([blocks(f(x)[0]) for x in elements], dtype=float)


def _homogeneous(value: exact.Value) -> list[list]:
    linear, d = value
    n = len(d)
    return [*([*linear[n * i : n * i + n], d[i]] for i in range(n)), [0] * n + [1]]


def vectors(count: int) -> Classes:
    """Return rotation vectors."""
    u = _axes(count)
    return {name: np.concatenate([angle * u for angle in angles]) for name, angles in ANGLES.items()}


def angles(count: int) -> Classes:
    """Return angles of the plane, of both signs."""
    return {name: np.array([s * a for a in values for s in (1, -1)]) for name, values in ANGLES.items()}


def twists(count: int) -> Classes:
    """Return twists of space, and some with very long and very short translations."""
    rng = np.random.default_rng(5)
    found = {n: np.concatenate([x, rng.normal(size=x.shape)], axis=-1) for n, x in vectors(count).items()}
    ordinary = found["ordinary angle"]
    for scale in (1e-50, 1e50):
        found[f"translation {scale:.0e}"] = ordinary * np.repeat([1.0, scale], 3)
    return found


def plane_twists(count: int) -> Classes:
    """Return twists of the plane."""
    rng = np.random.default_rng(6)
    return {
        name: np.concatenate([x[:, None], rng.normal(size=(len(x), 2))], axis=-1)
        for name, x in angles(count).items()
    }


def _promised(classes: Classes) -> Classes:
    """Leave out the angles above pi: as matrices they are smaller ones."""
    return {name: x for name, x in classes.items() if name != "angle to 2 pi"}


def rotations(count: int) -> Classes:
    """Return rotations, rounded from 50 digits."""
    return {
        name: _each(exact.so3_exp, x, lambda v: v[0]).reshape(-1, 3, 3)
        for name, x in _promised(vectors(count)).items()
    }


def plane_rotations(count: int) -> Classes:
    """Return rotations of the plane."""
    return {
        name: _each(exact.so2_exp, x, lambda v: v[0]).reshape(-1, 2, 2)
        for name, x in _promised(angles(count)).items()
    }


def rigid(count: int) -> Classes:
    """Return rigid transformations of space."""
    return {name: _each(exact.se3_exp, x, _homogeneous) for name, x in _promised(twists(count)).items()}


def plane_rigid(count: int) -> Classes:
    """Return rigid transformations of the plane."""
    return {name: _each(exact.se2_exp, x, _homogeneous) for name, x in _promised(plane_twists(count)).items()}


def unit_quaternions(count: int) -> Classes:
    """Return unit quaternions, rounded from 50 digits."""
    return {
        name: _each(exact.quaternion_exp, x, lambda v: v[0]) for name, x in _promised(vectors(count)).items()
    }


def _of_eigenvalues(rows: Sequence[Sequence[float]], count: int, seed: int) -> Array:
    """Return symmetric matrices with these eigenvalues, up to rounding, in several positions."""
    n = len(rows[0])
    Q = _rotations(count, seed)
    if n == 2:
        c, s = np.cos(x := np.linspace(0.3, 6.0, count)), np.sin(x)
        Q = np.stack([c, -s, s, c], axis=-1).reshape(-1, 2, 2)
    d = np.array(rows, dtype=float)
    S = np.einsum("nij,mj,nkj->mnik", Q, d, Q).reshape(-1, n, n)
    diagonal = np.eye(n) * d[:, None, :]
    return np.concatenate([0.5 * (S + np.swapaxes(S, -1, -2)), diagonal])


def _spectra(n: int) -> dict[str, list[tuple[float, ...]]]:
    """Eigenvalues, as logarithms."""
    if n == 2:
        near = [(0.7, 0.7 + g) for g in GAPS]
        return {
            "equal": [(0.0, 0.0), (-1.3, -1.3)],
            "nearly equal": near,
            "ordinary": [(0.5, -0.2), (2.0, 1.0)],
            "spread": [(0.0, np.log(c)) for c in CONDITIONS[1:]],
        }
    near = [(0.7, 0.7 + g, 0.7 - g * h) for g in GAPS for h in (0.0, 0.5)]
    near += [(0.7, -0.4, -0.4 + g) for g in GAPS]
    ordinary = [(0.5, -0.2, 0.1), (2.0, 1.0, -1.5), (1e-3, -2e-3, 3e-3)]
    spread = [(0.0, 0.5 * np.log(c), np.log(c)) for c in CONDITIONS[1:]]
    spread += [(0.0, 1e-9, np.log(c)) for c in CONDITIONS[1:]]
    return {
        "equal": [(0.0, 0.0, 0.0), (-1.3, -1.3, -1.3), (2.0, 2.0, -1.0)],
        "nearly equal": near,
        "ordinary": ordinary,
        "spread": spread,
    }


def _symmetric(count: int, n: int) -> Classes:
    found = {name: _of_eigenvalues(rows, count, 7) for name, rows in _spectra(n).items()}
    last = (3.0, 0.5)[: n - 1]
    found["small"] = _of_eigenvalues([(-s, *(x * s for x in last)) for s in (1e-300, 1e-50, 1e-9)], count, 8)
    found["large"] = _of_eigenvalues([(-s, *(x * s for x in last)) for s in (20.0, 100.0)], count, 8)
    return found


def _definite(count: int, n: int) -> Classes:
    found = {
        name: _of_eigenvalues([tuple(np.exp(row)) for row in rows], count, 9)
        for name, rows in _spectra(n).items()
    }
    ratios = (1.0, 3.0, 50.0)[:n]
    found["scale 1e-50 to 1e50"] = _of_eigenvalues([tuple(s * r for r in ratios) for s in SCALES], count, 10)
    small = [(1e-15, 1e-15), (1e-20, 1e-10)] if n == 2 else [(1e-10, 1e-10, 1e-10), (1e-14, 1e-10, 1e-6)]
    found["determinant 1e-30"] = _of_eigenvalues(small, count, 11)
    return found


def symmetric(count: int) -> Classes:
    """Return symmetric 3 x 3 matrices."""
    return _symmetric(count, 3)


def plane_symmetric(count: int) -> Classes:
    """Return symmetric 2 x 2 matrices."""
    return _symmetric(count, 2)


def definite(count: int) -> Classes:
    """Return positive definite 3 x 3 matrices."""
    return _definite(count, 3)


def plane_definite(count: int) -> Classes:
    """Return positive definite 2 x 2 matrices."""
    return _definite(count, 2)


def _turned(d: Sequence[Sequence[float]], count: int) -> Array:
    """Return U diag(d) V^T with determinant > 0; the first with V = U, so that the rotation is I."""
    U, V = _rotations(count, 12), _rotations(count, 13)
    V[0] = U[0]
    return np.einsum("nij,mj,nkj->mnik", U, np.array(d, float), V).reshape(-1, 3, 3)


def linear(count: int) -> Classes:
    """Return 3 x 3 matrices with positive determinant."""
    equal = [(1.0, 1.0, 1.0), (2.0, 2.0, 2.0), (3.0, 3.0, 0.5)]
    return {
        "equal": _turned(equal, count),
        "nearly equal": _turned([(1.0, 1.0 + g, 1.0 - 0.5 * g) for g in GAPS], count),
        "condition to 1e6": _turned([(1.0, c**-0.4, 1.0 / c) for c in CONDITIONS[1:4]], count),
        "condition 1e9, 1e12": _turned(
            [(1.0, c**-h, 1.0 / c) for c in CONDITIONS[4:] for h in (0.4, 1.0)], count
        ),
        "scale 1e-50 to 1e50": _turned([(s, 2.0 * s, 0.1 * s) for s in SCALES], count),
        "determinant 1e-30": _turned([(1e-10, 1e-10, 1e-10), (1e-5, 1e-10, 1e-15)], count),
    }


def affine(count: int) -> Classes:
    """Return affine transformations with positive determinant, their translations of unit size."""
    found = {}
    rng = np.random.default_rng(14)
    for name, L in linear(count).items():
        A = np.zeros((len(L), 4, 4))
        A[:, :3, :3], A[:, :3, 3], A[:, 3, 3] = L, rng.normal(size=(len(L), 3)), 1.0
        found[name] = A
    half = _each(exact.so3_exp, np.pi * _axes(count), lambda v: v[0]).reshape(-1, 3, 3)
    A = np.tile(np.eye(4), (len(half), 1, 1))
    A[:, :3, :3] = half @ _of_eigenvalues([(3.0, 1.0, 0.4)], len(half) - 1, 15)
    return found | {"half turn, stretched": A}


def parameters(count: int) -> Classes:
    """Return parameters of affine transformations: every kind of angle, and of eigenvalues."""
    rng = np.random.default_rng(17)
    Y = np.concatenate([y for name, y in symmetric(2).items() if name != "large"])
    upper = np.stack([Y[:, i, j] for i in range(3) for j in range(i, 3)], axis=-1)
    found = {}
    for name, x in vectors(count).items():
        y = upper[rng.integers(len(upper), size=len(x))]
        found[name] = np.concatenate([x, rng.normal(size=x.shape), y], axis=-1)
    return found


FAMILIES: Mapping[str, Callable[[int], Classes]] = {
    f.__name__: cache(f)
    for f in (
        *(vectors, angles, twists, plane_twists, rotations, plane_rotations, rigid, plane_rigid),
        *(unit_quaternions, symmetric, plane_symmetric, definite, plane_definite, linear, affine, parameters),
    )
}
"""By name; the argument is the number of axes or positions."""
