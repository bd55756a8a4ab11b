"""What a mesh in space is: normals, areas, and each fault by name."""

import igl
import numpy as np
import pytest

from lietool.mesh import surface
from lietool.mesh.surface import Mesh

CUBE = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
SIDES = np.array(
    [
        [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
        [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5],
    ]
)  # fmt: skip


def test_a_cube_is_well():
    health = surface.health(CUBE, SIDES)
    assert (health.components, health.boundary, health.doubles, health.closed) == (1, 0, 0, True)
    assert not any(map(len, (health.unused, health.flat, health.crowded, health.twisted)))
    assert np.array_equal(health.part, np.zeros(8))
    assert surface.areas(CUBE, SIDES) == pytest.approx(np.full(12, 0.5))
    centres = CUBE[SIDES].mean(axis=1) - 0.5
    assert np.all(np.sum(surface.face_normals(CUBE, SIDES) * centres, axis=1) > 0.4)


def test_every_fault_is_named():
    V = np.vstack([CUBE, CUBE + np.array([3.0, 0.0, 0.0]), [[9.0, 0.0, 0.0]], CUBE[:1], [[0.5, -1.0, 0.5]]])
    turned = SIDES + 8
    turned[3] = turned[3, ::-1]
    F = np.vstack([SIDES, turned[1:], [[0, 1, 18], [4, 4, 5]]])
    health = surface.health(V, F)
    assert health.components == 2
    assert health.unused.tolist() == [16, 17]
    assert health.part[[0, 18, 8, 16]].tolist() == [0, 0, 1, -1]
    assert health.crowded.tolist() == [[0, 1], [4, 5]]
    assert sorted(map(tuple, health.twisted.tolist())) == [(12, 14), (12, 15), (14, 15)]
    assert health.flat.tolist() == [len(F) - 1]
    assert health.doubles == 1 and not health.closed
    assert health.boundary == 3 + 2


def test_normals_are_libigls():
    rng = np.random.default_rng(1)
    V, F = CUBE + 0.2 * rng.normal(size=CUBE.shape), SIDES
    np.testing.assert_allclose(surface.areas(V, F), igl.doublearea(V, F) / 2, rtol=1e-13)
    theirs = igl.per_face_normals(V, F, np.zeros(3))
    theirs = theirs[0] if isinstance(theirs, tuple) else theirs
    np.testing.assert_allclose(surface.face_normals(V, F), theirs, atol=1e-14)
    theirs = igl.per_vertex_normals(V, F, igl.PER_VERTEX_NORMALS_WEIGHTING_TYPE_AREA)
    np.testing.assert_allclose(surface.vertex_normals(V, F), theirs, atol=1e-14)


def test_normals_of_nothing_are_0():
    V = np.vstack([CUBE, [[2.0, 2.0, 2.0]]])
    F = np.vstack([SIDES, [[0, 0, 1]]])
    assert np.array_equal(surface.vertex_normals(V, F)[8], np.zeros(3))
    assert np.array_equal(surface.face_normals(V, F)[-1], np.zeros(3))


def test_flat_faces_go_with_their_textures():
    F = np.vstack([SIDES[:2], [[0, 1, 1]], SIDES[2:]])
    mesh = Mesh(CUBE, F, np.zeros((3, 2)), np.arange(39).reshape(13, 3) % 3)
    clean, removed = surface.without_flat(mesh)
    assert removed.tolist() == [2]
    assert np.array_equal(clean.faces, SIDES) and len(clean.uv_faces) == 12
    assert clean.vertices is mesh.vertices


def test_welding_takes_the_first_at_each_place():
    V = np.array([[1.0, 0, 0], [0, 0, 0], [1, 0, 0], [-0.0, 0, 0], [0, 1, 0], [1, 0, 0]])
    first, place = surface.weld(V)
    assert first.tolist() == [0, 1, 4]
    assert place.tolist() == [0, 1, 0, 1, 2, 0]
    rng = np.random.default_rng(2)
    V = rng.integers(0, 3, (50, 3)).astype(float)
    first, place = surface.weld(V)
    assert np.array_equal(V[first][place], V) and np.all(np.diff(first) > 0)
    assert len(first) == len(np.unique(V, axis=0))


def test_all_numbers_of_vertices_by_name():
    V = np.eye(3)
    painted = {"held": np.arange(3.0)}
    mesh = Mesh(V, np.array([[0, 1, 2]]), colours=V, attributes=painted)
    assert list(mesh.numbers) == ["red", "green", "blue", "held"]
    np.testing.assert_array_equal(mesh.numbers["green"], [0.0, 1.0, 0.0])
    assert list(Mesh(V, mesh.faces).numbers) == []


def test_a_moved_mesh_keeps_the_rest():
    mesh = Mesh(CUBE, SIDES, attributes={"arm": np.arange(8.0)})
    moved = mesh.moved(2 * CUBE)
    assert moved.attributes is mesh.attributes and np.array_equal(moved.vertices, 2 * CUBE)
    with pytest.raises(ValueError, match=r"must be the 8 vertices of the mesh; got 7\."):
        mesh.moved(CUBE[:7])
    with pytest.raises(ValueError, match=r"must be finite; got \[nan, 0.0, 0.0\] at vertex 0\."):
        mesh.moved(np.where(np.arange(24).reshape(8, 3) == 0, np.nan, CUBE))


def test_a_mesh_so_large_that_squares_of_areas_overflow_is_refused():
    V = 1e71 * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    must = r"^surface\.health: V must be at most 1e\+70 in size; got 1e\+71\. [^\n]*$"
    with pytest.raises(ValueError, match=must):
        surface.health(V, [[0, 1, 2]])
