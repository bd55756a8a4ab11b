"""Maps of triangles and the ways to them: against linear algebra, mpmath and SciPy, and by their laws."""

import mpmath
import numpy as np
import pytest
import scipy.linalg

from lietool.interp import triangle
from lietool.lie import polar, sym

WAYS = (triangle.linear, triangle.arap, triangle.logexp, triangle.matrix_log)
TIMES = np.array([-0.7, 0.0, 0.25, 0.5, 1.0, 1.6])


def positive(count: int, seed: int = 0) -> np.ndarray:
    A = np.random.default_rng(seed).normal(size=(count, 2, 2))
    A[np.linalg.det(A) < 0.0, :, 0] *= -1.0
    return A


def with_log(count: int, seed: int = 0) -> np.ndarray:
    A = positive(3 * count, seed)
    return A[triangle.has_real_log(A)][:count]


class TestMaps:
    @pytest.mark.equation("B 5.1")
    def test_the_unit_triangle_goes_to_the_corners(self):
        p = np.random.default_rng(1).normal(size=(4, 5, 3, 2))
        unit = np.array([[1.0, 0, 1], [0, 1, 1], [0, 0, 1]])
        assert np.einsum("...ij,kj->...ki", triangle.frame(p), unit)[..., :2] == pytest.approx(p)
        # As printed: the corners, times what subtracts the third from the first two.
        corners = np.concatenate([np.swapaxes(p, -1, -2), np.ones((4, 5, 1, 3))], axis=-2)
        assert triangle.frame(p) == pytest.approx(corners @ [[1, 0, 0], [0, 1, 0], [-1, -1, 1]])

    @pytest.mark.equation("B 5.2")
    def test_a_triangle_goes_to_another(self):
        p, q = np.random.default_rng(2).normal(size=(2, 50, 3, 2))
        A = triangle.affine_map(p, q)
        homogeneous = [np.concatenate([np.swapaxes(x, -1, -2), np.ones((50, 1, 3))], axis=-2) for x in (p, q)]
        expected = np.swapaxes(
            np.linalg.solve(np.swapaxes(homogeneous[0], -1, -2), np.swapaxes(homogeneous[1], -1, -2)), -1, -2
        )
        assert pytest.approx(expected, rel=1e-9, abs=1e-9) == A
        assert (A[:, 2] == [0.0, 0.0, 1.0]).all()

    def test_far_from_the_origin(self):
        p, q = np.random.default_rng(3).normal(size=(2, 3, 2))
        A = triangle.affine_map(p + 1e9, q)
        assert A[:2, :2] == pytest.approx(triangle.affine_map(p, q)[:2, :2], rel=1e-5)

    def test_one_and_many_agree(self):
        p, q = np.random.default_rng(4).normal(size=(2, 2, 5, 3, 2))
        A = triangle.affine_map(p, q)
        assert A[1, 3].tolist() == triangle.affine_map(p[1, 3], q[1, 3]).tolist()
        assert triangle.affine_map(p[0, 0], q).shape == (2, 5, 3, 3)

    @pytest.mark.parametrize(
        ("source", "says"),
        [
            ([[0, 0], [1, 1], [2, 2]], "a triangle with area"),
            ([[0, 0], [0, 0], [2, 2]], "a triangle with area"),
            ([[0, 0], [np.nan, 1], [2, 0]], "finite"),
            ([[0, 0], [1, 1]], "shape"),
        ],
    )
    def test_what_is_no_triangle(self, source, says):
        with pytest.raises(ValueError, match=says):
            triangle.affine_map(source, [[0, 0], [1, 0], [0, 1]])


