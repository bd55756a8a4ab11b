"""The palette by numbers in every theme, and what a theme changes in a picture."""

from itertools import combinations, pairwise

import numpy as np
import pytest

from lietool.render import draw, marks, scene, style
from lietool.render.theme import BOOK, DARK, PRINT, THEMES, Mix, Theme, Tone

# Names and values of all colours of the style, those in tuples with their place: "AXES[0]".
COLORS = {name: value for name, value in vars(style).items() if isinstance(value, str) and name.isupper()} | {
    f"{name}[{i}]": color
    for name, value in vars(style).items()
    if isinstance(value, tuple) and name.isupper()
    for i, color in enumerate(value)
}
# Type is read, lines are seen; fills, rules and glass may be faint, for something else shows where they are.
TEXTS = [
    n for n in COLORS if "_TEXT" in n or n in ("INK", "MUTED", "GLASS_EDGE", "MARK", "WRONG", "GREYS[0]")
]
FAINT = ["PAPER", "RULE", "BAND", "BEFORE", "BETWEEN", "AFTER", "BONE", "GLASS", "GREYS[2]", "RAMP"]
FAINT += ["SHELLS", "SHELL_FILLS", "SHADOW", "EYE_WHITE", "PUPIL"]
LINES = [n for n in COLORS if n not in FAINT and n.partition("[")[0] not in FAINT]
# What is seen side by side, and is told apart by nothing but its colour.
SIDE_BY_SIDE = {
    "axes": style.AXES,
    "greys": style.GREYS,
    "shells": style.SHELLS,
    "fills": style.SHELL_FILLS,
    "stages": (style.BEFORE, style.BETWEEN, style.AFTER),
    "edges of stages": (style.BEFORE_EDGE, style.AFTER_EDGE),
    "routes": (style.ROUTE_1, style.ROUTE_2),
    "algebra, mark, group": (style.ALGEBRA, style.MARK, style.GROUP),
    "eyes": (style.EYE_WHITE, style.PUPIL),
    "wrong, right": (style.WRONG, style.RIGHT),
    "ramp": style.RAMP,
    "solid": marks.LETTER,
    "solid before": marks.LETTER_BEFORE[::2],
}


def luminance(theme: Theme, color: str) -> float:
    return float(theme.linear(color)[:3] @ (0.2126, 0.7152, 0.0722))


def contrast(theme: Theme, color: str) -> float:
    low, high = sorted(luminance(theme, c) for c in (color, style.PAPER))
    return (high + 0.05) / (low + 0.05)


def lightness(theme: Theme, color: str) -> float:
    """CIE L*, 0 to 100: what is left of a colour in grey."""
    y = luminance(theme, color)
    return 116 * y ** (1 / 3) - 16 if y > 0.008856 else 903.3 * y


@pytest.mark.parametrize("theme", THEMES.values(), ids=THEMES)
class TestPalette:
    def test_every_colour_has_a_value(self, theme):
        assert len(COLORS) > 40
        for name, color in COLORS.items():
            assert isinstance(color, Tone), name
            assert color.values.keys() == THEMES.keys(), name
            assert theme.srgb(color).shape == (3,), name

    @pytest.mark.parametrize("name", TEXTS)
    def test_type_can_be_read(self, theme, name):
        # The contrast that WCAG asks of text of any size.
        assert contrast(theme, COLORS[name]) >= 4.5

    @pytest.mark.parametrize("name", LINES)
    def test_lines_can_be_seen(self, theme, name):
        # In the book, hue helps where lightness alone is not enough.
        assert contrast(theme, COLORS[name]) >= (2.2 if theme is BOOK else 3.0)

    def test_rules_are_fainter_than_lines(self, theme):
        assert 1.3 < contrast(theme, style.RULE) < 2.2 > 1.08 < contrast(theme, style.BAND)


def test_in_print_everything_is_told_apart_without_hue():
    for name, colors in SIDE_BY_SIDE.items():
        levels = [lightness(PRINT, color) for color in colors]
        assert min(abs(a - b) for a, b in combinations(levels, 2)) >= 10.0, (name, levels)


