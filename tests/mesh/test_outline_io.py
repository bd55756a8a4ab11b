"""Outlines from files: each format, curves within the tolerance, transforms and units, every refusal."""

import re

import numpy as np
import pytest

from lietool.mesh import outline, outline_io

SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


@pytest.fixture
def read(tmp_path):
    def write_and_read(name, contents, **options):
        file = tmp_path / name.partition("#")[0]
        file.write_bytes(contents if isinstance(contents, bytes) else contents.encode())
        return outline_io.read(tmp_path / name, **options)

    return write_and_read


def svg(body, attributes='viewBox="0 0 100 100"'):
    return f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>\n{body}\n</svg>'


class TestTables:
    @pytest.mark.parametrize(
        "text",
        [
            "0,0\n1,0\n1,1\n0,1\n",
            "x,y\n0,0\n1,0\n1,1\n0,1\n0,0\n",
            "0;0\n1;0\r\n1;1\n\n0;1",
            "# made by hand\n0 0\n1\t0 # corner\n 1 1\n0  1",
            "\ufeff0.0, 0.0\n1e0, 0\n1, 1\n1, 1\n0, 1",
        ],
    )
    def test_columns(self, read, text):
        np.testing.assert_array_equal(read("a.csv", text), SQUARE)

    def test_points(self, read):
        np.testing.assert_array_equal(read("a.json", "[[0, 0], [1, 0], [1, 1], [0, 1.0], [0, 0]]"), SQUARE)


class TestDrawings:
    def test_y_is_turned_up(self, read):
        points = read("a.svg", svg('<polygon points="0,0 10,0 10,5"/>'))
        np.testing.assert_allclose(points, [(0, 0), (10, 0), (10, -5)], atol=1e-12)

    def test_transforms(self, read):
        body = '<g transform="translate(5,7)"><rect width="10" height="4" transform="rotate(90)"/></g>'
        points = read("a.svg", svg(body))
        expected = {(5.0, -7.0), (5.0, -17.0), (1.0, -17.0), (1.0, -7.0)}
        assert {tuple(p) for p in points.round(9).tolist()} == expected

    def test_units(self, read):
        points = read("a.svg", svg('<rect width="1in" height="25.4mm"/>', 'width="10in" height="10in"'))
        np.testing.assert_allclose(np.ptp(points, axis=0), [96.0, 96.0], rtol=1e-6)

    @pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-5])
    def test_curves_within_the_tolerance(self, read, tolerance):
        points = read("a.svg", svg('<circle r="5" cx="3" cy="4"/>'), tolerance=tolerance)
        middles = 0.5 * (points + np.roll(points, -1, axis=0))
        for p in (points, middles):
            off = np.abs(np.hypot(p[:, 0] - 3.0, p[:, 1] + 4.0) - 5.0)
            # An arc is cubic curves first, which are 1e-5 or so off by themselves.
            assert off.max() < 10.0 * tolerance + 5e-4
        assert len(points) < 8.0 / np.sqrt(tolerance)

    def test_each_kind_of_segment(self, read):
        data = "M0 0 h10 v5 l-1,1 q 2 2 0 4 t 0 4 c 0 3 -4 3 -4 0 s -3 -4 -4 0 a1 2 30 01-1-5 L0 5z"
        points = read("a.svg", svg(f'<path d="{data}"/>'))
        assert len(points) > 60
        for corner in [(0, 0), (10, 0), (10, -5), (9, -6), (9, -10), (9, -14), (5, -14), (1, -14), (0, -9)]:
            assert np.hypot(*(points - corner).T).min() < 1e-9

    def test_one_of_several_by_its_id(self, read):
        text = svg('<rect id="a" width="1" height="1"/><rect id="b" x="5" width="3" height="1"/>')
        assert outline.area(read("d.svg#b", text)) == pytest.approx(-3.0)

    def test_holes_are_filled_when_asked(self, read):
        text = svg('<path d="M0 0h9v9h-9z M2 2h1v1h-1z"/>')
        assert abs(outline.area(read("d.svg", text, outer=True))) == pytest.approx(81.0)

    def test_what_cannot_be_seen_is_left_out(self, read):
        body = '<defs><rect id="x" width="9" height="9"/></defs><rect width="2" height="2" display="none"/>'
        assert len(read("d.svg", svg(body + '<path d="M0 0h1v1z"/>'))) == 3


