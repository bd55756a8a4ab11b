"""The cage deformer: tetrahedra, weights without jumps, similarities, and what it refuses."""

from functools import partial

import igl
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lietool.deform import adjacency, cage, cage_checks, cage_frames, cage_weights, orientation, ways, weights
from lietool.lie import so3

KINDS = [cage_frames.faces, cage_frames.edges, cage_frames.corners]
SIMILARITY = 1.7 * Rotation.from_rotvec([0.3, 2.0, 1.0]).as_matrix()
MOVE = np.array([3.0, -1.0, 2.0])


def box() -> tuple[np.ndarray, np.ndarray]:
    V = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return V, np.array([[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)])


def tube(rows: int = 12, columns: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """A closed prism along z, from 0 to 4."""
    a = np.arange(columns) * 2.0 * np.pi / columns
    ring = np.stack([np.cos(a), np.sin(a), 0.0 * a], axis=1)
    z = np.linspace(0.0, 4.0, rows)
    V = (ring + z[:, None, None] * [0.0, 0.0, 1.0]).reshape(-1, 3)
    V = np.concatenate([V, [[0.0, 0, 0], [0.0, 0, 4.0]]])
    faces = []
    for i in range(rows - 1):
        for j in range(columns):
            p, q = columns * i + j, columns * i + (j + 1) % columns
            faces += [[p, q, q + columns], [p, q + columns, p + columns]]
    for j in range(columns):
        q = (j + 1) % columns
        last = columns * (rows - 1)
        faces += [[len(V) - 2, q, j], [len(V) - 1, last + j, last + q]]
    return V, np.array(faces)


def bent() -> tuple[np.ndarray, np.ndarray]:
    """A tube bent into a hook: planes of faces cut through its inside."""
    V, F = tube()
    angle = 0.7 * V[:, 2]
    r = 2.0 + V[:, 0]
    return np.stack([r * np.cos(angle), V[:, 1], r * np.sin(angle)], axis=1), F


def inside(V: np.ndarray, F: np.ndarray, count: int = 60) -> np.ndarray:
    x = np.random.default_rng(1).uniform(V.min(axis=0), V.max(axis=0), size=(40 * count, 3))
    return x[cage_checks.winding(x, V, F) > 0.5][:count]


@pytest.mark.parametrize("kind", KINDS)
def test_a_similarity_of_the_cage_is_that_of_every_tetrahedron(kind):
    V, F = bent()
    A = cage_frames.maps(cage_frames.rest(kind(F), V), V @ SIMILARITY.T + MOVE)
    np.testing.assert_allclose(A[:, :3, :3], np.broadcast_to(SIMILARITY, (len(A), 3, 3)), atol=1e-12)
    np.testing.assert_allclose(A[:, :3, 3], np.broadcast_to(MOVE, (len(A), 3)), atol=1e-12)


def test_a_unit_normal_would_miss_a_similarity():
    V, F = box()
    T = cage_frames.tetrahedra(cage_frames.faces(F), 1.2 * V)
    unit = (T[:, 3] - T[:, 0]) / np.linalg.norm(T[:, 3] - T[:, 0], axis=1, keepdims=True)
    x = inside(V, F)
    w = cage_weights.weights(x, V, cage_frames.faces(F))
    # Per face: 1.2 within it, 1 across.
    A = 1.2 * np.eye(3) - 0.2 * unit[:, :, None] * unit[:, None, :]
    rest = cage_frames.centres(cage_frames.faces(F), V)
    c = w @ rest
    moved = c + w @ (0.2 * rest) + np.einsum("nk,kij,nj->ni", w, A, x - c)
    assert np.abs(moved - 1.2 * x).max() > 0.01


def test_tetrahedra_are_as_described():
    V, F = box()
    n = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    T = cage_frames.tetrahedra(cage_frames.faces(F), V)
    np.testing.assert_allclose(T[:, :3], V[F])
    np.testing.assert_allclose(T[:, 3] - T[:, 0], n / np.sqrt(np.linalg.norm(n, axis=1))[:, None])
    elements = cage_frames.edges(F)
    T = cage_frames.tetrahedra(elements, V)
    k = int(np.flatnonzero((elements.points == [0, 1]).all(axis=1))[0])
    up = np.array([-1.0, -1.0, 0.0]) / np.sqrt(2.0)
    np.testing.assert_allclose(T[k], [V[0], V[1], V[:2].mean(axis=0) + up, T[k, 3]], atol=1e-15)
    np.testing.assert_allclose(np.abs(T[k, 3] - V[:2].mean(axis=0)), np.abs([*up[:2], 0.0]), atol=1e-15)
    elements = cage_frames.corners(F)
    assert elements.count == 3 * len(F)
    T = cage_frames.tetrahedra(elements, V)
    at = elements.ends[:, 0] == 7
    up = (T[at, 3] - V[7]) @ np.ones(3) / np.sqrt(3.0)
    np.testing.assert_allclose(up, 1.0, atol=0.1)


def test_what_is_added_has_the_root_of_the_mean_area_around():
    V, F = bent()
    n = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    size = np.linalg.norm(n, axis=1)
    elements = cage_frames.edges(F)
    for end, T in zip(elements.points, cage_frames.tetrahedra(elements, V), strict=True):
        here = np.isin(F, end).sum(axis=1) == 2
        middle, up = V[end].mean(axis=0), n[here].sum(axis=0)
        length = np.sqrt(size[here].mean())
        beside = np.cross(up, V[end[1]] - V[end[0]])
        np.testing.assert_allclose(T[2] - middle, length * up / np.linalg.norm(up), atol=1e-14)
        np.testing.assert_allclose(T[3] - middle, length * beside / np.linalg.norm(beside), atol=1e-14)
    elements = cage_frames.corners(F)
    for (v,), T in zip(elements.points, cage_frames.tetrahedra(elements, V), strict=True):
        here = np.isin(F, v).any(axis=1)
        up = n[here].sum(axis=0)
        length = np.sqrt(size[here].mean())
        np.testing.assert_allclose(T[3] - T[0], length * up / np.linalg.norm(up), atol=1e-14)


def test_neighbours():
    _, F = box()
    assert len(cage_frames.faces(F).pairs) == 18
    edges = cage_frames.edges(F)
    assert edges.count == 18 and len(edges.pairs) == 36
    shared = [len(set(edges.points[a]) & set(edges.points[b])) for a, b in edges.pairs]
    assert set(shared) == {1}
    corners = cage_frames.corners(F)
    round_ = corners.pairs[3 * len(F) :]
    assert len(round_) == 36
    assert (corners.ends[round_[:, 0], 0] == corners.ends[round_[:, 1], 0]).all()
    assert (corners.ends[round_[:, 0], 2] == corners.ends[round_[:, 1], 1]).all()


@pytest.mark.equation("B 7.9", "K 9")
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("way", ways.WAYS.values(), ids=ways.WAYS)
@pytest.mark.parametrize("shape", [box, bent])
def test_a_cage_moved_by_a_similarity_moves_the_points_by_it(kind, way, shape):
    V, F = shape()
    x = np.concatenate([inside(V, F), V, [[9.0, 9.0, 9.0]]])
    for origin in (None, np.zeros(3)):
        prepared = cage.prepare(x, V, F, kind, origin=origin)
        done = cage.solve(prepared, V @ SIMILARITY.T + MOVE, way)
        np.testing.assert_allclose(done.points, x @ SIMILARITY.T + MOVE, atol=1e-12)
        assert not done.fallback.any() and not done.pose.replaced.any()
        np.testing.assert_allclose(
            done.pose.maps[:, :3, 3], np.broadcast_to(MOVE, (len(prepared.elements.ends), 3)), atol=1e-11
        )


@pytest.mark.parametrize("way", ways.WAYS.values(), ids=ways.WAYS)
def test_equal_affine_maps_of_all_elements_are_reproduced(way):
    V, F = box()
    A = np.eye(4)
    A[:3, :3] = np.random.default_rng(2).normal(size=(3, 3)) * 0.2 + np.eye(3)
    A[:3, 3] = MOVE
    x = inside(V, F)
    prepared = cage.prepare(x, V, F)
    from lietool.deform import move

    B = move.about(np.broadcast_to(A, (12, 4, 4)), prepared.anchored.origins)
    done = move.solve(prepared.anchored, move.encode(way, B))
    np.testing.assert_allclose(done.points, x @ A[:3, :3].T + MOVE, atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_moving_points_and_both_cages_moves_the_result(kind):
    V, F = bent()
    x, R = inside(V, F), SIMILARITY / 1.7
    now = V + 0.1 * np.sin(3.0 * V[:, ::-1])
    here = cage.solve(cage.prepare(x, V, F, kind), now).points
    there = cage.solve(cage.prepare(x @ R.T + MOVE, V @ R.T + MOVE, F, kind), now @ R.T + MOVE).points
    np.testing.assert_allclose(there, here @ R.T + MOVE, atol=1e-10)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("shape", [box, bent])
def test_weights_sum_to_1_and_are_none_in_the_outer_half_spaces(kind, shape):
    V, F = shape()
    x = np.concatenate([inside(V, F), V, 20.0 * V + 3.0])
    elements = kind(F)
    w = cage_weights.weights(x, V, elements)
    np.testing.assert_allclose(w.sum(axis=1), 1.0, atol=1e-14)
    assert w.min() == 0.0
    P = V[F]
    n = np.cross(P[:, 1] - P[:, 0], P[:, 2] - P[:, 0])
    side = np.einsum("mi,nmi->nm", n, x[:, None] - P[:, 0])[:, elements.around]
    assert (w[(side > 1e-9).all(axis=-1)] == 0.0).all()
    assert (w[(side < -1e-9).any(axis=-1)] > 0.0).all()


def test_some_face_always_counts_fully():
    V, F = bent()
    P = V[F]
    n = np.cross(P[:, 1] - P[:, 0], P[:, 2] - P[:, 0])
    size = np.linalg.norm(n, axis=1)
    volume = cage_checks.volumes(V, F, np.zeros(len(F), int))[0]
    x = np.random.default_rng(3).normal(size=(500, 3)) * 10.0
    depth = np.einsum("mi,nmi->nm", n / size[:, None], P[:, 0] - x[:, None])
    np.testing.assert_allclose(depth @ (0.5 * size), 3.0 * volume, rtol=1e-10)
    assert (depth.max(axis=1) >= 3.0 * volume / (0.5 * size.sum())).all()


@pytest.mark.parametrize("kind", KINDS)
def test_weights_do_not_jump_where_a_plane_of_a_face_is_crossed(kind):
    V, F = bent()

    def steps(count: int, ramp: float, order: int) -> float:
        angle = np.linspace(0.3, 2.5, count)
        x = np.stack([1.4 * np.cos(angle), 0.1 + 0.0 * angle, 1.4 * np.sin(angle)], axis=1)
        return float(np.abs(np.diff(cage_weights.weights(x, V, kind(F), ramp=ramp), order, axis=0)).max())

    # With steps a quarter as long the weights change by a quarter, and their slopes too.
    assert steps(8001, cage_weights.RAMP, 1) < 0.3 * steps(2001, cage_weights.RAMP, 1)
    assert steps(8001, cage_weights.RAMP, 2) < 0.1 * steps(2001, cage_weights.RAMP, 2)
    # Cut off barely, they jump by as much however short the steps.
    assert steps(8001, 1e-9, 1) > 0.8 * steps(2001, 1e-9, 1) > 0.003


def test_weights_fall_with_the_distance():
    V, F = box()
    x = np.array([[0.5, 0.5, 0.5 + h] for h in (0.0, 0.1, 0.2, 0.3)])
    top = np.flatnonzero((V[F][:, :, 2] == 0.0).all(axis=1))
    w = cage_weights.weights(x, V, cage_frames.faces(F))[:, top].sum(axis=1)
    assert (np.diff(w) < 0.0).all()


def test_the_corners_of_a_vertex_share_it():
    V, F = box()
    elements = cage_frames.corners(F)
    w = cage_weights.weights([[0.5, 0.5, 0.5]], V, elements, ramp=1e-9)[0]
    np.testing.assert_allclose(np.bincount(elements.ends[:, 0], w), 1.0 / 8.0)


def test_measures_are_parts_of_the_area():
    V, F = tube()
    for kind in KINDS:
        elements = kind(F)
        m = cage_weights.measures(elements, V)
        np.testing.assert_allclose(m.sum(), 1.0)
        assert cage_weights.weights(inside(V, F), V, elements, measure=m).min() >= 0.0


def test_what_no_element_reaches_is_refused_or_left_to_the_identity():
    V, F = box()
    near = partial(weights.cutoff, reach=0.6)
    x = np.array([[0.5, 0.5, 0.1], [0.5, 0.5, 9.0]])
    with pytest.raises(
        ValueError, match=r"^cage_weights\.weights: influence [^\n]*at point 1\.[^\n]*capped\.$"
    ):
        cage_weights.weights(x, V, cage_frames.faces(F), near)
    weigh = partial(cage_weights.weights, influence=near, normalise=weights.capped)
    done = cage.solve(cage.prepare(x, V, F, weights=weigh), V + 1.0)
    np.testing.assert_allclose(done.points[1], x[1])


def twisted(V: np.ndarray, degrees: float) -> np.ndarray:
    R = so3.rotation("z", np.deg2rad(degrees) * V[:, 2] / 4.0)
    return np.einsum("nij,nj->ni", R, V)


def test_rotations_continue_each_other_over_the_cage():
    V, F = tube(rows=25)
    x = np.array([[0.3, 0.1, z] for z in np.linspace(0.2, 3.8, 19)])
    prepared = cage.prepare(x, V, F)
    done = cage.solve(prepared, twisted(V, 280.0))
    assert done.pose.lift is not None and done.pose.lift.is_promised
    assert done.pose.lift.angle.max() > np.deg2rad(265.0)
    wanted = twisted(x, 280.0)
    turn = np.angle((done.points[:, 0] + 1j * done.points[:, 1]) / (wanted[:, 0] + 1j * wanted[:, 1]))
    assert np.abs(np.rad2deg(turn)).max() < 25.0
    # By principal logarithms what is turned by more than a half turn pulls the other way.
    principal = cage.solve(prepared, twisted(V, 280.0), lift=None)
    assert principal.pose.lift is None
    assert np.abs(principal.points - done.points).max() > 0.1
    assert cage.solve(prepared, twisted(V, 280.0), ways.PHI_SE).pose.lift is None


def test_a_seed_states_turns():
    V, F = tube()
    prepared = cage.prepare(inside(V, F), V, F)
    near = [[0.0, 0.0, 2.0 * np.pi]]
    lift = partial(adjacency.consistent, seeds=[0], near=near)
    done = cage.solve(prepared, V, lift=lift)
    np.testing.assert_allclose(done.points, inside(V, F), atol=1e-12)
    np.testing.assert_allclose(done.pose.encoded.params[:, 2], 2.0 * np.pi)


@pytest.mark.equation("K Algorithm 1")
def test_a_sequence_of_poses_goes_on_beyond_a_turn():
    V, F = tube()
    x = inside(V, F)
    prepared = cage.prepare(x, V, F)
    angles = np.arange(0.0, 541.0, 60.0)
    poses = [V @ so3.rotation("z", np.deg2rad(a)).T for a in angles]
    track = cage.follow(prepared, poses)
    turned = [pose.encoded.params[:, 2].mean() for pose in track.poses]
    np.testing.assert_allclose(turned, np.deg2rad(angles), atol=1e-9)
    assert not track.steps
    for pose, now in zip(track.poses, poses, strict=True):
        # 0.75 of a turn of 540 degrees is not that of 180, so what the weights lack of 1 would show it.
        R, _ = Rotation.align_vectors(now, V)
        np.testing.assert_allclose(cage.moved(prepared, pose).points, R.apply(x), atol=1e-6)
    assert len(cage.follow(prepared, poses[::2]).steps) == 4 * len(F)


@pytest.mark.parametrize("kind", [cage_frames.faces, cage_frames.edges])
def test_a_face_that_collapses_is_refused_or_replaced_and_counted(kind):
    V, F = box()
    x = inside(V, F)
    prepared = cage.prepare(x, V, F, kind)
    now = V.copy()
    now[0] = now[1]
    with pytest.raises(
        ValueError,
        match=r"^cage\.pose: V must be a pose in [^\n]*; got \d of \d+, first element \d+ of [^\n]*$",
    ):
        cage.solve(prepared, now)
    if kind is cage_frames.edges:
        # Both faces of the edge are gone, and with them its normal: nothing is left to be near to.
        with pytest.raises(ValueError, match=r"^orientation\.nearest: A must be [^\n]*$"):
            cage.solve(prepared, now, policy=orientation.nearest)
        return
    done = cage.solve(prepared, now, policy=orientation.nearest)
    assert done.pose.replaced.sum() == 2
    assert np.isfinite(done.points).all()
    assert np.isfinite(cage.solve(prepared, now, ways.LINEAR).points).all()


def test_faces_and_edges_never_turn_inside_out():
    V, F = box()
    rng = np.random.default_rng(5)
    for kind in KINDS[:2]:
        rest = cage_frames.rest(kind(F), V)
        for _ in range(20):
            A = cage_frames.maps(rest, V + rng.normal(size=V.shape))
            assert np.linalg.det(A[:, :3, :3]).min() > 0.0


def test_alexa_falls_back_where_an_element_has_no_logarithm():
    V, F = box()
    x = inside(V, F)
    prepared = cage.prepare(x, V, F)
    now = np.einsum("nij,nj->ni", so3.rotation("z", np.pi * V[:, 2]), V * [1.0, 2.0, 1.0])
    done = cage.solve(prepared, now, ways.ALEXA)
    assert done.fallback.all() and not done.pose.encoded.able.all()
    np.testing.assert_array_equal(done.points, cage.solve(prepared, now, ways.POLAR_QUATERNION).points)


def test_painted_weights_and_blocks():
    V, F = box()
    x = inside(V, F, 30)
    w = cage_weights.weights(x, V, cage_frames.faces(F))
    now = V + 0.2 * np.cos(V[:, ::-1] * 3.0)
    one = cage.solve(cage.prepare(x, V, F, weights=w), now).points
    many = cage.solve(cage.prepare(np.tile(x, (400, 1)), V, F), now).points
    np.testing.assert_allclose(many, np.tile(one, (400, 1)), atol=1e-13)


def refused(words: str, *arguments, **named) -> None:
    with pytest.raises(ValueError, match=rf"^[a-z_]+\.[a-z_]+: [^\n]*{words}[^\n]*$"):
        cage.prepare(*arguments, **named)


def test_bad_input_is_refused_by_name():
    V, F = box()
    x = [[0.5, 0.5, 0.5]]
    refused(r"closed surface", x, V, F[1:])
    refused(r"finite; got \[nan, 0.0, 0.0\] at vertex 0", [[np.nan, 0, 0]], V, F)
    refused(r"array of shape \(k, 3\); got shape \(1, 2\)", [[0.0, 0.0]], V, F)
    refused(r"weights must be an array of shape \(1, 12\)", x, V, F, weights=np.ones((1, 11)))
    refused(r"weights must be finite", x, V, F, weights=np.full((1, 12), np.nan))
    refused(r"origins", x, V, F, origin=[0.0, 0.0])
    refused(r"ramp must be a number above 0; got 0", x, V, F, weights=partial(cage_weights.weights, ramp=0))
    refused(r"ramp", x, V, F, weights=partial(cage_weights.weights, ramp=np.nan))
    refused(
        r"influence must be a function that gives shape",
        x,
        V,
        F,
        weights=partial(cage_weights.weights, influence=np.sum),
    )
    refused(
        r"influence must be finite", x, V, F, weights=partial(cage_weights.weights, influence=np.negative)
    )
    refused(
        r"measure must be 12 finite numbers above 0",
        x,
        V,
        F,
        weights=partial(cage_weights.weights, measure=[1.0]),
    )
    prepared = cage.prepare(x, V, F)
    for now, words in (
        (V[1:], r"8 vertices of the cage; got 7"),
        (V + np.inf, r"finite"),
        (V[:, :2], r"shape"),
        ("abc", r"numbers"),
    ):
        with pytest.raises(ValueError, match=rf"^cage\.pose: V must be [^\n]*{words}[^\n]*$"):
            cage.solve(prepared, now)


def test_a_vertex_whose_normal_lies_in_its_face_has_no_corner():
    V, F = box()
    V[7] = [0.5, 0.5, 0.4999]
    elements = cage_frames.corners(F)
    total = np.zeros(3)
    n = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    total = n[(F == 7).any(axis=1)].sum(axis=0)
    assert np.linalg.norm(total) > 0.0
    with pytest.raises(ValueError, match=r"^cage_frames\.edges: F must be a closed surface"):
        cage_frames.edges(F[1:])
    flat = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    both = np.array([[0, 1, 2], [2, 1, 0]])
    with pytest.raises(ValueError, match=r"^cage_frames\.rest: V must be a cage with a volume in every"):
        cage_frames.rest(cage_frames.edges(both), flat)
    assert elements.count == 36


def test_where_a_surface_lies_on_itself_the_rounding_of_normals_is_no_direction():
    F = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]
    for seed in range(5):
        R = Rotation.random(random_state=seed).as_matrix()
        with pytest.raises(ValueError, match=r"^cage_frames\.rest: V must be a cage with a volume in every"):
            cage_frames.rest(
                cage_frames.edges(F), np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) @ R.T
            )


