"""Stitching against least squares on the same rows, and what the result says of itself."""

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.linalg import lsqr
from scipy.spatial.transform import Rotation

from lietool.deform import cage, enclosing, local_maps, move, probe, stitch, ways, weights
from lietool.lie import affine, so3


def torus(k: int = 12, m: int = 8) -> tuple[np.ndarray, np.ndarray]:
    u, v = np.meshgrid(np.arange(k) * 2 * np.pi / k, np.arange(m) * 2 * np.pi / m, indexing="ij")
    V = np.stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1)
    i = np.arange(k * m).reshape(k, m)
    a, b = np.roll(i, -1, 0), np.roll(i, -1, 1)
    c = np.roll(a, -1, 1)
    F = np.concatenate([np.stack([i, a, c], -1).reshape(-1, 3), np.stack([i, c, b], -1).reshape(-1, 3)])
    return V.reshape(-1, 3), F


def sheet(k: int = 5) -> tuple[np.ndarray, np.ndarray]:
    """A curved surface with a boundary."""
    x, y = np.meshgrid(np.linspace(0, 2, k), np.linspace(0, 1, k), indexing="ij")
    V = np.stack([x, y, 0.3 * np.sin(2 * x) * y], axis=-1).reshape(-1, 3)
    i = np.arange(k * k).reshape(k, k)
    a, b, c, d = i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]
    return V, np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def both() -> tuple[np.ndarray, np.ndarray]:
    """Two parts, and between them a vertex that no face uses."""
    (V, F), (W, G) = torus(), sheet()
    return np.concatenate([V, [[7.0, 7.0, 7.0]], np.add(W, (5, 0, 0))]), np.concatenate([F, G + len(V) + 1])


MESHES = {"torus": torus(), "sheet": sheet(), "both": both()}


def rows(V, F, A):
    """The energy as |M x - b|^2 for the vertices, by another way: P from the normal, B from edges."""
    M, b = np.zeros((3 * len(F), len(V))), np.zeros((3 * len(F), 3))
    for j, f in enumerate(F):
        e = np.stack([V[f[1]] - V[f[0]], V[f[2]] - V[f[0]]], axis=1)
        n = np.cross(*e.T)
        root = np.sqrt(0.5 * np.linalg.norm(n))
        P = np.eye(3) - np.outer(n, n) / (n @ n)
        inverse = np.linalg.pinv(e)  # (2, 3): B P = [x1 - x0, x2 - x0] pinv(e)
        M[3 * j : 3 * j + 3, f[1]] += root * inverse[0]
        M[3 * j : 3 * j + 3, f[2]] += root * inverse[1]
        M[3 * j : 3 * j + 3, f[0]] -= root * (inverse[0] + inverse[1])
        b[3 * j : 3 * j + 3] = root * (A[j] @ P).T
    return M, b


@pytest.mark.parametrize("name", MESHES)
def test_it_is_the_least_squares_solution(name):
    V, F = MESHES[name]
    A = np.random.default_rng(1).normal(size=(len(F), 3, 3))
    at = stitch.prepare(V, F)
    found = stitch.solve(at, A)
    M, b = rows(V, F, A)
    dense = np.linalg.lstsq(M, b, rcond=1e-12)[0]
    iterated = np.stack([lsqr(csr_array(M), b[:, k], atol=1e-14, btol=1e-14)[0] for k in range(3)], axis=1)
    for x in (dense, iterated):
        centred = [y - at.barycentres(y)[at.component] for y in (found.vertices, x)]
        np.testing.assert_allclose(*centred, atol=1e-8)
    assert found.energy == pytest.approx(np.sum((M @ dense - b) ** 2), rel=1e-10)
    assert found.energy == pytest.approx(np.sum((M @ found.vertices - b) ** 2), rel=1e-10)
    assert found.residual < 1e-13
    np.testing.assert_allclose(at.barycentres(found.vertices), at.barycentres(V), atol=1e-12)


