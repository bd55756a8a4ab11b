"""Gradient-domain editing of images against dense least squares, and what it must give back."""

import numpy as np
import pytest

from lietool.deform import image


def disc(h: int, w: int, row: float, column: float, radius: float) -> np.ndarray:
    y, x = np.mgrid[:h, :w]
    return (y - row) ** 2 + (x - column) ** 2 < radius**2


def pictures(seed: int = 0, shape: tuple[int, ...] = (17, 23)) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.uniform(size=shape), rng.uniform(size=shape)


MASKS = {
    "disc": disc(17, 23, 8, 10, 5),
    "one pixel": disc(17, 23, 8, 10, 0.5),
    "two parts": disc(17, 23, 5, 5, 3) | disc(17, 23, 11, 16, 4),
    "ring": disc(17, 23, 8, 10, 7) & ~disc(17, 23, 8, 10, 3),
    "at the border": disc(17, 23, 0, 0, 9),
    "all but one": ~disc(17, 23, 8, 10, 0.5),
}


def least_squares(mask: np.ndarray, target: np.ndarray, field: image.Field) -> np.ndarray:
    """(7.10) as it stands: one equation for each pair of pixels, and no Laplacian anywhere."""
    h, w = mask.shape
    number = np.full(mask.shape, -1)
    number[mask] = np.arange(mask.sum())
    rows, right = [], []
    for (dy, dx), wanted in zip(((0, 1), (1, 0)), field, strict=True):
        for i in range(h - dy):
            for j in range(w - dx):
                a, b = (i, j), (i + dy, j + dx)
                if mask[a] or mask[b]:
                    row, value = np.zeros(mask.sum()), wanted[i, j]
                    for pixel, sign in ((a, -1.0), (b, 1.0)):
                        if mask[pixel]:
                            row[number[pixel]] = sign
                        else:
                            value = value - sign * target[pixel]
                    rows.append(row)
                    right.append(value)
    result = target.copy()
    result[mask] = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    return result


@pytest.mark.equation("B 7.10")
@pytest.mark.parametrize("name", MASKS)
def test_the_result_has_the_nearest_gradient(name):
    mask = MASKS[name]
    target, source = pictures(1)
    found = image.solve(image.prepare(mask), target, image.gradient(source))
    np.testing.assert_allclose(found.image, least_squares(mask, target, image.gradient(source)), atol=1e-12)
    rng = np.random.default_rng(2)
    for _ in range(3):
        other = found.image + 1e-3 * mask * rng.normal(size=mask.shape)
        assert image.Result(found.prepared, found.field, other).energy > found.energy


@pytest.mark.equation("B 7.11")
@pytest.mark.parametrize("name", MASKS)
def test_it_solves_poissons_equation_with_the_values_outside(name):
    mask = MASKS[name]
    target, source = pictures(3)
    field = image.stronger(image.gradient(source), image.gradient(target))
    found = image.solve(image.prepare(mask), target, field)
    laplacian = image.divergence(*image.gradient(found.image))
    inner = mask & ~np.pad(np.zeros((15, 21), bool), 1, constant_values=True)
    np.testing.assert_allclose(laplacian[inner], image.divergence(*field)[inner], atol=1e-12)
    np.testing.assert_array_equal(found.image[~mask], target[~mask])
    assert found.residual < 1e-14


def test_divergence_is_minus_the_adjoint_of_the_gradient_and_gives_the_five_points():
    one, two = pictures(4)
    x, y = image.gradient(one)
    a, b = image.gradient(two)
    assert np.sum(image.divergence(a, b) * one) == pytest.approx(-np.sum(a * x) - np.sum(b * y), rel=1e-12)
    five = one[:-2, 1:-1] + one[2:, 1:-1] + one[1:-1, :-2] + one[1:-1, 2:] - 4.0 * one[1:-1, 1:-1]
    np.testing.assert_allclose(image.divergence(x, y)[1:-1, 1:-1], five, atol=1e-14)


@pytest.mark.parametrize("name", MASKS)
def test_a_source_of_the_same_gradients_is_reproduced(name):
    mask = MASKS[name]
    target, _ = pictures(5, (17, 23, 3))
    prepared = image.prepare(mask)
    found = image.solve(prepared, target, image.gradient(target + np.array([3.0, -2.0, 0.5])))
    np.testing.assert_allclose(found.image, target, atol=1e-12)
    assert found.energy < 1e-24
    # A source that is the target but for a constant meets it where it is seamless: at the rim.
    ramp = np.broadcast_to(np.linspace(0.0, 1.0, 23), (17, 23))
    smooth = image.solve(prepared, ramp, image.gradient(np.zeros((17, 23)))).image
    assert smooth.min() >= -1e-12 and smooth.max() <= 1.0 + 1e-12


