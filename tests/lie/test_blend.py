"""The ways of blending: what all have in common, what each keeps, and what the texts say that each fails."""

import numpy as np
import pytest
from scipy.linalg import expm

from lietool.lie import aff, affine, blend, dual_quaternion, polar, quaternion, so3

PI = np.pi
BATCHES = [(), (4,), (2, 3)]
LENGTHS = {"ordinary": 1.3, "tiny": 1e-9, "near pi": PI - 1e-9, "zero": 0.0}
K = 3

every_way = pytest.mark.parametrize("way", blend.WAYS.values(), ids=blend.WAYS.keys())
each_batch = pytest.mark.parametrize("batch", BATCHES, ids=str)
each_length = pytest.mark.parametrize("length", LENGTHS.values(), ids=LENGTHS.keys())


def vectors(batch, length: float, rng) -> np.ndarray:
    x = rng.normal(size=(*batch, 3))
    return length * x / np.linalg.norm(x, axis=-1, keepdims=True)


def rigid(batch, length: float = 1.3, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    A = np.zeros((*batch, 4, 4))
    A[..., :3, :3], A[..., :3, 3] = so3.exp(vectors(batch, length, rng)), rng.normal(size=(*batch, 3))
    A[..., 3, 3] = 1
    return A


def stretches(batch, size: float = 0.25, seed: int = 0) -> np.ndarray:
    """Sample symmetric stretches small enough that turn and stretch together still have a real logarithm."""
    params = np.zeros((*batch, 12))
    params[..., 6:] = size * np.random.default_rng(seed + 100).uniform(-1, 1, size=(*batch, 6))
    return affine.phi_so(params)


def transformations(batch, length: float = 1.3, seed: int = 0) -> np.ndarray:
    size = 0.25 if length < 2 else 0.0  # near a half turn a stretch makes two different negative eigenvalues
    return rigid(batch, length, seed) @ stretches(batch, size, seed)


def translations(*batch: int, seed: int = 0) -> np.ndarray:
    A = np.broadcast_to(np.eye(4), (*batch, 4, 4)).copy()
    A[..., :3, 3] = np.random.default_rng(seed).normal(size=(*batch, 3))
    return A


def partition(batch, seed: int = 0) -> np.ndarray:
    w = np.random.default_rng(seed).uniform(0.1, 1, size=(*batch, K))
    return w / np.sum(w, axis=-1, keepdims=True)


def gap(A, B) -> float:
    return float(np.max(np.abs(A - B)))


def test_registry():
    names = "linear polar_quaternion polar_dual_quaternion grassia alexa phi_so phi_se"
    assert list(blend.WAYS) == names.split()
    assert all(way.__name__ == name for name, way in blend.WAYS.items())


@every_way
@each_batch
@each_length
def test_one_weight_alone_gives_that_transformation(way, batch, length):
    A = transformations((*batch, K), length)
    for i, one_hot in enumerate(np.eye(K)):
        np.testing.assert_allclose(way(one_hot, A), A[..., i, :, :], rtol=0, atol=1e-14)


@every_way
@each_batch
def test_all_equal_give_the_same_again(way, batch):
    A = transformations(batch)
    same = np.broadcast_to(A[..., None, :, :], (*batch, K, 4, 4))
    np.testing.assert_allclose(way(partition(batch), same), A, rtol=0, atol=1e-14)


@every_way
@each_batch
def test_what_the_weights_lack_belongs_to_the_identity(way, batch):
    A = transformations((*batch, K))
    w = 0.7 * partition(batch, 1)
    filled = np.concatenate([w, np.full((*batch, 1), 0.3)], axis=-1)
    more = np.concatenate([A, np.broadcast_to(np.eye(4), (*batch, 1, 4, 4))], axis=-3)
    np.testing.assert_allclose(way(w, A), way(filled, more), rtol=0, atol=1e-14)
    np.testing.assert_allclose(way(0 * w, A), np.broadcast_to(np.eye(4), (*batch, 4, 4)), rtol=0, atol=1e-15)


@every_way
def test_the_order_does_not_matter(way):
    A, w = transformations((K,), 0.8), partition(())
    for order in ([1, 2, 0], [0, 2, 1]):
        np.testing.assert_allclose(way(w[order], A[order]), way(w, A), rtol=0, atol=1e-14)


@every_way
def test_one_set_of_transformations_serves_many_weights(way):
    A, w = transformations((K,)), partition((2, 5))
    repeated = np.broadcast_to(A, (2, 5, K, 4, 4))
    np.testing.assert_allclose(way(w, A), way(w, repeated), rtol=0, atol=1e-15)
    assert way(w, A).shape == (2, 5, 4, 4) and way(w[:0], A).shape == (0, 5, 4, 4)


@every_way
@pytest.mark.parametrize("weights", [[0.2, 0.3, 0.5], [1.5, -1.0, 0.5], [2.0, -0.5, 1.0]])
def test_all_agree_on_translations(way, weights):
    A = translations(K)
    expected = np.eye(4)
    expected[:3, 3] = weights @ A[:, :3, 3]
    np.testing.assert_allclose(way(weights, A), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    "way", [f for name, f in blend.WAYS.items() if name not in ("linear", "polar_dual_quaternion")]
)
@pytest.mark.parametrize("t", [0.0, 0.3, 1.0, 1.8, -0.5])
def test_all_but_the_linear_ones_agree_on_turns_about_one_axis(way, t):
    A = np.stack([np.eye(4), np.eye(4)])
    A[0, :3, :3], A[1, :3, :3] = so3.rotation("z", 0.4), so3.rotation("z", 1.7)
    expected = so3.rotation("z", 0.4 + t * 1.3)
    np.testing.assert_allclose(way([1 - t, t], A)[:3, :3], expected, rtol=0, atol=2e-15)


@pytest.mark.equation("K 9", "B 7.9")
@pytest.mark.parametrize(
    ("way", "phi", "psi"), [("phi_so",) * 2 + ("psi_so",), ("phi_se",) * 2 + ("psi_se",)]
)
def test_blend_in_a_linear_space_of_parameters(way, phi, psi):
    A, w = transformations((20, K)), np.random.default_rng(2).normal(size=(20, K))
    params = np.einsum("nk,nki->ni", w, getattr(affine, psi)(A))
    np.testing.assert_array_equal(blend.WAYS[way](w, A), getattr(affine, phi)(params))


@pytest.mark.erratum("M 5")
def test_the_sum_goes_inside_phi():
    """(M 5) sums the transformations phi(w psi(A)); that is not even rigid."""
    A = np.stack([np.eye(4), np.eye(4)])
    A[0, :3, :3], A[1, :3, :3] = so3.rotation("x", 1.0), so3.rotation("y", 2.0)
    printed = sum(affine.phi_se(1.0 * affine.psi_se(a)) for a in A)[:3, :3]
    true = blend.phi_se([1.0, 1.0], A)[:3, :3]
    assert np.linalg.norm(printed.T @ printed - np.eye(3)) > 3
    assert gap(true.T @ true, np.eye(3)) < 1e-15


def test_shoemake_is_slerp_and_grassia_its_logarithm():
    q = quaternion.normalize(np.random.default_rng(3).normal(size=(2, 4)))
    q[1] *= np.sign(q[0] @ q[1])
    A = np.broadcast_to(np.eye(4), (2, 4, 4)).copy()
    A[:, :3, :3] = quaternion.to_matrix(q)
    for t in (-0.7, 0.0, 0.3, 0.9, 2.5):
        value = blend.polar_quaternion([1 - t, t], A)[:3, :3]
        np.testing.assert_allclose(value, quaternion.to_matrix(quaternion.slerp(*q, t)), atol=4e-15)
        x = so3.log(A[:, :3, :3])
        expected = so3.exp((1 - t) * x[0] + t * x[1])
        np.testing.assert_allclose(blend.grassia([1 - t, t], A)[:3, :3], expected, atol=4e-15)


@pytest.mark.parametrize("name", ["polar_quaternion", "polar_dual_quaternion", "grassia"])
def test_polar_ways_blend_the_stretch_linearly(name):
    A, w = transformations((30, K)), partition((30,))
    S = polar.decompose(A[..., :3, :3])[1]
    value = polar.decompose(blend.WAYS[name](w, A)[..., :3, :3])[1]
    np.testing.assert_allclose(value, np.einsum("nk,nkij->nij", w, S), atol=4e-15)


def test_dual_quaternion_way_is_dlb_on_rigid_motions():
    A, w = rigid((30, K), 2.0), partition((30,))
    q = dual_quaternion.dlb(w, dual_quaternion.from_matrix(A))
    np.testing.assert_allclose(blend.polar_dual_quaternion(w, A), dual_quaternion.to_matrix(q), atol=1e-14)


# What follows the blend: any affine map, rigid motions, rotations, translations.
G = {
    "affine": transformations((), 1.0, 50) @ stretches((), 0.6, 51),
    "rigid": rigid((), 1.1, 52),
    "rotation": rigid((), 1.1, 53) * np.array([1.0, 1, 1, 0]) + np.diag([0.0, 0, 0, 1]),
    "translation": translations(seed=54),
}
SIDES = {
    "left": lambda g, A: g @ A,
    "right": lambda g, A: A @ g,
    "conjugate": lambda g, A: g @ A @ np.linalg.inv(g),
}
ALL = set(G)
EUCLID = {"rigid", "rotation", "translation"}
# On affine maps: the changes that the blend follows; and those that it follows among rigid motions only.
FOLLOWS = {
    "linear": {"left": ALL, "right": ALL, "conjugate": ALL},
    "polar_quaternion": {"left": EUCLID, "right": {"rotation"}, "conjugate": {"rotation"}},
    "polar_dual_quaternion": {"left": EUCLID, "right": {"rotation"}, "conjugate": {"rotation"}},
    "grassia": {"left": {"translation"}, "right": set(), "conjugate": {"rotation"}},
    "alexa": {"left": set(), "right": set(), "conjugate": ALL},
    "phi_so": {"left": {"translation"}, "right": set(), "conjugate": {"rotation"}},
    "phi_se": {"left": set(), "right": set(), "conjugate": {"rotation"}},
}
AMONG_RIGID = {
    ("polar_dual_quaternion", "right"): EUCLID,
    ("polar_dual_quaternion", "conjugate"): EUCLID,
    ("phi_se", "conjugate"): EUCLID,
}


@pytest.mark.parametrize("name", blend.WAYS)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("which", G)
@pytest.mark.parametrize("among", ["affine", "rigid"])
def test_which_changes_of_coordinates_each_follows(name, side, which, among):
    """Kaji and Ochiai, 6: dual quaternions are bi-invariant on SE(3); Alexa's claim for aff is false."""
    if among == "rigid" and which == "affine":
        return
    make = transformations if among == "affine" else rigid
    A, w, change = make((8, K), 0.7, 4), partition((8,)), SIDES[side]
    way = blend.WAYS[name]
    error = gap(way(w, change(G[which], A)), change(G[which], way(w, A)))
    follows = which in FOLLOWS[name][side] or (
        among == "rigid" and which in AMONG_RIGID.get((name, side), ())
    )
    assert error < 4e-14 if follows else error > 1e-3


@every_way
@pytest.mark.parametrize("which", ["rotations", "rigid", "linear"])
def test_classes_are_kept_except_by_the_sum_of_matrices(way, which):
    A = transformations((20, K)) if which == "linear" else rigid((20, K))
    if which != "rigid":
        A[..., :3, 3] = 0
    B = way(partition((20,)), A)
    L = B[..., :3, :3]
    np.testing.assert_array_equal(B[..., 3, :], np.broadcast_to([0.0, 0, 0, 1], (20, 4)))
    if which != "rigid":
        np.testing.assert_allclose(B[..., :3, 3], 0, atol=1e-16)
    if which != "linear":
        defect = gap(np.swapaxes(L, -1, -2) @ L, np.eye(3))
        assert defect > 0.1 if way is blend.linear else defect < 4e-15


@pytest.mark.parametrize("name", blend.WAYS)
def test_extrapolation_is_singular_for_linear_stretches(name):
    """Table 2: two stretches, one further than the other; only a logarithm of the stretch keeps det > 0."""
    A = np.stack([np.eye(4), np.diag([0.2, 3.0, 1.0, 1.0])])
    t = np.linspace(-1, 3, 41)
    det = np.linalg.det(blend.WAYS[name](np.stack([1 - t, t], axis=-1), A))
    assert np.min(det) > 0 if name in ("alexa", "phi_so", "phi_se") else np.min(det) < 0
    assert blend.WAYS[name]([-0.25, 1.25], A)[0, 0] == pytest.approx(0.0 if np.min(det) < 0 else 0.2**1.25)


@pytest.mark.parametrize("name", blend.WAYS)
def test_large_rotations_only_where_angles_are_added(name):
    """Table 2: ten times a turn by 1 is a turn by 10 for the ways by logarithms, and for slerp."""
    A = rigid((1,), 1.0)
    A[..., :3, 3] = 0
    ten = blend.WAYS[name]([10.0], A)[:3, :3]
    expected = so3.exp(10.0 * so3.log(A[0, :3, :3]))
    assert (gap(ten, expected) < 1e-13) == (name not in ("linear", "polar_dual_quaternion"))


@pytest.mark.parametrize("name", blend.WAYS)
def test_multiples_of_one_transformation_are_a_subgroup_for_alexa_only(name):
    """exp((s + t) log A) = exp(s log A) exp(t log A); the others take turn and stretch apart."""
    A = transformations((1,), 1.0)
    s, t, whole = (blend.WAYS[name]([w], A) for w in (0.4, 0.6, 1.0))
    assert (gap(s @ t, whole) < 1e-14) == (name == "alexa")


@pytest.mark.parametrize("name", blend.WAYS)
def test_multiples_of_multiples(name):
    """Associativity in Table 2, s (t A) = (s t) A: short of a half turn only the normalised sum lacks it."""
    A = transformations((1,), 1.0)
    way = blend.WAYS[name]
    twice = way([0.5], way([0.6], A)[None])
    assert (gap(twice, way([0.3], A)) < 1e-14) == (name != "polar_dual_quaternion")
    if name in ("polar_quaternion", "grassia", "alexa", "phi_so", "phi_se"):
        # But a turn by 4 is read as one by 4 - 2 pi.
        R = rigid((1,), 1.0)
        assert gap(way([0.25], way([4.0], R)[None]), R[0]) > 0.1


def homogeneous(L, t=(1.0, 2.0, 3.0)) -> np.ndarray:
    A = np.eye(4)
    A[:3, :3], A[:3, 3] = L, t
    return A


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1.0, 2.3, 2.5, PI - 1e-3, PI - 1e-9, PI - 1e-13, PI])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e3])
def test_logarithm_in_aff_undoes_the_exponential(angle, scale):
    A = rigid((20,), angle, 6)
    A[:, :3, :3] *= scale
    X = aff.log(A)
    tolerance = 2e-14 * max(1.0, abs(np.log(scale)))
    np.testing.assert_allclose(aff.exp(X), A, rtol=0, atol=tolerance * np.max(np.abs(A)))
    np.testing.assert_allclose(
        X[:, :3, :3] + np.swapaxes(X[:, :3, :3], -1, -2),
        np.broadcast_to(2 * np.log(scale) * np.eye(3), (20, 3, 3)),
        atol=1e-13 if angle in (0.0, 1e-9, 1.0, 2.3, 2.5, PI) else 1e-15 / abs(PI - angle) * 100,
    )
    assert np.all(np.abs(np.linalg.eigvals(X).imag) <= PI + 1e-9)


