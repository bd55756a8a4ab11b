"""Why two pictures differ: where, how much, and pictures of it."""

import numpy as np
import pytest
from PIL import Image

from lietool.golden import compare, explain

BASE = np.full((80, 120, 3), 230, np.uint8)
BASE[30:34] = 40


@pytest.fixture
def changed():
    image = BASE.copy()
    image[10:20, 60:75] = (200, 30, 30)
    image[60:63, 5:8] = 0
    return image


def test_blobs_are_boxes_the_larger_first(changed):
    first, second = explain.blobs(BASE, changed)
    assert first.box == (60, 10, 75, 20) and first.pixels == 150
    assert second.box == (5, 60, 8, 63) and second.pixels == 9
    assert first.delta_e > 30 and first.ssim < 0.5
    assert str(second).startswith("3x3 at (5, 60): 9 px, dE ")


def test_what_is_torn_apart_by_a_few_pixels_is_one_blob():
    image = BASE.copy()
    image[10, 20:50:5] = 0
    assert [blob.pixels for blob in explain.blobs(BASE, image)] == [6]


def test_a_wide_and_weak_difference_has_a_blob_too():
    image = BASE.copy()
    image[40:70, 40:90, 0] += 3
    assert not compare.images(BASE, image).passes
    assert explain.blobs(BASE, image)[0].box == (40, 40, 90, 70)


def test_pictures_smaller_than_a_window_are_explained():
    assert len(explain.blobs(BASE[:2, :3], 255 - BASE[:2, :3])) == 1


def test_lines_have_the_numbers_of_the_verdict(changed):
    said = explain.lines(BASE, changed, compare.images(BASE, changed))
    assert said[0].startswith("159 px beyond dE 2 (48 allowed), 150 of them in one place (8 allowed), ")
    assert said[1].startswith("9x9 mean -230.00 levels of") or "9x9 mean -200.00 levels of" in said[1]
    assert len(said) == 4


def test_many_places_are_counted():
    image = BASE.copy()
    image[2:80:16, 2:120:16] = 0
    assert explain.lines(BASE, image, compare.images(BASE, image))[-1].endswith("places more")


def test_the_difference_is_amplified_with_its_sign():
    image = BASE.copy()
    image[0, 0] += 3
    image[0, 1] -= 3
    shown = explain.amplified(BASE, image).astype(int)
    assert (shown[0, 0] - shown[0, 5]).tolist() == [48] * 3 == (shown[0, 5] - shown[0, 1]).tolist()
    assert (shown[31] < shown[0, 5]).all()


def test_pictures_are_left_and_those_of_an_earlier_failure_removed(tmp_path):
    failed = tmp_path / "out" / "failed"
    assert explain.leave(failed, "T1") == [] and not failed.exists()
    written = explain.leave(failed, "T1.b", expected=BASE, actual=BASE, difference=BASE)
    assert [path.name for path in written] == [
        "T1.b-expected.png",
        "T1.b-actual.png",
        "T1.b-difference.png",
    ]
    assert np.array_equal(np.array(Image.open(written[0])), BASE)
    explain.leave(failed, "T1.b", actual=BASE)
    assert [path.name for path in failed.iterdir()] == ["T1.b-actual.png"]
    explain.leave(failed, "T1.b")
    assert list(failed.iterdir()) == []
