"""How a project keeps its pictures: `pytest` compares, with `--golden-update=missing` it writes new ones."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import spirals


def test_array_and_numbers(lietool_golden):
    points = spirals.spiral(2.5)
    lietool_golden.check(spirals.pixels(points), name="spiral", numbers={"points": points[::20]})


@pytest.mark.parametrize("turns", [1, 3])
def test_pillow(lietool_golden, turns):
    image = pytest.importorskip("PIL.Image")
    levels = (255.0 * spirals.pixels(spirals.spiral(turns))).round().astype(np.uint8)
    # Its name is the test's: test_spirals/test_pillow-1 and -3.
    lietool_golden.check(image.fromarray(levels).resize((60, 60)))


def test_matplotlib(lietool_golden):
    figure = pytest.importorskip("matplotlib.figure").Figure(figsize=(2, 2), dpi=60)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.plot(*spirals.spiral(2.0).T, color="#2b66b1", linewidth=2)
    # Type is drawn differently by every version of FreeType: a golden is better off without.
    axes.set_axis_off()
    lietool_golden.check(figure, name="plots/spiral")


def test_what_changes_is_masked(lietool_golden):
    image = np.full((40, 60, 3), 230, np.uint8)
    image[10:30, 20:40] = (43, 102, 177)
    # A stamp that is another each time.
    image[:8, :8] = np.random.default_rng().integers(0, 256, (8, 8, 3))
    lietool_golden.check(image, name="stamped", ignore=[(0, 0, 8, 8)])


def test_a_tolerance_says_why(lietool_golden):
    points = spirals.spiral(2.5)
    lietool_golden.check(
        spirals.pixels(points), name="lenient", pixels=20, because="drawn by whatever numpy there is"
    )