def test_logarithm_in_aff_of_whatever_has_one():
    X = np.zeros((300, 4, 4))
    rng = np.random.default_rng(7)
    X[:, :3] = rng.normal(size=(300, 3, 4)) * 10.0 ** rng.uniform(-9, 0.2, size=(300, 1, 1))
    A = aff.exp(X)
    np.testing.assert_allclose(A, expm(X), rtol=1e-12, atol=1e-12)
    # Entry by entry relative to I: the logarithm of what the rounding of A left.
    np.testing.assert_allclose(aff.exp(aff.log(A)), A, rtol=0, atol=1e-14 * np.max(np.abs(A)))
    short = np.max(np.abs(np.linalg.eigvals(X).imag), axis=-1) < 3
    np.testing.assert_allclose(aff.log(A)[short], X[short], rtol=0, atol=1e-12)
    shear = homogeneous([[1.0, 1e3, 0], [0, 1, 1e3], [0, 0, 1]])
    np.testing.assert_allclose(aff.exp(aff.log(shear)), shear, rtol=1e-15)
    np.testing.assert_allclose(aff.log(shear)[:3, :3], [[0, 1e3, -5e5], [0, 0, 1e3], [0, 0, 0]], rtol=1e-15)


@pytest.mark.parametrize(
    ("L", "exists"),
    [
        (np.diag([-1.0, -2.0, 3.0]), False),  # two different negative eigenvalues
        (np.diag([-2.0, -2.0, 3.0]), True),  # equal: a half turn and a scaling
        (np.diag([-1.0, 1.0, 1.0]), False),  # a reflection
        (-np.eye(3), False),  # three
        (np.diag([0.0, 1.0, 1.0]), False),
        ([[-1.0, 1.0, 0], [0, -1, 0], [0, 0, 2]], False),  # sheared half turn: one Jordan block
        ([[-1.0, 1e-9, 0], [-1e-9, -1, 0], [0, 0, 2]], True),  # not quite a half turn
        ([[1.0, 5.0, 0], [0, 1, 5], [0, 0, 1]], True),  # a shear
        (np.diag([1e-9, 1.0, 1e9]), True),
    ],
)
def test_which_have_a_real_logarithm(L, exists):
    """Kaji and Ochiai, section 6: the exponentials are the squares; so are all conjugates of them."""
    P = np.eye(3) + 0.3 * np.random.default_rng(8).normal(size=(3, 3))
    for A in (homogeneous(L), homogeneous(so3.rotation("x", 0.7) @ L @ so3.rotation("x", -0.7))):
        assert aff.has_logarithm(A) == exists
        if exists:
            X = aff.log(A)
            np.testing.assert_allclose(aff.exp(X), A, rtol=0, atol=2e-14 * np.max(np.abs(A)))
            root = aff.exp(0.5 * X)
            np.testing.assert_allclose(root @ root, A, rtol=0, atol=2e-14 * np.max(np.abs(A)))
        else:
            with pytest.raises(ValueError, match=r"^aff\.log: A must be an exponential.*eigenvalues"):
                aff.log(A)
    if exists and np.max(np.abs(L)) < 10:
        assert aff.has_logarithm(homogeneous(P @ L @ np.linalg.inv(P))) or np.array_equal(
            L, np.diag([-2.0, -2, 3])
        )


