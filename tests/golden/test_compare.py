"""The rule that decides whether a picture is the same, from both sides of each limit."""

import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageFont

from lietool.figure import Tolerance
from lietool.golden import compare, compare_numbers

WIDE, HIGH, FINE = 320, 240, 8


def draw(*, shift=0.0, turn=0.0, thing=True, flip=False, label="theta = 1.2"):
    """A disc, a triangle, a few lines and a 10x10 object, antialiased by averaging 8x8, and a label."""
    image = Image.new("RGB", (WIDE * FINE, HIGH * FINE), "white")
    pen = ImageDraw.Draw(image)
    cos, sin = np.cos(np.radians(turn)), np.sin(np.radians(turn))

    def at(*points):
        centre = np.array([WIDE, HIGH]) / 2
        moved = (np.array(points) - centre) @ np.array([[cos, sin], [-sin, cos]]) + centre + [shift, 0.0]
        return [tuple(point) for point in moved * FINE]

    pen.polygon(at((40, 30), (150, 60), (90, 150)), fill="#b4cdea")
    third = (210, 110) if not flip else (230, 190)
    pen.polygon(at((180, 150), (260, 140), third), fill="#e0860b")
    for k in range(6):
        pen.line(at((30, 170 + 8 * k), (150, 160 + 11 * k)), fill="#2b2f36", width=2 * FINE)
    if thing:
        pen.polygon(at((280, 40), (290, 40), (290, 50), (280, 50)), fill="#c8372d")
    fine = np.asarray(image, float).reshape(HIGH, FINE, WIDE, FINE, 3)
    image = Image.fromarray(fine.mean(axis=(1, 3)).round().astype(np.uint8))
    ImageDraw.Draw(image).text((180, 200), label, "#2b2f36", ImageFont.load_default_imagefont())
    return np.array(image)


BASE = draw()


def jittered(levels, seed=1):
    noise = np.random.default_rng(seed).integers(-levels, levels + 1, BASE.shape)
    return np.clip(BASE.astype(int) + noise, 0, 255).astype(np.uint8)


def lighter(levels, channel=2):
    image = BASE.copy()
    image[60:100, 70:110, channel] += np.uint8(levels)
    return image


def test_equal_pictures_pass_with_all_headroom():
    found = compare.images(BASE, BASE.copy())
    assert found.passes and found.equal and found.differing == 0
    assert (found.headroom_pixels, found.headroom_lowpass) == (8, 1.5)


@pytest.mark.parametrize("seed", range(5))
def test_one_grey_level_of_jitter_passes(seed):
    found = compare.images(BASE, jittered(1, seed))
    assert found.passes and not found.equal and found.over == 0 and 0 < abs(found.lowpass) < 1


def test_one_grey_level_is_never_a_visible_distance():
    colours = np.random.default_rng(0).integers(1, 255, (100_000, 3))
    moved = colours + np.random.default_rng(1).integers(-1, 2, colours.shape)
    assert compare.delta_e76(colours.astype(np.uint8), moved.astype(np.uint8)).max() < compare.DELTA_E


MUTANTS = {
    "half-pixel shift": draw(shift=0.5),
    "turned by one degree": draw(turn=1.0),
    "10x10 object missing": draw(thing=False),
    "triangle flipped": draw(flip=True),
    "one label changed": draw(label="theta = 1.3"),
}


@pytest.mark.parametrize("name", MUTANTS)
def test_what_an_eye_sees_fails_both_ways(name):
    for pair in ((BASE, MUTANTS[name]), (MUTANTS[name], BASE)):
        found = compare.images(*pair)
        assert not found.passes and min(found.headroom_pixels, found.headroom_lowpass) < 0


def test_the_mean_sees_a_digit_of_seven_pixels_that_the_count_lets_through():
    found = compare.images(BASE, MUTANTS["one label changed"])
    assert found.too_wide and not found.too_far


@pytest.mark.parametrize("channel", range(3))
@pytest.mark.parametrize("sign", [1, -1])
def test_three_levels_in_one_channel_of_a_region_fail_by_the_mean(channel, sign):
    pair = (BASE, lighter(3, channel)) if sign > 0 else (lighter(3, channel), BASE)
    found = compare.images(*pair)
    assert found.too_wide and not found.passes and found.headroom_lowpass == -1.5
    assert (found.lowpass, found.lowpass_channel) == (3.0 * sign, "RGB"[channel])
    x, y = found.lowpass_at or (0, 0)
    assert 74 <= x < 106 and 64 <= y < 96


def test_one_level_in_a_region_passes():
    assert compare.images(BASE, lighter(1)).passes


@pytest.mark.parametrize(("count", "passes"), [(8, True), (9, False)])
def test_eight_pixels_in_one_place_may_be_too_far_and_nine_not(count, passes):
    image = np.full((90, 200, 3), 128, np.uint8)
    other = image.copy()
    # Around one of them as far as the place reaches, the nine on both of its rims.
    other[40, 84 : 84 + 4 * count : 4] += 8
    found = compare.images(image, other)
    assert found.over == found.differing == found.crowd == count and not found.too_wide
    assert found.passes is passes


