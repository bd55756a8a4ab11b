"""Small shapes for the tests of interpolation."""

import numpy as np
import pytest


def grid(n: int, k: int) -> tuple[np.ndarray, np.ndarray]:
    """A rectangle of n x k vertices, cut into triangles."""
    i, j = np.meshgrid(np.arange(n - 1), np.arange(k - 1), indexing="ij")
    a = (i * k + j).ravel()
    F = np.concatenate([np.stack([a, a + k, a + 1], 1), np.stack([a + 1, a + k, a + k + 1], 1)])
    V = np.stack(np.meshgrid(np.arange(n), np.arange(k), indexing="ij"), -1).reshape(-1, 2).astype(float)
    return V, F


def rolled(V: np.ndarray, angle: float) -> np.ndarray:
    """A straight strip rolled to an arc of a spiral, its ends turned by an angle against each other."""
    s = V[:, 0] / V[:, 0].max()
    radius = V[:, 0].max() / max(abs(angle), 1.0) * (1.0 + 0.4 * s) + 0.35 * (V[:, 1].max() - V[:, 1])
    a = angle * s - np.pi / 2
    return np.stack([radius * np.cos(a), radius * np.sin(a)], axis=1)


@pytest.fixture(scope="session")
def bent() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A strip, the same bent by about a right angle and stretched, and its triangles."""
    V, F = grid(7, 3)
    wave = np.stack([V[:, 0] * 1.1, V[:, 1] + 0.3 * np.sin(V[:, 0])], axis=1)
    return wave, rolled(V, 2.0), F


@pytest.fixture(scope="session")
def roll() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A long strip, the same rolled up by a turn and a half, and its triangles."""
    V, F = grid(40, 3)
    return V, rolled(V, 3.0 * np.pi), F


@pytest.fixture(scope="session")
def shaken() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A strip of 1444 triangles, the same bent; vertices shaken, and numbered at random."""
    V, F = grid(39, 20)
    rng = np.random.default_rng(3)
    V = V + rng.uniform(-0.2, 0.2, V.shape)
    number = rng.permutation(len(V))
    P, Q = np.empty_like(V), np.empty_like(V)
    P[number], Q[number] = V / 19.0, rolled(V / 19.0, 2.5)
    return P, Q, number[F]
