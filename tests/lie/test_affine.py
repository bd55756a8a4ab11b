"""The two parametrisations of Aff+: there and back, branches, the nine classes, what no inverse can do."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from lietool.lie import affine, blocks, so3, sym

MAPS = {
    "so": (affine.phi_so, affine.psi_so, affine.psi_so_near),
    "se": (affine.phi_se, affine.psi_se, affine.psi_se_near),
}
EPS = 2.0**-52


def stretch(p: np.ndarray) -> np.ndarray:
    i = [[0, 1, 2], [1, 3, 4], [2, 4, 5]] if p.shape[-1] == 12 else [[0, 1], [1, 2]]
    return p[..., np.array(i) + (6 if p.shape[-1] == 12 else 3)]


def random(n: int, count: int = 40, seed: int = 0) -> np.ndarray:
    """Return parameters with principal rotations."""
    p = np.random.default_rng(seed).normal(size=(count, 12 if n == 3 else 6))
    x = p[:, :3] if n == 3 else p[:, :1]
    x /= np.maximum(1.0, np.linalg.norm(x, axis=-1, keepdims=True) / 3.0)
    return p


def homogeneous(M: np.ndarray, d=(0.0, 0.0, 0.0)) -> np.ndarray:
    A = np.zeros((*M.shape[:-2], 4, 4))
    A[..., :3, :3], A[..., :3, 3], A[..., 3, 3] = M, d, 1.0
    return A


@pytest.mark.equation("B 7.1", "M 1", "K 2")
def test_the_maps_are_products_of_exponentials():
    p = random(3)
    for v, so, se in zip(p, affine.phi_so(p), affine.phi_se(p), strict=True):
        X = np.zeros((4, 4))
        X[:3, :3], X[:3, 3] = so3.hat(v[:3]), v[3:6]
        S = homogeneous(expm(stretch(v)))
        np.testing.assert_allclose(se, expm(X) @ S, atol=1e-12)
        move = np.eye(4)
        move[:3, 3] = v[3:6]
        X[:3, 3] = 0.0
        np.testing.assert_allclose(so, move @ expm(X) @ S, atol=1e-12)
    q = random(2)
    for v, so, se in zip(q, affine.phi_so(q), affine.phi_se(q), strict=True):
        X, S = np.zeros((3, 3)), np.eye(3)
        X[0, 1], X[1, 0], X[:2, 2] = -v[0], v[0], v[1:3]
        S[:2, :2] = expm(stretch(v))
        np.testing.assert_allclose(se, expm(X) @ S, atol=1e-12)
        np.testing.assert_allclose(so[:2, 2], v[1:3], atol=0)
        np.testing.assert_allclose(so[:2, :2], se[:2, :2], atol=0)


@pytest.mark.equation("B 7.2", "M 2", "K 3", "B 7.5", "B 7.8")
@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("way", MAPS)
def test_there_and_back(way, n):
    phi, psi, near = MAPS[way]
    p = random(n)
    A = phi(p)
    np.testing.assert_allclose(psi(A), p, atol=1e-11)
    np.testing.assert_allclose(phi(psi(A)), A, atol=1e-13)
    far = p.copy()
    far[:, : 3 if n == 3 else 1] *= 5.0
    np.testing.assert_allclose(near(phi(far), far), far, atol=1e-9)
    off = far + 0.3 * np.random.default_rng(1).uniform(-1, 1, far.shape)
    np.testing.assert_allclose(near(phi(far), off), far, atol=1e-9)


def cases(kind: str) -> list[tuple[float, float, float]]:
    if kind == "equal":
        return [(1, 1, 1), (1, 1 + 1e-15, 1 - 1e-15), (1, 1 + 1e-9, 1), (1, 1 + 1e-8, 2)]
    if kind == "scale":
        return [(s, 0.3 * s, t * s) for s in (1e-50, 1e-20, 1e20, 1e50) for t in (0.1, 1e-12)]
    if kind == "det 1e-30":
        return [(1e-10, 1e-10, 1e-10), (1e-5, 1e-10, 1e-15)]
    c = float(kind)
    return [(1, 1, 1 / c), (1, 1 / c, 1 / c), (1, c**-0.5, 1 / c), (1, 3 / c, 1 / c)]


@pytest.mark.parametrize("kind", ["equal", "1e1", "1e2", "1e4", "1e6", "1e8", "1e12", "scale", "det 1e-30"])
def test_round_trip_at_any_condition_and_scale(kind):
    rng = np.random.default_rng(4)
    Q = so3.exp(np.concatenate([rng.normal(size=(8, 3)), [[0, 0, 0], [1e-8, 0, 0]]]))
    x = [(0, 0, 0), (1e-9, 0, 0), (0.3, -1, 2), (0, np.pi, 0), np.array((1, 2, 2)) / 3 * (np.pi - 1e-9)]
    R = so3.exp(np.array(x, dtype=float))
    for d in cases(kind):
        A = homogeneous((R[:, None] @ Q * np.array(d, dtype=float)) @ np.swapaxes(Q, -1, -2))
        p = affine.psi_so(A)
        gap = np.max(np.abs(affine.phi_so(p) - A)[..., :3, :3]) / np.max(np.abs(A[..., :3, :3]))
        # Y holds the logarithm of the scale, and rounds it.
        assert gap <= 4e-15 * max(1.0, abs(np.log(max(d))))


def test_psi_itself_against_50_digits():
    """The exact exponentials of what psi returns: its own error, without that of phi."""
    rng = np.random.default_rng(9)
    for c in (1.0, 1e3, 1e12):
        for _ in range(4):
            Q, R = so3.exp(rng.normal(size=(2, 3)))
            A = R @ Q @ np.diag((1.0, c**-0.3, 1.0 / c)) @ Q.T
            p = affine.psi_so(homogeneous(A))
            with mpmath.workdps(50):
                X = mpmath.matrix([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
                exact = mpmath.expm(X) * mpmath.expm(mpmath.matrix(stretch(p).tolist()))
                gap = np.array((exact - mpmath.matrix(A.tolist())).tolist(), dtype=float)
            assert np.max(np.abs(gap)) <= 4e-15 * np.max(np.abs(A))


def test_squaring_the_matrix_loses_what_one_sided_jacobi_keeps():
    Q = so3.exp([0.4, -1.0, 0.7])
    A = so3.exp([1.0, 2.0, 0.5]) @ Q @ np.diag((1.0, 1e-4, 1e-7)) @ Q.T
    S = stretch(affine.psi_so(homogeneous(A)))
    by_square = 0.5 * sym.log(A.T @ A)
    assert abs(np.linalg.eigvalsh(S)[0] - np.log(1e-7)) < 1e-8
    assert abs(np.linalg.eigvalsh(by_square)[0] - np.log(1e-7)) > 1e-4


@pytest.mark.equation("K 9", "B 3.9")
@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("way", MAPS)
@pytest.mark.parametrize("name", affine.CLASSES)
def test_a_blend_stays_in_its_class(name, way, n):
    """Kaji-Ochiai's condition (V), with weights of any size; and classify finds the class."""
    phi, psi, _ = MAPS[way]
    p = affine.project(random(n, 12), name)
    A = phi(p)
    assert set(affine.classify(A).tolist()) == {name}
    weights = np.random.default_rng(2).normal(size=(30, 12))
    blend = phi(weights @ psi(A))
    assert set(affine.classify(blend).tolist()) == {name}
    np.testing.assert_array_equal(affine.project(p, name), p)


