"""Operators of surfaces: against libigl's, and the laws that tie them together."""

import igl
import numpy as np
import pytest

from lietool.mesh import laplacian


def sphere(level: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """A closed surface of uneven triangles, an ellipsoid with some obtuse ones."""
    V, F = igl.icosahedron()
    for _ in range(level):
        V, F = igl.upsample(V, F, 1)
        V /= np.linalg.norm(V, axis=1, keepdims=True)
    return V * [1.0, 2.0, 0.6], F.astype(np.intp)


def sheet(k: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """A curved surface with a boundary, and beside it a triangle of its own and an edge of three faces."""
    x, y = np.meshgrid(np.linspace(0, 2, k), np.linspace(0, 1, k) ** 2, indexing="ij")
    V = np.stack([x, y, 0.3 * np.sin(2 * x) * y], axis=-1).reshape(-1, 3)
    i = np.arange(k * k).reshape(k, k)
    a, b, c, d = i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]
    F = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    n = len(V)
    V = np.vstack([V, [[5, 0, 0], [6, 0, 0], [5, 1, 0.5], [0.3, 0.2, 1.0]]])
    return V, np.vstack([F, [[n, n + 1, n + 2], [0, k + 1, n + 3]]])


MESHES = pytest.mark.parametrize("mesh", [sphere(), sheet()], ids=["closed", "crowded"])


@MESHES
def test_stiffness_is_libigls_with_the_other_sign(mesh):
    V, F = mesh
    L, theirs = laplacian.cotangent(V, F), igl.cotmatrix(V, F)
    assert abs(L + theirs).max() <= 1e-12 * abs(theirs).max()


@MESHES
def test_masses_are_libigls(mesh):
    V, F = mesh
    theirs = igl.massmatrix(V, F, igl.MASSMATRIX_TYPE_BARYCENTRIC).diagonal()
    np.testing.assert_allclose(laplacian.mass(V, F), theirs, rtol=1e-12)
    theirs = igl.massmatrix(V, F, igl.MASSMATRIX_TYPE_VORONOI).diagonal()
    np.testing.assert_allclose(laplacian.voronoi_mass(V, F), theirs, rtol=1e-12)


@MESHES
def test_gradient_is_libigls_with_its_rows_face_by_face(mesh):
    V, F = mesh
    x = np.sin(V @ [1.0, 2.0, 3.0])
    theirs = (igl.grad(V, F) @ x).reshape(3, -1).T
    ours = (laplacian.gradient(V, F) @ x).reshape(-1, 3)
    np.testing.assert_allclose(ours, theirs, atol=1e-12 * np.abs(theirs).max())


@MESHES
def test_rows_of_the_stiffness_sum_to_0_and_it_is_the_dirichlet_energy(mesh):
    V, F = mesh
    L, G = laplacian.cotangent(V, F), laplacian.gradient(V, F)
    assert np.abs(L.sum(axis=0)).max() <= 1e-13 * abs(L).max()
    assert abs(L - L.T).max() == 0.0
    x = np.cos(V @ [2.0, 1.0, -1.0])
    area = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1) / 2
    energy = np.sum(area * np.sum((G @ x).reshape(-1, 3) ** 2, axis=1))
    assert x @ L @ x == pytest.approx(energy, rel=1e-12)


@MESHES
def test_the_gradient_of_a_linear_function_is_its_part_along_each_triangle(mesh):
    V, F = mesh
    a = np.array([1.0, -2.0, 0.5])
    normal = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    found = (laplacian.gradient(V, F) @ (V @ a)).reshape(-1, 3)
    np.testing.assert_allclose(found, a - (normal @ a)[:, None] * normal, atol=1e-12)


@MESHES
@pytest.mark.equation("B 7.13")
def test_the_divergence_of_a_gradient_is_minus_the_stiffness(mesh):
    V, F = mesh
    L = laplacian.cotangent(V, F)
    assert abs(laplacian.divergence(V, F) @ laplacian.gradient(V, F) + L).max() <= 1e-13 * abs(L).max()


def test_of_a_paraboloid_of_the_plane_the_integrated_divergence_is_2_times_the_masses():
    # f = (x^2 + y^2) / 2 has div grad f = 2: with the printed sign of (7.13) it would be -2.
    k = 9
    x, y = np.meshgrid(np.arange(k), np.arange(k), indexing="ij")
    V = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3) / (k - 1.0)
    i = np.arange(k * k).reshape(k, k)
    a, b, c, d = i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]
    F = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    f = np.sum(V**2, axis=1) / 2
    found = laplacian.divergence(V, F) @ (laplacian.gradient(V, F) @ f)
    inner = i[1:-1, 1:-1].ravel()
    np.testing.assert_allclose(found[inner], 2 * laplacian.mass(V, F)[inner], rtol=1e-12)


def test_masses_sum_to_the_area_and_are_0_where_no_face_is():
    V, F = sheet()
    V = np.vstack([V, [[9.0, 9.0, 9.0]]])
    area = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1).sum() / 2
    for mass in (laplacian.mass, laplacian.voronoi_mass):
        found = mass(V, F)
        assert found.sum() == pytest.approx(area, rel=1e-13)
        assert found[-1] == 0.0 and (found[:-1] > 0.0).all()


@pytest.mark.parametrize(
    "f", [laplacian.cotangent, laplacian.gradient, laplacian.divergence, laplacian.voronoi_mass]
)
def test_faces_without_an_area_are_refused_by_number(f):
    V, F = sheet()
    V = np.vstack([V, V[:1] + np.array([1e-18, 0.0, 0.0]), 0.5 * (V[1:2] + V[2:3])])
    n = len(V)
    bad = np.vstack([F, [[0, 0, 1], [0, n - 2, 3], [1, n - 1, 2]]])
    m = len(F)
    with pytest.raises(ValueError, match=rf"F must be .*; got area 0 in face {m}, {m + 1}, {m + 2}\. Remove"):
        f(V, bad)


def test_broken_meshes_are_refused():
    V, F = sheet()
    for f in (laplacian.cotangent, laplacian.mass, laplacian.gradient, laplacian.divergence):
        name = f"laplacian.{f.__name__}"
        with pytest.raises(ValueError, match=rf"^{name}: V must be finite; got \[nan, .* at vertex 3\.$"):
            f(np.where(np.arange(len(V))[:, None] == 3, np.nan, V), F)
        with pytest.raises(ValueError, match=r"F must be indices of the 40 vertices.* at triangle 2\."):
            f(V, np.where(np.arange(len(F))[:, None] == 2, 77, F))
        with pytest.raises(ValueError, match=r"F must be whole numbers of shape \(m, 3\)"):
            f(V, F.astype(float))
        with pytest.raises(ValueError, match=r"F must be whole numbers of shape \(m, 3\); got a ragged list"):
            f(V, [[0, 1, 2], [1, 2]])
        with pytest.raises(ValueError, match=r"F must be at least one triangle; got none"):
            f(V, F[:0])
        with pytest.raises(ValueError, match=r"V must be an array of shape \(k, 3\); got shape"):
            f(V[:, :2], F)
