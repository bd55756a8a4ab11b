"""Chapter 3 of the book, equation by equation: laws of public functions, on random input."""

from functools import partial

import numpy as np
import pytest

from lietool.lie import generic, groups, polar, so3, sym

close = partial(np.testing.assert_allclose, rtol=0, atol=1e-12)
COUNT = 25


@pytest.fixture
def rng():
    return np.random.default_rng(33)


def orthogonal(rng: np.random.Generator, n: int, sign: float) -> np.ndarray:
    Q, _ = np.linalg.qr(rng.normal(size=(COUNT, n, n)))
    Q[..., 0] *= (sign * np.sign(np.linalg.det(Q)))[:, None]
    return Q


def linear(rng: np.random.Generator, n: int, sign: float) -> np.ndarray:
    A = rng.normal(size=(COUNT, n, n))
    A[..., 0] *= (sign * np.sign(np.linalg.det(A)))[:, None]
    return A


def definite(rng: np.random.Generator, n: int) -> np.ndarray:
    B = rng.normal(size=(COUNT, n, n))
    return B @ np.swapaxes(B, -1, -2) + 0.1 * np.eye(n)


def transpose(A: np.ndarray) -> np.ndarray:
    return np.swapaxes(A, -1, -2)


@pytest.mark.equation("B 3.1", "B 3.2", "B 3.3", "B 3.4")
@pytest.mark.parametrize("n", [2, 3, 4])
def test_who_belongs_to_the_linear_and_the_affine_groups(rng, n):
    d = rng.normal(size=(COUNT, n))
    for name, affine, signs in (("GL", "Aff", (1.0, -1.0)), ("GL+", "Aff+", (1.0,))):
        for sign in (1.0, -1.0):
            A = linear(rng, n, sign)
            assert np.all(groups.is_member(name, A) == (sign in signs))
            assert np.all(groups.is_member(affine, generic.embed(A, d)) == (sign in signs))
        flat = linear(rng, n, 1.0)
        flat[..., 0] = flat[..., 1]
        assert not np.any(groups.is_member(name, flat))
        assert not np.any(groups.is_member(affine, generic.embed(flat, d)))
        A, B = linear(rng, n, 1.0), linear(rng, n, signs[-1])
        assert np.all(groups.is_member(name, A @ B)) and np.all(groups.is_member(name, np.linalg.inv(A)))


@pytest.mark.equation("B 3.6", "B 3.7", "B 3.8", "B 3.9", "B 3.10")
@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize(
    ("whole", "part", "make", "signs"),
    [
        ("SE", "SO", orthogonal, (1.0,)),
        ("E", "O", orthogonal, (1.0, -1.0)),
        ("Aff+", "GL+", linear, (1.0,)),
        ("Aff", "GL", linear, (1.0, -1.0)),
    ],
)
def test_one_factor_and_one_translation(rng, n, whole, part, make, signs):
    for sign in signs:
        A, d, b = make(rng, n, sign), rng.normal(size=(COUNT, n)), rng.normal(size=(COUNT, n))
        g, T_b = generic.embed(A, d), generic.embed(np.broadcast_to(np.eye(n), A.shape), b)
        h, k = groups.split(whole, g)
        close(h @ k, g)
        close(h, generic.embed(A, 0 * d))
        assert np.all(groups.is_member(part, A)) and np.all(groups.is_member(whole, g))
        # A product h k has no other factors than these: from T in H and in K follows T = I.
        close(k[:, :n, :n], np.broadcast_to(np.eye(n), A.shape))
        close(np.einsum("...ij,...j->...i", A, k[:, :n, n]), d)
        # Translations are normal; H is not.
        moved = g @ T_b @ np.linalg.inv(g)
        close(moved[:, :n, :n], np.broadcast_to(np.eye(n), A.shape), atol=1e-9)
        assert np.max(np.abs((T_b @ h @ np.linalg.inv(T_b))[:, :n, n])) > 0.1