def test_windings_are_libigls():
    V, F = bent()
    x = np.random.default_rng(6).uniform(V.min(axis=0) - 1.0, V.max(axis=0) + 1.0, size=(300, 3))
    found = cage_checks.winding(x, V, F)
    assert 0 < (found > 0.5).sum() < len(x)
    np.testing.assert_allclose(found, igl.winding_number(V, F, x), atol=1e-12)


def test_no_points_are_moved_nowhere():
    V, F = box()
    assert cage.solve(cage.prepare(np.zeros((0, 3)), V, F), V).points.shape == (0, 3)


def test_a_corner_may_turn_inside_out_and_is_named():
    V, F = box()
    prepared = cage.prepare([[0.2, 0.2, 0.2]], V, F, cage_frames.corners)
    now = V.copy()
    now[7] = [-0.5, 0.5, 0.9]
    with pytest.raises(
        ValueError, match=r"^cage\.pose: V must be [^\n]* of corners, vertices \[[^\n]*edges\.$"
    ):
        cage.solve(prepared, now)
    done = cage.solve(prepared, now, policy=orientation.nearest)
    assert done.pose.replaced.any() and np.isfinite(done.points).all()


def test_influence_falls_with_the_cube():
    w = cage_weights.inverse_cube(np.array([[1.0, 2.0, 4.0]]))
    assert w[0] / w[0, 0] == pytest.approx([1.0, 1.0 / 8.0, 1.0 / 64.0])
