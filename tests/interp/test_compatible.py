"""One triangulation for two shapes: valid by exact arithmetic for any pair, corners kept, every refusal."""

from collections import Counter
from fractions import Fraction

import numpy as np
import pytest

from lietool.interp import compatible, compatible_overlay, compatible_quality
from lietool.interp.compatible_smooth import Stars, badness
from lietool.mesh import outline

SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])


def disc(n):
    t = 2.0 * np.pi * np.arange(n) / n
    return np.stack([np.cos(t), np.sin(t)], axis=1)


def band(centre, width):
    """Return the outline of a curve with a width, counter-clockwise."""
    along = np.gradient(centre, axis=0)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    across *= width / np.linalg.norm(across, axis=1, keepdims=True)
    return np.concatenate([centre - across, (centre + across)[::-1]])


def spiral(n, turns=2.5, width=0.12):
    angle = 2.0 * np.pi * turns * np.sqrt(np.linspace(0.02, 1.0, n // 2))
    radius = 0.1 + 0.9 * angle / angle[-1]
    return band(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1), width)


def strip(n, width=0.05):
    x = np.linspace(-1.0, 1.0, n // 2)
    return band(np.stack([x, 0.0 * x], axis=1), width)


def comb(n):
    """Return a comb of n / 4 teeth."""
    k = np.arange(n // 4)
    top = np.stack(
        [np.repeat(2.0 * k, 4) + np.tile([0, 0, 1, 1], n // 4), np.tile([0.2, 3, 3, 0.2], n // 4)], 1
    )
    top = np.concatenate([[[0.0, 0.0]], top[1:-1], [[top[-1, 0], 0.0]]])
    return top[::-1].copy()


def zigzag(n, rng):
    x = np.arange(n // 2)
    centre = np.stack([x, (x % 2) * rng.uniform(1.0, 6.0)], axis=1)
    width = [0.0, rng.uniform(0.03, 0.2)]
    return np.concatenate([centre - width, (centre + width)[::-1]])


def star(n, rng):
    t = 2.0 * np.pi * (np.arange(n) + rng.uniform(-0.4, 0.4, n)) / n
    r = rng.uniform(0.05, 1.0, n)
    return np.stack([r * np.cos(t), r * np.sin(t)], axis=1)


def coil(n, rng):
    """Return a spiral of at most one turn for 20 corners, the two sides on the same rays."""
    angle = np.linspace(0.0, rng.uniform(0.1, 0.3) * n, n // 2)
    ray = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    radius = (1.0 + angle / (2.0 * np.pi))[:, None]
    return np.concatenate([(radius + rng.uniform(0.05, 0.5)) * ray, (radius * ray)[::-1]])


def tangled(n, rng):
    """Return a random polygon, its crossings undone by shortening it (2-opt)."""
    p = rng.random((n, 2))
    z = p[:, 0] + 1j * p[:, 1]
    done = False
    while not done:
        done = True
        for i in range(n - 2):
            j = np.arange(i + 2, n - (i == 0))
            a, b, c, d = z[i], z[i + 1], z[j], z[(j + 1) % n]
            gain = abs(a - b) + abs(c - d) - abs(a - c) - abs(b - d)
            if len(j) and gain.max() > 1e-12:
                k = int(j[np.argmax(gain)])
                z[i + 1 : k + 1] = z[i + 1 : k + 1][::-1].copy()
                done = False
    p = np.stack([z.real, z.imag], axis=1)
    return p if outline.area(p) > 0.0 else p[::-1].copy()


def sides(n, rng):
    """Return points on the sides of a square: most of them are no corners."""
    count = np.full(4, n // 4) + (np.arange(4) < n % 4)
    after = np.roll(SQUARE, -1, axis=0)
    steps = [np.arange(m)[:, None] / m for m in count]
    return np.concatenate([a + (b - a) * s for a, b, s in zip(SQUARE, after, steps, strict=True)])


KINDS = {
    "star": star,
    "tangled": tangled,
    "zigzag": zigzag,
    "sides": sides,
    "coil": coil,
    "comb": lambda n, rng: comb(n),
    "strip": lambda n, rng: strip(n, rng.uniform(0.001, 0.2)),
}


def twice_area(p, q, r):
    (a, b), (c, d), (e, f) = ([Fraction(x) for x in point] for point in (p, q, r))
    return (c - a) * (f - b) - (d - b) * (e - a)


def check(mesh, P, Q):
    """Assert all that makes a triangulation common to both polygons."""
    n = len(P)
    assert mesh.corners == n
    np.testing.assert_array_equal(mesh.source[:n], P)
    np.testing.assert_array_equal(mesh.target[:n], Q)
    for points in (mesh.source, mesh.target):
        rows = points.tolist()
        assert all(twice_area(*(rows[v] for v in face)) > 0 for face in mesh.faces.tolist())
    check_disc(mesh)
    check_boundary(mesh, P, Q)


def check_disc(mesh):
    """Assert that the faces are a disc with the boundary that is claimed."""
    edges = Counter((f[k - 1], f[k]) for f in mesh.faces.tolist() for k in range(3))
    assert set(edges.values()) == {1}
    rim = mesh.boundary.tolist()
    assert len(set(rim)) == len(rim)
    outer = {(a, b) for a, b in edges if (b, a) not in edges}
    assert outer == set(zip(rim, rim[1:] + rim[:1], strict=True))
    assert set(mesh.faces.ravel().tolist()) == set(range(len(mesh.source)))
    assert len(mesh.source) - (len(edges) + len(rim)) // 2 + len(mesh.faces) == 1


def check_boundary(mesh, P, Q):
    """Assert that what is between two corners lies on the edge, at the same fraction in both."""
    n, rim = len(P), mesh.boundary
    forwards = outline.area(P) > 0.0
    at = np.flatnonzero(rim < n)
    corners = rim[at].tolist()
    assert corners == (list(range(n)) if forwards else [0, *range(n - 1, 0, -1)])
    for k, a in enumerate(corners):
        between = rim[at[k] + 1 : at[k + 1] if k + 1 < n else None]
        b = corners[(k + 1) % n]
        fractions = []
        for X in (mesh.source, mesh.target):
            u = X[b] - X[a]
            t = (X[between] - X[a]) @ u / (u @ u)
            np.testing.assert_allclose(
                X[between], X[a] + t[:, None] * u, rtol=0, atol=1e-12 * np.abs(X).max()
            )
            assert np.all(np.diff([0.0, *t, 1.0]) > 0.0)
            fractions.append(t)
        np.testing.assert_allclose(*fractions, rtol=0, atol=1e-9)


@pytest.mark.parametrize("seed", range(40))
def test_random_pairs_are_valid(seed):
    rng = np.random.default_rng(seed)
    kinds = list(KINDS)
    first, second = kinds[seed % 7], kinds[(seed // 7 + 2 * seed) % 7]
    n = 4 * int(rng.integers(2, 11))
    P, Q = (np.roll(KINDS[k](n, rng), int(rng.integers(n)), axis=0) for k in (first, second))
    check(compatible.polygons(P, Q, triangles=int(rng.choice([1, 150, 300]))), P, Q)


@pytest.mark.parametrize(
    ("P", "Q", "angle"),
    [
        (spiral(120), disc(120), 6.0),
        (comb(40), disc(40), 1.0),
        (strip(60), disc(60), 6.0),
        (spiral(60), strip(60, 0.1), 8.0),
        (disc(40), disc(40) * [1.0, 0.4] + [3.0, 0.0], 14.0),
        (SQUARE, 1e-3 * SQUARE, 28.0),
    ],
    ids=["spiral-disc", "comb-disc", "strip-disc", "spiral-strip", "disc-ellipse", "squares"],
)
def test_quality(P, Q, angle):
    mesh = compatible.polygons(P, Q, triangles=500)
    check(mesh, P, Q)
    assert 350 < len(mesh.faces) < 800
    assert np.rad2deg(min(mesh.quality.least_angle)) > angle


def test_triangles_and_pentagons():
    check(
        compatible.polygons(SQUARE[:3], 2.0 * SQUARE[[0, 1, 3]], triangles=1),
        SQUARE[:3],
        2.0 * SQUARE[[0, 1, 3]],
    )
    # Quadrilaterals whose only diagonals are different ones need a vertex inside.
    P = np.array([(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)])
    Q = P[[3, 0, 1, 2]]
    mesh = compatible.polygons(P, Q, triangles=1)
    check(mesh, P, Q)
    assert len(mesh.source) > 4


def test_the_overlay_of_two_fans_has_all_crossings():
    n = 9
    first = np.array([(0, k) for k in range(2, n - 1)])
    second = np.array([(1, k) for k in range(3, n)])
    crossing = compatible_overlay._crossings(first, second)
    weights = compatible_overlay._weights(n, second)
    assert crossing.sum() == 21
    np.testing.assert_array_equal(crossing.sum(axis=1), weights[first[:, 0], first[:, 1]])


@pytest.mark.parametrize("seed", range(10))
def test_the_overlay_alone_is_valid(seed):
    rng = np.random.default_rng(seed)
    P, Q = tangled(24, rng), np.roll(tangled(24, rng), 7, axis=0)
    source, target, faces = compatible_overlay.common(P, Q)
    for points in (source.tolist(), target.tolist()):
        assert all(twice_area(*(points[v] for v in face)) > 0 for face in faces.tolist())
    assert len(faces) == 24 - 2 + 2 * (len(source) - 24)  # Euler


def test_deterministic():
    rng = np.random.default_rng(3)
    P, Q = star(20, rng), tangled(20, rng)
    first, second = (compatible.polygons(P, Q, triangles=200) for _ in range(2))
    for name in ("source", "target", "faces", "boundary"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes()
    assert first.quality == second.quality


def test_arguments_are_left_alone():
    P, Q = spiral(20), disc(20)
    before = P.tobytes(), Q.tobytes()
    compatible.polygons(P, Q, triangles=50)
    assert before == (P.tobytes(), Q.tobytes())


def test_clockwise_in_both():
    P, Q = spiral(40)[::-1], disc(40)[::-1]
    check(compatible.polygons(P, Q, triangles=200), P, Q)


@pytest.mark.parametrize("scale", [1e-140, 1e-9, 1e9, 1e140])
def test_any_scale(scale):
    mesh = compatible.polygons(scale * SQUARE, 3.0 * SQUARE, triangles=60)
    assert 50 <= len(mesh.faces) <= 90
    for points in (mesh.source.tolist(), mesh.target.tolist()):
        assert all(twice_area(*(points[v] for v in face)) > 0 for face in mesh.faces.tolist())


def test_scaling_by_a_power_of_two_changes_nothing_else():
    P, Q = spiral(40), disc(40)
    first = compatible.polygons(P, Q, triangles=200)
    second = compatible.polygons(4.0 * P, 0.5 * Q, triangles=200)
    np.testing.assert_array_equal(first.faces, second.faces)
    np.testing.assert_array_equal(4.0 * first.source, second.source)


def test_spacing():
    coarse, fine = (compatible.polygons(SQUARE, 2.0 * SQUARE, spacing=s) for s in (0.2, 0.1))
    assert 3.0 < len(fine.faces) / len(coarse.faces) < 5.5
    edges = fine.source[fine.faces] - fine.source[np.roll(fine.faces, 1, axis=1)]
    assert np.median(np.linalg.norm(edges, axis=-1)) == pytest.approx(0.1, rel=0.2)


def test_a_shape_with_itself_gives_the_same_drawing_twice():
    mesh = compatible.polygons(comb(16), comb(16), triangles=200)
    np.testing.assert_array_equal(mesh.source, mesh.target)
    assert mesh.quality.condition == pytest.approx(1.0)
    assert mesh.quality.area_ratio == pytest.approx((1.0, 1.0))


def test_quality_against_the_singular_values():
    rng = np.random.default_rng(0)
    mesh = compatible.polygons(star(12, rng), tangled(12, rng), triangles=80)
    a, b = (
        np.stack([X[mesh.faces[:, k]] - X[mesh.faces[:, 0]] for k in (1, 2)], -1)
        for X in (mesh.source, mesh.target)
    )
    maps = b @ np.linalg.inv(a)
    condition = np.linalg.cond(maps)
    assert mesh.quality.condition == pytest.approx(condition.max(), rel=1e-8)
    assert mesh.quality.condition_at == int(np.argmax(condition))
    assert mesh.quality.middle_condition == pytest.approx(np.median(condition), rel=1e-8)
    ratio = np.linalg.det(maps)
    assert mesh.quality.area_ratio == pytest.approx((ratio.min(), ratio.max()), rel=1e-8)
    right = compatible_quality.measure(SQUARE, SQUARE, np.array([[0, 1, 2], [0, 2, 3]]))
    assert right.least_angle == pytest.approx((np.pi / 4, np.pi / 4))


def test_subdivide():
    P, Q = spiral(20), disc(20)
    mesh = compatible.polygons(P, Q, triangles=50)
    fine = compatible.subdivide(mesh, 2)
    assert len(fine.faces) == 16 * len(mesh.faces)
    check(fine, P, Q)
    np.testing.assert_array_equal(fine.source[: len(mesh.source)], mesh.source)
    assert fine.quality.condition == pytest.approx(mesh.quality.condition, rel=1e-6)
    assert compatible.subdivide(mesh, 0) is mesh


class TestSmoothing:
    """The descent on which validity rests."""

    def test_badness(self):
        F = np.array([[0, 1, 2]])
        equilateral = np.array([(0.0, 0.0), (1.0, 0.0), (0.5, np.sqrt(0.75))])
        assert badness(equilateral, F) == pytest.approx(1.0)
        assert badness(SQUARE, F) == pytest.approx(2.0 / np.sqrt(3.0))
        assert np.isinf(badness(SQUARE, F[:, ::-1])[0])

    @pytest.mark.parametrize("power", [1.0, 2.0, 6.0])
    def test_one_vertex_goes_to_the_least_energy(self, power):
        from scipy.optimize import minimize

        rim = star(7, np.random.default_rng(1)) * 0.2 + disc(7)
        points = np.concatenate([rim, [[0.4, -0.3]]])
        F = np.array([(7, k, (k + 1) % 7) for k in range(7)])

        def energy(v):
            return np.sum(badness(np.concatenate([rim, [v]]), F) ** power)

        drawing = np.ascontiguousarray(points.T[:, None])
        stars = Stars(F, np.arange(8) == 7)
        for _ in range(20):
            stars.sweep(drawing, power)
        best = minimize(energy, points[7], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-12})
        np.testing.assert_allclose(drawing[:, 0, 7], best.x, atol=1e-6)


class TestOutlines:
    """Two outlines of which a few points correspond."""

    def test_marks_stay_together(self):
        P, Q = disc(50), 2.0 * disc(80) + 5.0
        marks = [(0, 20), (10, 30), (30, 70)]
        mesh = compatible.outlines(P, Q, marks, samples=60, triangles=200)
        check(mesh, mesh.source[: mesh.corners], mesh.target[: mesh.corners])
        assert 55 <= mesh.corners <= 65
        for i, j in marks:
            k = int(np.argmin(np.linalg.norm(mesh.source[: mesh.corners] - P[i], axis=1)))
            np.testing.assert_allclose(mesh.source[k], P[i], atol=1e-12)
            np.testing.assert_allclose(mesh.target[k], Q[j], atol=1e-12)

    def test_corners_are_kept(self):
        mesh = compatible.outlines(SQUARE, disc(100), [(0, 3)], samples=30, triangles=100)
        for corner in SQUARE:
            assert np.min(np.linalg.norm(mesh.source[: mesh.corners] - corner, axis=1)) < 1e-12

    def test_even_by_arc_length(self):
        mesh = compatible.outlines(disc(1000), disc(300), [(0, 0)], samples=40, triangles=100)
        steps = np.linalg.norm(np.diff(mesh.source[: mesh.corners], axis=0), axis=1)
        assert np.ptp(steps) < 1e-3

    def test_corners_near_each_other_become_one(self):
        other = SQUARE + np.array([(0.0, 0.0), (0.0, 0.02), (0.0, 0.0), (0.01, 0.0)])
        mesh = compatible.outlines(SQUARE, other, [(0, 0)], samples=40, triangles=100)
        for a, b in zip(SQUARE, other, strict=True):
            k = int(np.argmin(np.linalg.norm(mesh.source[: mesh.corners] - a, axis=1)))
            np.testing.assert_allclose(mesh.target[k], b, atol=1e-12)

    @pytest.mark.parametrize("turned", [False, True])
    def test_without_marks_it_is_laid_on(self, turned):
        P = comb(12)
        Q = np.roll(3.0 * P + 7.0, 5, axis=0)
        mesh = compatible.outlines(P, Q[::-1] if turned else Q, samples=60, triangles=200)
        np.testing.assert_allclose(3.0 * mesh.source + 7.0, mesh.target, atol=1e-9)

    @pytest.mark.parametrize("angle", [40.0, -100.0, 180.0])
    def test_without_marks_it_may_be_turned(self, angle):
        P = comb(12)
        c, s = np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))
        Q = np.roll(2.0 * P @ [[c, s], [-s, c]], 5, axis=0)
        mesh = compatible.outlines(P, Q, samples=60, triangles=200)
        np.testing.assert_allclose(2.0 * mesh.source @ [[c, s], [-s, c]], mesh.target, atol=1e-9)

    def test_of_equal_ways_it_takes_the_least_turn(self):
        P = 3.0 * SQUARE
        mesh = compatible.outlines(P, np.roll(P, 3, axis=0), samples=40, triangles=100)
        np.testing.assert_allclose(mesh.source, mesh.target, atol=1e-9)

    def test_directions_do_not_matter(self):
        P, Q = comb(12), 2.0 * comb(12)
        first = compatible.outlines(P, Q, [(0, 0), (4, 4), (7, 7)], samples=40, triangles=100)
        second = compatible.outlines(P[::-1], Q, [(11, 0), (7, 4), (4, 7)], samples=40, triangles=100)
        np.testing.assert_array_equal(first.faces, second.faces)
        np.testing.assert_allclose(first.source, second.source, atol=1e-12)


BOWTIE = SQUARE[[0, 2, 1, 3]]
P5, Q5 = disc(5), 2.0 * disc(5)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda: compatible.polygons(BOWTIE, SQUARE),
            "P must be a simple polygon; got edges 0-1 and 2-3 that meet near (0.5, 0.5)",
        ),
        (lambda: compatible.polygons(SQUARE, BOWTIE), "Q must be a simple polygon"),
        (
            lambda: compatible.polygons(SQUARE[[0, 1, 2, 0]], SQUARE),
            "point 0 again as point 3, (0, 0), at index (3,). Leave out the last point",
        ),
        (lambda: compatible.polygons(P5, P5[[0, 1, 2, 1, 4]]), "point 1 again as point 3"),
        (
            lambda: compatible.polygons(SQUARE * [1.0, np.nan], SQUARE),
            "P must be finite; got nan at index (0,)",
        ),
        (lambda: compatible.polygons(SQUARE[:2], SQUARE[:2]), "n at least 3; got shape (2, 2)"),
        (lambda: compatible.polygons("ab", SQUARE), "P must be real numbers"),
        (lambda: compatible.polygons([[0, 0], [1]], SQUARE), "got a ragged list"),
        (lambda: compatible.polygons(SQUARE * 1j, SQUARE), "dtype complex128"),
        (
            lambda: compatible.polygons(np.arange(4)[:, None] * [1.0, 1.0], SQUARE),
            "an outline that encloses an area; got 4 points on one line",
        ),
        (
            lambda: compatible.polygons([(0, 0), (2, 0), (1, 0), (1, 1)], SQUARE),
            "turns back on itself, (2, 0), at index (1,)",
        ),
        (
            lambda: compatible.polygons([(0, 0), (2, 0), (2, 2), (1, 0), (0, 2)], P5),
            "got edges 0-1 and 2-3 that meet near (1, 0)",
        ),
        (
            lambda: compatible.polygons(SQUARE, P5),
            "Q must be of as many points as P, 4; got 5. Use compatible.outlines",
        ),
        (
            lambda: compatible.polygons(SQUARE, SQUARE[::-1]),
            "Q must be counter-clockwise as P is; got clockwise. The map would be a reflection",
        ),
        (
            lambda: compatible.polygons(SQUARE, SQUARE, spacing=0.0),
            "spacing must be a positive number; got 0.0",
        ),
        (
            lambda: compatible.polygons(SQUARE, SQUARE, spacing=float("nan")),
            "spacing must be a positive number",
        ),
        (
            lambda: compatible.polygons(SQUARE, SQUARE, spacing=1e-9),
            "spacing must be enough for at most 50000 triangles",
        ),
        (
            lambda: compatible.polygons(SQUARE, SQUARE, triangles=10**6),
            "Ask for fewer, then use compatible.subdivide",
        ),
        (
            lambda: compatible.polygons(SQUARE, SQUARE, triangles=0),
            "triangles must be a whole number, at least 1; got 0",
        ),
        (lambda: compatible.polygons(SQUARE, SQUARE, triangles=2.5), "triangles must be a whole number"),
        (
            lambda: compatible.polygons(SQUARE, SQUARE, triangles=9, spacing=1.0),
            "spacing must be left out where triangles is given",
        ),
        (
            lambda: compatible.outlines(P5, Q5, [(0, 0), (1, 1), (2, 4), (3, 2)]),
            "in the same order around P and Q; got (3, 2) at index (3,)",
        ),
        (
            lambda: compatible.outlines(P5, Q5, [(0, 2), (1, 1), (2, 0)]),
            "got the reverse order on Q. The map would be a reflection",
        ),
        (
            lambda: compatible.outlines(P5, Q5, [(0, 0), (0, 1)]),
            "of different points of P; got 0 again at index (1, 0)",
        ),
        (lambda: compatible.outlines(P5, Q5, [(0, 0), (1, 5)]), "points of Q, 0 to 4; got 5 at index (1, 1)"),
        (
            lambda: compatible.outlines(P5, Q5, [(0, 0.5)]),
            "pairs of whole numbers; got shape (1, 2) of float64",
        ),
        (lambda: compatible.outlines(P5, Q5, [(0, 0), (1,)]), "pairs of whole numbers; got a ragged list"),
        (
            lambda: compatible.outlines(P5, Q5, samples=2),
            "samples must be a whole number from 3 to 5000; got 2",
        ),
        (lambda: compatible.outlines(P5, BOWTIE), "compatible.outlines: Q must be a simple polygon"),
        (
            lambda: compatible.outlines(spiral(200, 3.0, 0.05), disc(50), samples=8),
            "P once sampled at 14 points must be a simple polygon",
        ),
        (
            lambda: compatible.subdivide(compatible.polygons(SQUARE, SQUARE, triangles=2), -1),
            "times must be a whole number from 0 to 10",
        ),
    ],
)
def test_refusals(call, words):
    with pytest.raises(ValueError) as caught:
        call()
    message = str(caught.value)
    assert words in message
    assert "\n" not in message and message.startswith("compatible.")


def test_too_thin_for_its_numbers():
    spike = [(0, 0), (1, 0), (1, 1), (0.5 + 2.0**-53, 1), (0.5, 3), (0.5, 1), (0, 1)]
    with pytest.raises(ValueError, match=r"^compatible.polygons: P and Q must be [^\n]* near \(0.5, 1\)"):
        compatible.polygons(spike, disc(7), triangles=100)
