"""Consistent angles: no jumps between neighbours, whatever the mesh and the number of turns."""

import numpy as np
import pytest

from lietool.interp import angles


def strip(n):
    """A strip of 2 n triangles; the angle of triangle k is a function of k."""
    a = np.arange(n)
    F = np.concatenate(
        [np.stack([2 * a, 2 * a + 2, 2 * a + 1], 1), np.stack([2 * a + 1, 2 * a + 2, 2 * a + 3], 1)]
    )
    return F[np.argsort(F.sum(axis=1), kind="stable")]


def ring(n):
    """A closed ring of 2 n triangles, counter-clockwise; the inner vertices are even."""
    a = np.arange(n)
    b = (a + 1) % n
    return np.concatenate(
        [np.stack([2 * a, 2 * a + 1, 2 * b], 1), np.stack([2 * b, 2 * a + 1, 2 * b + 1], 1)]
    )


def wrapped(x):
    return np.angle(np.exp(1j * x))


class TestStrip:
    @pytest.mark.parametrize("total", [0.0, 3.0, -9.42, 40.0, -100.0])
    def test_any_number_of_turns_is_followed(self, total):
        F = strip(60)
        wanted = np.linspace(0.0, total, len(F))
        found = angles.consistent(wrapped(wanted), F)
        assert found == pytest.approx(wanted, abs=1e-12)

    def test_the_seed_keeps_its_angle(self):
        F = strip(60)
        wanted = np.linspace(0.0, 30.0, len(F))
        found = angles.consistent(wrapped(wanted), F, seed=100)
        assert found[100] == pytest.approx(wrapped(wanted)[100])
        assert np.diff(found) == pytest.approx(np.diff(wanted))

    def test_prescribed_turns_carry_their_part(self):
        F = strip(60)
        wanted = np.linspace(0.0, 30.0, len(F))
        found = angles.consistent(wrapped(wanted), F, turns={119: 7})
        assert found[119] == pytest.approx(wrapped(wanted)[119] + 14 * np.pi)
        assert np.diff(found) == pytest.approx(np.diff(wanted))
        both = angles.consistent(wrapped(wanted), F, turns={119: 7, 0: 2})
        assert both == pytest.approx(found)
        with pytest.raises(ValueError, match="turns must be alike"):
            angles.consistent(wrapped(wanted), F, turns={119: 7, 0: 3})

    def test_the_order_of_triangles_does_not_matter(self):
        F = strip(60)
        wanted = np.linspace(0.0, 30.0, len(F))
        order = np.random.default_rng(0).permutation(len(F))
        found = angles.consistent(wrapped(wanted)[order], F[order], seed=int(np.argmin(order)))
        assert found == pytest.approx(wanted[order])


class TestParts:
    def test_each_part_by_itself(self):
        F = np.concatenate([strip(10), strip(10) + 22])
        wanted = np.concatenate([np.linspace(0.0, 9.0, 20), np.linspace(1.0, -12.0, 20)])
        assert angles.consistent(wrapped(wanted), F) == pytest.approx(wanted)
        second = angles.consistent(wrapped(wanted), F, turns={30: 5})
        assert second[:20] == pytest.approx(wanted[:20])
        assert second[30] == pytest.approx(wrapped(wanted)[30] + 10 * np.pi)


class TestHoles:
    def test_a_ring_that_closes(self):
        F = ring(30)
        wanted = 2.5 * np.sin(np.tile(2 * np.pi * np.arange(30) / 30, 2))
        assert angles.consistent(wrapped(wanted), F) == pytest.approx(wanted)

    @pytest.mark.parametrize("turns", [1, -2])
    def test_a_ring_that_does_not(self, turns):
        F = ring(30)
        wanted = turns * np.tile(2 * np.pi * np.arange(30) / 30, 2)
        with pytest.raises(ValueError, match=r"close round every loop .* neighbours \d+ and \d+"):
            angles.consistent(wrapped(wanted), F)


@pytest.mark.parametrize(
    ("keywords", "says"),
    [
        ({"seed": 99}, "seed must be"),
        ({"turns": {-1: 2}}, "turns must be"),
        ({"turns": {500: 2}}, "turns must be"),
    ],
)
def test_no_such_triangle(keywords, says):
    with pytest.raises(ValueError, match=says):
        angles.consistent(np.zeros(20), strip(10), **keywords)


def test_one_angle_for_each():
    with pytest.raises(ValueError, match="one angle for each"):
        angles.consistent(np.zeros(7), strip(10))
    with pytest.raises(ValueError, match="finite"):
        angles.consistent(np.full(20, np.nan), strip(10))
