"""Blending shapes: the ends, affine images, rigid motions, consistent rotations, and bad targets."""

import time

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lietool.deform import adjacency, population, shape_blend, stitch, ways
from lietool.lie import affine, generic, polar, so3


def tube(rows: int = 30, columns: int = 8, radius: float = 0.3, length: float = 3.0):
    """An open tube along z."""
    a, z = np.meshgrid(np.arange(columns) * 2 * np.pi / columns, np.linspace(0, length, rows))
    V = np.stack([radius * np.cos(a), radius * np.sin(a), z], axis=-1).reshape(-1, 3)
    i = np.arange(rows * columns).reshape(rows, columns)
    j = np.roll(i, -1, axis=1)
    F = np.concatenate(
        [
            np.stack([i[:-1], j[:-1], j[1:]], -1).reshape(-1, 3),
            np.stack([i[:-1], j[1:], i[1:]], -1).reshape(-1, 3),
        ]
    )
    return V, F


def bent(V: np.ndarray, angle: float, axis: int = 0) -> np.ndarray:
    """A tube bent to an arc of an angle round an axis across it; the last ring is turned by the angle."""
    length = V[:, 2].max()
    other = 1 - axis
    sign = 1.0 if axis == 1 else -1.0
    s, r = V[:, 2] * angle / length, length / angle
    U = V.copy()
    U[:, other] = sign * (r - (r - sign * V[:, other]) * np.cos(s))
    U[:, 2] = (r - sign * V[:, other]) * np.sin(s)
    return U


def twisted(V: np.ndarray, angle: float) -> np.ndarray:
    """A tube turned about its axis, its upper end by the angle."""
    return so3.act(so3.rotation("z", angle * V[:, 2] / V[:, 2].max()), V)


def family():
    """A tube with a boundary, a second part, and a vertex that no face uses; and three targets."""
    V, F = tube()
    U = np.concatenate([V, 0.5 * V + [3, 0, 0], [[9.0, 9, 9]]])
    G = np.concatenate([F, F + len(V)])
    targets = []
    for k, (one, two) in enumerate([(0.8, 2.0), (-1.5, -1.0), (2.5, 0.3)]):
        second = twisted(0.5 * V, two) * [1, 1, 1 + 0.2 * k] + [3, k, 0]
        targets.append(np.concatenate([bent(V, one, k % 2), second, [[9.0, 9 + k, 9]]]))
    return U, targets, G


WAYS = sorted(ways.WAYS)
EXACT = ("phi_so", "phi_se")


@pytest.fixture(scope="module")
def shapes():
    return family()


@pytest.mark.parametrize("name", WAYS)
def test_unit_weights_give_the_targets_and_no_weights_the_rest(shapes, name):
    V, targets, F = shapes
    at = shape_blend.prepare(V, targets, F, ways.WAYS[name])
    for k, target in enumerate(targets):
        found = shape_blend.solve(at, np.eye(3)[k])
        np.testing.assert_allclose(found.vertices, target, atol=1e-11)
        assert found.energy < 1e-20 and found.residual < 1e-13 and found.flips == 0
    np.testing.assert_allclose(shape_blend.solve(at, np.zeros(3)).vertices, V, atol=1e-12)


@pytest.mark.parametrize("name", WAYS)
def test_equal_targets_share_their_weights(shapes, name):
    V, targets, F = shapes
    one = shape_blend.prepare(V, targets[:1], F, ways.WAYS[name])
    three = shape_blend.prepare(V, targets[:1] * 3, F, ways.WAYS[name])
    np.testing.assert_allclose(
        shape_blend.solve(three, [0.2, 0.7, -0.3]).vertices,
        shape_blend.solve(one, [0.6]).vertices,
        atol=1e-10,
    )


@pytest.mark.parametrize("name", EXACT)
@pytest.mark.parametrize("w", [-0.5, 0.3, 1.0, 1.7])
def test_an_affine_image_of_the_rest_is_blended_exactly(name, w):
    """Each part by phi(w psi(A)) about its barycentre, extrapolated too.

    No face's map but a similarity's is A itself: it takes the normal to the new normal.  So Y is isotropic.
    """
    V, F = tube()
    at = stitch.prepare(V, F)
    c = at.barycentres(V)[0]
    params = np.array([0.4, 1.9, -0.8, 3.0, -1.0, 2.0, 0.3, 0, 0, 0.3, 0, 0.3])
    A = affine.phi_so(params)
    U = (V - c) @ A[:3, :3].T + c + params[3:6]
    found = shape_blend.solve(shape_blend.prepare(V, [U], F, ways.WAYS[name]), [w])
    B = affine.phi_so(w * params)
    np.testing.assert_allclose(found.vertices, (V - c) @ B[:3, :3].T + c + w * params[3:6], atol=1e-11)
    assert found.energy < 1e-20


