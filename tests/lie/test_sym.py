"""Functions of symmetric matrices against 50 digits: equal, nearly equal and widely spread eigenvalues."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lietool.lie import blocks, so2, so3, sym

EPS = 2.0**-52

SPECTRA = {
    "equal": [(c, c, c) for c in (0.0, 1e-300, 1e-20, 1e-8, 1.0, -3.0, 50.0)],
    "two equal": [(1, 1, 3), (1, 1, -3), (5, 5, -2), (3, 3, 3.5), (7, -0.5, -0.5)],
    "nearly": [(1, 1 + d, 4) for d in (1e-15, 1e-12, 1e-8, 1e-4)]
    + [(1, 1 + d, 1 + 2 * d) for d in (1e-15, 1e-9, 1e-6)],
    "distinct": [(0.3, -0.7, 1.1), (2.0, -1.0, 0.5), (4.0, 0.1, -3.0)],
    "small": [(s, -2 * s, 0.5 * s) for s in (1e-3, 1e-8, 1e-15, 1e-100, 1e-170)],
    "wide": [
        (0, 4, 8),
        (0, 4, 8.01),
        (-27, 0, 0),
        (27, 0, 0),
        (-9, -9, 18),
        (-300, 0, 300),
        (-300, 200, 201),
    ],
}
POSITIVE = {
    "near I": [(1 + s, 1 - 0.7 * s, 1 + 0.2 * s) for s in (1e-1, 1e-4, 1e-8, 1e-12, 1e-15)],
    "equal": [(c, c, c) for c in (1.0, 1.4, 0.7, 1e-50, 1e50)],
    "nearly": [(3, 3 + d, 1) for d in (1e-15, 1e-12, 1e-8, 1e-4)] + [(1, 1 + 1e-9, 1 + 2e-9)],
    "condition 16": [(1, 2, 15.9), (1, 15, 15.9), (1, 16, 16.1), (2, 3, 4)],
    "ill": [(1, x, c) for c in (1e2, 1e6, 1e12) for x in (1, 3, c / 2, c)],
    "scales": [(s, 2 * s, 7 * s) for s in (1e-50, 1e50)] + [(s, 200 * s, 7e5 * s) for s in (1e-50, 1e50)],
}


def frames(n: int) -> list[np.ndarray]:
    rng = np.random.default_rng(3)
    if n == 2:
        return [so2.exp(t) for t in (0.0, 1e-8, 0.3, np.pi / 4, 2.0)]
    return [so3.exp(x) for x in (*rng.normal(size=(3, 3)), (0, 0, 0), (1e-8, 0, 0), (np.pi / 4, 0, 0))]


def with_spectrum(Q: np.ndarray, d) -> np.ndarray:
    M = mpmath.matrix(Q.tolist())
    product = M * mpmath.diag([mpmath.mpf(float(x)) for x in d[: len(Q)]]) * M.T
    S = np.array(product.tolist(), dtype=float)
    return 0.5 * (S + S.T)


def exact(S: np.ndarray, f) -> np.ndarray:
    d, Q = mpmath.eigsy(mpmath.matrix(S.tolist()))
    return np.array((Q * mpmath.diag([f(x) for x in d]) * Q.T).tolist(), dtype=object).reshape(S.shape)


def error(value: np.ndarray, reference: np.ndarray) -> float:
    return float(np.max(np.abs(value - reference)))


@pytest.mark.equation("K 6", "B 4.19", "M 4")
@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("kind", SPECTRA)
def test_exp_to_a_few_ulp(kind, n):
    with mpmath.workdps(50):
        for d in SPECTRA[kind]:
            for Q in frames(n):
                Y = with_spectrum(Q, d)
                reference = exact(Y, mpmath.exp)
                size = float(np.max(np.abs(reference)))
                assert error(sym.exp(Y), reference) <= 1e-15 * size * max(1.0, np.linalg.norm(Y, 2))


@pytest.mark.equation("K 7", "B 4.19")
@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("kind", POSITIVE)
def test_log_as_well_as_its_condition_allows(kind, n):
    with mpmath.workdps(50):
        for d in POSITIVE[kind]:
            for Q in frames(n):
                S = with_spectrum(Q, d)
                reference = exact(S, mpmath.log)
                size = float(np.max(np.abs(reference)))
                condition = max(d[:n]) / min(d[:n])
                limit = EPS * condition + 3e-15 * max(1.0, size)
                assert error(sym.log(S), reference) <= limit
                root = exact(S, mpmath.sqrt)
                size = float(np.max(np.abs(root)))
                assert error(sym.sqrt(S), root) <= (EPS * condition**0.5 + 1e-15) * size


@pytest.mark.parametrize("s", [1e-2, 1e-5, 1e-9, 1e-13])
def test_log_near_the_identity_keeps_what_the_matrix_holds(s):
    with mpmath.workdps(50):
        for Q in frames(3):
            S = with_spectrum(Q, (1 + s, 1 - 0.7 * s, 1 + 0.2 * s))
            assert error(sym.log(S), exact(S, mpmath.log)) <= 2e-15 * s


symmetric = st.lists(st.floats(-5, 5), min_size=6, max_size=6).map(
    lambda y: np.array([[y[0], y[1], y[2]], [y[1], y[3], y[4]], [y[2], y[4], y[5]]])
)


@settings(derandomize=True, max_examples=60, deadline=None)
@given(symmetric, st.floats(-2, 2), st.floats(-2, 2))
def test_powers_are_a_one_parameter_group(Y, s, t):
    S = sym.exp(Y)
    condition = np.linalg.cond(S)
    size = np.max(np.abs(Y))
    np.testing.assert_allclose(sym.log(S), Y, atol=4 * EPS * condition + 4e-15 * max(1.0, size))
    both = sym.power(S, s + t)
    product = sym.power(S, s) @ sym.power(S, t)
    scale = np.linalg.norm(sym.power(S, s), 2) * np.linalg.norm(sym.power(S, t), 2)
    np.testing.assert_allclose(product, both, atol=scale * (1e-14 * max(1.0, size) + 40 * EPS * condition))


@pytest.mark.equation("B 3.13", "B 4.3", "B 4.18", "K 10", "K 11")
@pytest.mark.parametrize("n", [2, 3])
def test_functions_go_through_the_eigenvalues(n):
    rng = np.random.default_rng(1)
    d = rng.normal(size=(20, n))
    for Q in frames(n):
        S = sym.exp(Q * d[..., None, :] @ Q.T)
        np.testing.assert_allclose(S, Q * np.exp(d)[..., None, :] @ Q.T, atol=1e-14 * np.exp(np.max(d)))
        np.testing.assert_allclose(
            sym.power(S, 0.3), Q * np.exp(0.3 * d)[..., None, :] @ Q.T, atol=1e-13 * np.exp(np.max(d))
        )
    np.testing.assert_allclose(
        sym.exp(np.eye(n) * d[..., None, :]), np.eye(n) * np.exp(d)[..., None, :], rtol=2e-15, atol=0
    )


def test_the_closed_formula_and_jacobi_meet_where_they_change():
    for n, kernel_limit in ((3, 8.0), (3, np.log(16.0))):
        for Q in frames(n):
            for spread in kernel_limit + np.array([-1e-9, -1e-15, 0.0, 1e-15, 1e-9]):
                Y = with_spectrum(Q, (spread, 0.4 * spread, 0.0))
                S = sym.exp(Y)
                E = np.linalg.eigh(Y)
                by_eigh = E.eigenvectors * np.exp(E.eigenvalues) @ E.eigenvectors.T
                np.testing.assert_allclose(S, by_eigh, atol=3e-14 * np.exp(spread))
                np.testing.assert_allclose(sym.log(S), Y, atol=8 * EPS * np.exp(spread) + 2e-14)


def test_a_batch_of_all_kinds_equals_single_calls():
    Q = frames(3)
    S = np.array([with_spectrum(q, d) for q in Q for kind in POSITIVE.values() for d in kind])
    S = np.concatenate([S] * (blocks.BLOCK // len(S) + 1))
    for f in (sym.log, sym.sqrt, lambda x: sym.exp(sym.log(x))):
        batch = f(S)
        for i in [*range(0, len(S), 97), len(S) - 1]:
            np.testing.assert_array_equal(f(S[i]), batch[i])


@pytest.mark.parametrize("n", [2, 3])
def test_bad_input_is_refused_with_its_index(n):
    S = np.tile(np.eye(n), (2, 4, 1, 1))
    S[1, 2, 0, 1] = 0.1
    for f in (sym.exp, sym.log, sym.sqrt):
        with pytest.raises(ValueError, match=r"must be symmetric, .*; got 1\.0e-01 at index \(1, 2\)\."):
            f(S)
    S[1, 2] = np.diag((1.0, 0.0, 2.0)[:n])
    for f in (sym.log, sym.sqrt, lambda x: sym.power(x, 0.5)):
        with pytest.raises(
            ValueError, match=r"positive definite; got smallest eigenvalue .* at index \(1, 2\)"
        ):
            f(S)
    assert np.isnan(sym.log(S, check=False)[1, 2]).any()
    S[1, 2] = np.diag((1000.0, 0.0, 2.0)[:n])
    with pytest.raises(ValueError, match=r"without eigenvalues above 709; got 1000 at index \(1, 2\)"):
        sym.exp(S)
    with pytest.raises(ValueError, match="n = 2 or 3"):
        sym.exp(np.eye(4))
