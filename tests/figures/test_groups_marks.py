"""How the diagrams of groups are drawn: what passes behind, sheets, the marks of what is compact, labels."""

import itertools

import numpy as np
import pytest
from lietool.figures.ch2 import _groups_classes, _groups_cube, _groups_marks

from lietool import figure, paths
from lietool.lie import groups
from lietool.render import scene, style

GROUPS = figure.load("groups", (paths.FIGURES,))


def records(drawing, kind):
    return [r for view in drawing.picture.views for r in view.records if isinstance(r, kind)]


class TestMarks:
    def test_a_line_is_broken_evenly_about_what_passes_before_it(self):
        (m,) = groups.edges([("SO", 3), ("O", 3)])
        behind = _groups_marks.Link(m, np.array([[0.0, 0.0], [300.0, 0.0]]), (1.0, 1.0))
        before = _groups_marks.Link(m, np.array([[120.0, -50.0], [120.0, 80.0]]))
        assert _groups_marks.pass_behind([behind, before]) == 1
        lines = [r for r in _groups_marks.arrow(behind) if isinstance(r, scene.Lines)]
        ends = np.sort(np.concatenate([np.asarray(r.points)[[0, -1], 0] for r in lines[1:]]))
        assert np.isclose(ends[1] + ends[2], 240.0) and 12.0 < ends[2] - ends[1] < 24.0

    def test_compact_is_tinted_and_framed_twice(self):
        kinds = {}
        for compact, sheets in itertools.product((True, False), (1, 2)):
            card = _groups_marks.Card(("SO", 3), (100.0, 100.0), (120.0, 80.0), compact, sheets)
            made = card.records()
            frames = [r for r in made if isinstance(r, scene.Lines)]
            kinds[compact] = {r.color for r in made}
            assert len(frames) == sheets * (1 + compact)
            shown = np.concatenate([np.asarray(r.points)[:, :2] for r in frames])
            assert np.allclose(np.concatenate([shown.min(axis=0), shown.max(axis=0)]), card.box)
        assert kinds[True] != kinds[False]
        # Orange is for what covers.
        assert not kinds[True] & {style.GROUP, style.GROUP_TEXT, style.BETWEEN, style.BETWEEN_EDGE}

    def test_arrows_to_the_back_leave_from_the_front_sheet(self):
        for sheets in (1, 2):
            cards = [
                _groups_marks.Card(("O", 3), p, (120.0, 80.0), True, sheets) for p in ((0, 0), (200, 300))
            ]
            start = _groups_marks.trimmed([(0.0, 0.0), (200.0, 300.0)], *cards)[0]
            assert np.allclose(start, np.array([2.0, 3.0]) * 49.0 / 3.0)

    def test_the_dual_unit_comes_last(self):
        assert _groups_marks.normal("DCN", 2).endswith(r"\,\varepsilon)")
        assert _groups_marks.normal("DQ", 3) == r"(1+\mathrm{Im}\,\mathrm{\mathbb{H}}\,\varepsilon)"


class TestLabels:
    @pytest.mark.parametrize(
        ("params", "directions"),
        [
            ({}, _groups_cube.DUAL),
            ({"diagram": "inclusions"}, _groups_cube.inclusions("n")),
            ({"diagram": "inclusions", "n": "2"}, _groups_cube.inclusions(2)),
        ],
        ids=["dual", "both", "plane"],
    )
    def test_those_of_parallel_arrows_are_beside_the_same_part(self, params, directions):
        drawing = GROUPS.draw(**params)
        nodes = list(_groups_cube.DUAL_NODES)
        if params:
            nodes = [(name, 2 if "n" in params else 3) for name in _groups_cube.INCLUDED]
        corner = dict(zip(nodes, drawing.numbers["corner"], strict=True))
        for axis, direction in enumerate(directions):
            mine = [
                m
                for m in groups.edges(nodes)
                if np.diff([corner[e] for e in m.ends(m.n[0])], axis=0)[0][axis]
            ]
            texts = {direction.label(m) for m in mine}
            starts = [(corner[m.ends(m.n[0])[0]] @ _groups_cube._STEPS)[1] for m in mine]
            heights = [r.position[1] for r in records(drawing, scene.Label) if r.text in texts]
            assert len(heights) == len(starts) == 4
            assert np.ptp(np.sort(heights) - np.sort(starts)) < 16.0

    @pytest.mark.parametrize("n", ["2", "3"])
    def test_the_key_of_the_hierarchy_names_every_cell(self, n):
        drawing = GROUPS.draw(diagram="hierarchy", n=n)
        indices = [r.text.strip("$") for r in records(drawing, scene.Label) if r.color == style.PAPER]
        i, j = np.triu_indices(int(n))
        upper = [f"{a + 1}{b + 1}" for a, b in zip(i, j, strict=True)]
        axes = [str(k + 1) for k in range(int(n))]
        assert indices == (axes if n == "3" else []) + axes + upper
        # The equal ones are the diagonal.
        tied = _groups_classes.subspace("CO+", int(n)).pattern[-len(upper) :]
        assert [kind == "tied" for kind in tied] == (i == j).tolist()

    @pytest.mark.parametrize(
        "params",
        [{}, *({"diagram": d, "n": n} for d in ("inclusions", "hierarchy") for n in ("both", "2", "3"))],
        ids=str,
    )
    def test_none_is_cut_or_meets_another(self, params, placed):
        picture = GROUPS.draw(**params).picture
        boxes = np.array([label.box for label in placed(picture)])
        assert boxes[:, :2].min() >= 20 and (boxes[:, 2:] <= np.array(picture.size) - 20).all()
        for a, b in itertools.combinations(boxes, 2):
            assert (a[2:] <= b[:2]).any() or (b[2:] <= a[:2]).any()
