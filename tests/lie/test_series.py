"""The coefficients against exact rationals near 0 and 50 digits elsewhere, on both sides of every switch."""

from fractions import Fraction
from math import factorial, pi

import mpmath
import numpy as np
import pytest

from lietool.lie import series

EPS = 2.0**-52
F = Fraction

# Name: value by mpmath, Taylor coefficients in t^2, where the code switches, allowed error in ulp.
CASES = {
    "sinc": (
        lambda t: mpmath.sin(t) / t,
        [F((-1) ** k, factorial(2 * k + 1)) for k in range(12)],
        1.0,
        2,
    ),
    "versinc": (
        lambda t: 2 * (mpmath.sin(t / 2) / t) ** 2,
        [F((-1) ** k, factorial(2 * k + 2)) for k in range(12)],
        1.0,
        3,
    ),
    "sine_defect": (
        lambda t: (t - mpmath.sin(t)) / t**3,
        [F((-1) ** k, factorial(2 * k + 3)) for k in range(12)],
        1.6,
        3,
    ),
    "cotangent_defect": (
        lambda t: (1 - t / 2 * mpmath.cot(t / 2)) / t**2,
        [F(1, 12), F(1, 720), F(1, 30240), F(1, 1209600), F(1, 47900160), F(691, 1307674368000)],
        2.0,
        4,
    ),
    "sinc_slope": (
        lambda t: (mpmath.sin(t) - t * mpmath.cos(t)) / t**3,
        [F((-1) ** k * (2 * k + 2), factorial(2 * k + 3)) for k in range(12)],
        1.0,
        5,
    ),
    "versinc_slope": (
        lambda t: (t * mpmath.sin(t) - 4 * mpmath.sin(t / 2) ** 2) / t**4,
        [F((-1) ** (k + 1) * (2 * k + 2), factorial(2 * k + 4)) for k in range(12)],
        2.0,
        4,
    ),
    "sine_defect_slope": (
        lambda t: (1 - mpmath.cos(t)) / t**4 - 3 * (t - mpmath.sin(t)) / t**5,
        [F((-1) ** (k + 1) * (2 * k + 2), factorial(2 * k + 5)) for k in range(12)],
        4.0,
        6,
    ),
    "cotangent_defect_slope": (
        lambda t: (t * mpmath.sin(t) / 4 + t * t / 4 - 1 + mpmath.cos(t)) / (t**2 * mpmath.sin(t / 2)) ** 2,
        [F(1, 360), F(1, 7560), F(1, 201600), F(1, 5987520), F(691, 130767436800)],
        3.5,
        4,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_exact_rationals_near_zero(name):
    _, taylor, _, ulp = CASES[name]
    for t in (0.0, 2.0**-1000, 2.0**-30, 2.0**-12, 3 / 64, 1 / 16, -1 / 16):
        exact = sum(c * F(t) ** (2 * k) for k, c in enumerate(taylor))
        value = getattr(series, name)(t)
        assert abs(F(float(value)) - exact) <= F(ulp * EPS) * abs(exact)


@pytest.mark.parametrize("name", CASES)
def test_fifty_digits_on_both_sides_of_the_switch(name):
    reference, _, switch, ulp = CASES[name]
    sides = [switch * (1 + s * 10.0**-k) for k in (1, 3, 8, 15) for s in (-1, 1)]
    spread = [*np.geomspace(1e-12, 1.0, 40), *np.linspace(0.05, 3.1, 120), 4.0, 6.0]
    angles = np.array([*sides, np.nextafter(switch, 0), switch, np.nextafter(switch, 9), *spread])
    values = getattr(series, name)(angles)
    with mpmath.workdps(90):
        for t, value in zip(angles, values, strict=True):
            exact = reference(mpmath.mpf(float(t)))
            assert abs(mpmath.mpf(float(value)) - exact) <= ulp * EPS * abs(exact), t


@pytest.mark.parametrize("name", CASES)
def test_even(name):
    t = np.linspace(0, 6, 61)
    assert np.array_equal(getattr(series, name)(t), getattr(series, name)(-t))


def test_relations_between_the_coefficients():
    t = np.linspace(0.01, 6.2, 200)
    a, b, c, d, *_ = (getattr(series, name)(t) for name in CASES)
    np.testing.assert_allclose((a * t) ** 2 + (1 - b * t * t) ** 2, 1, atol=4e-15)  # sin^2 + cos^2 = 1
    np.testing.assert_allclose(a + c * t * t, 1, atol=4e-15)
    # The left Jacobian times its inverse is I: the coefficient of X^2, by X^3 = -t^2 X.
    np.testing.assert_allclose(c + d - b / 2 - c * d * t * t, 0, atol=4e-14)


def test_printed_quotients_lose_digits():
    t = 1e-8
    assert (1 - np.cos(t)) / t**2 == 0  # true value 1/2
    assert abs((t - np.sin(t)) / t**3 - 1 / 6) > 0.1
    assert series.versinc(t) == 0.5
    assert series.sine_defect(t) == 1 / 6


def test_angle_over_sine():
    rng = np.random.default_rng(3)
    s = np.concatenate([rng.uniform(0, 2, 200), 10.0 ** rng.uniform(-300, 0, 100)])
    c = rng.uniform(-2, 2, 300)
    with mpmath.workdps(50):
        for si, ci, value in zip(s, c, series.angle_over_sine(s, c), strict=True):
            exact = mpmath.atan2(float(si), float(ci)) / mpmath.mpf(float(si))
            assert abs(mpmath.mpf(float(value)) - exact) <= 3 * EPS * exact
    assert series.angle_over_sine(0.0, 0.5) == 2.0


def test_at_pole():
    n = np.arange(1, 60)
    assert np.all(series.at_pole(2 * pi * n))
    assert np.all(series.at_pole(-2 * pi * n))
    assert not np.any(series.at_pole(2 * pi * n - 1e-12 * n))
    assert not np.any(series.at_pole([0.0, 1e-300, 1.0, pi]))
