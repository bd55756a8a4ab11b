"""What `triangle-interp` shows: four ways between two triangles, where they collapse, what is refused."""

import numpy as np
import pytest

from lietool import figure, paths
from lietool.interp import triangle

METHODS = ("linear", "arap", "logexp", "matrix_log")


def load():
    return figure.load("triangle-interp", (paths.FIGURES,))


def shown(**params):
    return load().draw(**params).numbers


def mapped(*target, turns=0):
    from lietool.figures.ch5 import _triangle_map as maps

    return maps.read((0.0, 0.0, 1.5, 1.4, -0.1, 1.6), target, turns)


def by_series(X, terms=60):
    """The exponential of a matrix, by halving and its series."""
    X, total, power = X / 16.0, np.eye(2), np.eye(2)
    for k in range(1, terms):
        power = power @ X / k
        total = total + power
    return np.linalg.matrix_power(total, 16)


class TestMap:
    def test_it_carries_corner_to_corner(self, plate):
        params = load().plate_params("B5.1b")
        p, q = (np.array(params[name]).reshape(3, 2) for name in ("source", "target"))
        affine = plate("B5.1b").numbers["affine"]
        corners = np.column_stack([p, np.ones(3)])
        # The entries from their linear equations: those of the book, transposed.
        assert np.abs(np.linalg.solve(corners, np.column_stack([q, np.ones(3)])).T - affine).max() < 1e-13
        assert np.abs(corners @ affine[:2].T - q).max() < 1e-13

    def test_its_factors_are_a_rotation_and_a_stretch(self, plate):
        numbers = plate("B5.2").numbers
        A, R, S = numbers["affine"][:2, :2], numbers["R"], numbers["S"]
        assert np.abs(R @ S - A).max() < 1e-14
        assert np.abs(R.T @ R - np.eye(2)).max() < 1e-15 and np.linalg.det(R) > 0.0
        assert np.abs(S @ S - A.T @ A).max() < 1e-14 and np.linalg.eigvalsh(S).min() > 0.0

    def test_four_numbers_are_the_matrix(self):
        target = (1.2, -0.7, 0.4, 0.6)
        assert np.abs(shown(target=target)["affine"][:2, :2] - np.reshape(target, (2, 2))).max() < 1e-14


class TestWays:
    @pytest.mark.parametrize("plate_id", ["B5.1", "B5.2", "B5.3", "B5.4", "B5.5", "B5.6", "B5.6b", "B5.6c"])
    def test_they_begin_at_the_identity_and_end_at_the_map(self, plate_id, plate):
        numbers = plate(plate_id).numbers
        ways = [numbers[f"{method}_steps"] for method in METHODS if f"{method}_steps" in numbers]
        assert ways
        for way in ways:
            assert np.abs(way[[0, -1]] - [np.eye(2), numbers["affine"][:2, :2]]).max() < 1e-13

    def test_equal_steps_of_one_power_are_one_matrix(self, plate):
        way = plate("B5.6c").numbers["matrix_log_steps"]
        ratios = way[1:] @ np.linalg.inv(way[:-1])
        assert np.abs(ratios - ratios[0]).max() < 1e-13

    def test_the_stretch_by_its_logarithm_is_a_power(self, plate):
        numbers = plate("B5.3").numbers
        values, vectors = np.linalg.eigh(numbers["S"])
        angle = np.deg2rad(numbers["angle"])
        for k, A in enumerate(numbers["logexp_steps"]):
            t = k / (len(numbers["logexp_steps"]) - 1)
            c, s = np.cos(t * angle), np.sin(t * angle)
            expected = np.array([[c, -s], [s, c]]) @ vectors @ np.diag(values**t) @ vectors.T
            assert np.abs(A - expected).max() < 1e-14

    def test_full_turns_change_the_way_and_not_its_end(self):
        once, more = shown(method="logexp", turns=0), shown(method="logexp", turns=2)
        assert more["angle"] - once["angle"] == pytest.approx(720.0)
        assert np.abs(once["logexp_steps"][-1] - more["logexp_steps"][-1]).max() < 1e-13
        assert np.abs(once["logexp_now"] - more["logexp_now"]).max() < 1e-13
        assert np.abs(once["logexp_steps"][1] - more["logexp_steps"][1]).max() > 0.5

    def test_power_and_log_exp_have_one_determinant_and_differ(self, plate):
        numbers = plate("B5.6c").numbers
        assert numbers["matrix_log_det"] == pytest.approx(numbers["logexp_det"])
        assert np.abs(numbers["matrix_log_now"] - numbers["logexp_now"]).max() > 0.3


