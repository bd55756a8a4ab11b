"""Matrix groups of any size: exponential, real logarithms and their absence, algebras, projective maps."""

import itertools

import mpmath
import numpy as np
import pytest
from scipy.linalg import expm, logm

from lietool.lie import axis_angle, basis, generic, projective, se2, se3, so3

PI = np.pi
SO3 = np.array([generic.J_X, generic.J_Y, generic.J_Z])
SE3 = se3.hat(np.eye(6))
rng_of = np.random.default_rng


def normal(*shape: int, seed: int = 0) -> np.ndarray:
    return rng_of(seed).normal(size=shape)


def exact_exp(A: np.ndarray) -> np.ndarray:
    with mpmath.workdps(50):
        return np.array(mpmath.expm(mpmath.matrix(A.tolist()), method="taylor").tolist(), dtype=float)


def residual(L: np.ndarray, A: np.ndarray) -> float:
    return float(np.linalg.norm(expm(L) - A) / np.linalg.norm(A))


@pytest.mark.equation("B 4.1", "B 4.2", "B 4.11")
@pytest.mark.parametrize("n", [1, 2, 3, 4, 6])
def test_exp_is_the_sum_of_powers(n):
    A = normal(3, n, n)
    for Ai, value in zip(A, generic.exp(A), strict=True):
        exact = exact_exp(Ai)
        np.testing.assert_allclose(value, exact, rtol=0, atol=1e-13 * np.max(np.abs(exact)))
    P = normal(n, n, seed=1) + 3 * np.eye(n)
    moved = np.linalg.inv(P) @ generic.exp(A) @ P
    np.testing.assert_allclose(generic.exp(np.linalg.inv(P) @ A @ P), moved, rtol=0, atol=1e-11)


@pytest.mark.equation("B 4.3", "B 4.4", "B 4.5", "B 4.6", "B 4.12", "B 4.13")
def test_exponentials_in_closed_form():
    np.testing.assert_allclose(
        generic.exp(np.diag([0.3, -1.0, 2.0])), np.diag(np.exp([0.3, -1.0, 2.0])), rtol=1e-15
    )
    c, s = np.cos(0.8), np.sin(0.8)
    turn = np.array([[c, -s], [s, c]])
    np.testing.assert_allclose(generic.exp([[0, -0.8], [0.8, 0]]), turn, atol=2e-16)
    assert c + 1j * s == pytest.approx(np.exp(0.8j))
    translation = np.zeros((4, 4))
    translation[:3, 3] = 1, 2, 3
    np.testing.assert_allclose(generic.exp(translation), np.eye(4) + translation, atol=1e-15)
    N = np.triu(normal(4, 4), 1)
    finite = np.eye(4) + N + N @ N / 2 + N @ N @ N / 6
    np.testing.assert_allclose(generic.exp(N), finite, atol=2e-15)
    # And the logarithms, each by its finite sum.
    np.testing.assert_allclose(generic.log(np.diag(np.exp([0.3, -1.0]))), np.diag([0.3, -1.0]), atol=1e-15)
    np.testing.assert_allclose(generic.log(turn), [[0, -0.8], [0.8, 0]], atol=1e-15)
    M = finite - np.eye(4)
    np.testing.assert_allclose(generic.log(finite), M - M @ M / 2 + M @ M @ M / 3, atol=4e-15)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 6])
def test_log_undoes_exp_near_zero_and_exp_undoes_log(n):
    X = 0.9 * normal(4, n, n) / max(n, 2)
    np.testing.assert_allclose(generic.log(generic.exp(X)), X, rtol=0, atol=2e-13)
    for Xi, L in zip(X, generic.log(generic.exp(X)), strict=True):
        np.testing.assert_allclose(L, logm(generic.exp(Xi)), rtol=0, atol=2e-13)


