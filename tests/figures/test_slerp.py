"""The laws in the pictures of slerp, against computations of their own."""

import numpy as np
import pytest

from lietool import figure, paths
from lietool.golden import numbers
from lietool.lie import euler, quaternion, so3
from lietool.render import draw, scene

SLERP = figure.load("slerp", (paths.FIGURES,))
WAYS = ("slerp", "nlerp", "Euler")


def compare(**params):
    return SLERP.draw(view="compare", **params).numbers


def texts(drawing) -> list[str]:
    return [r.text for view in drawing.picture.views for r in view.records if isinstance(r, scene.Label)]


def finely(shown, count=4001):
    """The three ways anew, by formulas that the figure does not use: (2.32), the chord, three turns."""
    t = np.linspace(0.0, 1.0, count)[:, None]
    first, last = (quaternion.from_matrix(shown["rotations"][0, k]) for k in (0, -1))
    last = last * np.sign(first @ last)
    theta = np.arccos(first @ last)
    arc = (np.sin((1 - t) * theta) * first + np.sin(t * theta) * last) / np.sin(theta)
    a, b, c = (shown["euler_start"] + t * shown["euler_turns"]).T
    turns = so3.exp(c[:, None] * np.eye(3)[2]) @ so3.exp(b[:, None] * np.eye(3)[1])
    turns = turns @ so3.exp(a[:, None] * np.eye(3)[0])
    return np.stack([quaternion.to_matrix(arc), quaternion.to_matrix((1 - t) * first + t * last), turns])


def angles(R):
    """The angles between consecutive rotations."""
    return np.linalg.norm(so3.log(np.swapaxes(R[..., :-1, :, :], -1, -2) @ R[..., 1:, :, :]), axis=-1)