def test_alexa_names_the_inputs_without_a_logarithm():
    bad = homogeneous(np.diag([-1.0, -2.0, 0.5]))
    A = np.stack([np.eye(4), bad, homogeneous(so3.rotation("y", PI)), bad])
    message = r"^blend\.alexa: A must be transformations with a real logarithm; got none for 2 of 4: "
    with pytest.raises(
        ValueError, match=message + r"\(1,\), \(3,\); eigenvalues -1, -2, 0\.5 at index \(1,\)\. [^\n]*$"
    ):
        blend.alexa(np.full(4, 0.25), A)
    with pytest.raises(ValueError, match="none for 1 of 2; eigenvalues"):
        blend.alexa([0.5, 0.5], A[:2], check=False)
    for name, way in blend.WAYS.items():
        if name != "alexa":
            assert np.all(np.isfinite(way(np.full(4, 0.25), A)))


@pytest.mark.parametrize("name", [name for name in blend.WAYS if name not in ("linear", "alexa")])
@pytest.mark.parametrize("L", [np.diag([1.0, 1.0, -1.0]), np.zeros((3, 3)), np.diag([1.0, 1.0, 0.0])])
def test_reflections_and_flat_ones_are_refused(name, L):
    A = np.stack([np.eye(4), np.eye(4), homogeneous(L)])
    with pytest.raises(
        ValueError, match=rf"^blend\.{name}: A must be matrices with det > 0; got det = .* index \(2,\)"
    ):
        blend.WAYS[name]([0.2, 0.3, 0.5], A)


