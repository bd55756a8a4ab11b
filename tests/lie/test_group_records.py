"""Every claim of the records of groups, tried: dimension, components, compact, exp, products, maps."""

import inspect
import re

import numpy as np
import pytest
import scipy.linalg

from lietool.lie import groups, polar, so3
from lietool.lie.groups import GROUPS, MAPS

CASES = [(name, n) for name, g in GROUPS.items() for n in ((2, 3) if g.only is None else (g.only,))]
IDS = [f"{name} {n}" for name, n in CASES]
each = pytest.mark.parametrize(("name", "n"), CASES, ids=IDS)
RNG = np.random.default_rng


def sample(name: str, n: int, count: int = 40, seed: int = 0) -> np.ndarray:
    return groups.sample(name, count, seed, n)


def matrix(name: str, a: np.ndarray) -> np.ndarray:
    """Write numbers as the matrices of b -> a b; matrices stay."""
    if GROUPS[name].only is None:
        return a
    basis = np.eye(a.shape[-1])
    return np.stack([groups.multiply(name, a, b) for b in basis], axis=-1)


def tangents(name: str, n: int, count: int = 60) -> np.ndarray:
    """Velocities of curves through the identity, (4.14), as `project` bends straight lines into the group."""
    one, step = groups.identity(name, n), 1e-5
    E = RNG(3).normal(size=(count, *one.shape))
    return (groups.project(name, one + step * E) - groups.project(name, one - step * E)) / (2 * step)


@each
@pytest.mark.equation("B 4.14")
def test_dimension_is_the_rank_of_the_tangent_space(name, n):
    D = tangents(name, n).reshape(60, -1)
    assert np.linalg.matrix_rank(D, 1e-4) == GROUPS[name].dimension(n)


@each
def test_samples_are_members_that_project_keeps(name, n):
    A = sample(name, n)
    assert np.all(groups.is_member(name, A))
    np.testing.assert_allclose(groups.project(name, A), A, rtol=1e-13, atol=1e-13)
    assert groups.is_member(name, groups.identity(name, n))
    wild = RNG(5).normal(size=A.shape)
    mended = groups.project(name, wild)
    # Which may lie on the very edge of an open set, at FLOOR.
    assert np.all(groups.is_member(name, mended))
    assert np.all(groups.is_member(name, groups.project(name, 1e-60 * wild)))


@each
def test_closed_under_products_and_inverses_but_for_sym(name, n):
    A, B = sample(name, n, seed=1), sample(name, n, seed=2)
    AB, inverse = groups.multiply(name, A, B), groups.inverse(name, A)
    assert np.all(groups.is_member(name, inverse))
    np.testing.assert_allclose(
        groups.multiply(name, A, inverse), np.broadcast_to(groups.identity(name, n), A.shape), atol=1e-9
    )
    assert bool(np.all(groups.is_member(name, AB))) is GROUPS[name].is_group is (name != "Sym+")


@each
@pytest.mark.equation("B 2.3", "B 2.13", "B 2.20", "B 3.3", "B 3.4")
def test_strangers_are_refused(name, n):
    if name not in ("GL", "GL+", "C^x", "H^x", "DQ^x"):
        assert not np.any(groups.is_member(name, RNG(8).normal(size=sample(name, n).shape) - 3.0))
    if GROUPS[name].only is None:
        flipped = sample(name, n) @ np.diag([-1.0] + [1.0] * (groups.identity(name, n).shape[0] - 1))
        assert np.all(groups.is_member(name, flipped) == (GROUPS[name].components == 2))
        singular = groups.identity(name, n)
        singular[0] = 0.0
        assert not groups.is_member(name, singular)
    else:
        assert not groups.is_member(name, 0.0 * groups.identity(name))