def in_class(name: str, A: np.ndarray) -> bool:
    """Tell from the matrix alone whether it belongs to a class."""
    n = A.shape[-1] - 1
    M, d = A[:n, :n], A[:n, n]
    scale = np.linalg.det(M) ** (1.0 / n)
    straight = np.allclose(M.T @ M, scale**2 * np.eye(n), atol=1e-9)
    return {
        "dilation": np.allclose(M, scale * np.eye(n)) and not d.any(),
        "translation": np.allclose(M, np.eye(n)),
        "SO": np.allclose(M.T @ M, np.eye(n)) and not d.any(),
        "CO+": straight and not d.any(),
        "Sym+": np.allclose(M, M.T) and not d.any(),
        "SE": np.allclose(M.T @ M, np.eye(n)),
        "Sim+": straight,
        "GL+": not d.any(),
        "Aff+": True,
    }[name]


@pytest.mark.parametrize("n", [2, 3])
def test_the_classes_are_what_they_are_called_and_have_their_dimensions(n):
    p = random(n, 5)
    projections = {}
    for name, space in affine.CLASSES.items():
        q = affine.project(p, name)
        P = affine.project(np.eye(p.shape[-1]), name)
        assert np.linalg.matrix_rank(P) == space.dimension(n) == round(np.trace(P))
        projections[name] = P
        for other in affine.CLASSES:
            contained = np.allclose(projections.get(other, P) @ P, P) if other in projections else False
            if contained:
                assert all(in_class(other, A) for A in affine.phi_so(q))
        assert all(in_class(name, A) for A in affine.phi_se(q))
    dimensions = {2: [1, 2, 1, 2, 3, 3, 4, 4, 6], 3: [1, 3, 3, 4, 6, 6, 7, 9, 12]}[n]
    assert [space.dimension(n) for space in affine.CLASSES.values()] == dimensions
    assert affine.classify(np.eye(n + 1)) == "dilation"


