"""What the diagrams of groups say, against experiments with elements; where their parts lie on the page."""

import itertools

import numpy as np
import pytest
from lietool.figures.ch2 import _groups_classes, _groups_cube, _groups_layout, _groups_order, _groups_words

from lietool import figure, paths
from lietool.lie import affine, groups, quaternion
from lietool.render import draw, scene

GROUPS = figure.load("groups", (paths.FIGURES,))
EVERY = ",".join(groups.GROUPS)
SETS = {
    "one": "SO",
    "two": "SO,GL",
    "apart": "R,S^1,SL",
    "cube": "SO,O,SE,E,GL+,GL,Aff+,Aff",
    "numbers": "SO(2),SE(2),SO(3),SE(3),S^1,S^3,DQ,DCN,H^x,C^x,DQ^x",
    "every": EVERY,
    "both": f"SO(2),SE(2),{EVERY}",
}
IDS = ("B2.9", "B3.1", "K1")


@pytest.fixture(params=[*IDS, *SETS])
def shown(request):
    """The nodes of a diagram and its numbers."""
    if request.param in SETS:
        return (
            _groups_order.read(SETS[request.param], 3),
            GROUPS.draw(diagram="custom", nodes=SETS[request.param]),
        )
    nodes = {
        "B2.9": _groups_cube.DUAL_NODES,
        "B3.1": [(name, 3) for name in _groups_cube.INCLUDED],
        "K1": _groups_order.read("R+,R,SO,CO+,Sym+,SE,Sim+,GL+,Aff+", 3),
    }
    return nodes[request.param], GROUPS.draw(**GROUPS.plate_params(request.param))


def tangent_rank(name: str, n: int) -> int:
    """The dimension of the span of velocities at the identity, by difference quotients."""
    one = groups.identity(name, n)
    step = 1e-6
    rng = np.random.default_rng(3)
    near = groups.project(name, one + step * rng.normal(size=(60, *one.shape)))
    return int(np.linalg.matrix_rank(((near - one) / step).reshape(60, -1), tol=1e-3))


class TestWhatIsSaid:
    def test_the_nodes(self, shown):
        nodes, drawing = shown
        assert drawing.numbers["nodes"] == [groups.label(*node) for node in nodes]

    def test_dimensions(self, shown):
        nodes, drawing = shown
        for node, found in zip(nodes, np.asarray(drawing.numbers["dimension"]), strict=True):
            counted = [tangent_rank(node[0], n) for n in ((2, 3) if len(found) == 2 else node[1:])]
            assert found.tolist() == counted, node

    def test_arrows_are_the_inclusions_and_no_more(self, shown):
        """Going along arrows one comes to all that contains a group, and no arrow can be left out."""
        nodes, drawing = shown
        label = {groups.label(*node): node for node in nodes}
        arrows = [arrow.partition(": ") for arrow in drawing.numbers["arrows"]]
        steps = {
            tuple(label[end] for end in ends.split(" -> ")) for ends, _, kind in arrows if kind != "covering"
        }
        reached = set(steps)
        for middle, a, b in itertools.product(nodes, nodes, nodes):
            if (a, middle) in reached and (middle, b) in reached:
                reached.add((a, b))
        wanted = {(a, b) for a, b in itertools.product(nodes, nodes) if a != b and groups.contains(b, a)}
        assert reached == wanted
        assert not any((a, c) in wanted and (c, b) in wanted for a, b in steps for c in nodes)

    def test_coverings_are_those_of_the_library(self, shown):
        nodes, drawing = shown
        wanted = {
            f"{groups.label(m.source, m.n[0])} -> {groups.label(m.target, m.n[1])}: covering"
            for m in groups.MAPS
            if m.kind == "covering" and m.n and {(m.source, m.n[0]), (m.target, m.n[1])} <= set(nodes)
        }
        found = [a for a in drawing.numbers["arrows"] if a.endswith("covering")]
        assert set(found) == wanted and len(found) == len(wanted)
        degrees = drawing.numbers["degree"]
        for arrow, degree in zip(drawing.numbers["arrows"], degrees, strict=True):
            assert degree == (2 if arrow.endswith("covering") else 1)

    def test_components_and_compactness(self, shown):
        """Samples show as many signs of the determinant as components; compact groups are bounded."""
        nodes, drawing = shown
        for node, components, compact in zip(
            nodes, drawing.numbers["components"], drawing.numbers["compact"], strict=True
        ):
            A = groups.sample(node[0], 300, seed=1, n=node[1])
            if A.ndim == 3:
                assert len(np.unique(np.sign(np.linalg.det(A)))) == components, node
            size = np.linalg.norm(A.reshape(300, -1), axis=-1)
            assert (np.ptp(size) < 1e-9) == compact, node


