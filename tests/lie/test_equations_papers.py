"""Kaji and Ochiai's paper and (3), (4) of the MEIS paper, equation by equation: laws on random input."""

from functools import partial

import numpy as np
import pytest

from lietool.lie import affine, blend, generic, series, so3, sym

PI = np.pi
close = partial(np.testing.assert_allclose, rtol=0, atol=1e-12)
COUNT = 25
UPPER = np.triu_indices(3)


@pytest.fixture
def rng():
    return np.random.default_rng(16)


def turned(rng: np.random.Generator, d: np.ndarray) -> np.ndarray:
    """Symmetric matrices with given eigenvalues, in random frames."""
    Q, _ = np.linalg.qr(rng.normal(size=(len(d), 3, 3)))
    return (Q * d[:, None, :]) @ np.swapaxes(Q, -1, -2)


def eigenvalues(rng: np.random.Generator) -> np.ndarray:
    """Three eigenvalues that are well apart, falling."""
    gaps = rng.uniform(0.3, 1.5, (COUNT, 2))
    middle = rng.uniform(-1, 1, COUNT)
    return np.stack([middle + gaps[:, 0], middle, middle - gaps[:, 1]], axis=-1)


def block(A: np.ndarray, d: np.ndarray) -> np.ndarray:
    H = np.zeros((len(A), 4, 4))
    H[:, :3, :3], H[:, :3, 3], H[:, 3, 3] = A, d, 1.0
    return H


def symmetric(y: np.ndarray) -> np.ndarray:
    Y = np.zeros((len(y), 3, 3))
    Y[:, UPPER[0], UPPER[1]] = Y[:, UPPER[1], UPPER[0]] = y
    return Y


def polynomial(a: np.ndarray, b: np.ndarray, c: np.ndarray, Y: np.ndarray) -> np.ndarray:
    a, b, c = (x[:, None, None] for x in (a, b, c))
    return a * np.eye(3) + b * Y + c * (Y @ Y)


@pytest.mark.equation("K 1", "K 2")
def test_stretch_turn_shift(rng):
    params = rng.normal(size=(COUNT, 12))
    x, d, y = params[:, :3], params[:, 3:6], params[:, 6:]
    A = affine.phi_so(params)
    linear = generic.exp(so3.hat(x)) @ generic.exp(symmetric(y))
    close(A, block(linear, d), atol=1e-10)
    assert np.all(np.linalg.det(A) > 0)
    close(A[:, 3], np.broadcast_to([0.0, 0, 0, 1], (COUNT, 4)))
    linear[..., 0] *= -1
    with pytest.raises(ValueError, match=r"affine\.psi_so: A must"):
        affine.psi_so(block(linear, d))


@pytest.mark.equation("K 3")
def test_translation_rotation_and_stretch_come_back(rng):
    A = rng.normal(size=(COUNT, 3, 3))
    A[..., 0] *= np.sign(np.linalg.det(A))[:, None]
    T = block(A, rng.normal(size=(COUNT, 3)))
    found = affine.psi_so(T)
    close(found[:, 3:6], T[:, :3, 3])
    d, Q = np.linalg.eigh(np.swapaxes(A, -1, -2) @ A)
    S = (Q * np.sqrt(d)[:, None, :]) @ np.swapaxes(Q, -1, -2)
    close(so3.exp(found[:, :3]) @ S, A, atol=1e-10)
    close(symmetric(found[:, 6:]), (Q * np.log(d)[:, None, :] / 2) @ np.swapaxes(Q, -1, -2), atol=1e-10)
    close(affine.phi_so(found), T)


@pytest.mark.equation("K 4")
def test_rodrigues_with_sinc(rng):
    x = rng.normal(size=(COUNT, 3)) * 2
    theta, X = np.linalg.norm(x, axis=-1)[:, None, None], so3.hat(x)
    full, half = np.sin(theta) / theta, np.sin(theta / 2) / (theta / 2)
    close(so3.exp(x), np.eye(3) + full * X + half**2 / 2 * (X @ X))
    close(theta[:, 0, 0], np.sqrt(np.trace(np.swapaxes(X, -1, -2) @ X, axis1=1, axis2=2) / 2))


@pytest.mark.equation("K 5")
def test_sinc_near_zero():
    theta = np.array([0.0, 1e-300, 1e-9, 1e-4, 0.01, 0.1, 0.5])
    rest = series.sinc(theta) - (1 - theta**2 / 6)
    assert np.all(np.abs(rest) <= theta**4 / 120 + 2e-16)
    np.testing.assert_allclose(rest[-2:], theta[-2:] ** 4 / 120, rtol=0.01)


