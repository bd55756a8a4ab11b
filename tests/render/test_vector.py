"""SVG and PDF files, read back: sizes, places of what is drawn, images, texts, metadata, the same bytes."""

import base64
import hashlib
import io
import json
import os
import re
import subprocess
import sys
import zlib
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from lietool.render import compose, context, draw, labels, solids, style, vector
from lietool.render.camera import Camera
from lietool.render.scene import Arrow, Label, Lines, Picture, Points, Surface, View
from lietool.render.theme import BOOK, DARK, PRINT, THEMES

SVG = "{http://www.w3.org/2000/svg}"
SIZE = (120, 90)
# So that a page unit is a point.
INCHES = (120.0 / 72.0, 90.0 / 72.0)
ABOUT = {"Title": "A picture", "Software": "lietool 1", "command": "slerp", "parameters": '{"t": 0.5}'}
FLAT = (
    Surface([(10, 10, 0), (40, 10, 0), (40, 30, 0)], [[0, 1, 2]], style.AFTER, material="flat"),
    Lines([(5, 50, 0), (60, 50, 0)], style.ALGEBRA, 3.0, dash=(6.0, 4.0)),
    Lines([(70, 20, 0), (90, 20, 0), (90, 40, 0), (70, 20, 0)], style.INK, 2.0, 0.5),
    Points([(100, 60, 0)], style.PAPER, 8.0, rim=style.MARK, shaded=False),
    Arrow((20, 70, 0), (60, 80, 0), style.GROUP, 1.0),
    Label("$q_0$", (80, 70, 0), style.MARK, 16.0),
    Label("plain text", (5, 5, 0), style.INK, 10.0, anchor="lb", halo=False),
)


def flat(*records) -> Picture:
    return Picture((View(records or FLAT),), SIZE)


def solid(*under) -> Picture:
    vertices, faces, normals = solids.sphere(0.8)
    ball = Surface(vertices, faces, style.ALGEBRA, normals)
    view = View((ball, Label("$S^2$", (0, 0, 0), style.INK, 12.0)), Camera(), (60.0, 30.0, 60.0, 60.0))
    return Picture((View(under), view, View((Lines([(60, 60, 0), (120, 60, 0)], style.MARK, 2.0),))), SIZE)


def svg(picture: Picture, **options) -> ElementTree.Element:
    return ElementTree.fromstring(vector.write(picture, "svg", **({"inches": INCHES} | options)))


def paths(root: ElementTree.Element) -> list[tuple[str, np.ndarray]]:
    """Style and corners, y down, of every path that is drawn."""
    drawn = [e for e in root.iter(f"{SVG}path") if "style" in e.attrib]
    return [
        (e.attrib["style"], np.array(re.findall(r"-?[\d.]+(?:e-?\d+)?", e.attrib["d"]), float).reshape(-1, 2))
        for e in drawn
    ]


def images(root: ElementTree.Element) -> list[tuple[np.ndarray, np.ndarray]]:
    """Pixels of every image, and its left, upper, right and lower edge."""
    found = []
    for e in root.iter(f"{SVG}image"):
        data = base64.b64decode(e.attrib["{http://www.w3.org/1999/xlink}href"].partition(",")[2])
        with Image.open(io.BytesIO(data)) as image:
            # Written upside down, and turned by its transform.
            assert e.attrib["transform"].startswith("scale(1 -1)")
            pixels = np.array(image)[::-1]
        x, y, w, h = (float(e.attrib[name]) for name in ("x", "y", "width", "height"))
        found.append((pixels, np.array([x, -y, x + w, -y + h])))
    return found


