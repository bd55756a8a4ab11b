"""What the plate of the edited image claims: no seam, nothing changed outside, the least energy."""

import numpy as np
import pytest
from lietool.figures.ch7 import _dusk, _paste
from PIL import Image

from lietool import figure, paths
from lietool.deform import image
from lietool.render import draw

EDIT = figure.load("poisson-image", (paths.FIGURES,))
RNG = np.random.default_rng(11)


def ours(across=0.68, down=0.39, mixed=False):
    return _paste.edit(_paste.paste(None, None, None, across, down), mixed)


@pytest.fixture(scope="module")
def made():
    return ours()


def small(tmp_path):
    """A source, a target and a mask in files, small enough to be solved densely."""
    source, target = (RNG.integers(0, 256, shape, dtype=np.uint8) for shape in ((8, 9, 3), (12, 14, 3)))
    mask = np.zeros((8, 9), np.uint8)
    mask[2:6, 2:7] = 255
    files = [tmp_path / f"{name}.png" for name in ("source", "target", "mask")]
    for file, data in zip(files, (source, target, mask), strict=True):
        Image.fromarray(data).save(file)
    return files, source.astype(float), target.astype(float), mask > 0


class TestPlate:
    def test_the_step_across_the_edge(self, plate):
        step = plate("G7.10").numbers["step across the edge"]
        assert step["copy"] > 50.0
        assert step["result"] < 1.0

    def test_what_is_darker_than_black(self, plate):
        assert plate("G7.10").numbers["darker than black"] == pytest.approx(0.04, abs=0.004)

    def test_the_energy_is_the_least(self, made):
        least = made.energy(made.result.image)
        assert least == pytest.approx(made.result.energy) and least < 0.01 * made.energy(made.copy)
        for _ in range(3):
            change = RNG.normal(0.0, 0.5, made.copy.shape) * made.paste.inside[..., None]
            assert made.energy(made.result.image + change) > least

    def test_nothing_changes_outside(self, made):
        outside = ~made.paste.inside
        assert np.array_equal(made.result.image[outside], made.paste.target[outside])
        assert np.array_equal(made.copy[outside], made.paste.target[outside])

    def test_the_field_is_of_both(self, made):
        given = made.paste
        inner, outer = image.gradient(given.laid), image.gradient(given.target)
        both = given.inside[:, :-1] | given.inside[:, 1:]
        assert np.array_equal(made.field[0][both], inner[0][both])
        assert np.array_equal(made.field[0][~both], outer[0][~both])

    def test_the_inside_keeps_its_steps(self, made):
        # Far from the edge the correction is smooth: steps inside the balloon are the source's.
        rows, columns = np.nonzero(made.paste.inside)
        y, x = int(rows.mean()), int(columns.mean())
        part = slice(y - 20, y + 20), slice(x - 20, x + 20)
        one, other = (image.gradient(a[part])[0] for a in (made.result.image, made.paste.laid))
        assert np.abs(one - other).max() < 3.0 and np.abs(other).max() > 50.0

    def test_images_of_whole_levels(self):
        levels, mask = _dusk.balloon(64)
        for shown in (levels, _dusk.evening(60)):
            assert np.array_equal(shown, np.rint(shown)) and shown.min() >= 0.0 and shown.max() <= 255.0
        assert not mask[[0, -1]].any() and not mask[:, [0, -1]].any() and 0.2 < mask.mean() < 0.6


class TestPlaces:
    @pytest.mark.parametrize(("across", "down"), [(0.0, 0.0), (1.0, 0.5), (0.5, 1.0)])
    def test_at_the_border_the_mask_is_cut_off(self, across, down):
        found = ours(across, down)
        assert 0 < found.paste.inside.sum() < ours().paste.inside.sum()
        assert np.isfinite(found.result.image).all() and found.result.residual < 1e-10

    def test_mixed_keeps_the_stars(self):
        plain, mixed = ours(), ours(mixed=True)
        for k in (0, 1):
            stronger = np.sum(mixed.field[k] ** 2, axis=2) - np.sum(plain.field[k] ** 2, axis=2)
            assert stronger.min() >= 0.0 and stronger.max() > 0.0