@pytest.mark.parametrize(("count", "passes"), [(48, True), (49, False)])
def test_strewn_pixels_may_be_too_far_where_none_crowd(count, passes):
    image = np.full((140, 200, 3), 128, np.uint8)
    other = image.copy()
    place = np.arange(count)
    other[10 + 17 * (place // 10), 10 + 18 * (place % 10)] += 8
    found = compare.images(image, other)
    assert found.over == found.differing == count and found.crowd == 1 and not found.too_wide
    assert found.passes is passes and found.headroom_pixels == (0 if passes else -1)


def test_a_crowd_is_counted_alike_by_pairs_and_by_sums():
    chance = np.random.default_rng(4)
    for size in (3 * compare.STREWN, 20 * compare.STREWN):
        spots = np.unique(chance.integers(0, (60, 90), (size, 2)), axis=0)
        y, x = spots.T
        image = np.full((60, 90, 3), 128, np.uint8)
        other = image.copy()
        other[y, x] += 8
        near = (np.abs(y - y[:, None]) <= 16) & (np.abs(x - x[:, None]) <= 16)
        found = compare.images(image, other)
        assert found.over == len(spots) and found.crowd == near.sum(axis=1).max()
        assert found.crowd_at is not None and (other[found.crowd_at[::-1]] == 136).all()


@pytest.mark.parametrize(("total", "passes"), [(121, True), (122, False), (-121, True), (-122, False)])
def test_the_mean_of_81_signed_differences_is_compared_with_one_and_a_half(total, passes):
    image = np.full((40, 40, 3), 128, np.uint8)
    box = np.full(81, 1)
    box[: abs(total) - 81] += 1
    other = image.astype(int)
    other[10:19, 20:29, 1] += np.sign(total) * box.reshape(9, 9)
    found = compare.images(image, other.astype(np.uint8))
    assert found.lowpass == total / 81 and found.over == 0 and found.lowpass_at == (24, 14)
    assert found.passes is passes


def test_a_value_exactly_at_its_limit_passes():
    image = np.full((30, 30, 3), 128, np.uint8)
    other = image + np.uint8(2)
    assert compare.images(image, other, lowpass=2.0).passes
    assert compare.images(image, other, lowpass=np.nextafter(2.0, 0.0)).too_wide
    far = compare.images(image, other).largest_delta_e
    assert compare.images(image, other, delta_e=far, lowpass=9.0).over == 0
    assert compare.images(image, other, delta_e=np.nextafter(far, 0.0), lowpass=9.0).over == 900


def test_noise_without_a_sign_cancels_and_noise_with_one_does_not():
    image = np.full((40, 40, 3), 128, np.uint8)
    board = np.indices((40, 40)).sum(axis=0)[..., None] % 2
    both = (image.astype(int) + np.where(board, 3, -3)).astype(np.uint8)
    one = (image.astype(int) + np.where(board, 3, 1)).astype(np.uint8)
    assert compare.images(image, both).passes
    assert compare.images(image, one).too_wide


@pytest.mark.parametrize("corner", [(0, 0), (0, -1), (-1, 0), (-1, -1)])
def test_edges_are_reflected(corner):
    # In a corner a pixel is seen through its mirror images too: four times in the box around it.
    image = np.zeros((20, 30, 3), np.uint8)
    other = image.copy()
    other[corner] = (0, 40, 0)
    found = compare.images(image, other)
    assert found.lowpass == 4 * 40 / 81
    assert compare.images(image[:5, :2], other[:5, :2]).same_size


@pytest.mark.parametrize("shape", [(60, 50), (9, 9), (3, 2), (1, 1)])
def test_box_means_are_those_of_scipy(shape):
    filters = pytest.importorskip("scipy.ndimage")
    difference = np.random.default_rng(3).integers(-255, 256, (*shape, 3)).astype(np.int16)
    expected = filters.uniform_filter(difference.astype(float), (9, 9, 1), mode="reflect")
    np.testing.assert_allclose(compare.box_sums(difference) / 81, expected, atol=1e-9)


def test_box_sums_do_not_overflow():
    assert compare.box_sums(np.full((20, 20, 3), -255, np.int16)).min() == -81 * 255


def test_a_picture_cut_to_where_it_differs_gives_what_the_whole_gives():
    rng = np.random.default_rng(5)
    for _ in range(20):
        other = BASE.copy()
        y, x = rng.integers(0, HIGH - 3), rng.integers(0, WIDE - 3)
        other[y : y + 3, x : x + 3] ^= rng.integers(0, 64, (3, 3, 3), np.uint8)
        sums = compare.box_sums(other.astype(np.int16) - BASE)
        assert abs(compare.images(BASE, other).lowpass) == np.abs(sums).max() / 81


def test_colour_distance_is_that_of_skimage():
    color = pytest.importorskip("skimage.color")
    a, b = np.random.default_rng(2).integers(0, 256, (2, 5000, 3), np.uint8)
    expected = color.deltaE_cie76(color.rgb2lab(a), color.rgb2lab(b))
    np.testing.assert_allclose(compare.delta_e76(a, b), expected, atol=1e-3)


def test_another_size_is_a_verdict_of_its_own():
    found = compare.images(BASE, BASE[:, :-1])
    assert not found.same_size and not found.passes and not found.equal
    assert (found.expected_size, found.actual_size) == ((WIDE, HIGH), (WIDE - 1, HIGH))


@pytest.mark.parametrize("wrong", [BASE.astype(float), BASE[..., 0], BASE[..., :2], BASE[:0]])
def test_what_is_no_picture_is_refused(wrong):
    with pytest.raises(ValueError, match=r"compare.images: actual must be a picture \(h, w, 3\) uint8; got"):
        compare.images(BASE, wrong)


def test_slices_of_larger_pictures_are_compared_too():
    big = np.concatenate([BASE, 255 - BASE], axis=1)
    assert compare.images(BASE, big[:, :WIDE]).equal


def test_the_limits_have_one_home_each_for_figures_and_for_comparing():
    own = (compare.PIXELS, compare.DELTA_E, compare.LOWPASS, compare_numbers.RELATIVE)
    default = Tolerance()
    assert own == (default.pixels, default.delta_e, default.lowpass, default.relative)