class TestSvg:
    def test_size(self):
        root = svg(flat(), inches=(8.5 / 2.54, 6.0 / 2.54))
        assert root.attrib["width"] == f"{8.5 / 2.54 * 72:.6f}pt"
        assert root.attrib["viewBox"].split()[2:] == ["240.944882", "170.07874"]

    def test_what_is_drawn_and_where(self):
        (paper, ground), (fill, corners), *rest = paths(svg(flat()))
        assert f"fill: {style.PAPER}" in paper
        assert ground.min(axis=0).tolist() == [0, 0] and ground.max(axis=0).tolist() == [120, 90]
        assert f"fill: {style.AFTER}" in fill and "stroke" not in fill
        assert {tuple(c) for c in corners.tolist()} == {(10, 80), (40, 80), (40, 60)}
        (dashed, line), (half, ring), (rim, outer), (dot, inner), (arrow, silhouette), *_ = rest
        assert "stroke-width: 3" in dashed and "stroke-linecap: round" in dashed and "fill: none" in dashed
        dash = np.array(re.findall(r"stroke-dasharray: ([\d.]+),([\d.]+)", dashed)[0], float)
        assert dash[0] / dash[1] == pytest.approx(1.5, abs=1e-3) and dash[0] == pytest.approx(6.0, rel=0.1)
        assert line.tolist() == [[5, 40], [60, 40]]
        assert "stroke-opacity: 0.3" in half and ring[0].tolist() == [70, 70]
        assert f"fill: {style.MARK}" in rim and np.ptp(outer, axis=0) == pytest.approx([16, 16])
        assert f"fill: {style.PAPER}" in dot and outer.mean(axis=0) == pytest.approx([100, 30], abs=0.5)
        assert np.ptp(inner, axis=0) == pytest.approx([12.48, 12.48])
        assert f"fill: {style.GROUP}" in arrow and [60, 10] in silhouette.tolist()

    def test_labels_are_type_where_the_picture_has_them(self):
        data = vector.write(flat(), "svg", inches=INCHES).decode()
        assert "<!-- $q_0$ -->" in data and "<!-- plain text -->" in data
        root = ElementTree.fromstring(data)
        groups = [g for g in root.iter(f"{SVG}g") if g.attrib.get("transform", "").startswith("translate")]
        assert len(groups) == 2
        placed = draw.render(flat()).labels
        for group, label in zip(groups, placed, strict=True):
            (x, base), (scale, flip) = (
                np.array(pair.split(), float)
                for pair in re.findall(r"\(([-\d. e]+)\)", group.attrib["transform"])
            )
            corners, _ = text_path(label.text)
            ink = np.concatenate([corners.min(axis=0), corners.max(axis=0)]) * [scale, flip, scale, flip]
            found = np.array([x + ink[0], base + ink[3], x + ink[2], base + ink[1]])
            # The ink of the picture lies on whole pixels.
            assert found == pytest.approx(np.array(label.box), abs=1.3)

    def test_a_halo_is_under_its_type(self):
        root = svg(flat(Label("$x$", (60, 45, 0), style.INK, 16.0)))
        strokes = [words for words, _ in paths(root) if f"stroke: {style.PAPER}" in words]
        widths = [float(re.findall(r"stroke-width: ([\d.]+)", words)[0]) for words in strokes]
        assert len(widths) == 2 and widths == sorted(widths, reverse=True)
        assert not [
            w for w, _ in paths(svg(flat(Label("$x$", (60, 45, 0), style.INK, 16.0, halo=False))))[1:]
        ]

    def test_what_it_says_of_itself(self):
        root = svg(flat(), about=ABOUT)
        title = root.find(f"{SVG}title")
        assert title is not None and title.text == "A picture"
        text = "".join(root.itertext())
        assert json.dumps({k: ABOUT[k] for k in ("command", "parameters")}) in text and "lietool 1" in text
        assert "date" not in ElementTree.tostring(root, "unicode")

    @pytest.mark.parametrize("theme", THEMES.values(), ids=THEMES)
    def test_themes(self, theme):
        (paper, _), (fill, _), (line, _), *_ = paths(svg(flat(), theme=theme))
        assert f"fill: {theme.hex(style.PAPER)}" in paper and f"fill: {theme.hex(style.AFTER)}" in fill
        width = float(re.findall(r"stroke-width: ([\d.]+)", line)[0])
        assert width == pytest.approx(3.0 * theme.widths) and (theme is not PRINT or width > 3.0)

    def test_the_page_is_in_the_middle_of_another_shape(self):
        _, (_, corners), *_ = paths(svg(flat(), inches=(2.0 * INCHES[0], INCHES[1])))
        assert corners.min(axis=0) == pytest.approx([70, 60])


def text_path(text: str) -> tuple[np.ndarray, np.ndarray]:
    with labels.typesetting():
        from matplotlib.font_manager import FontProperties
        from matplotlib.textpath import text_to_path

        corners, codes = text_to_path.get_text_path(FontProperties(family=labels.FONT), text, ismath=True)
    return np.array(corners), np.array(codes)


