"""Numbers to JSON and back to the last bit, and compared by their scale."""

import json
import math

import numpy as np
import pytest

from lietool.golden import compare_numbers, numbers

VALUES = {
    "array": np.random.default_rng(0).standard_normal((4, 2, 3))
    * 10.0 ** np.arange(-12, 12).reshape(4, 2, 3),
    "edges": np.array([0.0, -0.0, 5e-324, np.finfo(float).max, np.pi, 0.1, 1 / 3]),
    "empty": np.zeros((0, 3)),
    "integers": np.arange(6, dtype=np.int32).reshape(2, 3),
    "bytes": np.array([0, 255], np.uint8),
    "flags": np.array([[True], [False]]),
    "texts": np.array(["lock", "ξ"]),
    "single": np.float32([0.1, 3.0]),
    "nested": {"angle": 0.1, "count": 3, "name": 'θ "q"\n', "on": True, "deeper": {"x": 1e300}},
}


def test_everything_comes_back_with_its_bits_type_and_shape():
    back = numbers.loads(numbers.dumps(VALUES))
    assert list(back) == list(VALUES)
    for (name, value), (other, again) in zip(numbers.leaves(VALUES), numbers.leaves(back), strict=True):
        assert name == other
        if isinstance(value, np.ndarray):
            assert isinstance(again, np.ndarray)
            assert (again.dtype, again.shape) == (
                value.dtype,
                value.shape,
            ) and again.tobytes() == value.tobytes()
        else:
            assert type(again) is type(value) and again == value
    assert compare_numbers.numbers(VALUES, back, 0.0) == []


def test_the_text_is_strict_json_that_says_shape_and_type_and_is_always_the_same():
    text = numbers.dumps(VALUES)
    read = json.loads(text, parse_constant=lambda name: pytest.fail(name))
    assert read["integers"] == {"dtype": "int32", "shape": [2, 3], "data": [0, 1, 2, 3, 4, 5]}
    assert read["nested"]["count"] == 3
    assert numbers.dumps(numbers.loads(text)) == text
    assert read == numbers.plain(VALUES)


def test_scalars_of_numpy_and_sequences_are_what_they_stand_for():
    values = {"a": np.float64(0.5), "b": np.int64(2), "c": (1.0, 2.0), "d": ["x", "y"], "e": np.array(3.0)}
    back = numbers.loads(numbers.dumps(values))
    assert back["a"] == 0.5 and back["b"] == 2 and back["e"] == 3.0
    assert compare_numbers.numbers(values, back) == []


def test_nan_and_infinity_are_written_as_texts_and_listed():
    values = {"x": np.array([[1.0, np.nan], [np.inf, -np.inf]]), "y": math.inf, "in": {"z": 1.0}}
    text = numbers.dumps(values)
    assert json.loads(text)["x"]["data"] == [1.0, "NaN", "Infinity", "-Infinity"]
    back = numbers.loads(text)
    np.testing.assert_array_equal(back["x"], values["x"])
    assert back["y"] == math.inf
    assert numbers.nonfinite(values) == ["x[0, 1] is nan", "y is inf"]
    assert numbers.nonfinite(VALUES) == []


@pytest.mark.parametrize(
    ("values", "wanted"),
    [
        ({"z": 1j}, "z must be floats"),
        ({"a": {"b": None}}, "a.b must be floats"),
        ({"a": [1.0, "x"]}, "a must be .* got a sequence of unlike things"),
        ({"a": [[1.0], [1.0, 2.0]]}, "a must be .* got a sequence of unlike things"),
        ({"a": np.array([object()])}, "a must be"),
        ({"a": 2**70}, "a must be"),
        ({3: 1.0}, "keys must be texts"),
        ({"a": {"data": 1.0}}, "keys must be texts"),
        ({"": 1.0}, "keys must be texts"),
    ],
)
def test_what_cannot_be_kept_is_refused_by_name(values, wanted):
    with pytest.raises(ValueError, match=wanted):
        numbers.dumps(values)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "3",
        '{"a": NaN}',
        '{"a": null}',
        '{"a": {"dtype": "float64", "shape": [2], "data": [1.0]}}',
        '{"a": {"dtype": "object", "shape": [1], "data": [1.0]}}',
        '{"a": {"dtype": "nonsense", "shape": [1], "data": [1.0]}}',
        '{"a": {"dtype": "float64", "shape": [1], "data": ["one"]}}',
        '{"a": {"dtype": "uint8", "shape": [1], "data": [300]}}',
        '{"a": {"dtype": "float64", "shape": [1], "data": null}}',
        numbers.dumps(VALUES)[:-40],
    ],
)
def test_what_was_not_written_here_is_refused(text):
    with pytest.raises(ValueError, match=r"numbers.loads: text must be the JSON that dumps writes; got"):
        numbers.loads(text)