class TestFormulas:
    """The words beside the arrows of figure 2.9, by what the maps do."""

    def act(self, source: str, target: str):
        (found,) = [
            m for m in groups.edges(_groups_cube.DUAL_NODES) if (m.source, m.target) == (source, target)
        ]
        return found.act

    def test_into_space(self):
        z, p = groups.sample("S^1", 20), groups.sample("DCN", 20)
        assert np.allclose(self.act("S^1", "S^3")(z), np.pad(z, ((0, 0), (0, 2))))
        # p_1 = a + b i goes to p_1 j = a j + b k.
        dual = self.act("DCN", "DQ")(p)
        assert np.allclose(dual[:, :2], p[:, :2]) and np.allclose(dual[:, 6:], p[:, 2:])
        assert np.allclose(dual[:, 2:6], 0.0)
        for name in ("SO", "SE"):
            A = groups.sample(name, 20, n=2)
            B = groups.inclusion((name, 2), (name, 3)).act(A)
            assert np.allclose(B[:, 0, 0], 1.0) and np.allclose(B[:, 1:, 1:], A)
            assert np.allclose(B[:, 0, 1:], 0.0) and np.allclose(B[:, 1:, 0], 0.0)

    def test_motions_of_the_plane(self):
        v = np.array([0.3, -1.2])
        for name, target in (("S^1", "SO"), ("DCN", "SE")):
            p = groups.sample(name, 20)
            A = self.act(name, target)(p)
            p0 = p[:, 0] + 1j * p[:, 1]
            p1 = p[:, 2] + 1j * p[:, 3] if name == "DCN" else 0.0
            moved = p0**2 * complex(*v) + 2 * p0 * p1
            found = A[:, :2, :2] @ v + (A[:, :2, 2] if name == "DCN" else 0.0)
            assert np.allclose(found, np.stack([moved.real, moved.imag], axis=-1))

    def test_motions_of_space(self):
        v = np.array([0.0, 0.3, -1.2, 0.7])
        times, bar = quaternion.multiply, np.array([1.0, -1.0, -1.0, -1.0])
        for name, target in (("S^3", "SO"), ("DQ", "SE")):
            q = groups.sample(name, 20)
            A = self.act(name, target)(q)
            z, w = q[:, :4], q[:, 4:] if name == "DQ" else 0.0 * q
            moved = times(times(z, v), z * bar) + 2.0 * times(w, z * bar)
            found = A[:, :3, :3] @ v[1:] + (A[:, :3, 3] if name == "DQ" else 0.0)
            assert np.allclose(moved[:, 0], 0.0) and np.allclose(moved[:, 1:], found)

    def test_every_arrow_up_is_a_semidirect_product(self, plate):
        for plate_id in ("B2.9", "B3.1"):
            shown = plate(plate_id).numbers
            corner = dict(zip(shown["nodes"], shown["corner"], strict=True))
            for arrow in shown["arrows"]:
                source, target = arrow.partition(": ")[0].split(" -> ")
                if corner[source][1] == corner[target][1]:
                    continue
                name = target.partition("(")[0]
                product = groups.get(name).product
                assert product.kind == "semidirect" and product.acting == source.partition("(")[0]

    @pytest.mark.parametrize("n", [2, 3])
    @pytest.mark.parametrize(("source", "target"), [("SO", "GL+"), ("O", "GL"), ("SE", "Aff+"), ("E", "Aff")])
    def test_to_the_back_by_the_polar_decomposition(self, source, target, n):
        A = groups.sample(target, 50, n=n)
        U, _, V = np.linalg.svd(A[:, :n, :n])
        S = np.broadcast_to(np.eye(A.shape[-1]), A.shape).copy()
        S[:, :n, :n] = np.linalg.inv(U @ V) @ A[:, :n, :n]
        assert np.all(groups.is_member("Sym+", S[:, :n, :n]))
        assert np.all(groups.is_member(source, A @ np.linalg.inv(S)))

    @pytest.mark.parametrize(("source", "target"), [("SO", "O"), ("SE", "E"), ("GL+", "GL"), ("Aff+", "Aff")])
    def test_to_the_right_of_index_two(self, source, target):
        """An element is in the subgroup, or its product with one chosen flip is."""
        A = groups.sample(target, 50)
        flip = np.eye(A.shape[-1])
        flip[0, 0] = -1.0
        inside = groups.is_member(source, A)
        assert np.all(inside != groups.is_member(source, flip @ A)) and 0 < inside.sum() < 50