class TestFiles:
    def test_against_least_squares(self, tmp_path):
        files, source, target, mask = small(tmp_path)
        numbers = EDIT.draw(source=files[0], target=files[1], mask=files[2], across=0.5, down=0.5).numbers
        # The mask's middle, 4.5 and 4, at the target's, 7 and 6: two down and two or three to the right.
        row, column = 2, round(7.0 - 4.5)
        inside, laid = np.zeros((12, 14), bool), target.copy()
        inside[row : row + 8, column : column + 9] = mask
        laid[row : row + 8, column : column + 9] = source
        where = np.full(inside.shape, -1)
        where[inside] = np.arange(inside.sum())
        rows, right = [], []
        for a, b in [
            *(((i, j), (i, j + 1)) for i in range(12) for j in range(13)),
            *(((i, j), (i + 1, j)) for i in range(11) for j in range(14)),
        ]:
            if inside[a] or inside[b]:
                line, value = np.zeros(inside.sum()), laid[b] - laid[a]
                for place, sign in ((a, -1.0), (b, 1.0)):
                    if inside[place]:
                        line[where[place]] = sign
                    else:
                        value = value - sign * target[place]
                rows.append(line)
                right.append(value)
        best, rest, *_ = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)
        assert numbers["energy"]["result"] == pytest.approx(rest.sum(), rel=1e-9)
        expected = target.copy()
        expected[inside] = best
        assert np.allclose(numbers["range"], [expected.min(), expected.max()], atol=1e-9)

    def test_the_result_alone_has_the_targets_pixels(self, tmp_path):
        files, _, target, _ = small(tmp_path)
        drawing = EDIT.draw(view="result", source=files[0], target=files[1], mask=files[2])
        assert drawing.picture.size == (14, 12)
        found = draw.render(drawing.picture).image.astype(int)
        assert np.abs(found[0] - target[0]).max() <= 1 and np.abs(found[-1] - target[-1]).max() <= 1

    def test_an_opaque_part_is_a_mask(self, tmp_path):
        files, source, _, mask = small(tmp_path)
        clear = np.dstack([source, 255.0 * mask]).astype(np.uint8)
        Image.fromarray(clear).save(tmp_path / "clear.png")
        one = EDIT.draw(source=files[0], target=files[1], mask=files[2]).numbers
        other = EDIT.draw(source=tmp_path / "clear.png", target=files[1]).numbers
        assert one["energy"] == other["energy"]

    def test_our_balloon_in_your_image(self, tmp_path):
        Image.fromarray(RNG.integers(90, 99, (70, 60, 3), dtype=np.uint8)).save(tmp_path / "a.png")
        assert EDIT.draw(target=tmp_path / "a.png").numbers["step across the edge"]["result"] < 9.0

    def test_a_large_image_is_averaged(self, tmp_path):
        Image.new("RGB", (2400, 60), (9, 99, 9)).save(tmp_path / "a.png")
        shown = EDIT.draw(target=tmp_path / "a.png").picture.views[0].records
        assert max(np.shape(r.pixels)[1] for r in shown if type(r).__name__ == "Image") == 800


class TestRefused:
    def test_by_name(self, tmp_path):
        files, source, *_ = small(tmp_path)
        with pytest.raises(ValueError, match="mask must be given with a source; got only a mask"):
            EDIT.draw(mask=files[2])
        with pytest.raises(ValueError, match="mask must be of the source's size, 9x8; got 14x12"):
            EDIT.draw(source=files[0], mask=files[1])
        Image.fromarray(np.zeros(source.shape[:2], np.uint8)).save(tmp_path / "none.png")
        with pytest.raises(ValueError, match="mask must have pixels that are not at the source's edge"):
            EDIT.draw(source=files[0], mask=tmp_path / "none.png")
        with pytest.raises(ValueError, match="mask must cover some pixels of the target and not all"):
            Image.new("RGB", (2, 2)).save(tmp_path / "tiny.png")
            EDIT.draw(source=files[0], target=tmp_path / "tiny.png")
