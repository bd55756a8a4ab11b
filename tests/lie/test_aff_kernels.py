"""The exponential of aff(3) against sixty digits: near 0, far away, and for matrices of every kind."""

import mpmath
import numpy as np
import pytest

from lietool.lie import aff, aff_kernels, blocks

SIZES = (1e-3, 0.3, 1.0, 3.0, 30.0)
KINDS = {
    "any": lambda L: L,
    "skew": lambda L: L - L.T,
    "diagonal": lambda L: np.diag(np.diag(L)),
    "nilpotent": lambda L: np.triu(L, 1),
    "multiple of -I": lambda L: -abs(L[0, 0]) * np.eye(3),
}


def _precisely(X: np.ndarray) -> np.ndarray:
    with mpmath.workdps(60):
        E = mpmath.expm(mpmath.matrix(X.tolist()), method="taylor")
        return np.array([[float(x) for x in row] for row in E.tolist()])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", SIZES)
def test_exponential_to_the_last_digits(kind, size):
    rng = np.random.default_rng(5)
    for _ in range(4):
        X = np.zeros((4, 4))
        X[:3, :3] = KINDS[kind](rng.normal(size=(3, 3)))
        X[:3, :3] *= size / np.linalg.norm(X[:3, :3])
        X[:3, 3] = rng.normal(size=3)
        found, right = aff.exp(X), _precisely(X)
        # A relative error of X itself by half a digit would do as much.
        bound = 1e-15 * (1.0 + size)
        assert np.abs(found - right)[:3, :3].max() < bound * np.abs(right[:3, :3]).max()
        assert np.abs(found - right)[:3, 3].max() < bound * np.abs(right[:3, 3]).max()


def test_without_translation_it_is_the_same():
    X = np.zeros((50, 4, 4))
    X[:, :3] = np.random.default_rng(6).normal(size=(50, 3, 4)) * np.logspace(-3, 1, 50)[:, None, None]
    L = blocks.run(aff_kernels.exp_part, (3, 3), (X[:, :3, :3], 2))
    assert np.array_equal(L, aff.exp(X)[:, :3, :3])