@every_way
def test_bad_arguments(way):
    where = rf"^blend\.{way.__name__}: "
    with pytest.raises(
        ValueError, match=where + r"weights must be an array of shape \(\.\.\., 3\); got shape \(2,\)"
    ):
        way([0.5, 0.5], translations(3))
    with pytest.raises(ValueError, match=where + r"A must be an array of shape \(\.\.\., k, 4, 4\), k >= 1"):
        way([1.0], np.eye(4))
    with pytest.raises(ValueError, match=where + "weights and A must be batches that broadcast"):
        way(np.ones((2, 3)), translations(4, 3))
    last = translations(3)
    last[1, 3, 0] = 0.5
    with pytest.raises(ValueError, match=where + r"A must be an affine transformation.*index \(1,\)"):
        way([0.2, 0.3, 0.5], last)


def test_quaternions_that_cancel_are_refused():
    """Three half turns about axes of a plane, 120 degrees apart; and an extrapolation by way of 0."""
    axes = (3 * np.eye(3) - 1) / np.sqrt(6)
    A = np.stack([np.eye(4), *(homogeneous(L) for L in so3.exp(PI * axes))])
    for name in ("polar_quaternion", "polar_dual_quaternion"):
        with pytest.raises(
            ValueError, match=rf"^blend\.{name}: weights must be such that the sum .* index \(1,\)"
        ):
            blend.WAYS[name]([[1.0, 0, 0, 0], [0, 1 / 3, 1 / 3, 1 / 3]], A)
    s, c = np.sin(1.4), np.cos(1.4)
    w = 1 / (1 - s - c)
    A = np.stack([homogeneous(so3.rotation("x", angle)) for angle in (0.0, PI, 2.8)])
    with pytest.raises(ValueError, match=r"^blend\.polar_dual_quaternion: weights must be such"):
        blend.polar_dual_quaternion([1 - w + w * s, -w * s, w], A)


@pytest.mark.parametrize("name", ["polar_quaternion", "polar_dual_quaternion"])
def test_quaternions_go_round_the_shorter_way(name):
    """From 170 to -170 degrees by way of 180: both quaternions have w > 0, one must change its sign."""
    A = np.stack([homogeneous(so3.rotation("y", np.deg2rad(angle))) for angle in (170.0, -170.0)])
    middle = blend.WAYS[name]([0.5, 0.5], A)
    np.testing.assert_allclose(middle, homogeneous(so3.rotation("y", PI)), atol=1e-14)
