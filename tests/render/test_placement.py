"""Labels that may move: away from lines, from other text and from the edges of the page, and no further."""

import numpy as np
import pytest

from lietool.render import placement, scene, style
from lietool.render.camera import Camera

HALF = np.array([30.0, 12.0])


def page(*records: scene.Record) -> scene.Picture:
    return scene.Picture((scene.View(records),))


def wanted(point, offset=(0.0, 40.0), room=90.0):
    label = scene.Label("$b$", (*point, 0.0), style.INK, offset=offset, room=room)
    middle = np.asarray(point) + offset
    return label, np.asarray(point, float), np.concatenate([middle - HALF, middle + HALF])


def box_after(one, move):
    return one[2] + np.tile(move, 2)


class TestPlaces:
    def test_a_free_label_stays(self):
        one = wanted((600, 450))
        assert placement.places([one], page(scene.Lines([(0, 0, 0), (1200, 0, 0)], style.INK))) == [
            (0.0, 0.0)
        ]

    def test_a_label_without_room_stays_on_a_line(self):
        one = wanted((600, 450), room=0.0)
        line = scene.Lines([(0, 490, 0), (1200, 490, 0)], style.INK)
        assert placement.places([one], page(line)) == [(0.0, 0.0)]

    @pytest.mark.parametrize("angle", np.linspace(0.0, 3.0, 7))
    def test_it_leaves_a_line_through_its_point(self, angle):
        along = 500.0 * np.array([np.cos(angle), np.sin(angle), 0.0])
        middle = np.array([600.0, 450.0, 0.0])
        picture = page(scene.Lines([middle - along, middle + along], style.INK, style.CURVE))
        one = wanted((600, 450), tuple(0.08 * along[:2]))
        (move,) = placement.places([one], picture)
        assert placement.crossed(box_after(one, move)[None], placement.obstacles(picture))[0] == 0.0
        # Still beside its point.
        assert np.linalg.norm((one[2][:2] + one[2][2:]) / 2.0 + move - one[1]) < 90.0 + np.linalg.norm(HALF)

    def test_it_comes_back_onto_the_page(self):
        for point, offset in (((1190, 450), (40, 0)), ((600, 5), (0, -40)), ((8, 890), (-30, 30))):
            one = wanted(point, offset)
            (move,) = placement.places([one], page())
            box = box_after(one, move)
            assert box[:2].min() >= 16.0 and box[2] <= 1200 - 16.0 and box[3] <= 900 - 16.0

    def test_two_of_them_part(self):
        both = [wanted((600, 450)), wanted((604, 452))]
        first, second = (
            box_after(one, move) for one, move in zip(both, placement.places(both, page()), strict=True)
        )
        assert (first[:2] > second[2:]).any() or (second[:2] > first[2:]).any()

    def test_one_with_room_goes_round_one_without(self):
        both = [wanted((600, 450)), wanted((600, 450), room=0.0)]
        moves = placement.places(both, page())
        assert moves[1] == (0.0, 0.0) and moves[0] != (0.0, 0.0)

    def test_rounding_does_not_move_it(self):
        rng = np.random.default_rng(3)
        ends = rng.uniform((200, 200, 0), (1000, 700, 0), (12, 2, 3))
        ends[:, :, 2] = 0.0
        found = set()
        for k in range(5):
            noise = 1e-11 * rng.normal(size=ends.shape) if k else 0.0
            picture = page(*(scene.Lines(pair, style.INK) for pair in ends + noise))
            moves = placement.places([wanted(pair[0, :2]) for pair in ends], picture)
            found.add(tuple(np.round(np.ravel(moves), 6)))
        assert len(found) == 1


class TestObstacles:
    def test_a_line_with_a_gap_is_two(self):
        line = scene.Lines([(0, 0, 0), (10, 0, 0), (np.nan, 0, 0), (20, 0, 0), (30, 5, 0)], style.INK)
        assert placement.obstacles(page(line)).ends == pytest.approx(
            np.array([[[0, 0], [10, 0]], [[20, 0], [30, 5]]])
        )

    def test_a_surface_counts_by_its_outline(self):
        square = scene.Surface(
            [(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0)], [[0, 1, 2], [0, 2, 3]], style.INK
        )
        ends = placement.obstacles(page(square)).ends
        assert len(ends) == 4 and np.allclose(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1), 9.0)

    def test_a_solid_in_space_counts_by_what_is_seen_of_it(self):
        from lietool.render import solids

        camera = Camera((1.0, 0.6, 0.5), height=3.0)
        vertices, faces, normals = solids.sphere(1.0)
        view = scene.View((scene.Surface(vertices, faces, style.GLASS, normals),), camera, (0, 0, 900, 900))
        ends = placement.obstacles(scene.Picture((view,), (900, 900))).ends
        radius = np.linalg.norm(ends - 450.0, axis=-1)
        # The lens sees a little less than half of the ball, and sees it a little larger.
        assert len(ends) > 20 and radius.min() > 290 and radius.max() < 310

    def test_every_record_is_known(self):
        records = [
            scene.Points([(5, 5, 0)], style.INK, 4.0),
            scene.Arrow((0, 0, 0), (9, 0, 0), style.INK, 1.0),
            scene.Tube([(0, 0, 0), (9, 0, 0), (9, 9, 0)], style.INK, 1.0),
            scene.Frame(np.eye(3)),
            scene.Label("$a$", (0, 0, 0), style.INK),
        ]
        assert len(placement.obstacles(page(*records)).ends) == 1 + 1 + 2 + 3


class TestCrossed:
    def test_lengths(self):
        around = placement.Obstacles(np.array([[[0.0, 5.0], [100.0, 5.0]]]), np.zeros(1), np.ones(1))
        boxes = np.array([[10.0, 0, 30, 10], [90, 0, 130, 10], [10, 6, 30, 10]])
        assert placement.crossed(boxes, around) == pytest.approx([20.0, 10.0, 0.0])

    def test_a_pale_line_counts_for_less(self):
        lines = [scene.Lines([(0, 5, 0), (100, 5, 0)], style.INK, 2.0, alpha) for alpha in (1.0, 0.25)]
        box = np.array([[10.0, 0.0, 30.0, 10.0]])
        strong, pale = (placement.crossed(box, placement.obstacles(page(line)))[0] for line in lines)
        assert pale == pytest.approx(strong / 4.0)
