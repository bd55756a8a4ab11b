"""Every refusal is one line in the house form: function, argument, what was found, where."""

import numpy as np
import pytest

from lietool.lie import checks, euler, quaternion, so2, so3

I3 = np.broadcast_to(np.eye(3), (5, 3, 3))


def stretched(amount: float) -> np.ndarray:
    R = I3.copy()
    R[4, 0, 0] += amount
    return R


def reflected() -> np.ndarray:
    R = I3.copy()
    R[2] = np.diag([1.0, 1.0, -1.0])
    return R


REFUSALS = {
    "so3.log: R must be a rotation, |R^T R - I| <= 1e-06; got 2.1e-01 at index (4,).": (
        lambda: so3.log(stretched(0.1))
    ),
    "so3.log: R must be a rotation, det > 0; got det = -1 at index (2,).": lambda: so3.log(reflected()),
    "so3.log_near: R must be a rotation, det > 0; got det = -1 at index (2,).": (
        lambda: so3.log_near(reflected(), [0, 0, 0])
    ),
    "so2.log: R must be a rotation, det > 0; got det = -1 at index ().": lambda: so2.log(
        np.diag([1.0, -1.0])
    ),
    "so2.log: R must be a rotation, |R^T R - I| <= 1e-06; got 3.0e+00 at index ().": (
        lambda: so2.log(np.diag([2.0, 2.0]))
    ),
    "so3.exp: x must be finite; got nan at index (1, 2).": (
        lambda: so3.exp(np.where(np.arange(18).reshape(2, 3, 3) == 16, np.nan, 0.0))
    ),
    "so3.exp: x must be at most 1e+150 in size; got 1e+200 at index ().": lambda: so3.exp([1e200, 0, 0]),
    "so3.exp: x must be an array of shape (..., 3); got shape (4,).": lambda: so3.exp([1, 2, 3, 4]),
    "so3.exp: x must be numbers of shape (..., 3); got a ragged list.": lambda: so3.exp([[1, 2, 3], [1, 2]]),
    "so3.exp: x must be real numbers of shape (..., 3); got dtype complex128.": lambda: so3.exp([1j, 0, 0]),
    "so3.from_axis_angle: u must be a unit vector, norm within 1e-06 of 1; got 1.41421 at index ().": (
        lambda: so3.from_axis_angle([1, 1, 0], 1.0)
    ),
    "so3.rotation: axis must be one of x, y, z; got 'w'.": lambda: so3.rotation("w", 1.0),
    "so3.act: R and p must be batches that broadcast; got (5,) and (4,).": lambda: so3.act(
        I3, np.ones((4, 3))
    ),
    "quaternion.to_matrix: q must be different from zero; got norm 0.0e+00 at index (1,).": (
        lambda: quaternion.to_matrix([[1, 0, 0, 0], [0, 0, 0, 0]])
    ),
    "quaternion.log: q must be a unit quaternion, norm within 1e-06 of 1; got 2 at index ().": (
        lambda: quaternion.log([0, 2, 0, 0])
    ),
    "quaternion.slerp: q1 must be different from -q0; got [-1.  0.  0.  0.] at index (1,).": (
        lambda: quaternion.slerp([1.0, 0, 0, 0], [[0.0, 1, 0, 0], [-1.0, 0, 0, 0]], 0.5)
    ),
    "euler.to_matrix: convention must be one of xyx,": lambda: euler.to_matrix([0, 0, 0], "xyy"),
}


@pytest.mark.parametrize("message", REFUSALS)
def test_message(message):
    with pytest.raises(ValueError) as caught:
        REFUSALS[message]()
    text = str(caught.value)
    assert text.startswith(message)
    assert "\n" not in text


def test_tolerance_is_the_one_promised():
    R = np.eye(3)
    R[0, 1] = 0.9e-6
    so3.log(R)
    so3.log(stretched(0.49e-6))
    with pytest.raises(ValueError, match="rotation"):
        so3.log(stretched(0.6e-6))
    quaternion.log([1 + 0.9e-6, 0, 0, 0])
    with pytest.raises(ValueError, match="unit quaternion"):
        quaternion.log([1 + 1.2e-6, 0, 0, 0])


def test_one_bad_among_good_is_found_in_every_block():
    R = np.broadcast_to(np.eye(3), (3, 4000, 3, 3)).copy()
    R[2, 3999, 1, 1] = 1.5
    with pytest.raises(ValueError, match=r"index \(2, 3999\)"):
        so3.log(R)


def test_unchecked_calls_skip_values_but_not_shapes():
    with np.errstate(invalid="ignore"):
        assert np.all(np.isnan(so3.exp([np.nan, 0, 0], check=False)))
    assert np.all(np.isfinite(so3.log(stretched(0.1), check=False)))
    with pytest.raises(ValueError, match="shape"):
        so3.exp([1.0, 2.0], check=False)


def test_integers_and_lists_are_numbers():
    assert so3.exp([0, 0, 0]).dtype == np.float64
    assert np.array_equal(quaternion.multiply([0, 1, 0, 0], [0, 0, 1, 0]), [0, 0, 0, 1])


def test_first():
    bad = np.zeros((2, 3), dtype=bool)
    bad[1, 1] = bad[1, 2] = True
    assert checks.first(bad) == (1, 1)
    assert checks.first(np.array(True)) == ()