class TestHomotopies:
    @pytest.mark.parametrize("way", WAYS)
    def test_from_the_identity_to_the_map(self, way):
        A = with_log(300)
        path = way(A, TIMES)
        assert path.shape == (len(TIMES), 300, 2, 2)
        assert path[1] == pytest.approx(np.broadcast_to(np.eye(2), A.shape), abs=1e-15)
        assert path[4] == pytest.approx(A, rel=1e-12, abs=1e-12)

    @pytest.mark.parametrize("way", WAYS)
    def test_one_and_many_agree(self, way):
        A = with_log(10).reshape(2, 5, 2, 2)
        path = way(A, TIMES[:, None])
        assert path.shape == (6, 1, 2, 5, 2, 2)
        assert path[2, 0, 1, 3] == pytest.approx(way(A[1, 3], TIMES[2]), abs=1e-15)

    def test_rotation_and_stretch_apart(self):
        A = positive(200)
        R, S = polar.decompose(A)
        theta = np.arctan2(R[:, 1, 0], R[:, 0, 0])
        for t in TIMES:
            c, s = np.cos(t * theta), np.sin(t * theta)
            turn = np.stack([c, -s, s, c], axis=-1).reshape(-1, 2, 2)
            assert triangle.arap(A, t) == pytest.approx(turn @ ((1 - t) * np.eye(2) + t * S), abs=1e-12)
            expected = turn @ sym.power(S, t)
            assert triangle.logexp(A, t) == pytest.approx(expected, rel=1e-9, abs=1e-11)

    def test_an_ill_conditioned_map_by_mpmath(self):
        with mpmath.workdps(50):
            for scale in (1e-10, 1e-5, 1.0, 1e6):
                S = mpmath.matrix([[1.0, 0.75], [0.75, 0.5625 + scale]])
                A = np.array([[1.0, 0.75], [0.75, 0.5625 + scale]])
                values, V = mpmath.eigsy(S)
                half = V * mpmath.diag([mpmath.sqrt(x) for x in values]) * V.T
                expected = np.array(half.tolist(), float)
                error = np.abs(triangle.logexp(A, 0.5) - expected).max() / np.abs(expected).max()
                assert error < 1e-15 + 1e-16 / scale

    @pytest.mark.erratum("B 5.2 (text)")
    def test_the_straight_stretch_collapses_only_outside(self):
        A = np.diag([0.2, 3.0])
        assert np.linalg.det(triangle.arap(A, 1.25)) == pytest.approx(0.0, abs=1e-15)
        inside = triangle.arap(positive(200), np.linspace(0.0, 1.0, 21))
        assert np.linalg.det(inside).min() > 0.0
        assert np.linalg.det(triangle.logexp(positive(200), np.linspace(-3.0, 4.0, 29))).min() > 0.0

    def test_the_linear_way_may_collapse(self):
        A = np.diag([-1.0, -1.0])
        assert np.linalg.det(triangle.linear(A, 0.5)) == 0.0
        assert np.linalg.det(triangle.logexp(A, 0.5)) == pytest.approx(1.0)

    @pytest.mark.parametrize("way", [triangle.arap, triangle.logexp])
    def test_angles_beyond_a_half_turn(self, way):
        A = positive(50)
        theta = triangle.principal_angle(A)
        for turns in (-2, 1, 3):
            path = way(A, np.array([0.0, 0.5, 1.0]), theta + 2 * np.pi * turns)
            assert path[2] == pytest.approx(A, abs=1e-12)
            assert path[1] == pytest.approx(way(A, 0.5) * (-1) ** turns, abs=1e-12)
        with pytest.raises(ValueError, match="but for full turns"):
            way(A, 0.5, theta + 0.1)

    def test_symmetric_maps_are_powers(self):
        S = sym.exp(np.array([[0.3, 0.8], [0.8, -0.4]]))
        for t in TIMES:
            assert triangle.logexp(S, t) == pytest.approx(sym.power(S, t), abs=1e-14)
            assert triangle.arap(S, t) == pytest.approx(triangle.linear(S, t), abs=1e-14)

    @pytest.mark.parametrize("bad", [np.diag([-1.0, 2.0]), np.zeros((2, 2)), np.diag([1.0, 0.0])])
    def test_no_reflection_and_no_collapse(self, bad):
        for way in (triangle.arap, triangle.logexp):
            with pytest.raises(ValueError, match="det A > 0"):
                way(bad, 0.5)


class TestMatrixLog:
    def test_it_is_the_fractional_power(self):
        for A in with_log(60, 5):
            for t in (-0.5, 0.3, 1.7):
                expected = scipy.linalg.fractional_matrix_power(A, t)
                assert triangle.matrix_log(A, t) == pytest.approx(expected, rel=1e-6, abs=1e-8)

    def test_it_is_a_one_parameter_subgroup(self):
        A = with_log(100, 6)
        s, t = 0.3, 0.45
        both = triangle.matrix_log(A, s) @ triangle.matrix_log(A, t)
        size = np.abs(both).max(axis=(1, 2), keepdims=True)
        assert np.abs(both - triangle.matrix_log(A, s + t)).max() < 1e-9 * size.max()

    @pytest.mark.parametrize(
        ("A", "has"),
        [
            (np.eye(2), True),
            (-np.eye(2), True),
            (np.diag([-1.0, -2.0]), False),
            ([[-1.0, 1.0], [0.0, -1.0]], False),
            ([[1.0, 1.0], [0.0, 1.0]], True),
            (np.diag([-1.0, 1.0]), False),
            ([[0.0, -3.0], [0.5, 0.0]], True),
        ],
    )
    def test_which_have_one(self, A, has):
        assert triangle.has_real_log(A) == has
        if has:
            path = triangle.matrix_log(A, np.array([0.0, 0.5, 1.0]))
            assert path[2] == pytest.approx(np.asarray(A), abs=1e-15)
            assert path[1] @ path[1] == pytest.approx(np.asarray(A), abs=1e-15)
        else:
            with pytest.raises(ValueError, match="real logarithm"):
                triangle.matrix_log(A, 0.5)

    def test_nearly_equal_eigenvalues(self):
        for gap in (1e-3, 1e-7, 1e-9, 1e-12, 0.0):
            for sign in (1.0, -1.0):
                A = np.array([[2.0, 1.0], [sign * gap, 2.0]])
                with mpmath.workdps(60):
                    M = mpmath.matrix(A.tolist())
                    expected = mpmath.expm(mpmath.logm(M) * mpmath.mpf("0.3")) if gap else None
                if expected is None:
                    expected_array = 2.0**0.3 * np.array([[1.0, 0.3 / 2.0], [0.0, 1.0]])
                else:
                    expected_array = np.array([[float(x.real) for x in row] for row in expected.tolist()])
                assert triangle.matrix_log(A, 0.3) == pytest.approx(
                    expected_array, abs=2e-15 + 1e-8 * gap**0.5
                )

    def test_the_offending_one_is_named(self):
        A = np.tile(np.eye(2), (4, 1, 1))
        A[2] = np.diag([-1.0, -2.0])
        with pytest.raises(ValueError, match=r"-1, -2 in matrix at index \(2,\)"):
            triangle.matrix_log(A, 0.5)


def test_coordinates_and_back():
    A = np.random.default_rng(7).normal(size=(3, 4, 2, 2))
    a, b = triangle.coordinates(A)
    assert triangle.matrix(a, b) == pytest.approx(A)
    z = np.random.default_rng(8).normal(size=(3, 4, 2))
    moved = np.einsum("...ij,...j->...i", A, z)
    w = z[..., 0] + 1j * z[..., 1]
    assert (a * w + b * np.conj(w)) == pytest.approx(moved[..., 0] + 1j * moved[..., 1])
    assert np.abs(a) ** 2 - np.abs(b) ** 2 == pytest.approx(np.linalg.det(A))