def test_a_shape_on_its_way_comes_out_of_the_paper():
    """Before, between, after: where hue may be lost, the fills go one way, away from the paper."""
    for theme in (DARK, PRINT):
        levels = [lightness(theme, c) for c in (style.PAPER, style.BEFORE, style.BETWEEN, style.AFTER)]
        steps = np.diff(levels) * (1.0 if theme is DARK else -1.0)
        assert steps.min() > 1.0, (theme.name, levels)


def test_the_axes_keep_apart_in_grey():
    for theme in THEMES.values():
        levels = sorted(lightness(theme, color) for color in style.AXES)
        assert np.diff(levels).min() > 10, theme.name


class TestTheme:
    def test_the_book_is_the_text_of_a_colour(self):
        assert all(BOOK.hex(color) == str(color) for color in COLORS.values())

    def test_meanings_that_share_a_value_in_the_book_stay_apart(self):
        one, other = Tone("#111111", "#222222", "#333333"), Tone("#111111", "#444444", "#555555")
        assert [DARK.hex(c) for c in (one, other)] == ["#222222", "#444444"]
        assert [PRINT.hex(c) for c in (one, other)] == ["#333333", "#555555"]

    def test_a_value_of_ones_own_is_left_alone(self):
        assert {theme.hex("#123456") for theme in THEMES.values()} == {"#123456"}
        rows = np.array([[0.1, 0.2, 0.3, 0.4], [0.5, 0.6, 0.7, 0.8]])
        assert np.array_equal(BOOK.rgba(rows, 2), rows)
        assert np.array_equal(DARK.rgba(rows, 2)[:, :3], rows[:, :3])
        assert PRINT.rgba(rows, 2, 0.5)[:, 3].tolist() == [0.2, 0.4]

    def test_on_a_dark_ground_opacities_count_for_more(self):
        for theme in THEMES.values():
            found = theme.rgba(style.fade(style.INK, [0.0, 0.25, 1.0]), 3)[:, 3]
            assert found == pytest.approx([0.0, 0.25**theme.veil, 1.0])
        assert DARK.veil > BOOK.veil == PRINT.veil == 1.0

    def test_on_a_dark_ground_shadows_are_stronger(self):
        for theme in THEMES.values():
            found = theme.rgba(style.fade(style.SHADOW, [0.0, 0.25, 1.0]), 3, shadow=True)[:, 3]
            assert found == pytest.approx([0.0, 0.25**theme.shade, 1.0])
        assert DARK.shade < BOOK.shade == PRINT.shade == 1.0

    def test_linear_light(self):
        assert BOOK.linear("#ffffff").tolist() == [1, 1, 1, 1]
        assert BOOK.linear("#000000", 0.5).tolist() == [0, 0, 0, 0.5]
        # 0x80 of sRGB is 21.6 % of the light.
        assert BOOK.linear("#808080")[:3] == pytest.approx([0.2158605] * 3, abs=1e-7)

    @pytest.mark.parametrize("color", ["red", "#12345", "#1234567", "#12345g", 3])
    def test_what_is_no_colour(self, color):
        with pytest.raises(ValueError, match=r"^theme\.hex: color must be #rrggbb; got "):
            DARK.srgb(color)