REFUSED = [
    (
        "a.svg",
        svg('<path d="M0 0 L10 x 5"/>'),
        "a drawing whose paths are whole and finite; got 'M0 0 L10 x 5' in line 2",
    ),
    ("a.svg", svg('<path d="M0 0\nL10 5 5"/>'), "paths are whole and finite; got 'L10 5 5' in line 3"),
    ("a.svg", svg('<path d="M0 0 L nan 1"/>'), "paths are whole"),
    ("a.svg", svg('<path d="10 10 L 1 1"/>'), "paths are whole"),
    ("a.svg", svg('<path d="M0 0 A 5 5 0 2 1 3 3"/>'), "paths are whole"),
    ("a.svg", svg('<path d="M0 0 L 5 5 z 3"/>'), "paths are whole"),
    ("a.svg", svg('<path d="M0 0 h1e999 v1z"/>'), "whole and finite; got 'M0 0 h1e999 v1z' in line 2"),
    (
        "a.svg",
        svg('<path d="M0 0h9v1z" transform="scale(1e200)"/>'),
        "a drawing of finite coordinates; got others",
    ),
    ("a.svg", svg('<path d=""/>'), "a drawing of a closed shape; got none"),
    ("a.svg", svg("<text>moo</text>"), "Text must be turned into paths"),
    ("a.svg", svg('<line x2="5"/>'), "a drawing of a closed shape; got none"),
    ("a.svg", svg('<path d="M0 0h1v1z" transform="scale(0)"/>'), "a closed shape; got none"),
    ("a.svg#b", svg('<rect id="a" width="1" height="1"/>'), "a shape of id 'b'; got none"),
    (
        "a.svg",
        svg('<path d="M0 0h9v9h-9zM2 3h1v1z"/>'),
        "without holes; got a hole in <path>, near x = 2, y = 3",
    ),
    (
        "a.svg",
        svg('<rect width="9" height="9"/><circle id="eye" cx="3" cy="3" r="1"/>'),
        "got <circle id='eye'> inside <rect>",
    ),
    (
        "a.svg",
        svg('<rect width="2" height="2"/><rect id="b" x="4" width="1" height="1"/>'),
        "one shape; got <rect> and, beside it, <rect id='b'> near x = 4, y = 0",
    ),
    ("a.svg", svg('<path d="M0 0L10 10V0L0 10z"/>'), "got edges 0-1 and 2-3 that meet near (5, -5)"),
    ("a.svg", svg('<path d="M0 0L10 10V0'), "XML; got not well-formed (invalid token) in line 3"),
    ("a.svg", "<html/>", "a drawing, <svg>; got <html>"),
    ("a.svg", "", "a file with something in it; got an empty one"),
    ("a.csv", " \n", "an empty one"),
    ("a.csv", "x,y\n", "a table of points; got no numbers"),
    ("a.csv", "0,0\n1,0\n1,a\n", "a table of numbers; got '1,a' in line 3"),
    ("a.csv", "0,0\n1,nan\n", "finite numbers; got '1,nan' in line 2"),
    ("a.csv", "0,0,0\n", "two columns, x and y; got 3 numbers in line 1"),
    ("a.csv", "0,0\n1,1\n", "n at least 3; got shape (2, 2)"),
    ("a.csv", "0,0\n1,0\n1,1\n1,0\n0,1", "point 1 again as point 3, (1, 0)"),
    ("a.csv", b"0,0\n\xff", "text in UTF-8; got byte 0xff in line 2"),
    ("a.json", "[[0,0],\n[1,0],\n[1,1]", "JSON; got expecting ',' delimiter in line 3"),
    ("a.json", "[[0,0],[1,NaN]]", "finite points; got [1, NaN] as point 1"),
    ("a.json", "[[0,0],[1,true]]", "points [x, y]; got [1, true] as point 1"),
    ("a.json", "[[0,0],[1,2,3]]", "points [x, y]; got [1, 2, 3] as point 1"),
    ("a.json", '{"a": 1}', "a list of points [x, y]; got a dict"),
    ("a.json", "[]", "got an empty list"),
    ("a.json", "[" * 100_000, "a list nested too deeply"),
    ("a.txt", "0,0", "a file .svg, .csv or .json; got .txt"),
    ("a", "0,0", "got no ending"),
]


@pytest.mark.parametrize(("name", "contents", "words"), REFUSED)
def test_refusals(read, name, contents, words):
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        read(name, contents)
    assert re.fullmatch(r"outline_io\.read: [^\n]*a[.\w]* must be [^\n]*", str(caught.value))


def test_no_such_file(tmp_path):
    with pytest.raises(ValueError, match=r"none\.csv must be a file; got none of that name"):
        outline_io.read(tmp_path / "none.csv")
    (tmp_path / "a.csv").mkdir()
    with pytest.raises(ValueError, match=r"a\.csv must be a file; got a folder"):
        outline_io.read(tmp_path / "a.csv")
    with pytest.raises(ValueError, match="tolerance between 0 and 1; got 0"):
        outline_io.read(tmp_path / "a.svg", tolerance=0.0)


def test_area_and_lengths():
    assert outline.area(np.array(SQUARE)) == 1.0
    assert outline.area(np.array(SQUARE[::-1]) + 1e6) == -1.0
    np.testing.assert_array_equal(outline.lengths(np.array(SQUARE)), np.ones(4))


def test_the_narrowest_place():
    neck = np.array([(0, 0), (4, 0), (4, 1), (2, 0.1), (0, 1)], float)
    distance, corner = outline.narrowest(neck)
    assert distance == pytest.approx(0.1)
    np.testing.assert_array_equal(corner, (2, 0.1))


def test_large_outlines_are_looked_at_in_parts(monkeypatch):
    monkeypatch.setattr(outline, "_PAIRS", 64)
    t = 2.0 * np.pi * (np.arange(40) + 0.5) / 40
    points = np.stack([np.cos(t), np.sin(2.0 * t)], axis=1)
    with pytest.raises(ValueError, match=r"edges 9-10 and 29-30 that meet near"):
        outline.check("f", "P", points)
    assert outline.check("f", "P", np.stack([np.cos(t), np.sin(t)], axis=1)).shape == (40, 2)