class TestClasses:
    @pytest.mark.parametrize("n", [2, 3])
    def test_strips_against_elements_of_the_classes(self, n):
        """Elements drawn at random: what is zero is, what is tied is equal, what is free fills the rank."""
        drawing = GROUPS.draw(diagram="hierarchy", n=str(n))
        shown = drawing.numbers
        for label, pattern, rank, dimension in zip(
            shown["nodes"], shown["pattern"], shown["rank"], shown["dimension"], strict=True
        ):
            name = label.partition("(")[0].partition("^")[0]
            A = groups.sample(name, 60, seed=4, n=n)
            if A.shape[-1] == n:
                B = np.broadcast_to(np.eye(n + 1), (60, n + 1, n + 1)).copy()
                B[:, :n, :n] = A
                A = B
            params = affine.psi_so(A)
            kinds = np.array(pattern.split())
            assert np.abs(params[:, kinds == "zero"]).max(initial=0.0) < 1e-9
            assert np.abs(np.diff(params[:, kinds == "tied"], axis=-1)).max(initial=0.0) < 1e-9
            assert np.linalg.matrix_rank(params, tol=1e-6) == rank == dimension[0]
            assert rank == (kinds == "free").sum() + (kinds == "tied").any()

    @pytest.mark.parametrize("n", [2, 3])
    def test_every_solid_shows_a_member_of_its_class(self, n):
        for seed in (0, 9999):
            shown = GROUPS.draw(diagram="hierarchy", n=str(n), seed=seed).numbers
            for label, A in zip(shown["nodes"], shown["matrices"], strict=True):
                name = label.partition("(")[0].partition("^")[0]
                linear = groups.get(name).shape(n)[0] == n
                assert groups.is_member(name, A[:n, :n] if linear else A), label
                assert not linear or np.allclose(A[:n, n], 0.0)
            # The largest class keeps the parameter as it is.
            assert np.array_equal(shown["members"][-1], shown["parameters"])

    def test_subspaces_lie_in_each_other_as_the_classes_do(self):
        names = list(affine.CLASSES)
        spaces = [_groups_classes.subspace(name, 3).matrix for name in names]
        nodes = [({"translation": "R", "dilation": "R+"}.get(name, name), 3) for name in names]
        for (a, P), (b, Q) in itertools.product(zip(nodes, spaces, strict=True), repeat=2):
            assert np.allclose(Q @ P, P) == groups.contains(b, a)


