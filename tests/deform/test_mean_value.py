"""Mean value coordinates: exact on the cage, in the planes of its faces, and against their definition."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lietool.deform import mean_value


def box(size: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    V = np.array([[x, y, z] for x in (0.0, size) for y in (0.0, size) for z in (0.0, size)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return V, np.array([[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)])


def lump(seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A star-shaped surface that is not convex."""
    rng = np.random.default_rng(seed)
    V, F = sphere(1)
    return V * (1.0 + 0.4 * rng.normal(size=(len(V), 1)).clip(-1.0, 1.0)) + rng.normal(size=3), F


def sphere(times: int) -> tuple[np.ndarray, np.ndarray]:
    V = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    F = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    for _ in range(times):
        half = np.sort(F[:, [[0, 1], [1, 2], [2, 0]]], axis=-1)
        ends, index = np.unique(half.reshape(-1, 2), axis=0, return_inverse=True)
        mid = index.reshape(-1, 3) + len(V)
        V = np.concatenate([V, V[ends].sum(axis=1)])
        V /= np.linalg.norm(V, axis=1, keepdims=True)
        a, b, c = F.T
        ab, bc, ca = mid.T
        F = np.concatenate(
            [np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
    return V, F


def places(
    V: np.ndarray, F: np.ndarray, kind: str, away: float, seed: int = 1, count: int = 12
) -> np.ndarray:
    """Points near faces, edges, vertices, and near their planes and lines outside of them."""
    rng = np.random.default_rng(seed)
    share = {
        "face": [0.5, 0.3, 0.2],
        "edge": [0.3, 0.7, 0.0],
        "vertex": [1.0, 0.0, 0.0],
        "plane": [1.7, 0.2, -0.9],
        "line": [1.6, -0.6, 0.0],
    }[kind]
    off = rng.normal(size=(count, 3))
    off /= np.linalg.norm(off, axis=1, keepdims=True)
    return np.array(share) @ V[F[rng.integers(len(F), size=count)]] + away * off


def by_definition(x: np.ndarray, V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """The integral of hat function over distance on the sphere of directions, for a point inside.

    Each face is cut into small ones, and over these Gauss's rule of degree 5 integrates h / r^4.
    """
    a, b = (6.0 - np.sqrt(15.0)) / 21.0, (6.0 + np.sqrt(15.0)) / 21.0
    nodes = [[1 / 3] * 3]
    for c in (a, b):
        nodes += [[1 - 2 * c, c, c], [c, 1 - 2 * c, c], [c, c, 1 - 2 * c]]
    gauss = np.array([0.225] + [(155 - np.sqrt(15.0)) / 1200] * 3 + [(155 + np.sqrt(15.0)) / 1200] * 3)
    n = 24
    cells = []
    for i in range(n):
        for j in range(n - i):
            cells.append([[i, j], [i + 1, j], [i, j + 1]])
            if i + j < n - 1:
                cells.append([[i + 1, j], [i + 1, j + 1], [i, j + 1]])
    flat = np.array(cells) / n
    corner = np.concatenate([flat, 1.0 - flat.sum(axis=-1, keepdims=True)], axis=-1)
    share = np.einsum("qi,cij->cqj", np.array(nodes), corner).reshape(-1, 3)
    weight = np.tile(gauss, len(cells)) / len(cells)
    w = np.zeros(len(V))
    for f in F:
        P = V[f] - x
        normal = np.cross(P[1] - P[0], P[2] - P[0])
        r = np.linalg.norm(share @ P, axis=1)
        np.add.at(w, f, (share * (weight * 0.5 * (P[0] @ normal) / r**4)[:, None]).sum(axis=0))
    return w / w.sum()


@pytest.mark.parametrize("cage", [box, lump])
def test_they_are_the_mean_over_the_directions(cage):
    V, F = cage()
    x = V.mean(axis=0) + np.random.default_rng(2).normal(size=(5, 3)) * 0.1
    found = mean_value.coordinates(x, V, F)
    wanted = np.array([by_definition(p, V, F) for p in x])
    np.testing.assert_allclose(found, wanted, atol=1e-9)


@pytest.mark.parametrize("cage", [box, lump])
@pytest.mark.parametrize("kind", ["face", "edge", "vertex", "plane", "line"])
@pytest.mark.parametrize("away", [0.0, 1e-14, 1e-11, 1e-8, 1e-5, 1e-2])
def test_every_affine_map_is_reproduced_wherever_a_point_is(cage, kind, away):
    V, F = cage()
    x = places(V, F, kind, away)
    rng = np.random.default_rng(3)
    A, t = rng.normal(size=(3, 3)), rng.normal(size=3)
    prepared = mean_value.prepare(x, V, F)
    np.testing.assert_allclose(prepared.coordinates.sum(axis=1), 1.0, atol=1e-13)
    np.testing.assert_allclose(mean_value.solve(prepared, V @ A.T + t), x @ A.T + t, atol=5e-12)


@pytest.mark.parametrize("cage", [box, lump])
@pytest.mark.parametrize("kind", ["face", "edge", "vertex", "plane", "line"])
def test_they_are_continuous_on_the_cage_and_in_the_planes_of_its_faces(cage, kind):
    V, F = cage()
    at = mean_value.coordinates(places(V, F, kind, 0.0), V, F)
    for away in (1e-13, 1e-11, 1e-9, 1e-7):
        near = mean_value.coordinates(places(V, F, kind, away), V, F)
        # Within the planes and lines outside of a cage coordinates are large, and so are their slopes.
        assert np.abs(near - at).max() < 100.0 * away * np.abs(at).max() + 1e-11


@pytest.mark.parametrize("cage", [box, lump])
def test_on_the_cage_they_are_its_hat_functions(cage):
    V, F = cage()
    np.testing.assert_allclose(mean_value.coordinates(V, V, F), np.eye(len(V)), atol=1e-15)
    share = np.random.default_rng(4).dirichlet([1.0, 1.0, 1.0], size=len(F))
    share[::3, 0] = 0.0
    share /= share.sum(axis=1, keepdims=True)
    wanted = np.zeros((len(F), len(V)))
    np.put_along_axis(wanted, F, share, axis=1)
    found = mean_value.coordinates(np.einsum("mi,mij->mj", share, V[F]), V, F)
    np.testing.assert_allclose(found, wanted, atol=2e-14)


def test_they_are_positive_in_a_convex_cage_and_do_not_depend_on_place_and_size():
    V, F = sphere(1)
    x = np.random.default_rng(5).uniform(-0.4, 0.4, size=(30, 3))
    w = mean_value.coordinates(x, V, F)
    assert w.min() > 0.0
    R, t = 1e4 * Rotation.from_rotvec([0.2, 1.0, 3.0]).as_matrix(), np.array([1e5, 0.0, -2e5])
    np.testing.assert_allclose(mean_value.coordinates(x @ R.T + t, V @ R.T + t, F), w, atol=1e-12)


def test_a_cage_with_several_parts_and_a_hollow():
    V, F = box()
    two = (
        np.concatenate([V, V + np.array([3.0, 0, 0]), 0.25 + 0.5 * V]),
        np.concatenate([F, F + 8, F[:, ::-1] + 16]),
    )
    x = np.array([[0.1, 0.2, 0.15], [3.5, 0.5, 0.5], [1.5, 0.5, 0.5], [0.5, 0.5, 0.5]])
    w = mean_value.coordinates(x, *two)
    np.testing.assert_allclose(w @ two[0], x, atol=1e-14)


def refused(V, F, words: str, points=((0.5, 0.5, 0.5),)) -> None:
    with pytest.raises(ValueError, match=rf"^mean_value\.prepare: [^\n]*{words}[^\n]*$"):
        mean_value.prepare(points, V, F)


def test_what_is_no_cage_is_refused_by_name():
    V, F = box()
    refused(V, F[:-1], r"closed surface; got one triangle only at 3 edges, first that of vertices 1 and 3")
    refused(V, F[:, ::-1], r"seen from outside; got volume -1.*Reverse the faces")
    refused(V, np.concatenate([F, F[:1]]), r"one or two triangles at every edge; got 3")
    flipped = F.copy()
    flipped[3] = flipped[3, ::-1]
    refused(V, flipped, r"oriented alike; got triangles")
    refused(np.concatenate([V, [[5.0, 5, 5]]]), F, r"a use of every vertex; got none of vertex 8")
    refused(V[:-1], F, r"indices of the 7 vertices")
    refused(np.where(np.arange(8)[:, None] == 3, np.nan, V), F, r"finite; got \[nan, nan, nan\] at vertex 3")
    refused(V[:, :2], F, r"shape \(k, 3\); got shape \(8, 2\)")
    refused(V, F.astype(float), r"whole numbers")
    refused(V, F[:0], r"at least one triangle")
    flat = np.where(np.arange(8)[:, None] == 1, V[0] + 1e-15, V)
    refused(flat, F, r"faces with an area; got area")
    refused(V, F, r"points must be finite", [[np.inf, 0, 0]])
    refused(V, F, r"points must be an array of shape \(k, 3\)", [0.0, 0.0, 0.0])
    inward = np.concatenate([F, F[:, ::-1] + 8])
    refused(np.concatenate([V, V + np.array([3.0, 0, 0])]), inward, r"volume -1 of component 1 \(face 12\)")
    across = np.concatenate([V, V + np.array([0.5, 0.4, 0.3])])
    refused(across, np.concatenate([F, F + 8]), r"does not pass through itself; got \d+ crossings")
    with pytest.raises(
        ValueError, match=r"^mean_value\.solve: V must be the 8 vertices of the cage; got 7\.$"
    ):
        mean_value.solve(mean_value.prepare([[0.5] * 3], V, F), V[:-1])


def test_no_points_are_no_coordinates():
    assert mean_value.coordinates(np.zeros((0, 3)), *box()).shape == (0, 8)