@pytest.mark.parametrize("name", MESHES)
def test_pins_are_held_and_the_rest_is_least_squares(name):
    V, F = MESHES[name]
    rng = np.random.default_rng(2)
    A = rng.normal(size=(len(F), 3, 3))
    pins = [3, 0, 11]
    positions = rng.normal(size=(3, 3))
    found = stitch.solve(stitch.prepare(V, F, pins), A, positions=positions)
    assert np.array_equal(found.vertices[pins], positions)
    M, b = rows(V, F, A)
    free = np.setdiff1d(np.arange(len(V)), pins)
    x = np.linalg.lstsq(M[:, free], b - M[:, pins] @ positions, rcond=1e-12)[0]
    first = found.prepared.component == 0
    np.testing.assert_allclose(found.vertices[free][first[free]], x[first[free]], atol=1e-8)
    if name == "both":  # the sheet has no pin
        at = found.prepared
        np.testing.assert_allclose(at.barycentres(found.vertices)[1:], at.barycentres(V)[1:], atol=1e-12)
        assert at.floating.tolist() == [False, True, True]


@pytest.mark.parametrize("name", MESHES)
def test_consistent_maps_are_reproduced(name):
    V, F = MESHES[name]
    rng = np.random.default_rng(3)
    U = V + 0.2 * rng.normal(size=V.shape)
    at = stitch.prepare(V, F)
    A = local_maps.maps(at.frames, U)
    found = stitch.solve(at, A, at.barycentres(U))
    np.testing.assert_allclose(found.vertices, U, atol=1e-12)
    assert found.energy < 1e-24 and found.flips == 0
    np.testing.assert_allclose(found.det, np.linalg.det(A), rtol=1e-9)


def test_the_normal_part_of_a_map_does_not_matter():
    V, F = sheet()
    at = stitch.prepare(V, F)
    A = np.random.default_rng(4).normal(size=(len(F), 3, 3))
    other = A + np.random.default_rng(5).normal(size=(len(F), 3))[..., None] * at.frames.normal[:, None]
    np.testing.assert_allclose(stitch.solve(at, A).vertices, stitch.solve(at, other).vertices, atol=1e-12)


@pytest.mark.equation("M 5")
def test_one_affine_transformation_of_all_faces_moves_the_mesh_by_it():
    V, F = both()
    g = affine.phi_so([0.3, 2.0, -1.0, 5.0, 6.0, 7.0, 0.4, 0.1, 0.0, -0.3, 0.2, 0.1])
    at = stitch.prepare(V, F)
    found = stitch.deform(at, np.broadcast_to(g, (len(F), 4, 4)))
    moved = V @ g[:3, :3].T + g[:3, 3]
    used = np.unique(F)
    np.testing.assert_allclose(found.vertices[used], moved[used], atol=1e-12)
    np.testing.assert_allclose(found.vertices[96], V[96])  # no face moves it
    assert found.energy < 1e-24


def test_transformations_that_vary_are_followed():
    """A bend given to faces by their centres: the stitch is near to the bend of the vertices."""
    V, F = sheet(25)
    at = stitch.prepare(V, F)

    def bend(p):
        x = np.zeros_like(p)
        x[:, 1] = -0.8 * p[:, 0]
        return so3.exp(x)

    # d/dp of the map p -> (sin .8x / .8, y, (1 - cos .8x) / .8) + z normal is R_y(-.8 x) to first order in z.
    c = stitch.centres(at) * [1, 1, 0]
    R, z = bend(c), stitch.centres(at)[:, 2]
    A = np.zeros((len(F), 4, 4))
    A[:, :3, :3], A[:, 3, 3] = R, 1.0
    middle = np.stack([np.sin(0.8 * c[:, 0]) / 0.8, c[:, 1], (1 - np.cos(0.8 * c[:, 0])) / 0.8], axis=1)
    middle += R[:, :, 2] * z[:, None]
    A[:, :3, 3] = middle - np.einsum("fij,fj->fi", R, stitch.centres(at))
    found = stitch.deform(at, A)
    U = np.stack([np.sin(0.8 * V[:, 0]) / 0.8, V[:, 1], (1 - np.cos(0.8 * V[:, 0])) / 0.8], axis=1)
    U += bend(V)[:, :, 2] * V[:, 2:]
    assert np.max(np.abs(found.vertices - U)) < 0.1
    assert found.flips == 0


