"""Clouds of particles in coloured strips, to be stirred: a disc cut like a cake, and a layered block."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lietool.mesh.topology import fail

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_MOST = 1_000_000


@dataclass(frozen=True, eq=False)
class Cloud:
    """Points without faces.

    Attributes
    ----------
    points : (n, 3)
    strip : (n,) of int
        Which strip each point belongs to, from 0: what shows how the cloud was stirred.
    strips : int
        How many there are.
    """

    points: Array
    strip: Index
    strips: int


def disc(count: int = 6000, strips: int = 12, thickness: float = 0.05, seed: int = 1) -> Cloud:
    """Return a round flat cloud, its strips the pieces of a cake.

    The points lie on the spiral of the sunflower, which is even everywhere, a little moved at random.

    Parameters
    ----------
    count : int
        How many points.
    strips : int
    thickness : float
        Along z.
    seed : int

    Returns
    -------
    Cloud
        Of radius 1 about the origin.

    Raises
    ------
    ValueError
        If there are no points or no strips, or the thickness or the seed is negative.
    """
    rng = _random("particles.disc", count, strips, thickness, seed)
    k = np.arange(count) + 0.5
    radius, angle = np.sqrt(k / count), np.pi * (3.0 - np.sqrt(5.0)) * k
    moved = 0.5 / np.sqrt(count) * rng.uniform(-1.0, 1.0, (count, 2))
    x, y = radius * np.cos(angle) + moved[:, 0], radius * np.sin(angle) + moved[:, 1]
    z = thickness * rng.uniform(-0.5, 0.5, count)
    points = np.round(np.stack([x, y, z], axis=1), 9)
    turn = np.arctan2(points[:, 1], points[:, 0]) / (2.0 * np.pi) % 1.0
    return _cloud(points, np.minimum((turn * strips).astype(np.intp), strips - 1), strips)


def block(count: int = 12000, strips: int = 6, thickness: float = 0.6, seed: int = 1) -> Cloud:
    """Return a cloud in the shape of an upright block, its strips the layers across x.

    Parameters
    ----------
    count : int
        How many points.
    strips : int
    thickness : float
        Along y.
    seed : int

    Returns
    -------
    Cloud
        2 wide along x and 2 high along z, about the origin.

    Raises
    ------
    ValueError
        If there are no points or no strips, or the thickness or the seed is negative.
    """
    rng = _random("particles.block", count, strips, thickness, seed)
    # A lattice of three irrational steps is even in all directions and has no rows.
    g = 1.2207440846057596
    unit = (np.arange(1, count + 1)[:, None] * (1.0 / g, 1.0 / g**2, 1.0 / g**3)) % 1.0
    unit += 0.3 * count ** (-1.0 / 3.0) * rng.uniform(-1.0, 1.0, (count, 3))
    unit = np.clip(unit, 0.0, 1.0 - 1e-9)
    points = np.round((unit - 0.5) * (2.0, thickness, 2.0), 9)
    return _cloud(points, np.floor(unit[:, 0] * strips).astype(np.intp), strips)


def _random(where: str, count: int, strips: int, thickness: float, seed: int) -> np.random.Generator:
    for name, value, least, most in (
        ("count", count, 1, _MOST),
        ("strips", strips, 1, 1000),
        ("seed", seed, 0, 2**63),
    ):
        if not (isinstance(value, int | np.integer) and least <= value <= most):
            fail(where, name, f"a whole number, {least} to {most}", repr(value))
    if not (np.isfinite(thickness) and thickness >= 0.0):
        fail(where, "thickness", "0 or more", repr(thickness))
    return np.random.default_rng(seed)


def _cloud(points: Array, strip: Index, strips: int) -> Cloud:
    points.setflags(write=False)
    strip.setflags(write=False)
    return Cloud(points, strip, strips)
