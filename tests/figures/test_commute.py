"""What `commute` and `transform2` show, against matrices written out by hand."""

from typing import Any

import numpy as np
import pytest

from lietool import figure, paths
from lietool.render import scene


def shown(name: str, **params: object) -> dict[str, Any]:
    return dict(figure.load(name, (paths.FIGURES,)).draw(**params).numbers)


def picture(name: str, **params: object) -> scene.Picture:
    return figure.load(name, (paths.FIGURES,)).draw(**params).picture


def texts(name: str, **params: object) -> list[str]:
    views = picture(name, **params).views
    return [record.text for view in views for record in view.records if isinstance(record, scene.Label)]


def plane_turn(degrees: float) -> np.ndarray:
    z = np.exp(1j * np.deg2rad(degrees))
    return np.array([[z.real, -z.imag], [z.imag, z.real]])


class TestTranslations:
    def test_both_ways_end_at_the_sum(self, plate):
        numbers = plate("B2.1").numbers
        b, b2, corners = numbers["b"], numbers["b'"], numbers["parallelogram"]
        assert np.abs(numbers["ends"][0] - numbers["ends"][1]).max() < 1e-14
        assert numbers["ends"][0][:2, 2] == pytest.approx(corners[0] + b + b2)
        assert corners[1] - corners[0] == pytest.approx(corners[2] - corners[3])

    @pytest.mark.parametrize(
        ("b", "b2", "name"),
        [
            ((1.0, 2.0), (1.0, 2.0), "$T_b X = T_{b'} X$"),
            ((1.0, 2.0), (-1.0, -2.0), "$X = T_{b+b'} X$"),
            ((0.0, 0.0), (1.0, 2.0), "$X = T_b X$"),
            ((0.0, 0.0), (0.0, 0.0), "$X = T_b X = T_{b'} X = T_{b+b'} X$"),
        ],
    )
    def test_shapes_that_are_one_have_one_name(self, b, b2, name):
        assert name in texts("commute", b=b, b2=b2)

    def test_halfway_each_has_done_its_first_step(self):
        numbers = shown("commute", b=(1.0, 2.0), b2=(3.0, -1.0), place=(0.0, 0.0), t=0.5)
        assert numbers["now"][:, :2, 2] == pytest.approx(np.array([[1.0, 2.0], [3.0, -1.0]]))


class TestRotationsOfThePlane:
    @pytest.mark.parametrize("angle", [0.0, 30.0, 180.0, -720.0, 1000.0])
    def test_both_ways_end_at_the_sum(self, angle):
        numbers = shown("commute", group="rotation2", angle=angle, angle2=45.0)
        for end in numbers["ends"]:
            assert np.abs(end[:2, :2] - plane_turn(angle + 45.0)).max() < 1e-13


class TestRotationsOfSpace:
    def test_the_angle_between_both_ends(self, plate):
        numbers = plate("B2.6").numbers
        x, z = np.deg2rad([30.0, 45.0]) / 2.0
        # The commutator of two rotations about axes at right angles, from their half angles.
        half = np.arccos(1.0 - 2.0 * np.sin(x) ** 2 * np.sin(z) ** 2)
        one, two = numbers["stages"][:, 1]
        assert np.arccos((np.trace(one.T @ two) - 1.0) / 2.0) == pytest.approx(numbers["angle_between"])
        assert numbers["angle_between"] == pytest.approx(2.0 * half)

    def test_axes_are_fixed(self, plate):
        turn_x, turn_z = np.eye(3), np.eye(3)
        turn_x[1:, 1:], turn_z[:2, :2] = plane_turn(30.0), plane_turn(45.0)
        wanted = [[turn_x, turn_z @ turn_x], [turn_z, turn_x @ turn_z]]
        assert np.abs(plate("B2.6").numbers["stages"] - wanted).max() < 1e-15

    @pytest.mark.parametrize(
        "params",
        [
            {"axis": "z", "axis2": "z"},
            {"angle": 0.0},
            {"angle2": 360.0},
            {"angle": -720.0},
            {"angle": 180.0, "angle2": 180.0},
        ],
    )
    def test_where_they_commute_it_says_so(self, params):
        assert shown("commute", group="rotation3", **params)["angle_between"] < 1e-12
        assert "two orders, the same end: they commute" in texts("commute", group="rotation3", **params)

    def test_a_quarter_turn_each(self):
        numbers = shown("commute", group="rotation3", angle=90.0, angle2=90.0)
        assert numbers["angle_between_deg"] == pytest.approx(120.0)


