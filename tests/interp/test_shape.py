"""Interpolations of shapes: minimal against generic solvers, exact at both ends, and true to their laws."""

import numpy as np
import pytest
from scipy.optimize import minimize

from lietool.interp import constraint, energy, shape, triangle
from lietool.interp.constraint import Barycentre, Direction, Edge, Locus
from lietool.mesh import topology

ENERGIES = {
    "point": energy.POINT,
    "frobenius": energy.FROBENIUS,
    "point similarity": energy.POINT_SIMILARITY,
    "similarity": energy.SIMILARITY,
    "balanced": energy.balanced(0.35),
}
WAYS = (triangle.linear, triangle.arap, triangle.logexp)
T = np.array([0.0, 0.2, 0.5, 0.8, 1.0])


def turn(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def maps_of(V: np.ndarray, P: np.ndarray, F: np.ndarray) -> np.ndarray:
    return np.swapaxes(np.linalg.solve(P[F[:, :2]] - P[F[:, 2:]], V[F[:, :2]] - V[F[:, 2:]]), -1, -2)


def total(V, prepared, t, error, symmetric=False):
    """The energy by its definition."""
    P, Q, F = prepared.source, prepared.target, prepared.faces
    A = prepared.homotopy(prepared.maps, t, prepared.theta)
    value = np.sum(np.abs(topology.areas(P, F)) * energy.error(maps_of(V, P, F), A, error, P[F]))
    if symmetric:
        back = prepared.homotopy(np.linalg.inv(prepared.maps), 1.0 - t, -prepared.theta)
        value += np.sum(np.abs(topology.areas(Q, F)) * energy.error(maps_of(V, Q, F), back, error, Q[F]))
    return value


class TestMinimum:
    @pytest.mark.equation("B 6.1", "B 6.2", "B 6.3", "B 6.4")
    @pytest.mark.parametrize("symmetric", [False, True])
    @pytest.mark.parametrize("name", ENERGIES)
    def test_it_is_the_least_that_a_generic_minimiser_finds(self, bent, name, symmetric):
        P, Q, F = bent
        error = ENERGIES[name]
        anchors = [constraint.pinned(0, (0.2, -0.1)), Edge(20, 0, lambda t: np.stack([4 + t, 3 * t], -1))]
        prepared = shape.prepare(P, Q, F, error=error, symmetric=symmetric, constraints=anchors)
        found = shape.solve(prepared, 0.4)
        V = found.vertices[0]
        assert found.energy[0] == pytest.approx(
            total(V, prepared, 0.4, error, symmetric), rel=1e-9, abs=1e-12
        )
        held = np.zeros(len(P), bool)
        held[[0, 20]] = True

        def f(x):
            W = V.copy()
            W[~held] = x.reshape(-1, 2)
            return total(W, prepared, 0.4, error, symmetric)

        best = minimize(f, V[~held].ravel() + 0.01, method="BFGS", options={"gtol": 1e-7, "maxiter": 2000})
        assert found.energy[0] <= best.fun * (1 + 1e-9) + 1e-12
        assert best.x.reshape(-1, 2) == pytest.approx(V[~held], abs=2e-3)

    def test_alexa_by_least_squares_on_the_same_rows(self, bent):
        P, Q, F = bent
        prepared = shape.prepare(P, Q, F, homotopy=triangle.arap)
        t = 0.3
        A = triangle.arap(prepared.maps, t)
        weight = np.sqrt(np.abs(topology.areas(P, F)))
        E = np.linalg.inv(np.swapaxes(P[F[:, :2]] - P[F[:, 2:]], 1, 2))
        rows = np.zeros((len(F), 2, len(P)))
        for k, (f, e) in enumerate(zip(F, E, strict=True)):
            for j in range(2):
                rows[k, :, f[j]] += weight[k] * e[j]
                rows[k, :, f[2]] -= weight[k] * e[j]
        M = np.concatenate([rows.reshape(-1, len(P)), np.eye(len(P))[:1]])
        for axis in range(2):
            right = np.append(
                (weight[:, None] * A[:, axis, :]).ravel(), (1 - t) * P[0, axis] + t * Q[0, axis]
            )
            expected = np.linalg.lstsq(M, right, rcond=None)[0]
            assert shape.solve(prepared, t).vertices[0, :, axis] == pytest.approx(expected, abs=1e-10)


class TestEnds:
    @pytest.mark.parametrize("symmetric", [False, True])
    @pytest.mark.parametrize("way", WAYS)
    @pytest.mark.parametrize("name", ENERGIES)
    def test_source_and_target_are_met(self, bent, name, way, symmetric):
        P, Q, F = bent
        prepared = shape.prepare(P, Q, F, error=ENERGIES[name], homotopy=way, symmetric=symmetric)
        found = shape.solve(prepared, [0.0, 1.0])
        assert found.vertices[0] == pytest.approx(P, abs=1e-9)
        assert found.vertices[1] == pytest.approx(Q, abs=1e-9)
        assert found.energy == pytest.approx([0.0, 0.0], abs=1e-12)
        assert found.residual.max() < 1e-12

    def test_the_result_says_what_it_is(self, bent):
        P, Q, F = bent
        found = shape.solve(shape.prepare(P, Q, F), T)
        assert found.vertices.shape == (5, len(P), 2) and found.jacobians.shape == (5, len(F), 2, 2)
        assert found.det == pytest.approx(np.linalg.det(found.jacobians))
        assert found.jacobians[3] == pytest.approx(maps_of(found.vertices[3], P, F))
        assert not found.flipped.any()
        one = shape.solve(shape.prepare(P, Q, F), 0.5)
        assert one.vertices[0] == pytest.approx(found.vertices[2], abs=1e-12)


class TestLaws:
    @pytest.mark.parametrize("way", [triangle.arap, triangle.logexp])
    @pytest.mark.parametrize("alpha", [0.7, -2.0, 3.0])
    def test_turning_the_target_turns_the_frames(self, bent, way, alpha):
        P, Q, F = bent
        plain = shape.prepare(P, Q, F, homotopy=way)
        turned = shape.prepare(P, Q @ turn(alpha).T, F, homotopy=way, theta=plain.theta + alpha)
        before, after = shape.solve(plain, T).vertices, shape.solve(turned, T).vertices
        for t, v, w in zip(T, before, after, strict=True):
            expected = v @ turn(t * alpha).T
            assert w - w.mean(axis=0) == pytest.approx(expected - expected.mean(axis=0), abs=1e-10)

    @pytest.mark.parametrize("way", [triangle.arap, triangle.logexp])
    @pytest.mark.parametrize("name", ENERGIES)
    def test_a_rigid_motion_stays_rigid(self, bent, name, way):
        P, _, F = bent
        angle = 5.0
        Q = P @ turn(angle).T + [3.0, 1.0]
        prepared = shape.prepare(P, Q, F, error=ENERGIES[name], homotopy=way, turns={0: 1})
        assert prepared.theta == pytest.approx(np.full(len(F), angle))
        for t, V in zip(T, shape.solve(prepared, T).vertices, strict=True):
            expected = P @ turn(t * angle).T
            assert V - V.mean(axis=0) == pytest.approx(expected - expected.mean(axis=0), abs=1e-9)

    @pytest.mark.parametrize("way", [triangle.linear, triangle.arap, triangle.logexp])
    @pytest.mark.parametrize("name", ENERGIES)
    def test_swapping_the_shapes_reverses_time(self, bent, name, way):
        P, Q, F = bent

        def ask(a, b):
            return [
                Locus(3, constraint.line(a[3], b[3])),
                Edge(17, 3, constraint.line(a[17] - a[3], b[17] - b[3])),
                Locus(10, constraint.line(a[10], b[10]), weight=0.5),
            ]

        keywords = {"error": ENERGIES[name], "homotopy": way, "symmetric": True}
        there = shape.prepare(P, Q, F, constraints=ask(P, Q), **keywords)
        back = shape.prepare(Q, P, F, constraints=ask(Q, P), theta=-there.theta, **keywords)
        forth, reversed_ = shape.solve(there, T).vertices, shape.solve(back, 1.0 - T).vertices
        assert forth == pytest.approx(reversed_, abs=1e-9)

    def test_without_symmetry_it_does_not(self, bent):
        P, Q, F = bent
        there, back = shape.prepare(P, Q, F), shape.prepare(Q, P, F)
        forth, reversed_ = shape.solve(there, 0.5).vertices, shape.solve(back, 0.5).vertices
        assert np.abs(forth - reversed_).max() > 1e-3

    @pytest.mark.parametrize("name", ["similarity", "point similarity"])
    def test_similarities_ignore_the_local_angles(self, roll, name):
        P, Q, F = roll
        keywords = {"error": ENERGIES[name], "constraints": _ends(P, Q)}
        found = [
            shape.solve(shape.prepare(P, Q, F, theta=theta, **keywords), T).vertices
            for theta in (None, triangle.principal_angle(shape.local_maps(P, Q, F)))
        ]
        assert found[0] == pytest.approx(found[1], abs=1e-7)

    def test_rigid_energies_do_not(self, roll):
        P, Q, F = roll
        principal = triangle.principal_angle(shape.local_maps(P, Q, F))
        good = shape.solve(shape.prepare(P, Q, F), T)
        bad = shape.solve(shape.prepare(P, Q, F, theta=principal), T)
        assert not good.flipped.any() and bad.flipped[1:-1].any()

    def test_weights(self, bent):
        P, Q, F = bent
        even = shape.solve(shape.prepare(P, Q, F, weights=np.ones(len(F))), 0.5)
        scaled = shape.solve(shape.prepare(P, Q, F, weights=np.full(len(F), 7.0)), 0.5)
        assert even.vertices == pytest.approx(scaled.vertices, abs=1e-11)
        assert scaled.energy == pytest.approx(7.0 * even.energy)
        heavy = np.ones(len(F))
        heavy[4] = 1e6
        pressed = shape.solve(shape.prepare(P, Q, F, weights=heavy), 0.5)
        aim = triangle.logexp(pressed.prepared.maps, 0.5, pressed.prepared.theta)
        assert np.abs(pressed.jacobians[0, 4] - aim[4]).max() < 1e-5
        assert np.abs(even.jacobians[0, 4] - aim[4]).max() > 1e-3

    @pytest.mark.erratum("B 6.3 (text)")
    def test_the_matrix_of_similarities_depends_on_time(self, bent):
        P, Q, F = bent
        for name, moves in (("frobenius", False), ("point", False), ("similarity", True)):
            prepared = shape.prepare(P, Q, F, error=ENERGIES[name])
            part = prepared.sums[0]
            matrices = [
                prepared.assembly.pattern.add(part.blocks(part.form(part.maps(t)))) for t in (0.2, 0.7)
            ]
            assert (np.abs(matrices[0] - matrices[1]).max() > 1e-3) == moves
            assert prepared.is_static == (not moves)


def _ends(P, Q):
    return [Locus(0, constraint.line(P[0], Q[0])), Edge(1, 0, constraint.line(P[1] - P[0], Q[1] - Q[0]))]


class TestConstraints:
    @pytest.mark.parametrize("weight", [None, 40.0])
    @pytest.mark.parametrize("name", ENERGIES)
    def test_any_number_together(self, bent, name, weight):
        P, Q, F = bent
        asked = [
            Locus(0, constraint.polyline([P[0], P[0] + [1, 2], Q[0]]), weight),
            Locus(8, constraint.spline([P[8], P[8] + [0.5, 1], Q[8]])),
            Edge(20, 18, constraint.line(P[20] - P[18], Q[20] - Q[18]), weight),
            Direction(5, 3, (1.0, 0.3), weight),
            Barycentre(constraint.line(P.mean(axis=0), Q.mean(axis=0) + 0.1), weight),
        ]
        prepared = shape.prepare(P, Q, F, error=ENERGIES[name], constraints=asked)
        found = shape.solve(prepared, T)
        assert found.residual.max() < 1e-10
        V = found.vertices
        assert V[:, 8] == pytest.approx(constraint.spline([P[8], P[8] + [0.5, 1], Q[8]])(T), abs=1e-10)
        if weight is None:
            assert V[:, 20] - V[:, 18] == pytest.approx(asked[2].path(T), abs=1e-9)
            assert (V[:, 5] - V[:, 3]) @ [1.0, 0.3] == pytest.approx(np.zeros(5), abs=1e-9)
            assert V.mean(axis=1) == pytest.approx(asked[4].path(T), abs=1e-9)

    @pytest.mark.parametrize("name", ["frobenius", "similarity"])
    def test_a_heavy_weight_tends_to_an_exact_constraint(self, bent, name):
        P, Q, F = bent
        for make in (
            lambda w: [*_ends(P, Q), Locus(20, constraint.line(P[20], Q[20] + 1.0), w)],
            lambda w: [*_ends(P, Q), Direction(20, 2, (0.2, 1.0), w)],
            lambda w: [*_ends(P, Q), Barycentre(constraint.line(P.mean(axis=0), Q.mean(axis=0) + 1.0), w)],
            lambda w: [*_ends(P, Q), Edge(20, 2, constraint.line(P[20] - P[2], Q[20] - Q[2] + 1.0), w)],
        ):
            exact, heavy, light = (
                shape.solve(shape.prepare(P, Q, F, error=ENERGIES[name], constraints=make(w)), 0.5).vertices
                for w in (None, 1e9, 1e-9)
            )
            without = shape.solve(shape.prepare(P, Q, F, error=ENERGIES[name], constraints=_ends(P, Q)), 0.5)
            assert heavy == pytest.approx(exact, abs=1e-5)
            assert light == pytest.approx(without.vertices, abs=1e-3 if name == "similarity" else 1e-6)

    def test_a_moving_direction(self, bent):
        P, Q, F = bent

        def normal(t):
            return np.stack([np.cos(2 * t), np.sin(2 * t)], axis=-1)

        prepared = shape.prepare(P, Q, F, constraints=[*_ends(P, Q), Direction(20, 2, normal)])
        assert not prepared.is_static
        V = shape.solve(prepared, T).vertices
        assert np.sum((V[:, 20] - V[:, 2]) * normal(T), axis=1) == pytest.approx(np.zeros(5), abs=1e-10)

    def test_a_pinned_vertex_stays(self, bent):
        P, Q, F = bent
        V = shape.solve(shape.prepare(P, Q, F, constraints=[constraint.pinned(4, P[4])]), T).vertices
        assert V[:, 4] == pytest.approx(np.tile(P[4], (5, 1)))


class TestFreedoms:
    @pytest.mark.parametrize(
        ("name", "asked", "says"),
        [
            ("frobenius", [], "an unfixed translation"),
            ("frobenius", [Edge(3, 0, constraint.line((1, 0), (0, 1)))], "unfixed translation"),
            ("similarity", [Locus(0, constraint.line((0, 0), (1, 1)))], "shrunk to a point"),
            ("similarity", [Barycentre(constraint.line((0, 0), (1, 1)))], "shrunk to a point"),
            ("point similarity", [], "shrunk to a point"),
            ("similarity", [Edge(3, 0, constraint.line((1, 0), (0, 1)))], "unfixed translation"),
            (
                "similarity",
                [Locus(0, constraint.line((0, 0), (1, 1))), Direction(3, 0, (1.0, 0.0))],
                "shrunk to a point",
            ),
        ],
    )
    def test_what_is_unfixed_is_named(self, bent, name, asked, says):
        P, Q, F = bent
        with pytest.raises(ValueError, match=says) as caught:
            shape.prepare(P, Q, F, error=ENERGIES[name], constraints=asked)
        assert "Add a" in str(caught.value) and "\n" not in str(caught.value)

    def test_two_parts_are_held_apart(self, bent):
        P, Q, F = bent
        both = np.concatenate([P, P + 20.0]), np.concatenate([Q, Q + 20.0]), np.concatenate([F, F + len(P)])
        with pytest.raises(ValueError, match=r"translation of part 1 \(vertex 21\)"):
            shape.prepare(*both, constraints=[constraint.pinned(0, P[0])])
        for error in ENERGIES.values():
            found = shape.solve(shape.prepare(*both, error=error), [0.0, 0.5, 1.0]).vertices
            assert found[2] == pytest.approx(both[1], abs=1e-8)
            alone = shape.solve(shape.prepare(P, Q, F, error=error), 0.5).vertices[0]
            assert found[1, : len(P)] == pytest.approx(alone, abs=1e-8)


class TestBadInput:
    @pytest.mark.parametrize(
        ("change", "says"),
        [
            (lambda P, Q, F: (P, Q[:-1], F), "as many vertices as the source"),
            (lambda P, Q, F: (P * [np.nan, 1], Q, F), r"source must be finite; got \[nan, .*\] at vertex 0"),
            (lambda P, Q, F: (P, Q * [-1, 1], F), "oriented as the source .* Reverse the order"),
            (lambda P, Q, F: (P, Q, F[:, ::-1] * 0), "three vertices in each triangle"),
            (lambda P, Q, F: (P, Q, F + 1), "indices of the 21 vertices"),
            (lambda P, Q, F: (P, Q, F[:-2]), "a use of every vertex; got none of vertex"),
            (lambda P, Q, F: (P * [1, 0], Q, F), r"source must be a triangle with area; .* at index \(0,\)"),
            (lambda P, Q, F: (P, Q, F.astype(float)), "whole numbers"),
            (lambda P, Q, F: (P[:, :1], Q, F), r"shape \(k, 2\)"),
            (
                lambda P, Q, F: (P, Q, np.concatenate([F, F[:1]])),
                "one or two triangles at every edge|oriented alike",
            ),
        ],
    )
    def test_one_line_that_says_where(self, bent, change, says):
        with pytest.raises(ValueError, match=says) as caught:
            shape.prepare(*change(*bent))
        assert "\n" not in str(caught.value)

    def test_one_triangle_turned_over(self, bent):
        P, Q, F = bent
        torn = Q.copy()
        torn[10] = Q[10] + 4.0
        with pytest.raises(ValueError, match=r"turned over, the first triangle \d+. Mend the triangulation"):
            shape.prepare(P, torn, F)

    @pytest.mark.parametrize(
        ("asked", "says"),
        [
            ([Locus(99, constraint.line((0, 0), (1, 1)))], r"constraint 0 \(Locus\): vertex must be"),
            ([Locus(0, lambda t: np.zeros(3))], "path must be a function from times"),
            ([Locus(0, lambda t: np.full((len(t), 2), np.nan))], "finite"),
            ([constraint.pinned(0, (0, 0)), constraint.pinned(0, (1, 0))], "at most one exact Locus"),
            ([Locus(0, constraint.line((0, 0), (1, 1)), -1.0)], "weight must be positive"),
            ([constraint.pinned(0, (0, 0)), Edge(1, 1, constraint.line((0, 0), (1, 1)))], "another vertex"),
            ([constraint.pinned(0, (0, 0)), Direction(1, 2, (0, 0))], "a direction, not 0"),
        ],
    )
    def test_constraints(self, bent, asked, says):
        with pytest.raises(ValueError, match=says):
            shape.prepare(*bent, constraints=asked)

    def test_times_and_angles(self, bent):
        with pytest.raises(ValueError, match="t must be finite"):
            shape.solve(shape.prepare(*bent), [0.0, np.nan])
        with pytest.raises(ValueError, match="theta must be one angle"):
            shape.prepare(*bent, theta=np.zeros(3))
        with pytest.raises(ValueError, match="weights must be"):
            shape.prepare(*bent, weights=np.zeros(len(bent[2])))


class TestPaths:
    def test_they_begin_and_end_where_they_should(self):
        points = np.array([[0.0, 0.0], [1.0, 2.0], [3.0, 1.0], [4.0, 4.0], [5.0, 0.0]])
        ends = np.array([0.0, 1.0])
        for make in (constraint.polyline, constraint.spline, constraint.bspline):
            assert make(points)(ends) == pytest.approx(points[[0, -1]])
        assert constraint.spline(points)(np.linspace(0, 1, 5)) == pytest.approx(points)
        assert constraint.line(points[0], points[1])(np.array([0.5])) == pytest.approx(np.array([[0.5, 1.0]]))

    def test_an_arc(self):
        path = constraint.arc((1.0, 0.0), (2.0, 0.0), 2 * np.pi, 3.0)
        found = path(np.array([0.0, 0.25, 1.0]))
        assert found == pytest.approx(np.array([[2.0, 0.0], [1.0, 3.0**0.25], [4.0, 0.0]]))

    def test_a_polyline_has_constant_speed(self):
        path = constraint.polyline([[0, 0], [3, 0], [3, 1]])
        assert path(np.array([0.5, 0.75, 0.875])) == pytest.approx(np.array([[2, 0], [3, 0], [3, 0.5]]))

    @pytest.mark.parametrize(
        ("make", "points"),
        [
            (constraint.polyline, [[0, 0]]),
            (constraint.bspline, [[0, 0]] * 3),
            (constraint.polyline, [[1, 1]] * 3),
        ],
    )
    def test_too_few(self, make, points):
        with pytest.raises(ValueError, match=r"points must be"):
            make(points)


def test_a_bspline_has_even_knots():
    p = np.array([[0.0, 0.0], [1.0, 2.0], [3.0, -1.0], [4.0, 4.0], [6.0, 1.0]])
    found = constraint.bspline(p)(np.array([0.0, 0.5, 1.0]))
    # With one knot inside, at one half, that point is by de Boor's rule the mean of the middle of its means.
    assert found == pytest.approx(np.stack([p[0], (p[1] + 2.0 * p[2] + p[3]) / 4.0, p[4]]))