@pytest.mark.erratum("B 7.1", "M 1")
def test_psi_cannot_be_continuous_along_a_full_turn():
    t = np.linspace(0.0, 1.0, 401)
    A = np.tile(np.eye(4), (401, 1, 1))
    A[:, :3, :3] = so3.rotation("x", 2.0 * np.pi * t)
    steps = np.linalg.norm(np.diff(affine.psi_so(A), axis=0), axis=-1)
    assert np.max(steps) > 6.0
    p = np.zeros((401, 12))
    for i in range(1, 401):
        p[i] = affine.psi_so_near(A[i], p[i - 1])
    assert np.max(np.linalg.norm(np.diff(p, axis=0), axis=-1)) < 0.02
    np.testing.assert_allclose(p[-1, 0], 2.0 * np.pi, atol=1e-13)


@settings(derandomize=True, max_examples=60, deadline=None)
@given(st.lists(st.floats(-8, 8), min_size=12, max_size=12))
def test_near_its_own_parameters_psi_is_the_inverse(p):
    p = np.array(p)
    theta = np.linalg.norm(p[:3])
    p[6:] *= 0.25
    A = affine.phi_so(p)
    if theta > 1e-3 and abs(np.sin(theta / 2.0)) > 1e-3:
        np.testing.assert_allclose(affine.psi_so_near(A, p)[:3], p[:3], atol=1e-9)
    np.testing.assert_allclose(affine.phi_so(affine.psi_so_near(A, p)), A, atol=1e-13 * np.max(np.abs(A)))


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("way", MAPS)
def test_bad_input_is_refused_with_its_index(way, n):
    phi, psi, near = MAPS[way]
    A = np.tile(np.eye(n + 1), (2, 4, 1, 1))
    p = np.zeros((12 if n == 3 else 6,))
    A[1, 2, 0, 0] = -1.0
    for f in (psi, lambda a: near(a, p)):
        with pytest.raises(
            ValueError, match=rf"^affine.psi_{way}.*det > 0; got det = -1 at index \(1, 2\)\. "
        ):
            f(A)
    assert np.isnan(psi(A, check=False)[1, 2, -1])
    A[1, 2] = np.eye(n + 1)
    A[1, 2, n, 0] = 0.5
    with pytest.raises(ValueError, match=r"last row .* at index \(1, 2\)"):
        psi(A)
    with pytest.raises(ValueError, match="below 709"):
        phi(np.full(p.shape, 800.0))
    with pytest.raises(ValueError, match="parameters of 3 dimensions"):
        affine.psi_so_near(np.eye(4), np.zeros(6))
    with pytest.raises(ValueError, match="one of dilation, translation, SO"):
        affine.project(p, "so")


def test_no_screw_motion_makes_whole_turns_and_a_translation():
    A = np.eye(4)
    A[0, 3] = 1.0
    reference = np.zeros(12)
    reference[1] = 6.0
    with pytest.raises(ValueError, match=r"no whole turn; got an angle of 6\.28"):
        affine.psi_se_near(A, reference)
    A[:3, 3] = 0.0, 3.0, 0.0  # along the axis
    p = affine.psi_se_near(A, reference)
    np.testing.assert_allclose(p[:6], [0, 2 * np.pi, 0, 0, 3, 0], atol=1e-14)
    np.testing.assert_allclose(affine.phi_se(p), A, atol=1e-14)
    np.testing.assert_allclose(affine.phi_so(affine.psi_so_near(A, reference)), A, atol=1e-15)


def test_many_blocks_equal_single_calls():
    p = random(3, blocks.BLOCK + 5)
    p[::7, 6:] *= 3.0
    A = affine.phi_so(p)
    back = affine.psi_so(A)
    for i in range(0, len(p), 211):
        np.testing.assert_array_equal(affine.phi_so(p[i]), A[i])
        np.testing.assert_array_equal(affine.psi_so(A[i]), back[i])