class TestCollapse:
    def test_arap_leaves_the_cone_only_outside(self, plate):
        (exit,) = (x for x in plate("B5.2").numbers["arap_singular_at"] if 0.0 < x < 5.0)
        given = mapped(*load().plate_params("B5.2")["target"])
        assert exit > 1.0
        assert abs(np.linalg.det(given.at("arap", exit))) < 1e-11
        assert np.linalg.eigvalsh(given.stretches("arap", exit + 0.01))[0] < 0.0
        inside = given.stretches("arap", np.linspace(0.0, 1.0, 101))
        assert np.linalg.eigvalsh(inside).min() > 0.0
        far = given.stretches("logexp", np.linspace(-3.0, 4.0, 101))
        assert np.linalg.eigvalsh(far).min() > 0.0

    def test_the_straight_line_where_eigenvalues_are_negative(self, plate):
        numbers = plate("B5.6b").numbers
        assert numbers["eigenvalues"][:, 0].max() < 0.0 and not numbers["eigenvalues"][:, 1].any()
        assert not numbers["has_real_log"] and "matrix_log_steps" not in numbers
        exits = numbers["linear_singular_at"]
        assert len(exits) == 2 and 0.0 < exits[0] < 0.5 < exits[1] < 1.0
        assert np.linalg.det(numbers["linear_now"]) < 0.0
        assert min(numbers["arap_det"].min(), numbers["logexp_det"].min()) > 0.0

    def test_it_does_not_where_they_are_not_real(self, plate):
        numbers = plate("B5.6c").numbers
        assert numbers["eigenvalues"][:, 1].any() and numbers["has_real_log"]
        assert not len(numbers["linear_singular_at"])

    def test_areas_swell_on_the_straight_line_only(self, plate):
        numbers = plate("B5.6").numbers
        assert numbers["logexp_det"][1:-1] == pytest.approx(np.ones(3))
        assert numbers["arap_det"][2] > 1.3
        assert np.linalg.eigvalsh(numbers["S"]).prod() == pytest.approx(1.0)

    @pytest.mark.parametrize("method", ["linear", "arap", "logexp", "matrix-log"])
    def test_every_zero_of_the_determinant_is_found(self, method):
        for target in [
            (2.0, 0.3, -0.4, 0.5),
            (-1.0, 0.2, 0.1, -0.5),
            (0.3, 0.0, 0.0, 0.6),
            (1.0, 0.5, 0.0, 1.0),
        ]:
            given = mapped(*target)
            if not given.exists(method):
                continue
            span = np.linspace(-4.003, 5.001, 4001)
            dets = np.linalg.det(given.at(method, span))
            changes = span[1:][np.diff(np.sign(dets)) != 0.0]
            exits = given.exits(method)
            assert len(changes) == len([x for x in exits if -4.0 < x < 5.0])
            assert all(np.abs(changes - x).min() < 0.01 for x in exits if -4.0 < x < 5.0)