class TestSlerp:
    def test_the_line_is_laid_onto_the_arc(self, plate):
        shown = plate("B2.8").numbers
        assert np.abs(shown["arc_points"] - shown["slerp"]).max() < 1e-14
        assert np.linalg.norm(shown["arc_points"], axis=-1) == pytest.approx(1.0)
        assert np.linalg.norm(shown["tangent_points"][-1]) == pytest.approx(shown["theta"])

    def test_equal_steps_make_equal_arcs(self, plate):
        shown = plate("B2.8").numbers
        arc, line = shown["arc_points"], shown["tangent_points"]
        steps = len(arc) - 1
        cosines = np.sum(arc[1:] * arc[:-1], axis=-1)
        assert np.arccos(cosines) == pytest.approx(np.full(steps, shown["theta"] / steps))
        assert np.linalg.norm(np.diff(line, axis=0), axis=-1) == pytest.approx(
            np.full(steps, shown["theta"] / steps)
        )

    def test_the_moment_divides_the_angle(self, plate):
        shown = plate("B2.8").numbers
        t = plate("B2.8").item.parameters["t"]
        assert np.arccos(shown["arc_points"][0] @ shown["marked"]) == pytest.approx(t * shown["theta"])
        assert np.arccos(shown["arc_points"][-1] @ shown["marked"]) == pytest.approx((1 - t) * shown["theta"])

    @pytest.mark.parametrize(
        ("q0", "q1"),
        [
            ((1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
            ((1.0, 0.0, 0.0, 0.0), (1.0, 1e-9, 0.0, 0.0)),
            ((1.0, 0.0, 0.0, 0.0), (-1.0, 1e-3, 0.0, 0.0)),
            ((3.0, 0.0, 4.0, 0.0), (0.1, -0.2, 0.3, -0.4)),
            ((1e-100, 0.0, 0.0, 1e-100), (1e100, 1e100, 0.0, 0.0)),
            ((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0)),
            ((1.0, 0.0, 0.0, 0.0), (-1.0, 0.0, 0.0, 0.0)),
            ((0.3, -0.4, 0.5, 0.1), (-0.3, 0.4, -0.5, -0.1)),
            ((1.0, 0.0, 1.0, 0.0), (1.0, 0.0, -1.0, 0.0)),
        ],
    )
    @pytest.mark.parametrize("view", ["sphere", "compare"])
    def test_any_two_quaternions(self, view, q0, q1):
        drawing = SLERP.draw(view=view, q0=q0, q1=q1, t=0.5)
        assert (draw.render(drawing.picture, size=(64, 48), draft=True).image != 255).any()
        numbers.dumps(drawing.numbers)

    def test_the_law_that_is_printed(self):
        for q0, said in (
            ((1.0, 0.0, 0.0, 0.0), "(1, q_1, t) = "),
            ((1.0, 1.0, 0.0, 0.0), r"\mathbf{u})\,q_0$"),
        ):
            assert sum(said in text for text in texts(SLERP.draw(q0=q0))) >= 1, said

    def test_the_angles_that_are_printed(self):
        drawing = SLERP.draw(q0=(1.0, 0.0, 0.0, 0.0), q1=(0.5, 0.0, np.sqrt(0.75), 0.0), t=0.25)
        assert r"$t = 0.25,\;\; \theta = 60.0^{\circ},\;\; t\theta = 15.0^{\circ}$" in texts(drawing)

    def test_no_quaternion(self):
        with pytest.raises(ValueError, match=r"^q0 must .*; got \(0.0, 0.0, 0.0, 0.0\)\. "):
            SLERP.draw(q0=(0.0, 0.0, 0.0, 0.0))


class TestCompare:
    def test_the_ways_share_their_ends(self, plate):
        R = plate("B2.8b").numbers["rotations"]
        assert np.abs(R[:, [0, -1]] - R[0, [0, -1]]).max() < 1e-14

    def test_the_rotations_are_of_their_formulas(self, plate):
        shown = plate("B2.8b").numbers
        at = np.rint(4000 * shown["times"]).astype(int)
        assert np.abs(finely(shown)[:, at] - shown["rotations"]).max() < 1e-13

    def test_the_speeds_are_of_the_rotations(self, plate):
        shown = plate("B2.8b").numbers
        fine = finely(shown)
        t = np.linspace(0.0, 1.0, fine.shape[1])
        measured = angles(fine) * (len(t) - 1)
        for way in range(3):
            at = np.interp((t[1:] + t[:-1]) / 2, shown["instants"], shown["speeds"][way])
            assert measured[way] == pytest.approx(at, rel=1e-4), WAYS[way]

    def test_the_angles_are_the_lengths_of_the_ways(self, plate):
        shown = plate("B2.8b").numbers
        measured = angles(finely(shown))
        lengths = measured.reshape(3, len(shown["times"]) - 1, -1).sum(axis=-1)
        assert np.abs(lengths - shown["turned"]).max() < 1e-6

    def test_slerp_is_steady_and_nlerp_fast_in_the_middle(self, plate):
        shown = plate("B2.8b").numbers
        steady, chord, _ = shown["speeds"]
        theta = shown["theta"]
        assert np.ptp(steady) < 1e-14 and steady[0] == pytest.approx(2 * theta)
        assert shown["instants"][np.argmax(chord)] == pytest.approx(0.5)
        assert chord.max() == pytest.approx(4 * np.tan(theta / 2))
        assert chord[0] == pytest.approx(2 * np.sin(theta)) == chord[-1]

    def test_nlerp_stays_on_the_circle_of_slerp_and_euler_does_not(self, plate):
        shown = plate("B2.8b").numbers
        u = shown["line"] / np.linalg.norm(shown["line"])
        height = shown["axis_paths"] @ u
        assert np.ptp(height[:2]) < 1e-14 < 0.3 < np.ptp(height[2])
        # Of the three axes it is the one that is most nearly across u.
        assert abs(height[0, 0]) == pytest.approx(np.abs(u @ shown["rotations"][0, 0]).min())

    def test_the_moment(self, plate):
        shown = plate("B2.8b").numbers
        t, theta = plate("B2.8b").item.parameters["t"], shown["theta"]
        along = 2 * np.arctan2(t * np.sin(theta), 1 - t + t * np.cos(theta))
        assert shown["from_slerp"][0] == 0.0
        assert shown["from_slerp"][1] == pytest.approx(abs(2 * t * theta - along))
        between = shown["marked"][0].T @ shown["marked"][2]
        assert 1 + 2 * np.cos(shown["from_slerp"][2]) == pytest.approx(np.trace(between))

    @pytest.mark.parametrize(("t", "solids"), [(0.4, 18), (0.5, 21), (0.0, 18), (1.0, 18)])
    def test_the_solid_of_the_moment_takes_the_place_of_that_of_a_step(self, t, solids):
        views = SLERP.draw(**{**SLERP.plate_params("B2.8b"), "t": t}).picture.views
        assert sum(any(isinstance(r, scene.Arrow) for r in view.records) for view in views[:-1]) == solids

    @pytest.mark.parametrize("angle", [1e-6, 1.0, 3.0, 3.1415, 3.3, 5.0, 6.2])
    def test_the_way_is_as_given(self, angle):
        q1 = (np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0)
        shown = compare(q0=(1.0, 0.0, 0.0, 0.0), q1=q1)
        assert shown["turned"][:2].sum(axis=1) == pytest.approx([angle, angle])
        # Euler angles know the rotation, not the quaternion.
        assert shown["turned"][2].sum() >= min(angle, 2 * np.pi - angle) - 1e-9

    def test_which_way_is_said(self):
        one = (1.0, 0.0, 0.0, 0.0)
        for q1, said in (
            ((1.0, 1.0, 0.0, 0.0), "the short way round"),
            ((-1.0, 1.0, 0.0, 0.0), "the long way round, as given; to $-q_1$ it is $90^{\\circ}$"),
            (one, "nothing turns"),
            ((-1.0, 0.0, 0.0, 0.0), "nlerp has a gap at $t = 1/2$"),
        ):
            found = texts(SLERP.draw(view="compare", q0=one, q1=q1))
            assert sum(said in text for text in found) == 1, said

    def test_each_euler_angle_goes_the_shorter_way(self):
        shown = compare(q0=(0.2, 0.0, 0.0, 1.0), q1=(-0.2, 0.0, 0.0, 1.0))
        assert abs(shown["euler_start"][2]) > 2.7
        assert np.abs(shown["euler_turns"]).max() < np.pi / 2

    def test_between_opposite_quaternions_nlerp_has_a_gap(self):
        q0 = np.array([0.5, -0.1, 0.7, 0.2])
        drawing = SLERP.draw(view="compare", q0=tuple(q0), q1=tuple(-q0), steps=6, t=0.5)
        shown = drawing.numbers
        undefined = np.isnan(shown["rotations"]).any(axis=(-1, -2))
        assert np.argwhere(undefined).tolist() == [[1, 3]]
        assert np.isnan(shown["from_slerp"]).tolist() == [False, True, False]
        # In its row, and beside the sphere.
        assert texts(drawing).count("gap") == 1 == texts(drawing).count("nlerp undefined")
        assert shown["turned"].sum(axis=1) == pytest.approx([2 * np.pi, 0.0, 0.0], abs=1e-12)
        # As a rotation it never moves, on either side of the gap.
        assert np.nanmax(np.abs(shown["rotations"][1] - shown["rotations"][1, 0])) < 1e-14

    def test_beside_opposite_quaternions_the_speed_is_told_though_it_leaves_the_plot(self):
        drawing = SLERP.draw(view="compare", q0=(1.0, 0.0, 0.0, 0.0), q1=(-1.0, 1e-3, 0.0, 0.0))
        fastest = np.rad2deg(drawing.numbers["speeds"][1].max())
        assert fastest == pytest.approx(np.rad2deg(4.0 / np.tan(1e-3 / 2)), rel=1e-6)
        assert sum("up to" in text for text in texts(drawing)) == 1

    @pytest.mark.parametrize("steps", [1, 5, 8, 60])
    def test_never_more_solids_than_can_be_seen(self, steps):
        assert len(compare(steps=steps)["times"]) == min(steps, 8) + 1

    def test_the_chosen_euler_angles_are_of_the_ends(self, plate):
        shown = plate("B2.8b").numbers
        ends = np.stack([shown["euler_start"], shown["euler_start"] + shown["euler_turns"]])
        assert np.abs(euler.to_matrix(ends, "xyz") - shown["rotations"][0, [0, -1]]).max() < 1e-14