@pytest.mark.parametrize("way", ways.WAYS.values(), ids=ways.WAYS)
def test_probes_and_cages_may_give_their_transformations_to_faces(way):
    """MEIS section 3: with the laws that hold by vertices, and near to what comes of these."""
    V, F = torus(36, 24)
    at = stitch.prepare(V, F)
    c = stitch.centres(at)
    rest = np.stack([np.eye(4)] * 2)
    rest[:, 0, 3] = [-3.0, 3.0]
    w = weights.partition_of_unity(weights.inverse_distance(weights.distances(c, rest[:, :3, 3])))
    probes = probe.prepare(c, rest, w)

    def by_faces(anchored, pose):
        return stitch.deform(at, move.transformations(anchored, pose).A)

    A = affine.phi_so([0.5, -1.0, 0.3, 1.0, 2.0, 3.0, 0.1, 0.05, 0.0, -0.2, 0.1, 0.3])
    found = by_faces(probes.anchored, probe.pose(probes, A @ rest, way)[0])
    np.testing.assert_allclose(found.vertices, V @ A[:3, :3].T + A[:3, 3], atol=1e-12)
    hull = enclosing.cage(V, F, faces=60)
    S, t = 1.3 * so3.exp([0.4, 0.2, -1.0]), np.array([1.0, 0.0, -2.0])
    caged = cage.prepare(c, hull.vertices, hull.faces)
    now = cage.pose(caged, hull.vertices @ S.T + t, way)
    np.testing.assert_allclose(by_faces(caged.anchored, now.encoded).vertices, V @ S.T + t, atol=1e-12)
    current = rest.copy()
    current[1, :3, :3] = so3.rotation("x", 1.2)
    found = by_faces(probes.anchored, probe.pose(probes, current, way)[0])
    own = weights.partition_of_unity(weights.inverse_distance(weights.distances(V, rest[:, :3, 3])))
    vertexwise = probe.solve(probe.prepare(V, rest, own), current, way).points
    # They differ by what the slope of the weights adds to the map of a face.
    far = np.linalg.norm(vertexwise - V, axis=1).mean()
    assert far > 0.3
    assert np.linalg.norm(found.vertices - vertexwise, axis=1).mean() < 0.3 * far


def test_a_face_that_is_turned_over_is_counted():
    V, F = sheet()
    at = stitch.prepare(V, F)
    A = np.broadcast_to(np.eye(3), (len(F), 3, 3)).copy()
    A[7] = 20.0 * so3.rotation("z", np.pi)
    found = stitch.solve(at, A)
    again = np.cross(*(found.vertices[F[:, k]] - found.vertices[F[:, 0]] for k in (1, 2)))
    asked = np.cross(*(np.einsum("fij,fj->fi", A, V[F[:, k]] - V[F[:, 0]]) for k in (1, 2)))
    assert np.array_equal(found.flipped, np.einsum("fi,fi->f", again, asked) <= 0)
    assert found.flips == found.flipped.sum() > 0
    assert np.all(found.errors >= 0) and found.errors.sum() == pytest.approx(found.energy)


def test_the_result_moves_with_its_mesh():
    V, F = both()
    g, t = Rotation.from_rotvec([1.0, 2, 3]).as_matrix(), np.array([1e3, -2e3, 3e3])
    A = np.random.default_rng(6).normal(size=(len(F), 3, 3))
    here, there = stitch.prepare(V, F), stitch.prepare(V @ g.T + t, F)
    one, two = stitch.solve(here, A).vertices, stitch.solve(there, g @ A @ g.T).vertices
    np.testing.assert_allclose(two, one @ g.T + t, atol=1e-9)