@pytest.mark.equation("K 6")
def test_the_exponential_about_the_middle_eigenvalue(rng):
    d = eigenvalues(rng)
    Y = turned(rng, d)
    l1, l2, l3 = d[:, 0] - d[:, 1], d[:, 1], d[:, 2] - d[:, 1]

    def e2(x: np.ndarray) -> np.ndarray:
        return (np.exp(x) - 1 - x) / x**2

    b = 1 - l1 * l3 * (e2(l1) - e2(l3)) / (l1 - l3)
    c = 1 / 2 + (l1 * (2 * e2(l1) - 1) - l3 * (2 * e2(l3) - 1)) / (2 * (l1 - l3))
    Z = Y - l2[:, None, None] * np.eye(3)
    close(sym.exp(Y), np.exp(l2)[:, None, None] * polynomial(np.ones(COUNT), b, c, Z))


@pytest.mark.equation("K 7")
def test_the_logarithm_of_the_stretch(rng):
    d = np.exp(eigenvalues(rng))
    gram = turned(rng, d)
    l1, l2, l3 = d[:, 0] / d[:, 1], d[:, 1], d[:, 2] / d[:, 1]

    def g(x: np.ndarray) -> np.ndarray:
        return (np.log(x) - (x - 1)) / (x - 1)

    a = -1 + (l3 * g(l1) - l1 * g(l3)) / (l1 - l3)
    c = (g(l1) - g(l3)) / (l1 - l3)
    Z = gram / l2[:, None, None]
    wanted = polynomial(a + np.log(l2), -(a + c), c, Z) / 2
    close(sym.log(sym.sqrt(gram)), wanted, atol=1e-11)
    close(sym.log(gram) / 2, wanted, atol=1e-11)
    stretch = block(sym.sqrt(gram), np.zeros((COUNT, 3)))
    close(symmetric(affine.psi_so(stretch)[:, 6:]), wanted, atol=1e-11)


@pytest.mark.equation("K 8")
def test_the_logarithm_of_a_rotation(rng):
    x = rng.normal(size=(COUNT, 3))
    x *= rng.uniform(0.1, 3.0, (COUNT, 1)) / np.linalg.norm(x, axis=-1, keepdims=True)
    R = generic.exp(so3.hat(x))
    theta = np.arccos((np.trace(R, axis1=1, axis2=2) - 1) / 2)[:, None, None]
    wanted = (R - np.swapaxes(R, -1, -2)) / (2 * np.sin(theta) / theta)
    close(so3.hat(so3.log(R)), wanted, atol=1e-11)
    # Near a half turn theta comes with the eigenvector whose sign agrees with R - R^T.
    x *= (PI - 1e-7) / np.linalg.norm(x, axis=-1, keepdims=True)
    close(so3.log(so3.exp(x)), x)


@pytest.mark.equation("K 9")
def test_a_blend_is_a_sum_of_parameters(rng):
    A, w = affine.phi_so(0.4 * rng.normal(size=(3, 12))), rng.uniform(-0.5, 1.5, (COUNT, 3))
    close(blend.phi_so(w, A), affine.phi_so(w @ affine.psi_so(A)))
    for i in range(3):
        close(blend.phi_so(np.eye(3)[i], A), A[i])
    # A blend of members of a class stays in it.
    rigid = affine.phi_so(np.concatenate([0.4 * rng.normal(size=(3, 6)), np.zeros((3, 6))], axis=-1))
    R = blend.phi_so(w, rigid)[:, :3, :3]
    close(R @ np.swapaxes(R, -1, -2), np.broadcast_to(np.eye(3), R.shape))


@pytest.mark.equation("K 11")
def test_a_function_acts_on_the_eigenvalues(rng):
    d, P = rng.uniform(0.2, 3.0, (COUNT, 3)), rng.normal(size=(COUNT, 3, 3)) + 3 * np.eye(3)
    inverse = np.linalg.inv(P)

    def similar(values: np.ndarray) -> np.ndarray:
        return (P * values[:, None, :]) @ inverse

    close(generic.exp(similar(d)), similar(np.exp(d)), atol=1e-9)
    close(generic.log(similar(d)), similar(np.log(d)), atol=1e-9)
    S = turned(rng, d)
    frame = np.linalg.eigh(S)
    root = (frame[1] * frame[0][:, None, :] ** 0.3) @ np.swapaxes(frame[1], -1, -2)
    close(sym.power(S, 0.3), root)