@each
@pytest.mark.equation("B 2.11", "B 2.12", "B 3.1", "B 3.2")
def test_components(name, n):
    """One: a path leads from every sample to the identity.  Two: the sign of det tells them apart."""
    A = sample(name, n)
    if GROUPS[name].components == 2:
        sign = np.sign(np.linalg.det(A))
        assert set(sign) == {-1.0, 1.0}
        flip = groups.identity(name, n)
        flip[0, 0] = -1.0
        A = np.where(sign[:, None, None] > 0, A, A @ flip)  # now the path below leads to I or to the flip
    t = np.linspace(0, 1, 41)
    for a in A[:8]:
        path = along(name, a, t)
        assert np.all(groups.is_member(name, path))
        np.testing.assert_allclose(path[0], groups.identity(name, n), atol=1e-12)
        np.testing.assert_allclose(path[-1], a, rtol=1e-9, atol=1e-9)
        assert np.max(np.abs(np.diff(path, axis=0))) < 0.2 * max(1.0, np.max(np.abs(a)))
    assert GROUPS[name].connected == (GROUPS[name].components == 1)


def along(name: str, a: np.ndarray, t: np.ndarray) -> np.ndarray:
    """A path from the identity to a: R^t S^t and the translation t d; powers of numbers."""
    t = t[:, None, None]
    if GROUPS[name].only is not None:
        real = a.copy()
        dual = {"DCN": 2, "DQ": 4, "DQ^x": 4}.get(name, len(a))
        real[dual:] = 0.0
        power = exponential(name, t[..., 0] * number_logarithm(name, real))
        k = np.tile(groups.multiply(name, groups.inverse(name, real), a), (len(t), 1))
        k[:, dual:] *= t[..., 0]
        return groups.multiply(name, power, k)
    m = len(a) - (name in ("R", "SE", "E", "Sim+", "Aff+", "Aff"))
    X, Y = polar_logarithms(a[:m, :m])
    B = np.tile(np.eye(len(a)), (len(t), 1, 1))
    B[:, :m, :m] = scipy.linalg.expm(t * X) @ scipy.linalg.expm(t * Y)
    B[:, :m, m:] = t * a[:m, m:]
    return B