class TestLayout:
    def test_cubes_cross_where_cubes_do(self, plate):
        for plate_id in ("B2.9", "B3.1"):
            shown = plate(plate_id).numbers
            assert shown["crossings"] == 2
            assert sorted(map(tuple, shown["corner"])) == list(itertools.product((0, 1), repeat=3))
            assert len(shown["arrows"]) == 12

    def test_the_hierarchy_has_no_crossing(self, plate):
        assert plate("K1").numbers["crossings"] == 0

    @pytest.mark.parametrize("which", SETS)
    def test_arrows_go_up_and_meet_no_card(self, which):
        nodes = _groups_order.read(SETS[which], 3)
        cards, links, page = _groups_order.placed(nodes, groups.edges(nodes), (160.0, 88.0))
        boxes = np.array([c.box for c in cards])
        assert boxes[:, :2].min() > 20.0 and (boxes[:, 2:] < np.array(page) - 20.0).all()
        for a, b in itertools.combinations(boxes, 2):
            assert (a[2:] < b[:2]).any() or (b[2:] < a[:2]).any()
        for link in links:
            assert (np.diff(link.points[:, 1]) > 0.0).all()
            for start, end in link.segments:
                way = start + np.linspace(0.0, 1.0, 400)[:, None] * (end - start)
                inside = (way[:, None] > boxes[:, :2]) & (way[:, None] < boxes[:, 2:])
                assert not inside.all(axis=-1).any(), link.map

    @pytest.mark.parametrize("which", SETS)
    def test_words_lie_on_even_ground(self, which):
        """No label is cut, meets another, or has a line under it."""
        picture = GROUPS.draw(diagram="custom", nodes=SETS[which]).picture
        rendered = draw.render(picture, draft=True)
        bare = scene.Picture(
            tuple(
                scene.View(
                    tuple(r for r in view.records if not isinstance(r, scene.Label)), view.camera, view.box
                )
                for view in picture.views
            ),
            picture.size,
        )
        ground = draw.render(bare, draft=True).image.astype(int)
        boxes = np.array([label.box for label in rendered.labels])
        assert boxes[:, :2].min() >= 4 and (boxes[:, 2:] <= np.array(picture.size) - 4).all()
        for label in rendered.labels:
            x0, y0, x1, y1 = label.box
            assert np.ptp(ground[y0:y1, x0:x1].reshape(-1, 3), axis=0).max() < 3, label.text
        for a, b in itertools.combinations(boxes, 2):
            assert (a[2:] <= b[:2]).any() or (b[2:] <= a[:2]).any()

    def test_levels_are_longest_chains(self):
        arrows = [(0, 1), (1, 2), (0, 2), (3, 2)]
        assert _groups_layout.levels(4, arrows).tolist() == [0, 1, 2, 1]

    def test_fewest_crossings_of_a_small_graph(self):
        """Two pairs given the wrong way round are exchanged."""
        found = _groups_layout.arrange(4, [(0, 3), (1, 2)], 10.0, 5.0, 100.0)
        assert found.crossings == 0

    def test_rising_is_the_nearest(self):
        rng = np.random.default_rng(0)
        for _ in range(20):
            values = rng.normal(size=6)
            found = _groups_layout.rising(values)
            assert (np.diff(found) >= -1e-12).all()
            # No small change that still rises comes nearer.
            for change in rng.normal(size=(200, 6)) * 1e-3:
                other = np.sort(found + change)
                assert np.sum((other - values) ** 2) >= np.sum((found - values) ** 2) - 1e-12

    def test_a_legend_of_nothing_is_empty(self):
        assert _groups_words.legend([], []) == []


class TestNodes:
    @pytest.mark.parametrize(
        ("nodes", "complaint"),
        [
            ("SOO", r"got 'SOO'\. Nearest: SO"),
            ("SE(4)", r"got 'SE\(4\)'\. Write SE\(2\) or SE\(3\)"),
            ("S^3(2)", r"got 'S\^3\(2\)'\. Write S\^3"),
            ("SO,SO(3)", r"got 'SO\(3\)' twice"),
            (" , ", r"must name a group"),
            ("?", r"got '\?'\. Known: SO, O"),
        ],
    )
    def test_refused_in_one_line(self, nodes, complaint):
        with pytest.raises(ValueError, match=complaint) as refused:
            GROUPS.draw(diagram="custom", nodes=nodes)
        assert "\n" not in str(refused.value)

    def test_dimension_of_the_space(self):
        with pytest.raises(ValueError, match=r"got 'a{60}\.\.\.'") as refused:
            _groups_order.read("a" * 3000, 3)
        assert len(str(refused.value)) < 400
        assert _groups_order.read("SO,SE(2), DQ", 3) == [("SO", 3), ("SE", 2), ("DQ", 3)]
        flat = GROUPS.draw(diagram="custom", nodes="SO,SE,S^1,DCN", n="2").numbers
        assert flat["nodes"] == ["SO(2)", "SE(2)", "S^1", "DCN"]

    def test_both_dimensions_or_one(self):
        both = GROUPS.draw(diagram="inclusions").numbers["dimension"]
        two, three = (GROUPS.draw(diagram="inclusions", n=n).numbers["dimension"] for n in "23")
        assert np.array_equal(both, np.hstack([two, three]))