class TestNormal:
    def test_the_three_steps_are_a_translation(self, plate):
        numbers = plate("B3.2").numbers
        wanted = np.eye(3)
        wanted[:2, 2] = plane_turn(140.0) @ numbers["b"]
        assert np.abs(numbers["product"] - wanted).max() < 1e-15
        assert numbers["turned"] == pytest.approx(wanted[:2, 2])
        assert numbers["stages"][3] == pytest.approx(wanted @ numbers["stages"][0])

    def test_at_the_end_both_ways_are_one(self, plate):
        long, short = plate("B3.2").numbers["now"]
        assert np.abs(long - short).max() < 1e-15


class TestRotation:
    def test_the_marked_point_stays_on_its_circle(self, plate):
        numbers = plate("B2.2").numbers
        assert np.linalg.norm(numbers["x'"]) == pytest.approx(numbers["radius"])
        assert numbers["after"] == pytest.approx(numbers["before"] @ plane_turn(150.0).T)

    def test_so_does_the_point_that_is_furthest_away(self, plate):
        numbers = plate("B2.2").numbers
        first, last = numbers["other"]
        assert last == pytest.approx(plane_turn(150.0) @ first)
        furthest = np.linalg.norm(numbers["before"], axis=-1).max()
        assert np.linalg.norm(first) == pytest.approx(furthest)


class TestRigid:
    def test_both_orders(self, plate):
        numbers = plate("B2.3").numbers
        R, b, x = plane_turn(100.0), numbers["b"], numbers["stages"][0][:2, 2]
        assert numbers["stages"][2][:2, 2] == pytest.approx(R @ x + b)
        assert numbers["other_order"][2][:2, 2] == pytest.approx(R @ (x + b))
        # (2.7): from the turned shape it is a shift by b'.
        assert numbers["other_order"][2][:2, 2] - numbers["stages"][1][:2, 2] == pytest.approx(numbers["b'"])
        for order in ("stages", "other_order"):
            assert np.abs(numbers[order][2][:2, :2] - R).max() < 1e-15

    def test_it_shows_the_functions_that_it_is_given(self):
        def commuting(p, q):
            """The product of dual numbers that commute, without the conjugate of (2.38)."""
            (a, b), (c, d) = ((x[..., ::2] + 1j * x[..., 1::2]).T for x in np.broadcast_arrays(p, q))
            product = np.stack([a * c, b * c + a * d], axis=-1)
            return np.stack([product.real, product.imag], axis=-1).reshape(*np.shape(a.T), 4)

        drawn = figure.load("transform2", (paths.FIGURES,)).draw_with({"multiply": commuting}, kind="rigid")
        ends = [drawn.numbers[order][2] for order in ("stages", "other_order")]
        assert np.abs(ends[0] - ends[1]).max() < 1e-15

    @pytest.mark.parametrize("params", [{"angle": 0.0}, {"angle": 360.0}, {"b": (0.0, 0.0)}])
    def test_where_the_order_does_not_matter_it_says_so(self, params):
        assert "two orders, the same end" in texts("transform2", kind="rigid", **params)


class TestAboutAPoint:
    def test_the_point_stays_and_the_rest_turns_about_it(self, plate):
        numbers = plate("B2.3b").numbers
        b, product = numbers["b"], numbers["product"]
        assert product[:2, :2] @ b + product[:2, 2] == pytest.approx(b)
        start, end = numbers["stages"][0][:2, 2] - b, numbers["stages"][3][:2, 2] - b
        assert end == pytest.approx(plane_turn(60.0) @ start)
        assert np.abs(numbers["now"][0] - numbers["now"][1]).max() < 1e-14