@pytest.mark.parametrize("gap", [1.0, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-14])
def test_log_of_rotations_and_screws_beside_a_half_turn(gap):
    """The condition is 1 / gap for a general matrix; for a rotation it is 1, but so3.log alone knows it."""
    for u in ((1, 0, 0), (0.6, 0.0, -0.8), (1, 1, 1)):
        x = np.r_[(PI - gap) * np.array(u) / np.linalg.norm(u), 1.0, 2.0, 3.0]
        T = se3.exp(x)
        L, M = generic.log(T[:3, :3]), generic.log(T)
        assert residual(L, T[:3, :3]) < 4e-15
        assert residual(M, T) < 2e-14
        np.testing.assert_allclose(L, so3.hat(so3.log(T[:3, :3])), rtol=0, atol=1e-14 / gap)
        np.testing.assert_allclose(M, se3.hat(se3.log(T)), rtol=0, atol=1e-13 / gap)


def test_log_of_half_turns_is_one_of_many():
    for n in (2, 4, 6):
        assert residual(generic.log(-np.eye(n)), -np.eye(n)) < 1e-14
    T = se3.exp([PI, 0, 0, 1.0, 2.0, 3.0])
    assert residual(generic.log(T), T) < 1e-14
    A = np.diag([-2.0, -2, -3, -3, 5])
    P = normal(5, 5) + 2 * np.eye(5)
    assert residual(generic.log(A), A) < 1e-13
    B = P @ np.diag([-2.0, -2, 1, 3, 5]) @ np.linalg.inv(P)
    assert residual(generic.log(B), B) < 1e-12


NONE = {
    "a reflection": (np.diag([1.0, -1.0, 1.0]), "the negative eigenvalue -1"),
    "two unlike": (np.diag([-1.0, -2.0, 1.0]), "the negative eigenvalue -[12]"),
    "three alike": (-np.eye(3), "the negative eigenvalue -1, 3 times"),
    "one eigenvector for two": (np.array([[-1.0, 1, 0], [0, -1, 0], [0, 0, 2]]), "with too few eigenvectors"),
    "singular": (np.diag([1.0, 0.0, 2.0]), "eigenvalue 0"),
    "zero": (np.zeros((3, 3)), "eigenvalue 0"),
}


@pytest.mark.parametrize("name", NONE)
def test_log_says_which_matrix_has_none(name):
    A, words = NONE[name]
    batch = np.tile(so3.rotation("x", 0.4), (2, 3, 1, 1))
    batch[1, 2] = A
    must = r"^generic\.log: A must be a matrix with a real logarithm; got .*"
    with pytest.raises(ValueError, match=must + words + r" at index \(1, 2\)\. [^\n]*$"):
        generic.log(batch)
    L = generic.log(batch, check=False)
    assert np.all(np.isnan(L[1, 2]))
    assert np.all(np.isfinite(L[0]))


def test_log_agrees_with_the_eigenvalues_on_random_affine_maps():
    """A real logarithm fails to exist for about a third of Aff+(3), and is found for all others."""
    A = np.tile(np.eye(4), (80, 1, 1))
    A[:, :3] = normal(80, 3, 4)
    A = A[np.linalg.det(A) > 0]
    w = np.linalg.eigvals(A)
    has = ~np.any((w.imag == 0) & (w.real < 0), axis=-1)
    L = generic.log(A, check=False)
    assert np.array_equal(np.all(np.isfinite(L), axis=(-1, -2)), has)
    assert 0.2 < np.mean(~has) < 0.5
    assert max(residual(Li, Ai) for Li, Ai in zip(L[has], A[has], strict=True)) < 1e-11


def test_what_float64_cannot_hold_is_refused():
    """Similar to a Jordan block of -1: rounding gives it logarithms, of a size that makes them useless."""
    P = normal(3, 3)
    J = np.array([[-1.0, 1, 0], [0, -1, 0], [0, 0, 2]])
    with pytest.raises(ValueError, match=r"^generic\.log: A must be a matrix with a real logarithm"):
        generic.log(P @ J @ np.linalg.inv(P))


