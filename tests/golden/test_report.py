"""The report of a comparison: what an entry says, and what the page makes of it."""

import io
import re

import numpy as np
import pytest
from PIL import Image

from lietool.golden import compare, elements, explain, report
from lietool.golden.compare_numbers import numbers as differing

GREY = np.full((40, 60, 3), 200, np.uint8)


def changed(by: int = 90, box: tuple[slice, slice] = np.s_[10:20, 30:45]) -> np.ndarray:
    image = GREY.copy()
    image[box] -= np.uint8(by)
    return image


def page(*entries: report.Entry, **options: str) -> str:
    return report.build(entries, title="Toys", about={"renderer": "llvmpipe"}, **options)


@pytest.mark.parametrize(
    ("actual", "kind", "word"),
    [
        (GREY.copy(), "passed", "equal"),
        (changed(1, np.s_[10:11, 30:32]), "changed", "passes"),
        (changed(), "failed", "differs"),
    ],
)
def test_an_entry_tells_the_same_from_what_passes_and_what_does_not(
    actual: np.ndarray, kind: str, word: str
) -> None:
    entry = report.entry("T1", expected=GREY, actual=actual)
    assert (entry.kind, entry.word) == (kind, word)
    assert (entry.actual is None) == (kind == "passed")
    assert (entry.ssim is not None) == (kind == "failed")
    assert bool(entry.blobs) == (kind != "passed")


def test_a_message_or_a_changed_number_fails_a_picture_that_is_the_same() -> None:
    assert report.entry("T1", expected=GREY, actual=GREY, messages=["other parameters"]).kind == "failed"
    entry = report.entry("T1", expected=GREY, actual=GREY, before={"x": 1.0}, after={"x": 1.1})
    assert entry.kind == "failed" and entry.differences[0].entry == "x" and entry.counted == 1


def test_the_tolerance_of_the_numbers_is_the_entry_s_own() -> None:
    near = {"before": {"x": 1.0}, "after": {"x": 1.0 + 5e-10}}
    entry = report.entry("T1", expected=GREY, actual=GREY, **near)
    assert entry.kind == "passed" and entry.nearest == ("x", pytest.approx(0.5))
    assert report.entry("T1", expected=GREY, actual=GREY, relative=1e-10, **near).kind == "failed"


def test_pictures_are_kept_to_the_bit_and_named_by_their_pixels() -> None:
    entry = report.entry("T1", expected=GREY, actual=changed(), after={"x": 1.0})
    assert entry.actual is not None
    with Image.open(io.BytesIO(entry.actual)) as picture:
        assert np.array_equal(np.array(picture), changed())
        assert report.picture_digest(np.array(picture)) == entry.digests[0]
    assert entry.digests[1] == report.numbers_digest({"x": np.float64(1.0)})
    # Of the same bytes, but another picture.
    assert report.picture_digest(GREY) != report.picture_digest(GREY.reshape(60, 40, 3))


def test_the_map_of_similarity_is_clear_where_nothing_differs() -> None:
    with Image.open(io.BytesIO(explain.similarity_png(GREY, changed()))) as picture:
        colours = np.array(picture.convert("RGBA"))
    assert (colours[:5, :20, 3] == 0).all() and (colours[10, 32:42, 3] > 200).any()


def test_the_worst_elements_of_a_number_come_first_and_are_named() -> None:
    before = {"vertices": np.zeros((30, 2)), "turn": np.arange(4.0), "ok": True}
    after = {"vertices": before["vertices"].copy(), "turn": before["turn"] + [0, 0, 0.5, 0], "ok": False}
    after["vertices"][12, 1], after["vertices"][3, 0] = -0.5, 0.25
    found = elements.worst(tuple(differing(before, after)), before, after)
    assert [(e.where, e.by) for e in found["vertices"]] == [("vertex 12, y", -0.5), ("vertex 3, x", 0.25)]
    assert [(e.where, e.expected, e.got) for e in found["turn"]] == [("[2]", 2.0, 2.5)]
    assert [(e.where, e.expected, e.got, e.by) for e in found["ok"]] == [("", True, False, None)]


def test_elements_that_are_not_finite_and_scalars_are_told() -> None:
    before, after = {"x": np.array([1.0, 2.0]), "s": 1.0}, {"x": np.array([1.0, np.nan]), "s": 2.0}
    found = elements.worst(tuple(differing(before, after)), before, after)
    assert found["x"][0].where == "[1]" and found["x"][0].by == np.inf
    assert (found["s"][0].where, found["s"][0].by) == ("", 1.0)
    assert elements.nearest(before, after, 1e-9) == ("x", np.inf)


def test_at_most_six_elements_are_listed_and_the_rest_counted() -> None:
    entry = report.entry(
        "T1", expected=GREY, actual=GREY, before={"x": np.zeros(50)}, after={"x": np.arange(50.0)}
    )
    assert [e.index for e in entry.elements["x"]] == [(i,) for i in range(49, 43, -1)]
    assert "49 elements differ, the worst:" in page(entry)


