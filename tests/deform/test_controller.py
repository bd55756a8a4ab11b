"""Weights from a point in a polygon, and weights for many variations."""

import igl
import numpy as np
import pytest

from lietool.deform import controller, population

SQUARE = np.array([[0, 0], [2, 0], [2, 1], [0, 1]], float)
NOTCHED = np.array([[0, 0], [4, 0], [4, 3], [2, 1], [0, 3]], float)  # not convex
POLYGONS = {
    "triangle": controller.regular(3),
    "square": SQUARE,
    "clockwise": SQUARE[::-1].copy(),
    "seven": np.add(controller.regular(7, 3.0), (10.0, -4.0)),
    "notched": NOTCHED,
    "small and far": np.add(1e-6 * SQUARE, (1000.0, 2000.0)),
}


def inside(corners: np.ndarray, count: int = 400, spread: float = 1.0) -> np.ndarray:
    rng = np.random.default_rng(1)
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * spread * (high - low)
    return middle + rng.uniform(-1, 1, (count, 2)) * half


@pytest.mark.parametrize("name", POLYGONS)
@pytest.mark.parametrize("spread", [1.0, 8.0])
def test_they_sum_to_one_and_reproduce_the_point(name, spread):
    c = POLYGONS[name]
    p = inside(c, spread=spread)
    w = controller.coordinates(c, p)
    np.testing.assert_allclose(w.sum(axis=-1), 1.0, atol=1e-12)
    size = np.ptp(c)
    tolerance = 1e-10 * np.max(np.abs(w), axis=-1, keepdims=True) * size + 1e-12 * np.max(np.abs(c))
    assert np.all(np.abs(w @ c - p) < tolerance)


@pytest.mark.parametrize("name", POLYGONS)
def test_corners_and_edges_are_exact(name):
    c = POLYGONS[name]
    k = len(c)
    np.testing.assert_allclose(controller.coordinates(c, c), np.eye(k), atol=1e-12)
    for i in range(k):
        for t in (1e-9, 0.25, 0.5, 0.9):
            w = controller.coordinates(c, (1 - t) * c[i] + t * c[(i + 1) % k])
            expected = np.zeros(k)
            expected[i], expected[(i + 1) % k] = 1 - t, t
            np.testing.assert_allclose(w, expected, atol=1e-6 if name == "small and far" else 1e-9)


@pytest.mark.parametrize("name", ["square", "seven", "notched"])
@pytest.mark.parametrize("spread", [1.0, 3.0])
def test_they_are_libigls(name, spread):
    c = POLYGONS[name]
    p = inside(c, spread=spread)
    np.testing.assert_allclose(controller.coordinates(c, p), igl.mvc(p, c), atol=1e-12)


def test_they_are_continuous_across_edges_and_towards_corners():
    for c in (SQUARE, NOTCHED):
        for i in range(len(c)):
            a, b = c[i], c[(i + 1) % len(c)]
            out = np.array([b[1] - a[1], a[0] - b[0]])
            for t in (0.0, 0.3):
                on = controller.coordinates(c, (1 - t) * a + t * b)
                for step in (1e-5, 1e-8, 1e-11, 1e-13, 1e-15):
                    for side in (1, -1):
                        near = controller.coordinates(c, (1 - t) * a + t * b + side * step * out)
                        np.testing.assert_allclose(near, on, atol=max(20 * step, 1e-9))


def test_positive_inside_a_convex_polygon_and_negative_somewhere_outside():
    c = controller.regular(5)
    assert np.all(controller.coordinates(c, 0.5 * inside(c)) > 0.0)
    assert np.any(controller.coordinates(c, [3.0, 0.0]) < 0.0)
    w = controller.coordinates(c, 50.0 * inside(c))
    assert np.isfinite(w).all()


def test_in_a_triangle_they_are_barycentric():
    c = np.array([[0, 0], [3, 1], [1, 4]], float)
    p = inside(c, spread=5.0)
    expected = np.linalg.solve(np.vstack([c.T, np.ones(3)]), np.vstack([p.T, np.ones(len(p))])).T
    np.testing.assert_allclose(controller.coordinates(c, p), expected, atol=1e-10)


def test_they_are_the_integral_of_the_mean_value_property():
    """By Floater's definition: the mean over directions of f on the edge, weighted with 1 / distance."""
    c, p = controller.regular(5), np.array([0.2, -0.3])
    angle = (np.arange(200_000) + 0.5) * 2 * np.pi / 200_000
    d = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    total = np.zeros(5)
    for i in range(5):
        a, e = c[i] - p, c[(i + 1) % 5] - c[i]
        # p + r d = a + s e
        cross = d[:, 0] * e[1] - d[:, 1] * e[0]
        r = (a[0] * e[1] - a[1] * e[0]) / cross
        s = (a[0] * d[:, 1] - a[1] * d[:, 0]) / cross
        hit = (r > 0) & (s >= 0) & (s < 1)
        total[i] += np.sum((1 - s[hit]) / r[hit])
        total[(i + 1) % 5] += np.sum(s[hit] / r[hit])
    np.testing.assert_allclose(controller.coordinates(c, p), total / total.sum(), atol=1e-5)