class TestMix:
    def test_ramp(self):
        stops = style.ramp([0.0, 0.5, 1.0], ("#000000", "#ff0000", "#ffffff"))
        assert BOOK.rgba(stops, 3).tolist() == [[0, 0, 0, 1], [1, 0, 0, 1], [1, 1, 1, 1]]
        quarter = style.ramp([0.25], ("#000000", "#ffffff"))
        assert BOOK.rgba(quarter, 1)[0] == pytest.approx([0.25, 0.25, 0.25, 1.0])

    def test_a_theme_mixes_its_own_values(self):
        half = style.ramp([0.5], (style.PAPER, style.INK))
        for theme in THEMES.values():
            expected = (theme.linear(style.PAPER) + theme.linear(style.INK)) / 2.0
            assert theme.rgba(half, 1)[0] == pytest.approx(expected)

    def test_fade(self):
        faded = style.fade(style.MARK, [0.0, 0.25, 1.0])
        for theme in THEMES.values():
            rows = theme.rgba(faded, 3, 0.5)
            assert rows[:, 3] == pytest.approx(np.array([0.0, 0.125, 0.5]) ** theme.veil)
            assert np.abs(rows[:, :3] - theme.linear(style.MARK)[:3]).max() == 0.0
        assert BOOK.rgba(style.fade(style.MARK, 0.5), 4).shape == (4, 4)
        again = style.fade(style.fade(style.ramp([0.0, 1.0]), 0.5), [1.0, 0.5])
        assert again.alpha.tolist() == [0.5, 0.25]

    def test_rows_as_of_an_array(self):
        mix = style.fade(style.ramp(np.linspace(0, 1, 7)), np.linspace(0, 1, 7))
        rows = BOOK.rgba(mix, 7)
        for some in (slice(2, 5), np.array([3, 3, 0]), np.arange(7) > 4):
            assert isinstance(mix[some], Mix)
            assert np.array_equal(BOOK.rgba(mix[some], len(mix[some])), rows[some])


class TestPictures:
    def page(self, *records: scene.Record, theme: Theme) -> np.ndarray:
        picture = scene.Picture((scene.View(records),), (60, 40))
        return draw.render(picture, theme=theme).image

    @pytest.mark.parametrize("theme", THEMES.values(), ids=THEMES)
    def test_paper_fill_rim_and_type(self, theme):
        points = scene.Points([(20, 20, 0)], style.PAPER, 12.0, rim=style.MARK, shaded=False)
        square = scene.Surface(
            [(40, 10, 0), (55, 10, 0), (55, 30, 0), (40, 30, 0)],
            [[0, 1, 2], [0, 2, 3]],
            style.ramp([0.0] * 4),
            material="flat",
        )
        image = self.page(points, square, theme=theme)
        for at, color in (((2, 2), style.PAPER), ((20, 20), style.PAPER), ((20, 9), style.MARK)):
            assert image[at].tolist() == theme.srgb(color).tolist()
        assert image[20, 48].tolist() == theme.srgb(style.AXIS_Z).tolist()
        label = scene.Label(r"$\mathbf{H}$", (30, 20, 0), style.INK, 40.0)
        colors = self.page(label, theme=theme).reshape(-1, 3)
        assert (colors == theme.srgb(style.INK)).all(axis=1).any()

    def test_lines_are_wider_in_print(self):
        line = scene.Lines([(0, 20, 0), (60, 20, 0)], "#000000", 5.0)
        book, print_ = (255 - self.page(line, theme=theme)[:, 30].astype(int) for theme in (BOOK, PRINT))
        wide = [np.count_nonzero(column) for column in (book, print_)]
        assert wide[1] == pytest.approx(PRINT.widths * wide[0], abs=2) and wide[1] > wide[0]

    def test_glass_stands_out_from_every_paper(self):
        from lietool.render import globe
        from lietool.render.camera import Camera

        camera = Camera()
        for theme in THEMES.values():
            picture = scene.Picture((scene.View(tuple(globe.globe(camera)), camera),), (120, 90))
            image = draw.render(picture, theme=theme).image.astype(int)
            paper = theme.srgb(style.PAPER)
            inside = np.abs(image[25:65, 45:75] - paper).max(axis=-1)
            assert np.median(inside) > 6, theme.name
            edge = np.abs(image[45] - paper).max(axis=-1)
            assert edge.max() > 90, theme.name


def test_neighbouring_themes_are_not_alike():
    for one, other in pairwise(THEMES.values()):
        assert sum(one.hex(c) != other.hex(c) for c in COLORS.values()) > len(COLORS) / 2
