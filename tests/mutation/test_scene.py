"""Pictures as plain arrays: what is the same, what moved and how far on the page."""

import numpy as np
import pytest

from lietool.mutation import scene as subject
from lietool.render import scene
from lietool.render.camera import Camera, Page, project


def picture(shift=0.0, color="#ff0000", camera=None, more=(), text="$a$"):
    records = (
        scene.Lines([[0.0, 0.0, 0.0], [10.0 + shift, 5.0, 0.0], [np.nan] * 3, [1.0, 2.0, 0.0]], color),
        scene.Label(text, (5.0, 5.0, 0.0), "#000000", offset=(1.0, 2.0)),
        *more,
    )
    return subject.shape(scene.Picture((scene.View(records, camera or Page()),), (60, 40)))


def test_the_same_picture_has_no_differences_and_nothing_moved():
    assert not subject.differences(picture(), picture())
    assert subject.displacement(picture(), picture()) == 0.0


def test_rounding_is_no_difference():
    assert not subject.differences(picture(), picture(1e-12))


@pytest.mark.parametrize("shift", [0.01, -3.0])
def test_what_moved_is_measured_on_the_page(shift):
    before, after = picture(), picture(shift)
    assert [d.entry for d in subject.differences(before, after)] == ["views.0.records.0.points"]
    assert subject.displacement(before, after) == pytest.approx(abs(shift))


def test_a_colour_or_a_text_differs_and_nothing_moves():
    for after in (picture(color="#00ff00"), picture(text="$b$")):
        assert len(subject.differences(picture(), after)) == 1
        assert subject.displacement(picture(), after) == 0.0


def test_records_that_do_not_line_up_have_no_displacement():
    after = picture(more=(scene.Points([[1.0, 1.0, 0.0]], "#0000ff"),))
    assert subject.differences(picture(), after)
    assert subject.displacement(picture(), after) is None
    before = picture(more=(scene.Points([[1.0, 1.0, 0.0], [2.0, 1.0, 0.0]], "#0000ff"),))
    assert subject.displacement(before, after) is None


def test_a_camera_that_moves_moves_everything():
    cameras = Camera(), Camera(target=(0.1, 0.0, 0.0))
    before, after = (picture(camera=camera) for camera in cameras)
    box = (0.0, 0.0, 60.0, 40.0)
    a, b = (project(camera, box, [[0.0, 0.0, 0.0]])[0, :2] for camera in cameras)
    assert subject.differences(before, after)
    assert subject.displacement(before, after) >= np.linalg.norm(a - b) - 1e-12


def test_what_is_far_off_the_page_does_not_count():
    far = [scene.Points([[1e4 + x, 1.0, 0.0]], "#0000ff") for x in (0.0, 7.0)]
    before, after = (picture(more=(points,)) for points in far)
    assert subject.differences(before, after)
    assert subject.displacement(before, after) == 0.0


def test_every_record_has_its_vertices():
    triangle, faces = np.eye(3), [[0, 1, 2]]
    records = (
        scene.Surface(triangle, faces, "#ffffff"),
        scene.Points(triangle, "#ffffff"),
        scene.Arrow((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), "#ffffff", 0.1),
        scene.Tube(triangle, "#ffffff", 0.1),
        scene.Frame(np.eye(3)),
        scene.Image(np.zeros((2, 2)), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    )
    found = picture(more=records)
    assert [len(points) for points in found.points.values()] == [4, 1, 3, 3, 2, 3, 4, 4]


def test_what_is_no_record_is_refused():
    with pytest.raises(TypeError, match="got object"):
        picture(more=(scene.Lines([[0.0, 0.0, 0.0]], object()),))  # type: ignore[arg-type]