def test_channels_are_each_by_itself():
    mask = MASKS["ring"]
    target, source = pictures(6, (17, 23, 4))
    prepared = image.prepare(mask)
    together = image.solve(prepared, target, image.gradient(source)).image
    for c in range(4):
        one = image.solve(prepared, target[..., c], image.gradient(source[..., c])).image
        np.testing.assert_allclose(together[..., c], one, atol=1e-14)


def test_the_stronger_of_two_fields():
    one, two = pictures(7)
    a, b = image.gradient(one), image.gradient(two)
    for x, y, z in zip(a, b, image.stronger(a, b), strict=True):
        np.testing.assert_array_equal(z, np.where(np.abs(y) > np.abs(x), y, x))
    # Channels choose together, so that no colour is torn off the others.
    rgb = tuple(np.stack([x, 0.1 * x, y], -1) for x, y in zip(a, b, strict=True))
    other = tuple(0.5 * x for x in rgb)
    for x, z in zip(rgb, image.stronger(other, rgb), strict=True):
        np.testing.assert_array_equal(x, z)
    # By squares (3, 0) is stronger than (2, 2), which has the larger sum.
    three, two = np.array([[[0.0, 0.0], [3.0, 0.0]]]), np.array([[[0.0, 0.0], [2.0, 2.0]]])
    chosen, _ = image.stronger(image.gradient(two), image.gradient(three))
    np.testing.assert_array_equal(chosen, [[[3.0, 0.0]]])
    assert image.stronger(a, a)[0] is not a[0]


def test_images_of_whole_numbers_are_taken_and_left_alone():
    target = np.full((9, 9), 200, np.uint8)
    source = np.arange(81, dtype=np.uint8).reshape(9, 9)
    before = target.copy(), source.copy()
    found = image.solve(image.prepare(disc(9, 9, 4, 4, 3)), target, image.gradient(source)).image
    assert found.dtype == np.float64 and np.isfinite(found).all()
    # Differences of small whole numbers must not wrap round.
    assert image.gradient(source[:, ::-1])[0].max() == -1.0
    np.testing.assert_array_equal(target, before[0])
    np.testing.assert_array_equal(source, before[1])


GOOD = pictures(8)[0]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: image.prepare(np.ones((4, 5), bool)), "mask must be some pixels of the image and not all"),
        (lambda: image.prepare(np.zeros((4, 5), bool)), "mask must be some pixels .* got none"),
        (lambda: image.prepare(np.zeros((0, 5), bool)), "mask must be some pixels"),
        (lambda: image.prepare(np.ones((4, 5))), "mask must be true or false"),
        (lambda: image.gradient(np.zeros(4)), "image must be numbers of shape"),
        (lambda: image.gradient(np.full((2, 2), np.nan)), r"image must be finite; got nan at index \(0, 0\)"),
        (lambda: image.gradient([[1, 2], [3]]), "image must be an array of numbers"),
        (lambda: image.gradient([[1e200]]), r"image must be at most 1e\+150 in size"),
        (lambda: image.prepare([[True], [True, False]]), "mask must be true or false, .* got a ragged list"),
        (lambda: image.gradient("abc"), "image must be numbers of shape"),
        (lambda: image.divergence(np.zeros((3, 3)), np.zeros((3, 3))), "field must be of shapes"),
        (lambda: image.solve(image.prepare(MASKS["disc"]), GOOD[1:], image.gradient(GOOD)), "target must be"),
        (lambda: image.solve(image.prepare(MASKS["disc"]), GOOD, image.gradient(GOOD[1:])), "field must be"),
        (
            lambda: image.solve(
                image.prepare(MASKS["disc"]), np.where(GOOD > 0.9, np.inf, GOOD), (GOOD, GOOD)
            ),
            "target must be finite; got inf",
        ),
        (
            lambda: image.stronger(image.gradient(GOOD), image.gradient(GOOD[1:])),
            "other must be a field of shapes",
        ),
    ],
)
def test_bad_input_is_refused_by_name(call, message):
    with pytest.raises(ValueError, match=rf"^image\.\w+: {message}[^\n]*$"):
        call()