def test_batches_are_single_calls():
    p = inside(NOTCHED, 12).reshape(3, 4, 2)
    p[0, 0], p[1, 1] = NOTCHED[2], 0.5 * (NOTCHED[0] + NOTCHED[1])
    w = controller.coordinates(NOTCHED, p)
    assert w.shape == (3, 4, 5)
    for index in np.ndindex(3, 4):
        assert np.array_equal(controller.coordinates(NOTCHED, p[index]), w[index])
    assert controller.coordinates(NOTCHED, np.zeros((0, 2))).shape == (0, 5)


def test_a_corner_may_stand_for_the_rest():
    c = controller.controller(SQUARE, rest=1)
    assert c.targets == 3
    np.testing.assert_allclose(c.weights(SQUARE), np.delete(np.eye(4), 1, axis=1), atol=1e-15)
    p = inside(SQUARE, 50, 3.0)
    np.testing.assert_allclose(c.position(c.weights(p)), p, atol=1e-10)
    assert controller.controller(SQUARE).targets == 4


def test_the_inverse_undoes_positions_but_not_weights():
    c = controller.controller(SQUARE)
    w = np.array([0.5, 0.0, 0.5, 0.0])
    again = c.weights(c.position(w))
    assert not np.allclose(again, w)
    np.testing.assert_allclose(c.position(again), c.position(w), atol=1e-15)
    t = controller.controller(controller.regular(3), rest=0)
    np.testing.assert_allclose(t.weights(t.position([-0.4, 1.7])), [-0.4, 1.7], atol=1e-12)


def test_dirichlet_weights():
    w = population.dirichlet(200, 3, 7)
    assert w.shape == (200, 3) and np.all(w >= 0)
    np.testing.assert_allclose(w.sum(axis=1), 1.0)
    assert np.array_equal(w, population.dirichlet(200, 3, 7))
    assert not np.array_equal(w, population.dirichlet(200, 3, 8))
    np.testing.assert_allclose(w.mean(axis=0), 1 / 3, atol=0.06)
    with_rest = population.dirichlet(200, 3, 7, rest=1.0)
    assert np.all(with_rest.sum(axis=1) < 1.0) and with_rest.sum(axis=1).mean() == pytest.approx(
        0.75, abs=0.05
    )
    low, high = (population.dirichlet(200, 3, 7, concentration=a).max(axis=1).mean() for a in (0.1, 10.0))
    assert low > 0.85 and high < 0.55
    assert population.dirichlet(0, 3, 7).shape == (0, 3)


def test_grid_weights():
    assert population.grid(3, 1).tolist() == np.eye(3).tolist()
    w = population.grid(3, 4)
    assert w.shape == (15, 3) and len(np.unique(w, axis=0)) == 15
    np.testing.assert_allclose(w.sum(axis=1), 1.0)
    np.testing.assert_allclose(4 * w, np.rint(4 * w))
    assert population.grid(1, 5).tolist() == [[1.0]]
    assert population.grid(4, 3).shape == (20, 4)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: controller.controller(SQUARE[:2]), "corners must be three corners or more"),
        (lambda: controller.controller(SQUARE[[0, 2, 1, 3]]), "corners must be of a polygon"),
        (lambda: controller.controller([[0, 0], [1, 0], [1, 0], [0, 1.0]]), "corners must be"),
        (lambda: controller.controller([[0, 0], [1, 0], [0, 0.0]]), "corners must be different"),
        (lambda: controller.controller([[0, 0], [1, 0], [0.5, 0.0]]), "corners must be different"),
        (lambda: controller.controller([[0, 0], [2, 0], [2, 2], [1, 0], [0, 2]]), "corners must be of"),
        (lambda: controller.controller([[0, 0], [np.nan, 0], [0, 1]]), "corners must be finite"),
        (lambda: controller.controller(SQUARE, 4), "rest must be a corner, 0 to 3; got 4"),
        (lambda: controller.coordinates(SQUARE, [0, np.inf]), "position must be finite"),
        (lambda: controller.coordinates(SQUARE, [0, 0, 0]), "position must be an array"),
        (lambda: controller.controller(SQUARE).position([1, 1, 0, 0]), "weights must be of sum 1; got 2"),
        (lambda: controller.controller(SQUARE).position([1, 0]), "weights must be an array"),
        (lambda: controller.regular(2), "k must be a whole number, at least 3; got 2"),
        (lambda: controller.regular(3, -1.0), "radius must be positive"),
        (lambda: population.dirichlet(-1, 3, 0), "count must be a whole number"),
        (lambda: population.dirichlet(1, 0, 0), "targets must be a whole number"),
        (lambda: population.dirichlet(1, 2, -5), "seed must be a whole number"),
        (lambda: population.dirichlet(1, 2, 0, concentration=0.0), "concentration must be positive"),
        (lambda: population.dirichlet(1, 2, 0, rest=np.nan), "rest must be not negative"),
        (lambda: controller.regular(np.nan), "k must be a whole number, at least 3; got nan"),
        (lambda: population.grid(3, np.nan), "steps must be a whole number"),
        (lambda: population.grid(3, 0), "steps must be a whole number"),
        (lambda: population.grid(30, 30), "steps must be so few"),
    ],
)
def test_bad_input_is_named(call, says):
    with pytest.raises(ValueError, match=rf"^(controller|population)\.\w+: {says}[^\n]*$"):
        call()
