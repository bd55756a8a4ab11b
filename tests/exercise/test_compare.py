"""How far results are from each other, and how they are told."""

import numpy as np
import pytest

from lietool.exercise import compare, texts


@pytest.mark.parametrize(
    ("got", "want", "off"),
    [
        (1.0, 1.0, 0.0),
        (0.5, 0.0, 0.5),
        ([1, 2], np.array([1.0, 4.0]), 0.5),
        (300.0, 200.0, 0.5),
        ((1.0, np.eye(2)), (1.0, np.zeros((2, 2))), 1.0),
        (np.nan, np.nan, 0.0),
        (np.inf, np.inf, 0.0),
        (np.zeros((0, 3)), np.zeros((0, 3)), 0.0),
        (1j, 1.0 + 0j, np.sqrt(2.0)),
    ],
)
def test_the_distance_is_relative_to_what_is_wanted(got, want, off):
    assert compare.apart(got, want) == pytest.approx(off)


@pytest.mark.parametrize(("got", "want"), [(np.nan, 1.0), (np.inf, 1.0), (1.0, np.nan)])
def test_what_is_not_finite_is_far(got, want):
    assert not compare.apart(got, want) <= 1.0


@pytest.mark.parametrize(
    ("got", "want", "message"),
    [
        (np.eye(3), np.eye(4), r"an array of shape \(3, 3\); wanted an array of shape \(4, 4\)"),
        (1.0, (1.0, 2.0), "a number; wanted 2 results: a number, a number"),
        ((1.0,), (1.0, 2.0), "1 results: a number; wanted 2"),
        ((1.0, 2.0), 1.0, "2 results"),
        (1j, 1.0, "complex numbers; wanted real"),
        ("text", 1.0, "text; wanted real"),
        (None, 1.0, "no numbers"),
    ],
)
def test_what_cannot_be_compared_is_told(got, want, message):
    with pytest.raises(compare.UnlikeError, match=message):
        compare.apart(got, want)


def test_a_vector_may_have_either_sign_each_by_itself():
    v = np.array([[1.0, 0.0], [0.0, 1.0]])
    assert compare.up_to_sign(v * [[1], [-1]], v) == 0.0
    assert compare.up_to_sign(-v + [[0.0, 0.25], [0.0, 0.0]], v) == 0.25


def test_vectors_of_either_sign_that_are_no_numbers_are_the_same_or_far():
    v, blank = np.eye(2), np.full((2, 2), np.nan)
    assert compare.up_to_sign(blank, blank) == 0.0
    assert not compare.up_to_sign(blank, v) <= 1.0
    assert not compare.up_to_sign(np.where(v == 1.0, np.inf, v), v) <= 1.0


@pytest.mark.parametrize("got", [[1, 2], np.array([1, 2], np.uint8), np.array([1, 2], np.float32)])
def test_a_result_is_passed_on_in_double_precision(got):
    made = compare.doubles(got, np.zeros(2))
    assert made.dtype == np.float64 and made.tolist() == [1.0, 2.0]
    assert compare.doubles(got, np.zeros(2, complex)).dtype == np.complex128
    one, two = compare.doubles((got, True), (np.zeros(2), 0.0))
    assert one.dtype == two.dtype == np.float64
    with pytest.raises(compare.UnlikeError):
        compare.doubles(got, np.zeros(3))


def test_values_are_told_in_one_line():
    assert texts.value(np.pi) == "3.141592654"
    assert texts.value(np.eye(2)) == "[[1, 0], [0, 1]]"
    assert texts.value(np.zeros((10, 3, 3))) == "an array of shape (10, 3, 3)"
    assert texts.given(("axis", "angle"), (np.array([0.0, 0.0, 1.0]), 2)) == "axis = [0, 0, 1], angle = 2"
    assert texts.value(np.array([1.0, -1e-17, -0.0, 1e-7])) == "[1, 0, 0, 1e-07]"
    assert texts.value(np.array([np.nan, np.inf, 2.0 + 1j])) == "[nan+0j, inf+0j, 2+1j]"
    assert "\n" not in texts.value(np.random.default_rng(0).random((4, 4)))


def test_of_a_batch_the_worst_entry_is_told():
    want = np.tile(np.eye(3), (20, 1, 1))
    got = want.copy()
    got[7, 1, 1] = 5.0
    wanted, came = texts.beside(got, want)
    assert wanted == "[7] [[1, 0, 0], [0, 1, 0], [0, 0, 1]]"
    assert came == "[7] [[1, 0, 0], [0, 5, 0], [0, 0, 1]]"
    got[11] = np.nan
    assert texts.beside(got, want)[1].startswith("[11] [[nan")
    wanted, came = texts.beside((1.0, got), (2.0, want))
    assert wanted.startswith("2; [11]") and came.startswith("1; [11]")


def test_of_a_batch_of_truth_values_or_unsigned_integers_too():
    want = np.ones(20, bool)
    assert texts.beside(np.arange(20) != 3, want) == ("[3] True", "[3] False")
    got = np.full(20, 7, np.uint8)
    got[5] = 9
    assert texts.beside(got, np.full(20, 8, np.uint8))[0].startswith("[0]")
    assert texts.beside(np.arange(20, dtype=np.uint8), np.full(20, 1, np.uint8))[1].startswith("[19]")


def test_what_differs_little_is_told_with_more_digits():
    assert texts.beside(np.array([1.0, 2.00000007]), np.array([1.0, 2.0])) == ("[1, 2]", "[1, 2.00000007]")
    assert texts.beside(1.0 + 1e-9, 1.0) == ("1", "1.000000001")
    assert texts.beside(1.0 + 1e-14, 1.0) == ("1", "1.00000000000001")