EXTREMES = [
    *({"angle": a} for a in (0.0, 180.0, 360.0, -720.0, 1000.0)),
    *({"b": b} for b in ((0.0, 0.0), (100.0, 20.0), (0.01, 0.0))),
    {"place": (0.0, 0.0)},
    {"t": 0.3},
]
KINDS = [
    *(("commute", {"group": group}) for group in ("translation2", "rotation2", "rotation3", "normal")),
    *(("transform2", {"kind": kind}) for kind in ("rotation", "rigid", "about")),
]


@pytest.mark.parametrize(
    ("name", "kind"), KINDS, ids=lambda x: x if isinstance(x, str) else "-".join(x.values())
)
def test_no_label_is_cut_or_overlaps_another(name, kind, placed):
    for extreme in EXTREMES:
        boxes = np.array([label.box for label in placed(picture(name, **kind, **extreme))])
        assert boxes.min() >= 4 and boxes[:, 2].max() <= 1196 and boxes[:, 3].max() <= 896, extreme
        low, high = boxes[:, None, :2], boxes[None, :, 2:]
        over = (low < high).all(axis=-1)
        assert (over & over.T).sum() == len(boxes), extreme


@pytest.mark.parametrize("turns", [0.5, 1.0, 2.0, 3.0, -2.8])
def test_an_arc_of_several_turns_ends_where_the_point_does(turns):
    from lietool.figures.ch2 import _motions

    theta = 2.0 * np.pi * turns
    curve = _motions.about((1.0, 2.0), (3.0, 2.5), theta)
    end = plane_turn(360.0 * turns) @ (2.0, 0.5) + (1.0, 2.0)
    assert curve[0] == pytest.approx([3.0, 2.5]) and curve[-1] == pytest.approx(end)


class TestTrackedCorner:
    """The corner is tracked at which arrows run over letters least."""

    def letters(self):
        from lietool.figures.ch2 import _letters, _motions

        return _letters, _motions

    def test_arrows_to_the_upper_right_leave_from_the_upper_left(self):
        letters, m = self.letters()
        sides = [m.straight(u, v) for u, v in (((0, 0), (4, 0.3)), ((0, 0), (1, 2.4)), ((4, 0.3), (1, 2.4)))]
        found = letters.tracked(1.2, [m.shift(at) for at in ((0, 0), (4, 0.3), (1, 2.4), (5, 2.7))], sides)
        assert found.corner == (-0.375, 0.5)

    def test_the_tracked_corner_goes_where_the_motion_takes_the_origin(self):
        letters, m = self.letters()
        T = m.shift((2.0, -1.0)) @ m.turn(0.7)
        for corner in ((-0.375, 0.5), (-0.375, -0.5), (0.375, 0.5)):
            outline = letters.Letter(0.8, corner).outline(T)
            assert np.linalg.norm(outline - (2.0, -1.0), axis=-1).min() == pytest.approx(0.0, abs=1e-12)

    def test_what_lies_on_a_letter(self):
        letters, m = self.letters()
        letter = letters.Letter(4.0, (-0.375, -0.5))
        points = np.array([[0.5, 3.5], [2.5, 0.5], [1.5, 1.5], [2.5, 2.5]])
        assert letter.on(m.shift((0.0, 0.0)), points).tolist() == [True, False, True, False]


class TestWhatIsSeenOfTheTurnBetweenBothEnds:
    def test_the_arc_leads_from_a_corner_to_the_same_corner_about_the_right_axis(self, plate):
        from lietool.figures.ch2 import _commute_space

        from lietool.render import letter

        one, two = plate("B2.6").numbers["stages"][:, 1]
        axis, delta = _commute_space._between(one, two)
        camera = _commute_space._eye(one, two)
        records = _commute_space._corner_turned(one, axis, delta, camera)
        (ends,) = (r for r in records if isinstance(r, scene.Points))
        solid = letter.solid()[0]
        k = int(np.argmin(np.linalg.norm(solid @ one.T - ends.positions[0], axis=-1)))
        assert ends.positions[0] == pytest.approx(one @ solid[k])
        assert ends.positions[1] == pytest.approx(two @ solid[k])
        # Right-handed: from the first to the second about the axis.
        assert np.cross(ends.positions[0], ends.positions[1]) @ axis > 0.0
        # Not along the page: the angle is seen.
        assert abs(camera.axes[2] @ axis) > np.cos(np.deg2rad(50.0))
