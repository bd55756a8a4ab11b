"""Green coordinates: their integrals, similarities, the limits on the cage, and the continuation outside."""

import numpy as np
import pytest
from scipy.integrate import dblquad
from scipy.spatial.transform import Rotation

from lietool.deform import green

KINDS = {
    "face": [0.5, 0.3, 0.2],
    "edge": [0.3, 0.7, 0.0],
    "vertex": [1.0, 0.0, 0.0],
    "plane": [1.7, 0.2, -0.9],
    "line": [1.6, -0.6, 0.0],
}


def box() -> tuple[np.ndarray, np.ndarray]:
    V = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return V, np.array([[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)])


def dented() -> tuple[np.ndarray, np.ndarray]:
    """A box with a corner pushed in: not convex, no two faces in one plane."""
    V, F = box()
    rng = np.random.default_rng(8)
    V = V + 0.1 * rng.normal(size=V.shape)
    V[7] = [0.45, 0.5, 0.4]
    return V, F


def places(V: np.ndarray, F: np.ndarray, kind: str, away: float) -> np.ndarray:
    rng = np.random.default_rng(1)
    off = rng.normal(size=(12, 3))
    off /= np.linalg.norm(off, axis=1, keepdims=True)
    return np.array(KINDS[kind]) @ V[F[rng.integers(len(F), size=12)]] + away * off


def similarity() -> tuple[np.ndarray, np.ndarray]:
    return 1.7 * Rotation.from_rotvec([0.3, 2.0, 1.0]).as_matrix(), np.array([3.0, -1.0, 2.0])


def test_they_are_the_integrals_of_the_paper():
    V, F = dented()
    x = np.array([0.3, 0.25, 0.3])
    prepared = green.prepare([x], V, F)
    phi, psi = np.zeros(len(V)), np.zeros(len(F))
    for j, f in enumerate(F):
        P = V[f] - x
        n = np.cross(P[1] - P[0], P[2] - P[0])
        twice = np.linalg.norm(n)
        h = P[0] @ n / twice

        def at(s, t, power, weight, P=P, twice=twice):
            share = np.array([1.0 - s - t, s, t])
            return weight(share) * twice / np.linalg.norm(share @ P) ** power / (4.0 * np.pi)

        def over(power, weight, at=at):
            return dblquad(at, 0.0, 1.0, 0.0, lambda t: 1.0 - t, (power, weight), epsabs=1e-12)[0]

        psi[j] = over(1, lambda share: 1.0)
        for i in range(3):
            phi[f[i]] += over(3, lambda share, i=i, h=h: share[i] * h)
    np.testing.assert_allclose(prepared.psi[0], psi, atol=1e-11)
    np.testing.assert_allclose(prepared.phi[0], phi, atol=1e-11)
    assert not prepared.outside[0]


@pytest.mark.parametrize("cage", [box, dented])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("away", [0.0, 1e-15, 1e-13, 1e-10, 1e-7, 1e-4, 1e-2])
def test_every_similarity_is_reproduced_wherever_a_point_is(cage, kind, away):
    V, F = cage()
    x = places(V, F, kind, away)
    prepared = green.prepare(x, V, F)
    np.testing.assert_allclose(prepared.phi.sum(axis=1), 1.0, atol=1e-13)
    S, t = similarity()
    np.testing.assert_allclose(green.solve(prepared, V @ S.T + t), x @ S.T + t, atol=1e-12)


@pytest.mark.parametrize("size", [2.0**-200, 2.0**-20, 2.0**20, 2.0**200])
def test_the_unit_of_length_does_not_matter(size):
    V, F = dented()
    x = np.concatenate([places(V, F, kind, 0.0) for kind in ("face", "edge", "vertex")])
    one, other = green.prepare(x, V, F), green.prepare(size * x, size * V, F)
    assert np.array_equal(one.outside, other.outside)
    np.testing.assert_allclose(other.phi, one.phi, atol=1e-12)
    np.testing.assert_allclose(other.psi / size, one.psi, atol=1e-12)


def test_another_affine_map_is_not_reproduced():
    V, F = box()
    x = np.random.default_rng(2).uniform(0.2, 0.8, size=(20, 3))
    A = np.diag([2.0, 1.0, 1.0])
    assert np.abs(green.solve(green.prepare(x, V, F), V @ A.T) - x @ A.T).max() > 0.05


def test_on_the_cage_they_are_the_limits_from_inside():
    V, F = box()
    on = np.array([[0.0, 0.3, 0.6], [0.0, 0.5, 0.5], [0.0, 0.0, 0.7], [0.0, 0.0, 0.0]])
    at = green.prepare(on, V, F)
    assert not at.outside.any()
    inward = np.array([0.5, 0.5, 0.5]) - on
    for away in (1e-7, 1e-9, 1e-11, 1e-13):
        near = green.prepare(on + away * inward, V, F)
        np.testing.assert_allclose(near.phi, at.phi, atol=40.0 * away + 1e-14)
        # psi has the slope of r log r at edges and vertices.
        np.testing.assert_allclose(near.psi, at.psi, atol=40.0 * away + 1e-14)


def test_outside_they_are_continued_through_the_nearest_face():
    V, F = box()
    x = np.array([[0.3, 0.4, 1.0]])
    out = green.prepare(x + np.array([0.0, 0.0, 1e-6]), V, F)
    within = green.prepare(x - np.array([0.0, 0.0, 1e-6]), V, F)
    assert out.outside.all() and not within.outside.any()
    np.testing.assert_allclose(out.phi, within.phi, atol=1e-5)
    np.testing.assert_allclose(out.psi, within.psi, atol=1e-5)
    # The slope goes on as well.
    x, d = np.array([[0.3, 0.4, 1.0]]), np.array([0.0, 0.0, 1e-4])
    three = [green.prepare(x + k * d, V, F).phi for k in (-1, 0, 1)]
    assert np.abs(three[2] - 2.0 * three[1] + three[0]).max() < 1e-6


def test_stretch_is_the_root_mean_square_of_the_singular_values():
    rng = np.random.default_rng(3)
    V, W, F = rng.normal(size=(3, 3)), rng.normal(size=(3, 3)), np.array([[0, 1, 2]])
    u = np.stack([V[1] - V[0], V[2] - V[0]], axis=1)
    w = np.stack([W[1] - W[0], W[2] - W[0]], axis=1)
    s = np.linalg.svd(w @ np.linalg.pinv(u), compute_uv=False)
    length = np.linalg.norm(green.stretched_normals(V, W, F))
    np.testing.assert_allclose(length, np.sqrt((s[0] ** 2 + s[1] ** 2) / 2.0))


def test_a_face_that_collapses_has_no_normal():
    V, F = box()
    now = V.copy()
    now[1] = now[0]
    x = green.solve(green.prepare([[0.5, 0.5, 0.5]], V, F), now)
    assert np.isfinite(x).all()


def test_what_is_no_cage_is_refused_by_name():
    V, F = box()
    with pytest.raises(ValueError, match=r"^green\.prepare: F must be a closed surface; got [^\n]*$"):
        green.prepare([[0.5] * 3], V, F[1:])
    with pytest.raises(ValueError, match=r"^green\.solve: V must be finite; got [^\n]*$"):
        green.solve(green.prepare([[0.5] * 3], V, F), V * np.nan)