@pytest.mark.parametrize(
    ("entry", "index", "shape", "said"),
    [
        ("vertices_beside", (4, 0), (9, 3), "vertex 4, x"),
        ("steps.vertices", (2, 4, 1), (3, 9, 2), "[2] vertex 4, y"),
        ("vertices", (3,), (9,), "[3]"),
        ("vertices", (3, 3), (9, 4), "[3, 3]"),
        ("R", (1, 2), (3, 3), "[1, 2]"),
        ("angle", (), (), ""),
    ],
)
def test_an_element_is_a_vertex_where_the_rows_are_points(
    entry: str, index: tuple[int, ...], shape: tuple[int, ...], said: str
) -> None:
    assert elements.place(entry, index, shape) == said


def test_the_page_names_no_other_file_and_no_host() -> None:
    text = page(*(report.entry(n, expected=GREY, actual=a) for n, a in (("T1", GREY), ("T2", changed()))))
    assert not re.search(r"(src|srcset)=\"(?!data:)", text)
    addresses = set(re.findall(r"https?://[^\s'\")]+", text))
    assert addresses <= {"http://www.w3.org/2000/svg"}
    assert not re.search(r"<link[^>]+href=\"(?!data:)|@import|\bfetch\(|XMLHttpRequest|WebSocket", text)


def test_a_picture_that_is_equal_is_there_once() -> None:
    assert page(report.entry("T1", expected=GREY, actual=GREY)).count("data:image/png") == 1
    # Expected, actual, and the map of similarity.
    assert page(report.entry("T1", expected=GREY, actual=changed())).count("data:image/png") == 3


def test_texts_are_text_whatever_they_hold() -> None:
    bad = "<script>alert('a')</script>\"&"
    entry = report.entry(
        bad,
        expected=GREY,
        actual=changed(),
        title=bad,
        messages=[bad],
        because=bad,
        parameters={bad: bad},
        provenance=({bad: bad}, {"renderer": bad}),
        accept=bad,
        before={bad: bad},
        after={bad: "</script>"},
    )
    text = report.build([entry], title=bad, about={bad: bad}, notes=[bad], review=bad)
    assert "<script>alert" not in text and text.count("</script>") == 2


def test_the_page_says_numbers_and_headroom() -> None:
    entry = report.entry("T1", expected=GREY, actual=changed(), before={"x": 1.0}, after={"x": 2.0})
    text = page(entry)
    found = entry.comparison
    assert found is not None
    assert f"{found.over} of 8" in text and f"{found.over - 8} too many" in text
    assert f"−{abs(found.lowpass):.2f} of ±1.5" in text and f"largest dE {found.largest_delta_e:.1f}" in text
    assert "1e-09 allowed" in text and "+1" in text and "failed: differs" in text
    near = page(report.entry("T1", expected=GREY, actual=changed(20, np.s_[10:11, 30:33])))
    assert "3 of 8" in near and "5 more would pass" in near and "changed, within tolerance" in near


def test_what_is_not_the_same_on_both_sides_is_marked() -> None:
    made = {"renderer": "llvmpipe (LLVM 15)", "date": "1", "parameters": "{}"}
    text = page(report.entry("T1", expected=GREY, actual=GREY, provenance=(made, {**made, "renderer": "x"})))
    assert text.count('class="other"') == 1 and "llvmpipe (LLVM 15)</td><td>x</td>" in text


@pytest.mark.parametrize(
    ("expected", "actual", "pictures"),
    [(None, changed(), 1), (GREY, None, 1), (None, None, 0), (GREY, np.zeros((20, 30, 3), np.uint8), 2)],
)
def test_what_cannot_be_compared_is_shown_as_far_as_it_is_there(
    expected: np.ndarray | None, actual: np.ndarray | None, pictures: int
) -> None:
    entry = report.entry("T1", expected=expected, actual=actual, word="missing", messages=["no golden"])
    assert entry.kind == "failed" and entry.blobs == () and entry.ssim is None
    text = page(entry)
    assert text.count("data:image/png") == pictures and "failed: missing" in text
    assert ("There is no picture." in text) == (not pictures)


def test_only_what_was_drawn_can_be_marked() -> None:
    options = {"messages": ["wrong"], "accept": "lietool figures accept T1"}
    assert 'class="accept"' in page(report.entry("T1", expected=GREY, actual=changed(), **options))
    assert 'class="accept"' not in page(report.entry("T1", expected=GREY, actual=None, **options))
    assert 'class="accept"' not in page(report.entry("T1", expected=GREY, actual=GREY, accept="x"))


def test_names_must_differ() -> None:
    entry = report.entry("T1", expected=GREY, actual=GREY)
    with pytest.raises(ValueError, match=r"report\.build: entries must have names that differ; got T1"):
        page(entry, entry)


def test_the_page_is_the_same_each_time_and_its_marks_are_its_own() -> None:
    one, other = (page(report.entry("T1", expected=GREY, actual=changed(by))) for by in (90, 91))
    assert one == page(report.entry("T1", expected=GREY, actual=changed(90)))
    keys = [re.findall(r'data-report="(\w+)"', text) for text in (one, other)]
    assert keys[0] != keys[1] and len(keys[0][0]) == 16


def test_nothing_at_all_is_a_page() -> None:
    assert "Nothing was compared." in page()


def test_a_comparison_by_its_own_limits_is_kept() -> None:
    loose = compare.images(GREY, changed(), pixels=1000, lowpass=200)
    entry = report.entry("T1", expected=GREY, actual=changed(), comparison=loose, because="because")
    assert entry.kind == "changed" and "Looser than usual: because" in page(entry)