@pytest.mark.equation("K 12", "K 13", "M 4")
def test_a_function_is_a_polynomial_of_degree_2(rng):
    d = eigenvalues(rng)
    Y, (l1, l2, l3) = turned(rng, d), d.T
    for f, ours, argument, (m1, m2, m3) in (
        (np.exp, sym.exp, Y, (l1, l2, l3)),
        (np.log, sym.log, turned(np.random.default_rng(1), np.exp(d)), np.exp(d).T),
    ):
        s = f(m1) / ((m1 - m2) * (m1 - m3))
        t = f(m2) / ((m2 - m3) * (m2 - m1))
        u = f(m3) / ((m3 - m1) * (m3 - m2))
        a = s * m2 * m3 + t * m3 * m1 + u * m1 * m2
        b = -s * (m2 + m3) - t * (m3 + m1) - u * (m1 + m2)
        close(ours(argument), polynomial(a, b, s + t + u, argument), atol=1e-10)


def meis(l1: float, l2: float, l3: float) -> tuple[float, float, float]:
    """The s, t, u that the MEIS paper prints."""
    return (
        np.exp(l1) / ((l1 - l2) * (l1 - l3)),
        np.exp(l2) / ((l2 - l3) * (l1 - l2)),
        np.exp(l3) / ((l2 - l3) * (l3 - l1)),
    )


@pytest.mark.equation("M 4")
@pytest.mark.erratum("M (4) distinct")
def test_the_printed_sum_has_two_wrong_signs(rng):
    d = eigenvalues(rng)
    for Y, (l1, l2, l3) in zip(turned(rng, d), d, strict=True):
        s, t, u = meis(l1, l2, l3)
        a = s * l2 * l3 - t * l3 * l1 - u * l1 * l2
        b = -s * (l2 + l3) + t * (l3 + l1) + u * (l1 + l2)
        close(a * np.eye(3) + b * Y + (s - t - u) * Y @ Y, sym.exp(Y), atol=1e-11)
        printed = a * np.eye(3) + b * Y + (s + t + u) * Y @ Y
        assert np.linalg.norm(printed - sym.exp(Y)) > 0.01


@pytest.mark.equation("M 4")
@pytest.mark.erratum("M (4) two equal")
def test_with_two_equal_eigenvalues_a_and_b_are_exchanged(rng):
    for l2, l3 in rng.uniform(-1, 1, (10, 2)):
        Y = turned(rng, np.array([[l2, l2, l3]]))[0]
        s, t = np.exp(l2) / (l2 - l3), np.exp(l3) / (l2 - l3)
        close((t * l2 - s * l3) * np.eye(3) + (s - t) * Y, sym.exp(Y), atol=1e-11)
        close(sym.exp(l2 * np.eye(3)), np.exp(l2) * np.eye(3))
        printed = (s - t) * np.eye(3) + (t * l2 - s * l3) * Y
        assert np.linalg.norm(printed - sym.exp(Y)) > 1e-3


@pytest.mark.equation("M 3")
def test_the_characteristic_polynomial_of_the_exponential(rng):
    """Its roots are the logarithms of the eigenvalues of exp Y, so Y satisfies it too."""
    Y = turned(rng, eigenvalues(rng))
    trace, squares = np.trace(Y, axis1=1, axis2=2), np.sum(Y**2, axis=(-1, -2))
    roots = np.log(np.linalg.eigvalsh(sym.exp(Y)))
    for root in roots.T:
        close(root**3 - trace * root**2 + (trace**2 - squares) / 2 * root - np.linalg.det(Y), 0.0, atol=1e-11)
    close(np.sum(roots, axis=-1), trace)
    close(np.log(np.linalg.det(sym.exp(Y))), trace)


@pytest.mark.equation("K Algorithm 1")
def test_the_logarithm_nearest_to_a_reference(rng):
    R = so3.exp(rng.normal(size=(200, 3)))
    reference = rng.normal(size=(200, 3)) * 8
    x, distance = so3.log_near(R, reference)
    close(so3.exp(x), R, atol=1e-13)
    close(np.linalg.norm(x - reference, axis=-1), distance)
    principal = so3.log(R)
    u = principal / np.linalg.norm(principal, axis=-1, keepdims=True)
    every = [np.linalg.norm(principal + 2 * PI * k * u - reference, axis=-1) for k in range(-8, 9)]
    close(distance, np.min(every, axis=0))