def change(value, by, relative=1e-9):
    array = np.array(value, float)
    moved = array.copy()
    moved[0] += by
    return compare_numbers.numbers({"a": array}, {"a": moved}, relative)


def test_the_limit_is_a_part_of_the_largest_expected_magnitude():
    assert change([0.0, -2.0], 1.9e-9) == []
    (found,) = change([0.0, -2.0], 2.1e-9)
    assert (found.entry, found.kind, found.index, found.count) == ("a", "value", (0,), 1)
    assert found.by == pytest.approx(2.1e-9) and found.allowed == 2e-9
    assert change([0.0, -2.0], 1.9e-7, 1e-7) == []
    # By what was expected: a number that grew without bounds does not excuse itself.
    assert change([1.0, 1.0], 1e12)


def test_what_is_zero_but_for_rounding_is_compared_at_the_smallest_scale():
    assert change([0.0], 6e-17) == [] and change([3e-17], 5e-16) == [] and change([0.0], 0.9e-12) == []
    assert change([0.0], 1.1e-12) and change([1e-3], 1.1e-12)


def test_all_but_floats_must_be_exactly_the_same():
    before = {"n": 1, "big": 2**53, "t": "a", "on": True, "i": np.arange(3)}
    after = {"n": 2, "big": 2**53 + 1, "t": "b", "on": False, "i": np.array([0, 1, 3])}
    said = [str(found) for found in compare_numbers.numbers(before, after)]
    assert said[0] == "n: expected 1, got 2" and said[2] == "t: expected 'a', got 'b'"
    assert said[4] == "i[2]: expected 2, got 3" and len(said) == 5


def test_missing_extra_reshaped_and_retyped_entries_are_differences():
    before = {"gone": 1.0, "in": {"a": np.zeros(4), "b": 1, "c": np.zeros(2)}}
    after = {"in": {"a": np.zeros((2, 2)), "b": 1.0, "c": np.zeros(2)}, "new": 1}
    found = compare_numbers.numbers(before, after)
    assert [(x.entry, x.kind) for x in found] == [
        ("gone", "missing"),
        ("in.a", "shape"),
        ("in.b", "kind"),
        ("new", "extra"),
    ]
    assert [str(x) for x in found] == [
        "gone: missing",
        "in.a: shape was (4,), is (2, 2)",
        "in.b: kind was integers, is floats",
        "new: not in the golden",
    ]


def test_the_worst_element_is_named_and_the_others_counted():
    before = np.zeros((2, 3))
    after = np.array([[0.0, 1.0, 0.0], [0.0, -2.0, 0.0]])
    (found,) = compare_numbers.numbers({"a": before}, {"a": after})
    assert found.index == (1, 1) and found.by == 2.0 and found.count == 2
    assert (
        str(found) == "a[1, 1]: expected 0.0, got -2.0, off by 2 where 1e-12 is allowed (2 elements differ)"
    )


@pytest.mark.parametrize("got", [1.0, np.inf, -np.inf])
def test_nan_is_only_like_nan_and_infinity_only_like_itself(got):
    assert compare_numbers.numbers({"a": np.nan}, {"a": got})
    assert compare_numbers.numbers({"a": got}, {"a": np.nan})
    assert bool(compare_numbers.numbers({"a": np.inf}, {"a": got})) is (got != np.inf)
    assert compare_numbers.numbers({"a": got}, {"a": got}) == []
    assert compare_numbers.numbers({"a": np.nan}, {"a": np.nan}) == []


def test_an_infinity_does_not_widen_the_limit_of_its_array():
    before, after = np.array([np.inf, 1.0]), np.array([np.inf, 1.1])
    assert compare_numbers.numbers({"a": before}, {"a": after})[0].allowed == 1e-9


def test_negative_zero_is_zero():
    assert compare_numbers.numbers({"a": 0.0}, {"a": -0.0}, 0.0) == []
