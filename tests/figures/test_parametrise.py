"""Figure 7.1: phi and psi, against the exponential series and the singular values."""

import numpy as np
import pytest
from scipy.linalg import expm, polar

from lietool import figure, paths
from lietool.lie import affine, se3
from lietool.render.scene import Label


def drawn(**params):
    return figure.load("parametrise", (paths.FIGURES,)).draw(**params)


def hat(x):
    return np.array([[0.0, -x[2], x[1]], [x[2], 0.0, -x[0]], [-x[1], x[0], 0.0]])


def matrix(shown):
    """A by the series: what its parameters say, stretch first."""
    x, shift, y = np.split(shown["parameters"], [3, 6])
    Y = np.array([[y[0], y[1], y[2]], [y[1], y[3], y[4]], [y[2], y[4], y[5]]])
    return x, shift, expm(Y)


class TestNumbers:
    @pytest.mark.parametrize("plate_id", ["B7.1", "B7.1b"])
    def test_the_map_of_the_book_is_the_exponential_of_se3_after_the_stretch(self, plate_id, plate):
        shown = plate(plate_id).numbers
        x, shift, S = matrix(shown)
        X = np.zeros((4, 4))
        X[:3, :3], X[:3, 3] = hat(x), shift
        stretched = np.eye(4)
        stretched[:3, :3] = S
        assert shown["A"] == pytest.approx(expm(X) @ stretched, abs=1e-12)
        assert shown["d"] == pytest.approx(expm(X)[:3, 3], abs=1e-12)

    def test_it_shows_the_maps_of_se3_that_it_is_given(self):
        def straight(x):
            T = se3.exp(x)
            T[..., :3, 3] = x[..., 3:]
            return T

        parametrise = figure.load("parametrise", (paths.FIGURES,))
        shown = parametrise.draw_with({"exp": straight, "log": lambda T: 0.5 * se3.log(T)}).numbers
        right = parametrise.draw().numbers
        assert shown["d"] == pytest.approx(shown["parameters"][3:6])
        assert shown["principal"][:3] == pytest.approx(0.5 * right["principal"][:3])
        assert not shown["same"] and right["same"]

    def test_the_other_map_adds_the_translation_last(self, plate):
        shown = plate("B7.1c").numbers
        x, shift, S = matrix(shown)
        assert shown["A"][:3, :3] == pytest.approx(expm(hat(x)) @ S, abs=1e-12)
        assert shown["A"][:3, 3] == pytest.approx(shift)

    def test_rotation_and_stretch_are_the_polar_parts(self, plate):
        shown = plate("B7.1").numbers
        R, S = polar(shown["A"][:3, :3])
        assert shown["R"] == pytest.approx(R, abs=1e-12)
        assert shown["S"] == pytest.approx(S, abs=1e-12)
        assert np.sort(np.exp(shown["log_stretch"])) == pytest.approx(np.sort(np.linalg.eigvalsh(S)))

    @pytest.mark.parametrize(
        ("angle", "principal"), [(80.0, 80.0), (250.0, 110.0), (400.0, 40.0), (-300.0, 60.0)]
    )
    @pytest.mark.parametrize("kind", ["phi_se", "phi_so"])
    def test_psi_gives_the_principal_rotation(self, angle, principal, kind):
        shown = drawn(angle=angle, map=kind).numbers
        found = shown["principal"][:3]
        assert np.degrees(np.linalg.norm(found)) == pytest.approx(principal)
        turns = (found - shown["parameters"][:3]) / (2.0 * np.pi)
        assert np.linalg.norm(turns) == pytest.approx(round(np.linalg.norm(turns)), abs=1e-9)
        assert shown["same"] == (abs(angle) < 180.0)

    def test_psi_jumps_where_the_rotation_vector_leaves_the_ball(self):
        near, past = (drawn(angle=a).numbers for a in (179.999, 180.001))
        assert np.abs(near["A"] - past["A"]).max() < 1e-3
        assert np.linalg.norm(near["principal"][:3] - past["principal"][:3]) == pytest.approx(
            2.0 * np.pi, abs=1e-3
        )

    def test_of_the_two_maps_only_the_plain_one_keeps_its_translation(self):
        for kind, kept in (("phi_so", True), ("phi_se", False)):
            shown = drawn(angle=250.0, map=kind).numbers
            assert np.allclose(shown["principal"][3:6], shown["parameters"][3:6]) == kept