@pytest.mark.equation("B 3.11", "B 3.12")
@pytest.mark.parametrize("n", [2, 3])
def test_one_rotation_and_one_stretch(rng, n):
    A = linear(rng, n, 1.0)
    R, S = polar.decompose(A)
    close(R @ S, A)
    close(R @ transpose(R), np.broadcast_to(np.eye(n), A.shape))
    close(np.linalg.det(R), 1.0)
    close(S, transpose(S))
    assert np.all(np.linalg.eigvalsh(S) > 0)
    left, same = polar.decompose_left(A)
    close(left @ same, A)
    close(same, R)
    close(left, R @ S @ transpose(R))
    assert np.max(np.abs(left - S)) > 0.1
    # One-to-one: the factors of a product come back.
    turn, stretch = orthogonal(rng, n, 1.0), definite(rng, n)
    again = polar.decompose(turn @ stretch)
    close(again[0], turn, atol=1e-10)
    close(again[1], stretch, atol=1e-10)
    close(polar.rotation(turn @ stretch), turn, atol=1e-10)
    # Sym+ is no group.
    product = stretch[1:] @ stretch[:-1]
    assert np.max(np.abs(product - transpose(product))) > 0.1


@pytest.mark.equation("B 3.13")
@pytest.mark.parametrize("n", [2, 3])
def test_a_stretch_is_diagonal_in_a_turned_frame(rng, n):
    S = definite(rng, n)
    U, d, V = polar.svd(S)
    D = d[..., None] * np.eye(n)
    close(U, V, atol=1e-10)
    close(np.linalg.det(U), 1.0)
    close(U @ D @ transpose(U), S)
    close(d, np.linalg.eigvalsh(S)[:, ::-1])
    close(sym.sqrt(S), U @ np.sqrt(D) @ transpose(U))
    close(sym.power(S, 0.3), U @ (D**0.3 * np.eye(n)) @ transpose(U))
    # Not unique: an even permutation of the axes, or two signs.
    swap = so3.rotation("z", np.pi / 2)[:n, :n]
    close((U @ swap.T) @ (swap @ D @ swap.T) @ transpose(U @ swap.T), S)


@pytest.mark.erratum("B 3.13 (text)")
def test_the_signs_of_the_axes_are_free_too(rng):
    U, d, _ = polar.svd(definite(rng, 3))
    other = U * np.array([-1.0, -1.0, 1.0])
    close(np.linalg.det(other), 1.0)
    assert np.all(np.max(np.abs(other - U), axis=(-1, -2)) > 0.5)
    close((other * d[:, None, :]) @ transpose(other), (U * d[:, None, :]) @ transpose(U))


@pytest.mark.equation("B 3.14")
@pytest.mark.parametrize("n", [2, 3])
def test_two_rotations_and_a_diagonal_matrix(rng, n):
    A = linear(rng, n, 1.0)
    U, d, V = polar.svd(A)
    for Q in (U, V):
        close(Q @ transpose(Q), np.broadcast_to(np.eye(n), A.shape))
        close(np.linalg.det(Q), 1.0)
    assert np.all(d > 0)
    D = d[..., None] * np.eye(n)
    close(U @ D @ transpose(V), A)
    close(d, np.linalg.svd(A, compute_uv=False))
    R, S = polar.decompose(A)
    close(U @ transpose(V), R)
    close(V @ D @ transpose(V), S)


@pytest.mark.erratum("B 3.3.3 (text)")
def test_the_singular_values_of_the_text_lack_a_transpose(rng):
    A = linear(rng, 3, 1.0)
    R, S = polar.decompose(A)
    V, d, _ = polar.svd(S)
    D = d[..., None] * np.eye(3)
    close((R @ V) @ D @ transpose(V), A, atol=1e-11)
    assert np.max(np.abs((R @ V) @ D @ V - A)) > 1
