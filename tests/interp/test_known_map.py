"""A shape bent by a known map, of which every moment is known: z -> (exp(i k z) - 1) / (i k).

This map is conformal, and its derivative exp(i k z) at a point is a rotation and a scale, of which
the power t is exp(i k t z): the derivative of the same map with t k for k.  So the local maps of a fine
mesh, taken apart into rotation and stretch, fit together at every moment, and the shape between is the
source bent by t k.
"""

from pathlib import Path

import numpy as np
import pytest

from lietool.figure import load
from lietool.interp import constraint, energy, shape
from lietool.mesh import io, shapes

TIMES = np.linspace(0.0, 1.0, 5)
ERRORS = {
    "frobenius": energy.FROBENIUS,
    "point": energy.POINT,
    "similarity": energy.SIMILARITY,
    "point similarity": energy.POINT_SIMILARITY,
}


def bent(P: np.ndarray, k: float) -> np.ndarray:
    z = P @ np.array([1.0, 1.0j])
    w = z if k == 0.0 else (np.exp(1.0j * k * z) - 1.0) / (1.0j * k)
    return np.stack([w.real, w.imag], axis=-1)


def strip(fine: int, long: float = 4.0) -> tuple[np.ndarray, np.ndarray]:
    """A strip of squares of side 1 / fine, of which every other is cut the other way."""
    n, m = round(long * fine), fine
    x, y = np.meshgrid(np.arange(n + 1) / fine, np.arange(m + 1) / fine, indexing="ij")
    a = (np.arange(n)[:, None] * (m + 1) + np.arange(m)).ravel()
    b, c, d = a + m + 1, a + m + 2, a + 1
    odd = (np.add.outer(np.arange(n), np.arange(m)) % 2).ravel().astype(bool)[:, None]
    one, other = np.stack([a, b, c, a, c, d], -1), np.stack([a, b, d, b, c, d], -1)
    return np.stack([x, y - 0.5], axis=-1).reshape(-1, 2), np.where(odd, one, other).reshape(-1, 3)


def farthest(P: np.ndarray, F: np.ndarray, k: float, error: energy.Energy) -> float:
    """How far the shapes between are from those bent less, over the size of the source."""
    a, b = (int(v) for v in F[0, :2])
    paths = [lambda t, v=v: np.stack([bent(P[v], s * k) for s in t]) for v in (a, b)]
    held = [constraint.Locus(v, path) for v, path in zip((a, b), paths, strict=True)]
    if error in (energy.FROBENIUS, energy.POINT):
        held = held[:1]
    prepared = shape.prepare(P, bent(P, k), F, error=error, constraints=held)
    found = shape.solve(prepared, TIMES)
    assert not found.flipped.any()
    known = np.stack([bent(P, t * k) for t in TIMES])
    return float(np.linalg.norm(found.vertices - known, axis=-1).max() / np.ptp(P, axis=0).max())


@pytest.mark.equation("B 5.2", "B 6.1", "B 6.2", "B 6.3", "B 6.4")
@pytest.mark.parametrize("name", ERRORS)
def test_between_is_the_shape_bent_less(name):
    # By 480 degrees in all: more than a full turn.
    k = np.deg2rad(480.0) / 4.0
    coarse, fine = (farthest(*strip(n), k, ERRORS[name]) for n in (8, 16))
    assert fine < 0.02
    # Of second order in the side of the triangles.
    assert coarse / fine > 3.0


def test_an_animal_too():
    pair = shapes.cat()
    size = np.ptp(pair.source, axis=0).max()
    assert farthest(pair.source, pair.faces, np.deg2rad(100.0) / size, energy.FROBENIUS) < 0.01


def test_by_the_command_and_from_files(tmp_path: Path):
    P, F = strip(16)
    k = np.deg2rad(300.0) / 4.0
    for name, V in (("a", P), ("b", bent(P, k))):
        (tmp_path / f"{name}.obj").write_bytes(io.obj(V, F))
    files = {"source": tmp_path / "a.obj", "target": tmp_path / "b.obj"}
    # Angles are counted from the end that does not turn.
    drawing = load("global-interp").draw(stage="global", t=0.5, seed=1.0, **files)
    V, known = drawing.mesh.vertices[:, :2], bent(P, 0.5 * k)
    # Its middle goes straight, and that of what is bent does not.
    assert V - V.mean(axis=0) == pytest.approx(known - known.mean(axis=0), abs=0.01)