def test_the_maps_of_faces_give_any_affine_image_exactly_through_the_stitch():
    """With A itself as each face's map the stitch gives phi(w psi(A)) for every A."""
    V, F = tube()
    A = affine.phi_so([0.4, 1.9, -0.8, 3.0, -1.0, 2.0, 0.3, 0.1, -0.2, 0.3, 0.1, -0.4])
    blend = ways.blend(ways.PHI_SO, [0.37], A[None])
    found = stitch.deform(stitch.prepare(V, F), np.broadcast_to(blend.A, (len(F), 4, 4)))
    np.testing.assert_allclose(found.vertices, generic.transform(blend.A, V), atol=1e-12)


def test_an_affine_target_of_a_plane_sheet_is_blended_by_its_face_map():
    """In a plane sheet all faces have one map, of the plane and the normal; the blend is its phi(w psi)."""
    V, F = tube()
    V = np.stack(
        [V[:, 2] + np.tile(0.2 * np.arange(8), 30), np.tile(0.3 * np.arange(8), 30), 0 * V[:, 2]], axis=1
    )
    F = F[np.ptp(F % 8, axis=1) <= 1]
    A = np.array([[1.2, 0.5, 0], [-0.3, 0.9, 0], [0.4, 0.1, 1.0]])
    at = shape_blend.prepare(V, [V @ A.T], F)
    np.testing.assert_allclose(at.maps[0], np.broadcast_to(at.maps[0, 0], at.maps[0].shape), atol=1e-12)
    for w in (0.5, 2.0):
        L = ways.blend(ways.PHI_SO, [w], shape_blend.homogeneous(at.maps[0, :1])).A[:3, :3]
        found = shape_blend.solve(at, [w])
        c = [b[0] for b in at.barycentres]
        np.testing.assert_allclose(found.vertices, (V - c[0]) @ L.T + (1 - w) * c[0] + w * c[1], atol=1e-11)


@pytest.mark.parametrize("name", WAYS)
def test_a_rigid_motion_of_all_meshes_moves_the_blend(shapes, name):
    V, targets, F = shapes
    g, t = Rotation.from_rotvec([0.5, -1.0, 0.7]).as_matrix(), np.array([5.0, -7.0, 2.0])
    w = [0.3, 0.4, 0.6]
    here = shape_blend.solve(shape_blend.prepare(V, targets, F, ways.WAYS[name]), w)
    there = shape_blend.prepare(V @ g.T + t, [U @ g.T + t for U in targets], F, ways.WAYS[name])
    moved = shape_blend.solve(there, w)
    assert np.array_equal(here.fallback, moved.fallback)
    np.testing.assert_allclose(moved.vertices, here.vertices @ g.T + t, atol=1e-9)


@pytest.mark.equation("K 9")
def test_the_blend_is_that_of_lie_and_scipy_face_by_face(shapes):
    V, targets, F = shapes
    w = np.array([0.3, 0.5, -0.4])
    at = shape_blend.prepare(V, targets, F)
    found = shape_blend.solve(at, w)
    from scipy.linalg import expm, logm, polar

    for j in range(0, len(F), 97):
        x, Y = np.zeros(3), np.zeros((3, 3))
        for k in range(3):
            R, S = polar(at.maps[k, j])
            v = Rotation.from_matrix(R).as_rotvec()
            n = np.linalg.norm(v)
            turns = [v + 2 * np.pi * i * v / n for i in (-1, 0, 1)]
            x += w[k] * min(turns, key=lambda y: np.linalg.norm(y - at.lifts[k].vectors[j]))
            Y += w[k] * np.real(logm(S))
        expected = Rotation.from_rotvec(x).as_matrix() @ expm(Y)
        np.testing.assert_allclose(found.maps[j], expected, atol=1e-11)


def test_both_parametrisations_of_affine_maps_are_one_here(shapes):
    V, targets, F = shapes
    one, two = (
        shape_blend.solve(shape_blend.prepare(V, targets, F, ways.WAYS[n]), [0.4, 0.1, 0.9]) for n in EXACT
    )
    np.testing.assert_allclose(one.vertices, two.vertices, atol=1e-11)