class TestSolids:
    def test_an_image_of_enough_dots_where_the_view_is(self):
        for dpi in (150.0, 300.0):
            ((pixels, edges),) = images(svg(solid(), dpi=dpi))
            # 0.8 of 3 units of height, on 60 page units, a little more by perspective.
            assert edges[2] - edges[0] == pytest.approx(60.0 * 1.6 / 3.0, abs=0.6)
            assert (edges[:2] + edges[2:]) / 2.0 == pytest.approx([90.0, 30.0], abs=0.6)
            assert len(pixels) / (edges[3] - edges[1]) * 72.0 == pytest.approx(dpi, rel=0.01)
            assert pixels[0, 0, 3] == 0 and pixels[len(pixels) // 2, len(pixels) // 2, 3] == 255

    def test_it_looks_as_in_the_picture(self):
        # With as many dots as the picture has pixels, and nothing under it, each of them is the same.
        for theme in (BOOK, DARK):
            ((pixels, edges),) = images(svg(solid(), dpi=72.0, theme=theme))
            left, top, right, low = np.rint(edges).astype(int)
            views = solid().views
            alone = Picture((View(views[1].records[:1], views[1].camera, views[1].box),), SIZE)
            expected = draw.render(alone, theme=theme).image[top:low, left:right].astype(float)
            alpha = pixels[..., 3:] / 255.0
            seen = pixels[..., :3] * alpha + theme.srgb(style.PAPER) * (1.0 - alpha)
            assert np.abs(seen - expected).max() <= 1.01

    def test_the_order_of_the_views_is_kept_and_labels_are_on_top(self):
        band = Surface(
            [(60, 0, 0), (120, 0, 0), (120, 90, 0), (60, 90, 0)],
            [[0, 1, 2], [0, 2, 3]],
            style.BAND,
            material="flat",
        )
        root = svg(solid(band))
        kinds = [
            e.tag.removeprefix(SVG) for e in root.iter() if "style" in e.attrib or "href" in str(e.attrib)
        ]
        drawn = [kind for kind in kinds if kind in ("path", "image", "use")]
        # Paper, band, the ball, the line over it, the halo of its label and the label.
        assert drawn == ["path", "path", "image", "path", "path", "path", "use", "use"]

    def test_what_is_lit_on_a_page_is_an_image_too(self):
        ((pixels, edges),) = images(svg(flat(Points([(30, 40, 0)], style.MARK, 10.0))))
        assert (edges[:2] + edges[2:]) / 2.0 == pytest.approx([30.0, 50.0], abs=0.3)
        assert np.ptp(pixels[len(pixels) // 2, :, 0].astype(int)) > 60

    def test_only_what_is_lit_needs_a_renderer(self, monkeypatch):
        def none(*_: object) -> None:
            raise context.NoRendererError({"osmesa": "not there"})

        monkeypatch.setattr(context, "get", none)
        for kind in ("svg", "pdf"):
            assert vector.write(flat(), kind, inches=INCHES)
            with pytest.raises(context.NoRendererError):
                vector.write(solid(), kind, inches=INCHES)


class TestPdf:
    def data(self, picture: Picture, **options) -> bytes:
        return vector.write(picture, "pdf", **({"inches": INCHES} | options))

    def content(self, data: bytes) -> str:
        """The longest stream of text: what the page draws."""
        streams = re.findall(rb"stream\r?\n(.*?)endstream", data, re.DOTALL)
        texts = []
        for stream in streams:
            try:
                texts.append(zlib.decompress(stream).decode("ascii"))
            except (zlib.error, UnicodeDecodeError):
                continue
        return max((text for text in texts if " Tf" in text), key=len)

    def test_header_and_page(self):
        data = self.data(flat(), inches=(8.5 / 2.54, 6.0 / 2.54))
        assert data.startswith(b"%PDF-1.") and data.rstrip().endswith(b"%%EOF")
        box = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", data)
        assert [float(side) for side in box[0]] == pytest.approx([240.944882, 170.078740], abs=1e-5)

    def test_paths_and_type(self):
        content = self.content(self.data(flat()))
        assert re.search(r"\n3 w \[ [\d.]+ [\d.]+ \] 0 d [^\n]*\s/DeviceRGB cs\s5 50 m\s60 50 l\s+S", content)
        assert re.search(r"40 10 m\s40 30 l\s10 10 l\sh\s+f", content)
        # Each letter of both labels.
        assert content.count(" Tj") == len("q0") + len("plain text")

    def test_type_is_where_svg_has_it(self):
        label = Label("$q_0$", (80, 70, 0), style.MARK, 16.0)
        root = svg(flat(label))
        (transform,) = [
            g.attrib["transform"]
            for g in root.iter(f"{SVG}g")
            if g.attrib.get("transform", "").startswith("translate")
        ]
        x, base = np.array(re.findall(r"translate\(([-\d. e]+)\)", transform)[0].split(), float)
        content = self.content(self.data(flat(label)))
        (places,) = re.findall(r"1 0 -?0 1 (\S+) (\S+) cm\sBT\s\S+ (\S+) Td", content)
        left, height, risen = np.array(places, float)
        height += risen
        assert left == pytest.approx(x, abs=1e-3)
        # Matplotlib sets type in SVG up to a hundredth of its size too high; so do we in PDF, to be alike.
        assert 0.0 <= base - (90.0 - height) <= 0.01 * 16.0

    def test_what_it_says_of_itself(self):
        data = self.data(flat(), about=ABOUT)
        assert b"/Title (A picture)" in data and b"/Creator (lietool 1)" in data and b"slerp" in data
        assert b"Date" not in data

    def test_fonts_are_whole_ones(self):
        data = self.data(flat())
        assert b"/Type0" in data.replace(b" ", b"") and b"/Type3" not in data.replace(b" ", b"")

    def test_images(self):
        data = self.data(solid(), dpi=200.0)
        sizes = re.findall(rb"/Height (\d+)|/Width (\d+)", data)
        assert data.count(b"/SMask") == 1
        assert max(int(a or b) for a, b in sizes) == pytest.approx(60.0 * 1.6 / 3.0 * 200.0 / 72.0, abs=3)


@pytest.mark.parametrize("kind", ["svg", "pdf"])
def test_the_same_picture_is_the_same_file(kind, tmp_path):
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); sys.path.insert(0, sys.argv[1] + '/tests/render')\n"
        "import hashlib; from lietool.render import vector; from test_vector import flat, INCHES, ABOUT\n"
        f"print(hashlib.sha256(vector.write(flat(), {kind!r}, inches=INCHES, about=ABOUT)).hexdigest())"
    )
    root = str(Path(__file__).resolve().parents[2])
    found = {
        subprocess.run(
            [sys.executable, "-c", code, root],
            env=os.environ | {"PYTHONHASHSEED": seed, "SOURCE_DATE_EPOCH": epoch, "TZ": zone},
            capture_output=True,
            text=True,
            check=True,
            timeout=120,
        ).stdout.strip()
        for seed, epoch, zone in (("1", "0", "UTC"), ("2", "86400", "Asia/Tokyo"))
    }
    found.add(hashlib.sha256(vector.write(flat(), kind, inches=INCHES, about=ABOUT)).hexdigest())
    assert len(found) == 1


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"inches": (0.0, 1.0)}, "must be above 0"),
        ({"inches": (np.nan, 1.0)}, "must be above 0"),
        ({"dpi": np.inf}, "must be above 0"),
    ],
)
def test_a_size_that_is_none_is_refused(options, words):
    with pytest.raises(ValueError, match=words):
        vector.write(flat(), "svg", **({"inches": INCHES} | options))