def test_local_maps_reproduce_similarities_and_their_determinant_is_the_area_to_three_halves():
    V, F = torus()
    at = local_maps.frames(V, F)
    similar = 3.0 * so3.exp([1.0, 0.2, -0.5])
    np.testing.assert_allclose(
        local_maps.maps(at, V @ similar.T + 5.0), np.stack([similar] * len(F)), atol=1e-12
    )
    U = V + 0.1 * np.random.default_rng(0).normal(size=V.shape)
    areas = [
        np.linalg.norm(np.cross(X[F[:, 1]] - X[F[:, 0]], X[F[:, 2]] - X[F[:, 0]]), axis=1) for X in (V, U)
    ]
    A = local_maps.maps(at, U)
    np.testing.assert_allclose(np.linalg.det(A), (areas[1] / areas[0]) ** 1.5, rtol=1e-12)
    np.testing.assert_allclose(at.area, 0.5 * areas[0], rtol=1e-12)
    # The tetrahedra themselves: corner + n / sqrt|n| goes to its counterpart.
    for k in (1, 2):
        e = [X[F[:, k]] - X[F[:, 0]] for X in (V, U)]
        np.testing.assert_allclose(np.einsum("fij,fj->fi", A, e[0]), e[1], atol=1e-13)
    n = [np.cross(X[F[:, 1]] - X[F[:, 0]], X[F[:, 2]] - X[F[:, 0]]) for X in (V, U)]
    fourth = [x / np.sqrt(np.linalg.norm(x, axis=1))[:, None] for x in n]
    np.testing.assert_allclose(np.einsum("fij,fj->fi", A, fourth[0]), fourth[1], atol=1e-13)


def test_slivers_keep_their_digits():
    V = np.array([[0, 0, 0], [1, 0, 0], [0.5, 1e-7, 0], [0.5, -1, 0]], float)
    F = np.array([[0, 1, 2], [1, 0, 3]])
    U = V * [2.0, 3.0, 1.0]
    A = local_maps.maps(local_maps.frames(V, F), U)
    np.testing.assert_allclose(A, np.stack([np.diag([2, 3, np.sqrt(6)])] * 2), rtol=1e-8)


FLAT = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]], float)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (
            lambda V, F: stitch.prepare(FLAT, [[0, 1, 3], [0, 1, 2]]),
            r"F must be triangles with an area.*face 1",
        ),
        (lambda V, F: stitch.prepare(V * np.nan, F), "V must be finite"),
        (lambda V, F: stitch.prepare(V, F, [3, 3]), "pins must be distinct vertices; got vertex 3 twice"),
        (lambda V, F: stitch.prepare(V, F, [99]), "pins must be indices of the 25 vertices, from 0; got 99"),
        (lambda V, F: stitch.prepare(V, F, [0.5]), "pins must be whole numbers"),
        (
            lambda V, F: stitch.solve(stitch.prepare(V, F), np.eye(3)),
            "maps must be one for each of the 32 faces",
        ),
        (
            lambda V, F: stitch.solve(stitch.prepare(V, F), np.full((32, 3, 3), np.inf)),
            r"maps must be finite; got inf at index \(0,\)",
        ),
        (
            lambda V, F: stitch.solve(stitch.prepare(V, F), np.zeros((32, 3, 3)), [[1.0, 2, 3]] * 2),
            r"barycentre must be an array of shape \(1, 3\)",
        ),
        (
            lambda V, F: stitch.solve(stitch.prepare(V, F, [1]), np.zeros((32, 3, 3)), positions=[1.0, 2, 3]),
            r"positions must be an array of shape \(1, 3\)",
        ),
        (
            lambda V, F: stitch.deform(stitch.prepare(V, F), np.eye(4)),
            "A must be one for each of the 32 faces",
        ),
        (lambda V, F: local_maps.frames(FLAT, [[0, 1, 2]]), "F must be triangles with an area"),
        (
            lambda V, F: local_maps.maps(local_maps.frames(V, F), V * [1, 0, 0]),
            "U must be a mesh with an area in every face; got face 0, 1, 2, 3 and 28 more",
        ),
        (
            lambda V, F: local_maps.maps(local_maps.frames(V, F), V[:9]),
            "U must be at least 25 vertices; got 9",
        ),
    ],
)
def test_bad_input_is_named(call, says):
    with pytest.raises(ValueError, match=rf"^(stitch|local_maps)\.\w+: {says}[^\n]*$"):
        call(*sheet())