@pytest.mark.equation("B 4.8", "B 4.14", "B 4.17")
def test_one_parameter_subgroups():
    A, s, t = normal(4, 3, 3), 0.3, -1.1
    phi = generic.one_parameter
    np.testing.assert_allclose(phi(A, s) @ phi(A, t), phi(A, s + t), rtol=0, atol=1e-13)
    np.testing.assert_array_equal(phi(A, 0.0), np.broadcast_to(np.eye(3), A.shape))
    h = 1e-5
    np.testing.assert_allclose((phi(A, h) - phi(A, -h)) / (2 * h), A, atol=1e-8)
    np.testing.assert_allclose((phi(A, t + h) - phi(A, t - h)) / (2 * h), A @ phi(A, t), atol=1e-7)
    # It stays in the group whose algebra A is of.
    R = phi(SO3, t)
    np.testing.assert_allclose(np.swapaxes(R, -1, -2) @ R, np.broadcast_to(np.eye(3), R.shape), atol=1e-15)
    np.testing.assert_allclose(
        np.linalg.det(phi(A - np.trace(A, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3), t)), 1
    )


@pytest.mark.equation("B 4.9", "B 4.10")
def test_exp_of_a_sum_and_the_series_that_mends_it():
    A, B = np.array([[0.0, 0], [1, 0]]), np.array([[0.0, -1], [0, 0]])
    first, second, third = (
        generic.exp(A + B),
        generic.exp(A) @ generic.exp(B),
        generic.exp(B) @ generic.exp(A),
    )
    assert min(np.max(np.abs(x - y)) for x, y in itertools.combinations((first, second, third), 2)) > 0.2
    X = normal(3, 3)
    Y = X @ X - 2 * X
    np.testing.assert_allclose(generic.bracket(X, Y), 0, atol=1e-14)
    np.testing.assert_allclose(generic.exp(X + Y), generic.exp(X) @ generic.exp(Y), rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(generic.bch(X, Y), X + Y, atol=1e-13)


@pytest.mark.parametrize("order", basis.ORDERS)
def test_baker_campbell_hausdorff_to_its_order(order):
    """What is left out shrinks as the size to the power order + 1."""
    X, Y = normal(3, 3), normal(3, 3, seed=1)

    def gap(h: float) -> float:
        return float(
            np.max(
                np.abs(
                    generic.bch(h * X, h * Y, order) - generic.log(generic.exp(h * X) @ generic.exp(h * Y))
                )
            )
        )

    assert np.log2(gap(0.04) / gap(0.02)) == pytest.approx(order + 1, abs=0.3)


def test_bch_of_so3_is_the_composition_of_rotations():
    x, y = 0.02 * normal(3), 0.02 * normal(3, seed=1)
    exact = so3.log(so3.exp(x) @ so3.exp(y))
    np.testing.assert_allclose(so3.vee(generic.bch(so3.hat(x), so3.hat(y))), exact, atol=1e-8)
    with pytest.raises(ValueError, match=r"^basis\.bch: order must be one of 1, 2, 3, 4; got 5"):
        generic.bch(SO3, SO3, 5)


def test_lie_bracket():
    A, B, C = normal(3, 4, 4)
    b = generic.bracket
    np.testing.assert_allclose(b(A, B), -b(B, A))
    np.testing.assert_allclose(b(2 * A + C, B), 2 * b(A, B) + b(C, B), atol=1e-14)
    np.testing.assert_allclose(b(A, b(B, C)) + b(B, b(C, A)) + b(C, b(A, B)), 0, atol=1e-13)
    # It is what the group's commutator leaves to second order.
    h = 1e-3
    g = [generic.exp(s * h * X) for s in (1, -1) for X in (A, B)]
    np.testing.assert_allclose((g[0] @ g[1] @ g[2] @ g[3] - np.eye(4)) / h**2, b(A, B), atol=0.1)
    x, y = normal(2, 3)
    np.testing.assert_allclose(so3.vee(b(so3.hat(x), so3.hat(y))), np.cross(x, y), atol=1e-15)


def test_structure_constants():
    signs = np.zeros((3, 3, 3))
    for i, j, k in itertools.permutations(range(3)):
        signs[i, j, k] = np.linalg.det(np.eye(3)[[i, j, k]])
    np.testing.assert_allclose(generic.structure_constants(SO3), signs, atol=1e-15)
    assert np.array_equal(SO3, so3.hat(np.eye(3)))
    assert np.array_equal(generic.exp(0.7 * generic.J_Z), generic.one_parameter(generic.J_Z, 0.7))
    c = generic.structure_constants(SE3)
    for i, j in itertools.product(range(6), repeat=2):
        np.testing.assert_allclose(generic.bracket(SE3[i], SE3[j]), generic.combine(c[i, j], SE3), atol=1e-15)
    # Jacobi's identity in coordinates.
    nested = np.einsum("jkl,ilm->ijkm", c, c)
    cyclic = nested + np.einsum("ijkm->kijm", nested) + np.einsum("ijkm->jkim", nested)
    np.testing.assert_allclose(cyclic, 0, atol=1e-14)
    M = normal(3, 3) + 2 * np.eye(3)
    other = np.einsum("ij,jab->iab", M, SO3)
    there = np.einsum("ia,jb,abc,ck->ijk", M, M, signs, np.linalg.inv(M))
    np.testing.assert_allclose(generic.structure_constants(other), there, atol=1e-13)
    with pytest.raises(
        ValueError, match=r"^basis\.structure_constants: basis must be in the span of the basis"
    ):
        generic.structure_constants(SO3[:2])
    with pytest.raises(
        ValueError, match=r"basis must be linearly independent matrices; got .* at index \(\)"
    ):
        generic.structure_constants(SO3[[0, 1, 1]])
    with pytest.raises(ValueError, match="read-only"):
        generic.J_X[0, 0] = 1.0


@pytest.mark.equation("B 4.11")
def test_ad_is_the_derivative_of_the_adjoint_and_its_exponential_gives_it():
    for module, base in ((so3, SO3), (se3, SE3), (se2, se2.hat(np.eye(3)))):
        x = normal(len(base))
        A = generic.ad(module.hat(x), base)
        np.testing.assert_allclose(generic.exp(A), module.adjoint(module.exp(x)), atol=1e-14)
        y, z = normal(2, len(base), seed=3)
        bracket = generic.bracket(module.hat(x), module.hat(y))
        np.testing.assert_allclose(A @ y, module.vee(bracket), atol=1e-14)
        both = generic.ad(generic.bracket(module.hat(y), module.hat(z)), base)
        np.testing.assert_allclose(
            generic.bracket(generic.ad(module.hat(y), base), generic.ad(module.hat(z), base)),
            both,
            atol=1e-13,
        )
        c = generic.structure_constants(base)
        np.testing.assert_allclose(A, np.einsum("i,ijk->kj", x, c), atol=1e-14)


@pytest.mark.equation("B 4.21", "B 4.22", "B 4.23")
def test_coordinates_and_direct_sums():
    np.testing.assert_allclose(generic.coordinates(so3.hat([1, 2, 3]), SO3), [1, 2, 3], atol=1e-15)
    x = normal(5, 6)
    np.testing.assert_allclose(generic.coordinates(se3.hat(x), SE3), x, atol=1e-15)
    np.testing.assert_allclose(generic.combine(x, SE3), se3.hat(x), atol=1e-15)
    units = np.eye(9).reshape(9, 3, 3)
    symmetric = [units[3 * i + j] + units[3 * j + i] for i in range(3) for j in range(i, 3)]
    gl = np.array([*SO3, *symmetric])
    A = normal(3, 3)
    t = generic.coordinates(A, gl)
    np.testing.assert_allclose(generic.combine(t[:3], SO3), (A - A.T) / 2, atol=1e-15)
    np.testing.assert_allclose(generic.combine(t[3:], np.array(symmetric)), (A + A.T) / 2, atol=1e-15)
    with pytest.raises(
        ValueError, match=r"^basis\.coordinates: X must be in the span of the basis; got a rest"
    ):
        generic.coordinates(np.eye(3), SO3)


@pytest.mark.equation("B 2.21", "B 4.7")
def test_canonical_coordinates():
    t = normal(5, 3)
    np.testing.assert_allclose(generic.first_kind(t, SO3), so3.exp(t), atol=4e-15)
    np.testing.assert_allclose(
        generic.coordinates(generic.log(so3.exp(t)), SO3), so3.log(so3.exp(t)), atol=1e-13
    )
    turns = [so3.rotation(name, t[:, i]) for i, name in enumerate(axis_angle.AXES[::-1])]
    np.testing.assert_allclose(generic.second_kind(t, SO3[::-1]), turns[0] @ turns[1] @ turns[2], atol=4e-15)
    h = 1e-4 * normal(3)
    for kind in (generic.first_kind, generic.second_kind):  # the same to first order
        np.testing.assert_allclose(kind(h, SO3), np.eye(3) + so3.hat(h), atol=1e-7)
    apart = generic.first_kind(h, SO3) - generic.second_kind(h, SO3)
    assert 1e-10 < np.max(np.abs(apart)) < 1e-7


@pytest.mark.equation("B 2.44")
def test_projective_maps():
    P, x = normal(4, 4), normal(20, 3, seed=1)
    z = (P @ generic.homogeneous(x)[..., None])[..., 0]
    np.testing.assert_allclose(generic.transform(P, x), generic.inhomogeneous(z))
    np.testing.assert_allclose(generic.transform(-3.0 * P, x), generic.transform(P, x), rtol=1e-12)
    np.testing.assert_array_equal(generic.inhomogeneous(generic.homogeneous(x)), x)
    Q = normal(4, 4, seed=2)
    np.testing.assert_allclose(
        generic.transform(P @ Q, x), generic.transform(P, generic.transform(Q, x)), rtol=1e-8
    )
    # Lines go to lines: the cross ratio of four points on one stays.
    line = x[0] + np.array([0.0, 1.0, 2.5, 4.0])[:, None] * x[1]
    image = generic.transform(P, line)

    def ratio(p: np.ndarray) -> float:
        a = [np.dot(q - p[0], p[3] - p[0]) for q in p]
        return (a[2] - a[0]) * (a[3] - a[1]) / ((a[2] - a[1]) * (a[3] - a[0]))

    assert np.linalg.svd(image - image[0])[1][1] < 1e-12
    assert ratio(image) == pytest.approx(ratio(line), rel=1e-9)
    for point in ([1.0, 2.0, 0.0], [0.0, 0.0]):
        with pytest.raises(
            ValueError, match=r"^projective\.inhomogeneous: z must be a finite point; got a point at"
        ):
            generic.inhomogeneous(point)
    swap = np.eye(3)[[2, 1, 0]]
    with pytest.raises(
        ValueError, match=r"^projective\.transform: x must be a finite point; got .* at index \(1,\)"
    ):
        generic.transform(swap, [[1.0, 2.0], [0.0, 1.0]])


@pytest.mark.equation("B 2.45", "B 3.2", "B 3.4")
def test_affine_maps_are_the_projective_ones_that_preserve_the_space():
    A, d, x = normal(3, 3), normal(3, seed=1), normal(20, 3, seed=2)
    M = generic.embed(A, d)
    np.testing.assert_array_equal(M[3], [0, 0, 0, 1])
    np.testing.assert_allclose(generic.transform(M, x), x @ A.T + d, atol=1e-14)
    np.testing.assert_allclose(generic.affine(-7.0 * M), M, atol=1e-15)
    for bad in (normal(4, 4), np.diag([1.0, 1, 1, 0])):
        with pytest.raises(ValueError, match=r"^projective\.affine: P must be a map of R\^n to itself"):
            generic.affine(bad)


@pytest.mark.equation("B 2.42", "B 3.1", "B 3.3", "B 3.6", "B 3.9", "B 3.10")
def test_embedding_is_a_semidirect_product():
    A, B, d, e = normal(3, 3), normal(3, 3, seed=1), normal(3, seed=2), normal(3, seed=3)
    product = generic.embed(A, d) @ generic.embed(B, e)
    np.testing.assert_allclose(product, generic.embed(A @ B, A @ e + d), atol=1e-14)
    for got, want in zip(generic.parts(generic.embed(A, d)), (A, d), strict=True):
        np.testing.assert_array_equal(got, want)
    iota = generic.embed(A, np.zeros(3))
    np.testing.assert_allclose(generic.embed(np.eye(3), d) @ iota, generic.embed(A, d), atol=1e-15)
    conjugate = iota @ generic.embed(np.eye(3), e) @ np.linalg.inv(iota)
    np.testing.assert_allclose(conjugate, generic.embed(np.eye(3), A @ e), atol=1e-13)
    assert projective.embed(np.zeros((2, 5, 3, 3)), d).shape == (2, 5, 4, 4)
