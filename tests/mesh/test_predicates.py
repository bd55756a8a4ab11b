"""The turn of three points, exact where floating point is not."""

from fractions import Fraction

import numpy as np

from lietool.mesh.predicates import orientation


def exact(a, b, c):
    (x, y), (u, v), (s, t) = ([Fraction(k) for k in p] for p in (a.tolist(), b.tolist(), c.tolist()))
    det = (x - s) * (v - t) - (y - t) * (u - s)
    return (det > 0) - (det < 0)


def test_signs():
    p = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    assert orientation(*p) == 1
    assert orientation(*p[::-1]) == -1
    assert orientation(p[0], p[1], 0.5 * p[1]) == 0


def test_points_near_a_line_by_rational_arithmetic():
    # Kettner et al.'s example: in floating point the signs around (0.5, 0.5) are noise.
    k = np.arange(32) * 2.0**-53
    a = np.stack(np.meshgrid(0.5 + k, 0.5 + k), axis=-1)
    b, c = np.array([12.0, 12.0]), np.array([24.0, 24.0])
    sign = orientation(a, b, c)
    assert sign.shape == (32, 32)
    np.testing.assert_array_equal(sign.ravel(), [exact(p, b, c) for p in a.reshape(-1, 2)])
    naive = np.sign((a[..., 0] - 24.0) * (b[1] - 24.0) - (a[..., 1] - 24.0) * (b[0] - 24.0))
    assert np.any(naive != sign)


def test_products_that_vanish():
    tiny = np.array([(0.0, 0.0), (1e-200, 0.0), (0.0, 1e-200)])
    assert orientation(*tiny) == 1
    assert orientation(*tiny[[0, 2, 1]]) == -1


def test_random_triples_of_few_values():
    p = np.random.default_rng(0).integers(-3, 4, (300, 3, 2)) * 0.1
    expected = [exact(*row) for row in p]
    np.testing.assert_array_equal(orientation(p[:, 0], p[:, 1], p[:, 2]), expected)