class TestOtherFunctions:
    def given(self, **functions):
        drawing = figure.load("parametrise", (paths.FIGURES,)).draw_with(functions, angle=250.0)
        texts = [r.text for view in drawing.picture.views for r in view.records if isinstance(r, Label)]
        return drawing.numbers, " ".join(texts)

    def test_what_does_not_lead_back_is_said(self):
        def wrong(A):
            return affine.psi_se(A) * np.repeat([1.0, 2.0], 6)

        numbers, texts = self.given(psi_se=wrong)
        assert r"\neq" in texts and "Y'" in texts and numbers["round_trip_below"] > 0.01
        assert r"\neq" not in self.given(psi_se=lambda A: affine.psi_se(A))[1]

    def test_the_steps_are_those_of_the_function(self):
        numbers, _ = self.given(phi_se=affine.phi_so, psi_se=affine.psi_so)
        assert numbers["d"] == pytest.approx([0.0, 1.3, 0.7])

    def test_exp_and_log_of_rigid_motions_make_the_map(self):
        found, texts = self.given(exp=lambda x: se3.exp(x), log=lambda T: se3.log(T))
        right, _ = self.given()
        for name in ("A", "R", "S", "d", "principal"):
            assert found[name] == pytest.approx(right[name], abs=1e-12)
        assert r"\neq" not in texts


class TestPicture:
    @pytest.mark.parametrize(
        "params",
        [
            {"angle": 0.0},
            {"angle": 180.0},
            {"angle": 360.0},
            {"angle": -720.0, "map": "phi_so"},
            {"translation": (0.0, 0.0, 0.0)},
            {"stretch": (1.0, 1.0, 1.0), "angle": 0.0, "translation": (0.0, 0.0, 0.0)},
            {"stretch": (0.25, 4.0, 0.25), "tilt": 180.0},
            {"axis": (1.0, 0.5, 0.34)},
        ],
        ids=str,
    )
    def test_what_degenerates_is_shown(self, params):
        found = drawn(**params)
        texts = [r for view in found.picture.views for r in view.records if isinstance(r, Label)]
        assert len(texts) > 10
        assert np.isfinite(found.numbers["principal"]).all()

    def test_the_page_says_when_psi_answers_with_another(self):
        def page(**params):
            views = drawn(**params).picture.views
            return " ".join(r.text for view in views for r in view.records if isinstance(r, Label))

        assert r"\mathbf{x}'" not in page()
        assert r"\mathbf{x}'" in page(angle=250.0) and r"\mathbf{l}'" in page(angle=250.0)
        assert r"\mathbf{l}'" not in page(angle=250.0, map="phi_so")

    @pytest.mark.parametrize("kind", ["phi_se", "phi_so"])
    def test_a_film_is_seen_in_one_way(self, kind):
        angles = [0.0, 80.0, 185.0, 350.0]
        pictures = drawn(map=kind).film(angles)
        first = [view.camera for view in pictures[0].views]
        for picture, angle in zip(pictures, angles, strict=True):
            assert [view.camera for view in picture.views] == first
            still = drawn(map=kind, angle=angle).picture
            assert [len(v.records) for v in picture.views] == [len(v.records) for v in still.views]

    def test_no_axis_is_refused_by_name(self):
        with pytest.raises(ValueError, match="axis must be different from 0"):
            drawn(axis=(0.0, 0.0, 0.0))