class TestParts:
    """The factors that are drawn on circle and cone."""

    @pytest.mark.parametrize("method", ["linear", "arap", "logexp", "matrix-log"])
    @pytest.mark.parametrize(
        "target", [(-0.75, -0.48, 1.25, 0.12), (-0.74, 0.33, -1.43, -0.74), (2.0, 3.0, 0.0, 0.5)]
    )
    def test_rotation_and_stretch_make_the_map_and_do_not_jump(self, method, target):
        given, span = mapped(*target), np.linspace(-1.0, 2.0, 601)
        angles, S = given.angles(method, span), given.stretches(method, span)
        assert np.abs(np.diff(angles)).max() < 0.3
        assert np.abs(given.angles(method, np.array(0.0))) < 1e-12
        c, s = np.cos(angles), np.sin(angles)
        R = np.stack([c, -s, s, c], axis=-1).reshape(-1, 2, 2)
        assert np.abs(R @ S - given.at(method, span)).max() < 1e-12

    def test_the_logarithm_in_the_diagram_gives_the_power(self):
        from lietool.figures.ch5 import _triangle_equations as diagram

        for target in [
            (-0.75, -0.48, 1.25, 0.12),
            (2.0, 3.0, 0.0, 0.5),
            (-2.0, 0.0, 0.0, -2.0),
            (1.0, 0.7, 0.0, 1.0),
        ]:
            given = mapped(*target)
            L = diagram.logarithm(given)
            for t in (0.3, 1.0):
                assert np.abs(by_series(t * L) - triangle.matrix_log(given.A, t)).max() < 1e-12

    @pytest.mark.parametrize("method", ["arap", "logexp"])
    def test_the_stretches_lie_in_the_section_of_the_cone(self, method):
        from lietool.figures.ch5 import _triangle_path as path

        from lietool.render import cone

        given = mapped(*load().plate_params("B5.2")["target"])
        at = cone.drawn(given.stretches(method, np.linspace(-1.0, 2.0, 31)))
        across = path._across(given.S)
        assert np.abs(at[:, :2] @ [-across[1], across[0]]).max() < 1e-12
        # Beyond its wall, |across| = height, the determinant is negative.
        outside = np.abs(at[:, :2] @ across) > at[:, 2]
        assert outside.any() == (method == "arap")

    def test_rows_fill_their_part_of_the_page_and_do_not_overlap(self):
        from lietool.figures.ch5 import _triangle_shape as shapes

        heights = np.array([1.0, 2.0, 0.5])
        for most in (np.inf, 10.0):
            scale, middles = shapes.stack(heights, 100.0, 800.0, 20.0, most)
            assert scale == pytest.approx(min(660.0 / 3.5, most))
            upper, lower = middles + scale * heights / 2.0, middles - scale * heights / 2.0
            assert upper[0] <= 800.0 + 1e-9 and lower[-1] >= 100.0 - 1e-9
            assert (lower[:-1] - upper[1:] >= 20.0 - 1e-9).all()
            assert 800.0 - upper[0] == pytest.approx(lower[-1] - 100.0)

    def test_the_arrow_begins_and_ends_outside_the_triangles(self):
        from lietool.figures.ch5 import _triangle_affine as affine

        p, q = (np.reshape(load().plate_params("B5.1b")[name], (3, 2)) for name in ("source", "target"))
        ends = affine._between(p, q, 0.0)
        for corners, end in zip((p, q), ends, strict=True):
            weights = np.linalg.solve(np.vstack([corners.T, np.ones(3)]), [*end, 1.0])
            assert weights.min() == pytest.approx(0.0, abs=1e-12)
        assert affine._between(p, p, 0.0) is None

    def test_the_letter_stays_in_its_triangle(self):
        from lietool.figures.ch5 import _triangle_shape as shapes

        for target in [(1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 3.0, -2.0, 0.5)]:
            shape = shapes.Shape.of(mapped(*target))
            weights = np.linalg.solve(
                np.vstack([shape.corners.T, np.ones(3)]), np.vstack([shape.letter.T, np.ones(10)])
            )
            assert weights.min() > 0.0

    def test_the_red_part_is_where_no_logarithm_is(self):
        from lietool.figures.ch5 import _triangle_chart as charts

        rng = np.random.default_rng(5)
        for A in rng.standard_normal((200, 2, 2)):
            if np.linalg.det(A) > 0.0:
                a, b = (np.abs(x) for x in triangle.coordinates(A))
                inside = charts.without_log(triangle.principal_angle(A), b / a)
                assert inside != triangle.has_real_log(A)


class TestRefusals:
    @pytest.mark.parametrize(
        ("params", "message"),
        [
            ({"source": (0.0, 0.0, 1.0, 1.0, 2.0, 2.0)}, "source must be a triangle with area"),
            ({"target": (0.0, 0.0, 1.0, 1.0, 2.0, 2.0)}, "target must be a triangle with area"),
            ({"target": (3.0, 3.0, 3.0, 3.0, 3.0, 3.0)}, "target must be a triangle with area"),
            ({"target": (1.0, 0.0, 0.0, -1.0)}, "target must not be a mirror image"),
            ({"target": (1.0, 2.0, 3.0)}, "target must be six numbers"),
            ({"target": (-2.0, 0.0, 0.0, -1.0), "method": "matrix-log"}, "target must give a map"),
            ({"compare": "linear,exponential", "turns": 1}, "turns must be 0"),
        ],
    )
    def test_in_one_line(self, params, message):
        with pytest.raises(ValueError, match=f"^{message}.*; got ") as caught:
            load().draw(**params)
        assert "\n" not in str(caught.value)

    @pytest.mark.parametrize("plate_id", ["B5.1", "B5.2", "B5.3", "B5.4", "B5.5", "B5.6", "B5.6b"])
    @pytest.mark.parametrize(
        "target",
        [(1.0, 0.0, 0.0, 1.0), (-1.0, 0.0, 0.0, -1.0), (-3.0, 0.0, 0.0, -0.1), (0.01, 0.0, 0.0, 80.0)],
    )
    def test_extremes_are_drawn(self, plate_id, target):
        drawing = load().draw(**load().plate_params(plate_id) | {"target": target})
        assert drawing.picture.views