def test_another_kind_is_refused():
    with pytest.raises(ValueError, match="kind must be svg or pdf; got 'eps'"):
        vector.write(flat(), "eps", inches=INCHES)  # type: ignore[arg-type]


def test_too_many_dots_are_refused():
    with pytest.raises(ValueError, match=r"draw\.render: size must be 1 to 20000"):
        vector.write(solid(), "pdf", inches=(200.0, 150.0))


def test_labels_that_move_go_where_the_picture_has_them():
    line = Lines([(0, 45, 0), (120, 45, 0)], style.INK, 2.0)
    label = Label("$x$", (60, 45, 0), style.INK, 12.0, room=40.0)
    picture = flat(line, label)
    ((_, glyphs, point),) = compose.located(picture, 1.0, labels.Store())
    assert abs(point[1] - 45.0) > 4.0
    root = svg(picture)
    (transform,) = [
        g.attrib["transform"]
        for g in root.iter(f"{SVG}g")
        if g.attrib.get("transform", "").startswith("translate")
    ]
    _, base = np.array(re.findall(r"translate\(([-\d. e]+)\)", transform)[0].split(), float)
    middle = 90.0 - base + glyphs.coverage.shape[0] / 2.0 - glyphs.baseline
    assert middle == pytest.approx(point[1], abs=0.1)