def polar_logarithms(A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    R, S = scipy.linalg.polar(A)
    turn = so3.log(scipy.linalg.block_diag(*([1.0] * (3 - len(A))), R))
    d, V = np.linalg.eigh(S)
    return so3.hat(turn)[3 - len(A) :, 3 - len(A) :], (V * np.log(d)) @ V.T


@each
def test_compact_means_bounded(name, n):
    rng = RNG(11)
    scales = 10.0 ** rng.uniform(-8, 8, size=(300, *groups.identity(name, n).shape))
    wild = groups.project(name, scales * rng.normal(size=scales.shape))
    assert bool(np.max(np.abs(wild)) <= 1.0 + 1e-12) is GROUPS[name].compact
    assert bool(np.max(np.abs(wild)) > 1e4) is not GROUPS[name].compact


@each
@pytest.mark.equation("B 2.7")
def test_abelian_means_that_products_commute(name, n):
    A, B = sample(name, n, seed=1), sample(name, n, seed=2)
    gap = np.max(np.abs(groups.multiply(name, A, B) - groups.multiply(name, B, A)))
    assert bool(gap < 1e-12) is GROUPS[name].abelian(n)


@each
@pytest.mark.equation("B 4.12", "B 4.18", "B 4.19")
def test_exp_is_injective_where_the_algebra_turns_nothing(name, n):
    """A logarithm is unique if it has real eigenvalues only; i theta in one leads to a full turn."""
    turning = np.max(np.abs(np.linalg.eigvals(matrix(name, tangents(name, n))).imag))
    assert bool(turning < 1e-3) is GROUPS[name].exp_injective


@each
@pytest.mark.equation("B 4.17", "B 4.20")
def test_exp_is_surjective_where_claimed(name, n):
    special = [groups.identity(name, n), *hard(name, n)]
    if GROUPS[name].exp_surjective:
        assert GROUPS[name].unreachable is None
        for a in [*sample(name, n, 12), *special]:
            x = logarithm(name, a)
            np.testing.assert_allclose(exponential(name, x), a, atol=2e-7 * np.max(np.abs(a)))
        return
    unreachable = GROUPS[name].unreachable
    assert unreachable is not None
    a = unreachable(n)
    assert groups.is_member(name, a)
    if name == "DCN":
        # Every logarithm of -1 is i pi (2 k + 1), and what is added to it in the dual part does not show.
        for k in (-2, -1, 0, 1):
            y = np.concatenate([[0.0, (2 * k + 1) * np.pi], RNG(k + 5).normal(size=2)])
            np.testing.assert_allclose(exponential(name, y), [-1, 0, 0, 0], atol=1e-12)
        return
    # Non-real eigenvalues of a real X come in conjugate pairs: a negative eigenvalue of exp(X) has a twin.
    d = np.linalg.eigvals(a)
    negative = np.sort(d[(d.imag == 0) & (d.real < 0)].real)
    assert len(negative) % 2 == 1 or np.any(np.diff(negative)[::2] > 0.5)
    assert not np.isrealobj(scipy.linalg.logm(a))


def hard(name: str, n: int) -> list[np.ndarray]:
    """Half turns, with and without translation, and -1."""
    if GROUPS[name].only is not None:
        minus = -groups.identity(name)
        moved = minus.copy()
        if name.startswith("DQ"):
            moved[5:] = 0.3, -0.2, 0.5
        return [minus, moved]
    half = groups.identity(name, n)
    half[0, 0] = half[1, 1] = -1.0
    moved = half.copy()
    moved[:-1, -1] = np.where(moved[:-1, -1] == 0.0, 0.7, moved[:-1, -1])
    return [A for A in (half, moved) if groups.is_member(name, A)]


def exponential(name: str, x: np.ndarray) -> np.ndarray:
    X = scipy.linalg.expm(matrix(name, x))
    return X if GROUPS[name].only is None else X[..., 0]


def logarithm(name: str, a: np.ndarray) -> np.ndarray:
    if GROUPS[name].only is not None:
        return number_logarithm(name, a)
    m = len(a) - (name in ("R", "SE", "Sim+"))
    x = np.zeros(a.shape)
    x[:m, :m] = np.add(*polar_logarithms(a[:m, :m]))  # which commute, in each of these groups
    if m < len(a):
        # exp((X, l; 0, 0)) = (exp X, V l; 0, 1)
        both = np.block([[x[:m, :m], np.eye(m)], [np.zeros((m, 2 * m))]])
        x[:m, m] = np.linalg.lstsq(scipy.linalg.expm(both)[:m, m:], a[:m, m], rcond=1e-10)[0]
    return x


def number_logarithm(name: str, a: np.ndarray) -> np.ndarray:
    half = len(a) // 2 if name in ("DCN", "DQ", "DQ^x") else len(a)
    size, axis = np.linalg.norm(a[:half]), a[1:half]
    theta = np.arctan2(np.linalg.norm(axis), a[0])
    if np.linalg.norm(axis) < 1e-12:  # at -1 any axis serves for z; take that of w, if there is one
        axis = a[half + 1 :] if np.any(a[half + 1 :]) else np.eye(half - 1)[0]
    x = np.zeros(len(a))
    x[0], x[1:half] = np.log(size), theta * axis / np.linalg.norm(axis)
    if half < len(a) and np.any(a[half:]):
        basis = np.eye(len(a))[half + (name == "DQ") :]
        columns = [exponential(name, x + b) - exponential(name, x) for b in basis]  # linear in the dual part
        rest = a - exponential(name, x)
        y = np.linalg.lstsq(np.stack(columns, axis=-1), rest, rcond=1e-10)[0]
        x = x + y @ basis
    return x


PRODUCTS = [(name, n) for name, n in CASES if GROUPS[name].product]


@pytest.mark.parametrize(("name", "n"), PRODUCTS, ids=[f"{name} {n}" for name, n in PRODUCTS])
@pytest.mark.equation("B 3.5", "B 3.6", "B 3.7", "B 3.8", "B 3.9", "B 3.10")
def test_products_of_groups(name, n):
    product = GROUPS[name].product
    A, B = sample(name, n, seed=1), sample(name, n, seed=2)
    (h, k), (g, _) = groups.split(name, A), groups.split(name, B)
    np.testing.assert_allclose(groups.multiply(name, h, k), A, atol=1e-9)
    # H is a subgroup, and K is normal: g k g^-1 has no part in H.
    np.testing.assert_allclose(
        groups.split(name, groups.multiply(name, h, g))[0], groups.multiply(name, h, g), atol=1e-9
    )
    carried = groups.multiply(name, groups.multiply(name, B, k), groups.inverse(name, B))
    one = np.broadcast_to(groups.identity(name, n), A.shape)
    np.testing.assert_allclose(groups.split(name, carried)[0], one, atol=1e-6)
    commute = np.allclose(groups.multiply(name, h, k), groups.multiply(name, k, h), atol=1e-9)
    assert commute is (product.kind == "direct")
    for part, factor in ((h, product.acting), (k, product.normal)):
        if factor in GROUPS:
            size = GROUPS[factor].shape(n)[-1]
            inside = part[..., :size, :size] if GROUPS[factor].only is None else part[..., :size]
            assert np.all(groups.is_member(factor, inside, 1e-6))
            assert GROUPS[factor].dimension(n) < GROUPS[name].dimension(n)


@pytest.mark.equation("B 2.8", "B 3.5")
def test_a_rotated_translation():
    R, b = groups.sample("SE", seed=4), groups.sample("R", seed=5)
    R[:3, 3] = 0.0
    moved = R @ b @ np.linalg.inv(R)
    np.testing.assert_allclose(moved[:3, 3], R[:3, :3] @ b[:3, 3], atol=1e-15)


LINKS = [(m, m.n or (n, n)) for m in MAPS for n in ((2, 3) if m.n is None else (0,))]
LINKS = [(m, n) for m, n in LINKS if GROUPS[m.source].only in (None, n[0])]


@pytest.mark.parametrize(("link", "n"), LINKS, ids=[f"{m.source} {m.target} {n}" for m, n in LINKS])
@pytest.mark.equation("B 2.29")
def test_maps_lead_into_the_target_and_respect_products(link, n):
    A, B = sample(link.source, n[0], seed=1), sample(link.source, n[0], seed=2)
    image = link.act(A)
    assert image.shape[1:] == GROUPS[link.target].shape(n[1])
    assert np.all(groups.is_member(link.target, image))
    np.testing.assert_allclose(link.act(A[0]), image[0], rtol=4e-16, atol=4e-16)
    if GROUPS[link.source].is_group:
        product = link.act(groups.multiply(link.source, A, B))
        np.testing.assert_allclose(groups.multiply(link.target, image, link.act(B)), product, atol=1e-11)
    one = groups.identity(link.source, n[0])
    np.testing.assert_allclose(link.act(one), groups.identity(link.target, n[1]), atol=1e-15)
    # Locally one-to-one: no direction at the identity is lost.
    D, h = tangents(link.source, n[0]), 1e-6
    image = (link.act(one + h * D) - link.act(one - h * D)) / (2 * h)
    assert np.linalg.matrix_rank(image.reshape(60, -1), 1e-4) == GROUPS[link.source].dimension(n[0])
    if link.kind == "covering":
        assert GROUPS[link.source].dimension(n[0]) == GROUPS[link.target].dimension(n[1])
    else:
        assert link.degree == 1
        assert (link.kind == "subset") is ("Sym+" in (link.source, link.target))


COVERINGS = [m for m in MAPS if m.kind == "covering"]


@pytest.mark.parametrize("link", COVERINGS, ids=[f"{m.source} {m.target}" for m in COVERINGS])
@pytest.mark.equation("B 2.29", "B 2.30")
def test_degree_of_a_covering(link):
    """Onto: every element is lifted.  Its degree: as many elements lead to the identity, found at random."""
    g = sample(link.target, link.n[1], 300)
    np.testing.assert_allclose(link.act(link.lift(g)), g, atol=1e-14)
    q = sample(link.source, link.n[0], 300, seed=9)
    kernel = groups.multiply(link.source, groups.inverse(link.source, link.lift(link.act(q))), q)
    assert len(np.unique(np.round(kernel, 9) + 0.0, axis=0)) == link.degree == 2
    np.testing.assert_allclose(np.abs(kernel[:, 0]), 1.0)
    # And the lift of a loop ends at the other one: the two are joined, it is no double copy.
    loop = np.linspace(0, np.pi, 50)
    half = np.zeros((50, *GROUPS[link.source].shape(link.n[0])))
    half[:, 0], half[:, 1] = np.cos(loop), np.sin(loop)
    np.testing.assert_allclose(link.act(half)[-1], link.act(half)[0], atol=1e-15)
    np.testing.assert_allclose(half[-1], -half[0], atol=1e-15)


def names(text: str, n: int) -> list[tuple[str, int]]:
    return [(name, n) for name in text.split()]


def lines(nodes) -> set[tuple[str, str]]:
    return {(m.source, m.target) for m in groups.edges(nodes)}


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.equation("B 3.2", "B 3.4")
def test_the_cube_of_inclusions(n):
    """Figure 3.1: flips to the right, translations up, deformations behind."""
    cube = names("SO O SE E GL+ GL Aff+ Aff", n)
    right = {("SO", "O"), ("SE", "E"), ("GL+", "GL"), ("Aff+", "Aff")}
    up = {("SO", "SE"), ("O", "E"), ("GL+", "Aff+"), ("GL", "Aff")}
    behind = {("SO", "GL+"), ("O", "GL"), ("SE", "Aff+"), ("E", "Aff")}
    assert lines(cube) == right | up | behind
    for s, t in right:  # of index two
        assert GROUPS[s].components == 1 and GROUPS[t].components == 2
        assert GROUPS[s].dimension(n) == GROUPS[t].dimension(n)
    for s, t in up:
        assert GROUPS[t].product == groups.Product("semidirect", s, "R")
    assert {name for name, _ in cube if GROUPS[name].compact} == {"SO", "O"}
    assert {name for name, _ in cube if GROUPS[name].abelian(n)} == ({"SO"} if n == 2 else set())


def test_the_hierarchy_of_nine_classes():
    nine = names("R SO R+ SE CO+ Sym+ Sim+ GL+ Aff+", 3)
    text = "R-SE SO-SE SO-CO+ R+-CO+ R+-Sym+ SE-Sim+ CO+-Sim+ CO+-GL+ Sym+-GL+ Sim+-Aff+ GL+-Aff+"
    assert lines(nine) == {tuple(line.split("-")) for line in text.split()}
    assert all(groups.contains(("Aff+", 3), node) for node in nine)


@pytest.mark.equation("B 2.38")
def test_the_cube_of_dual_numbers_commutes():
    """Figure 2.9: whichever way one goes along its edges, the element arrived at is the same."""
    flat, space = (
        [("S^1", 2), ("DCN", 2), ("SO", 2), ("SE", 2)],
        [("S^3", 3), ("DQ", 3), ("SO", 3), ("SE", 3)],
    )
    cube = groups.edges([*flat, *space])
    assert len(cube) == 12
    ways = {(m.source, m.n[0]): {} for m in cube}
    for m in cube:
        ways[m.source, m.n[0]][m.target, m.n[1]] = m.act
    A = groups.sample("S^1", 30)
    ends = []
    for first, f in ways["S^1", 2].items():
        for second, s in ways[first].items():
            ends += [last(s(f(A))) for last in ways[second].values()]
    assert len(ends) == 6
    for end in ends:
        np.testing.assert_allclose(end, ends[0], atol=1e-14)
    p = groups.sample("DCN", 30, seed=2)
    one, other = (ways["DCN", 2][node] for node in (("DQ", 3), ("SE", 2)))
    np.testing.assert_allclose(ways["DQ", 3]["SE", 3](one(p)), ways["SE", 2]["SE", 3](other(p)), atol=1e-14)


def test_inclusion_is_composed_and_refused():
    R = groups.sample("SO", 5, n=2)
    A = groups.inclusion(("SO", 2), ("Aff", 3)).act(R)
    assert np.all(groups.is_member("Aff", A))
    assert groups.inclusion(("Diag+", 3), ("Aff+", 3)).kind == "subset"
    with pytest.raises(ValueError, match=r"groups\.inclusion: target must contain \('GL', 3\)"):
        groups.inclusion(("GL", 3), ("GL+", 3))


@each
def test_batches_equal_single_calls_and_own_their_memory(name, n):
    A = groups.sample(name, (2, 5), 3, n)
    assert A.shape == (2, 5, *GROUPS[name].shape(n))
    np.testing.assert_array_equal(A, groups.sample(name, (2, 5), 3, n))
    before = A.copy()
    for result in (groups.project(name, A), groups.inverse(name, A), groups.multiply(name, A, A)):
        assert not np.shares_memory(result, A)
    np.testing.assert_array_equal(A, before)
    np.testing.assert_allclose(groups.project(name, A)[1, 3], groups.project(name, A[1, 3]), atol=1e-15)
    assert groups.is_member(name, A).shape == (2, 5)
    empty = A[:0]
    assert groups.is_member(name, empty).shape == (0, 5)
    assert groups.project(name, empty).shape == empty.shape
    assert groups.sample(name, (), 0, n).shape == GROUPS[name].shape(n)


@pytest.mark.parametrize("n", [2, 3])
def test_the_nearest_rotation_is_that_of_polar(n):
    A = RNG(4).normal(size=(50, n, n))
    np.testing.assert_allclose(groups.project("SO", A), polar.rotation(A), atol=1e-12)


def test_nearest_is_nearest():
    """No other element that we can find is nearer than the projection."""
    for name in ("SO", "O", "SE", "CO+", "R+", "Diag+", "Sym+", "R"):
        A = RNG(1).normal(size=GROUPS[name].shape(3)) + 1.5 * groups.identity(name, 3)
        best = np.linalg.norm(groups.project(name, A) - A)
        B = groups.project(name, groups.project(name, A) + 0.1 * RNG(2).normal(size=(500, *A.shape)))
        assert np.all(np.linalg.norm(B - A, axis=(-1, -2)) >= best - 1e-7), name


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda: groups.is_member("SU", np.eye(3)),
            r"groups\.is_member: name must be one of SO, .*; got 'SU'",
        ),
        (
            lambda: groups.is_member("SO", np.ones((4, 3))),
            r"A must be an array of shape .*; got shape \(4, 3\)",
        ),
        (lambda: groups.is_member("SE", np.eye(2)), r"A must be an array of shape \(\.\.\., 3, 3\)"),
        (
            lambda: groups.is_member("SO", np.full((2, 3, 3), np.nan)),
            r"A must be finite; got nan at index \(0,\)",
        ),
        (lambda: groups.is_member("SO", np.eye(3), -1.0), r"tol must be 0 or more; got -1"),
        (
            lambda: groups.project("S^3", np.zeros((2, 4))),
            r"a number with an inverse; got .* at index \(0,\)",
        ),
        (lambda: groups.split("SO", np.eye(3)), r"name must be a product of groups: .*; got SO"),
        (lambda: groups.sample("SO", 3, n=1), r"n must be 2 or more; got 1"),
    ],
)
def test_refusals(call, words):
    with pytest.raises(ValueError, match=words) as caught:
        call()
    assert "\n" not in str(caught.value)


def test_docstrings_cite_what_the_records_cite():
    cited = set(re.findall(r"\((\d\.\d+)\)", inspect.getdoc(groups.is_member) or ""))
    assert cited == {number for group in GROUPS.values() for number in group.equations}


def test_labels():
    assert [groups.label(name, 3) for name in ("SE", "R", "R+", "DQ")] == ["SE(3)", "R^3", "R+", "DQ"]