def test_parts_are_blended_about_barycentres_and_lone_vertices_linearly(shapes):
    V, targets, F = shapes
    w = np.array([0.2, 0.9, -0.3])
    at = shape_blend.prepare(V, targets, F)
    found = shape_blend.solve(at, w)
    c = at.stitching.barycentres(found.vertices)
    expected = (1 - w.sum()) * at.barycentres[0] + np.tensordot(w, at.barycentres[1:], 1)
    np.testing.assert_allclose(c, expected, atol=1e-11)
    np.testing.assert_allclose(found.vertices[-1], [9, 9 + w @ [0, 1, 2], 9], atol=1e-11)
    # One part does not know of the other.
    alone = shape_blend.prepare(V[:240], [U[:240] for U in targets], F[: len(F) // 2])
    np.testing.assert_allclose(found.vertices[:240], shape_blend.solve(alone, w).vertices, atol=1e-11)


def test_rotations_up_to_300_degrees_are_halved_as_they_are():
    """A tube bent by 290 degrees, half way: a bend by 145, where quaternions and principal ones bend back."""
    V, F = tube(rows=60)
    angle = np.deg2rad(290.0)
    U = bent(V, angle)
    at = shape_blend.prepare(V, [U], F)
    assert at.messages == () and np.rad2deg(at.lifts[0].angle.max()) == pytest.approx(290, abs=4)
    half = shape_blend.solve(at, [0.5])
    turned = so3.log(polar.rotation(half.maps[-1]) @ polar.rotation(half.maps[0]).T)
    assert np.linalg.norm(turned) == pytest.approx(angle / 2, abs=0.1)
    expected = bent(V, angle / 2)
    centred = [x - x.mean(axis=0) for x in (half.vertices, expected)]
    assert np.max(np.abs(centred[0] - centred[1])) < 0.1 and half.flips == 0
    poor = shape_blend.solve(shape_blend.prepare(V, [U], F, ways.POLAR_QUATERNION), [0.5])
    assert np.max(np.abs(poor.vertices - poor.vertices.mean(axis=0) - centred[1])) > 1.0


@pytest.mark.erratum("K 4.3, 5.3 (text)")
def test_a_twist_of_540_degrees_is_reported_and_cannot_be_found():
    V, F = tube(rows=120)
    at = shape_blend.prepare(V, [twisted(V, np.deg2rad(540.0))], F)
    assert np.rad2deg(at.lifts[0].angle.max()) < 354.5
    assert len(at.messages) == 1 and at.messages[0].startswith("target 0: ") and "beyond" in at.messages[0]
    # Still the target itself is met: a choice of turns is a choice of the way, not of the end.
    np.testing.assert_allclose(
        shape_blend.solve(at, [1.0]).vertices, twisted(V, np.deg2rad(540.0)), atol=1e-10
    )


def test_maps_that_are_known_are_taken():
    V, F = tube()
    # Across the faces it does something else than their normals tell.
    A = generic.exp(np.array([[0.1, 0.4, -0.2], [0.0, 0.3, 0.1], [0.2, -0.3, 0.2]]))
    known = np.broadcast_to(A, (1, len(F), 3, 3))
    at = shape_blend.prepare(V, [V @ A.T], F, ways.ALEXA, maps=known)
    assert at.maps == pytest.approx(known)
    # So the blend is that of A itself, which is not to be had from faces and normals.
    half = shape_blend.solve(at, [0.5])
    assert half.energy == pytest.approx(0.0, abs=1e-20)
    assert half.maps == pytest.approx(np.broadcast_to(generic.exp(0.5 * generic.log(A)), half.maps.shape))
    told = shape_blend.solve(shape_blend.prepare(V, [V @ A.T], F, ways.ALEXA), [0.5])
    assert told.energy > 1e-6


def test_stated_turns_of_a_separate_part_are_kept():
    V, F = tube()
    two = np.concatenate([V, np.add(V, (5, 0, 0))])
    G = np.concatenate([F, F + len(V)])
    R = so3.rotation("z", np.deg2rad(60.0))
    target = np.concatenate([V, V @ R.T + [5, 0, 0]])
    face = len(F) + 3
    near = adjacency.turned([0, 0, np.deg2rad(60.0)], 1)
    at = shape_blend.prepare(two, [target], G, stated={0: {face: near}})
    np.testing.assert_allclose(np.rad2deg(at.lifts[0].angle[[0, face]]), [0, 420], atol=1e-5)
    half = shape_blend.solve(at, [0.5])
    np.testing.assert_allclose(
        half.vertices[len(V) :], V @ so3.rotation("z", np.deg2rad(210.0)).T + [5, 0, 0], atol=1e-10
    )


def test_alexa_gives_faces_without_a_logarithm_the_polar_blend():
    """Half turns with unequal stretch have none; they are counted and masked."""
    V, F = tube()
    U = twisted(V, 2.0 * np.pi) * [1.0, 1.6, 1.0]
    at = shape_blend.prepare(V, [U, twisted(V, 0.5)], F, ways.ALEXA)
    assert 0 < len(at.lacking) < len(F)
    found = shape_blend.solve(at, [0.5, 0.2])
    assert np.array_equal(np.flatnonzero(found.fallback), at.lacking)
    other = shape_blend.solve(
        shape_blend.prepare(V, [U, twisted(V, 0.5)], F, ways.POLAR_QUATERNION), [0.5, 0.2]
    )
    np.testing.assert_allclose(found.maps[found.fallback], other.maps[found.fallback], atol=1e-12)
    assert not np.allclose(found.maps[~found.fallback], other.maps[~found.fallback], atol=1e-3)
    assert not shape_blend.solve(at, [0.0, 1.0]).fallback.any()
    expected = ways.blend(ways.ALEXA, [0.5, 0.2], shape_blend.homogeneous(np.swapaxes(at.maps, 0, 1)))
    np.testing.assert_allclose(found.maps, expected.A[:, :3, :3], atol=1e-12)
    assert np.array_equal(found.fallback, expected.fallback)


def test_pins_go_straight_or_where_they_are_told(shapes):
    V, targets, F = shapes
    w = np.array([0.5, 0.5, 0.5])
    pins = [0, 1, 2, 3]
    at = shape_blend.prepare(V, targets, F, pins=pins)
    straight = (1 - w.sum()) * V[pins] + sum(x * U[pins] for x, U in zip(w, targets, strict=True))
    np.testing.assert_allclose(shape_blend.solve(at, w).vertices[pins], straight, atol=1e-13)
    told = V[pins] + [0, 0, 1.0]
    assert np.array_equal(shape_blend.solve(at, w, told).vertices[pins], told)
    np.testing.assert_allclose(shape_blend.solve(at, [0, 1, 0]).vertices, targets[1], atol=1e-11)


def test_phi_never_turns_a_face_inside_out_and_linear_can():
    """Weights far outside [0, 1]: the blended maps keep det > 0, those of the linear way do not."""
    V, F = tube()
    U = bent(V, 2.5)
    for w in ([-3.0], [4.0]):
        assert np.all(np.linalg.det(shape_blend.solve(shape_blend.prepare(V, [U], F), w).maps) > 0)
    linear = shape_blend.solve(shape_blend.prepare(V, [twisted(V, np.pi)], F, ways.LINEAR), [0.5])
    assert np.min(np.abs(np.linalg.det(linear.maps))) < 0.02


def test_results_repeat_and_a_frame_leaves_what_is_prepared_alone(shapes):
    V, targets, F = shapes
    at = shape_blend.prepare(V, targets, F)
    before = at.params.copy()
    first = shape_blend.solve(at, [0.3, 0.3, 0.3]).vertices
    for w in population.dirichlet(3, 3, seed=5):
        shape_blend.solve(at, w)
    assert np.array_equal(shape_blend.solve(at, [0.3, 0.3, 0.3]).vertices, first)
    assert np.array_equal(at.params, before)


def test_many_faces_at_one_edge_and_parts_that_touch_in_a_vertex():
    """Three faces at an edge, and two cones that share their tip: no surface, and still blended."""
    V = np.array([[0, 0, 0.1], [0, 0.2, 1], [1, 0.1, 0], [0.3, 1, 0], [-1, -1, 0], [2, 0, 1], [2, 1, 0]])
    F = [[0, 1, 2], [0, 1, 3], [1, 0, 4], [2, 5, 6]]
    U = V @ so3.rotation("y", 2.0).T + 0.1 * np.random.default_rng(0).normal(size=V.shape)
    at = shape_blend.prepare(V, [U], F)
    np.testing.assert_allclose(shape_blend.solve(at, [1.0]).vertices, U, atol=1e-12)
    assert np.isfinite(shape_blend.solve(at, [0.5]).vertices).all()


def test_a_frame_is_fast():
    """Of the size of the usual example, 5856 faces; far above what a frame takes, for slow machines."""
    V, F = tube(rows=184, columns=16)
    targets = [bent(V, 2.0), twisted(V, 3.0), V * [1.5, 1, 1]]
    at = shape_blend.prepare(V, targets, F)
    times = []
    for k in range(5):
        start = time.perf_counter()
        shape_blend.solve(at, [0.3, 0.3, 0.1 * k])
        times.append(time.perf_counter() - start)
    assert len(F) == 5856 and min(times) < 0.05


def test_same_faces():
    _, F = tube()
    shape_blend.same_faces(F, [F, F.copy()])
    other = F.copy()
    other[4] = other[4][::-1]
    with pytest.raises(
        ValueError, match=r"target must be a mesh of the faces of the rest; got face 4 of target 1"
    ):
        shape_blend.same_faces(F, [F, other])
    with pytest.raises(ValueError, match="the same in another order"):
        shape_blend.same_faces(F, [F[::-1]])
    told = rf"a mesh of the {len(F)} faces of the rest; got {len(F) - 1} in 0. Keep the order .* \.glb and"
    with pytest.raises(ValueError, match=told):
        shape_blend.same_faces(F, [F[1:]])


def collapsed(V, F):
    U = V.copy()
    U[F[5]] = U[F[5, 0]]
    return U


def only(V, F, **more):
    """One target, the rest itself."""
    return shape_blend.prepare(V, [V], F, **more)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (
            lambda V, F: shape_blend.prepare(V, [V, V[1:]], F),
            "target 1 must be as many vertices .*, 240; got 239",
        ),
        (lambda V, F: shape_blend.prepare(V, [V * np.nan], F), "target 0 must be finite; got .* at vertex 0"),
        (
            lambda V, F: shape_blend.prepare(V, [V, collapsed(V, F)], F),
            "target 1 must be a mesh with an area .*5",
        ),
        (lambda V, F: shape_blend.prepare(collapsed(V, F), [V], F), "F must be triangles with an area"),
        (lambda V, F: shape_blend.prepare(V, [], F), "targets must be at least one mesh; got none"),
        (lambda V, F: shape_blend.prepare(V, [V[:, :2]], F), r"target 0 must be an array of shape \(k, 3\)"),
        (lambda V, F: shape_blend.prepare(V, ["abc"], F), "target 0 must be an array of numbers"),
        (
            lambda V, F: only(V, F, maps=np.eye(3)),
            r"maps must be one for each of 1 targets and .* faces; got",
        ),
        (lambda V, F: only(V, F + 1), "F must be indices of the 240 vertices"),
        (lambda V, F: only(V, F, way="phi_so"), "way must be one of ways.WAYS; got 'phi_so'"),
        (lambda V, F: only(V, F, stated={1: {0: [0, 0, 1]}}), "stated must be for targets 0 to 0; got 1"),
        (lambda V, F: only(V, F, stated={0: {9999: [0, 0, 1]}}), "stated must be for faces"),
        (lambda V, F: only(V, F, stated={0: {0: [0, 1]}}), r"stated\[0\]\[0\] must be an array"),
        (lambda V, F: only(V, F, stated={0: {0: [0, 1, np.nan]}}), r"stated\[0\]\[0\] must be finite"),
        (
            lambda V, F: only(V, F, way=ways.ALEXA, stated={0: {0: [0, 0, 1]}}),
            "stated must be left out for ways without rotation vectors; got some for alexa",
        ),
        (
            lambda V, F: shape_blend.solve(only(V, F), [1.0, 2.0]),
            "weights must be one for each of the 1 targets",
        ),
        (lambda V, F: shape_blend.solve(only(V, F), [np.nan]), "weights must be finite"),
        (lambda V, F: shape_blend.solve(only(V, F), ["a"]), "weights must be real numbers"),
    ],
)
def test_bad_input_is_named(call, says):
    with pytest.raises(ValueError, match=rf"^(shape_blend)\.\w+: {says}[^\n]*$"):
        call(*tube())


def test_an_overflow_is_named():
    V, F = tube()
    at = shape_blend.prepare(V, [V * 2.0], F)
    with pytest.raises(ValueError, match=r"params must be such that .* overflows at index \(0,\)"):
        shape_blend.solve(at, [2000.0])
