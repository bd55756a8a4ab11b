"""A snake that has swallowed something: its triangles are large in one place, and later in another."""

from functools import cache

import numpy as np

from lietool.mesh import topology
from lietool.mesh.shapes import Shape

Array = np.ndarray

# Along the middle line, of length 1: how thick the body is, and the bulge.
_BODY, _BULGE, _SPREAD = 0.034, 0.11, 0.095
_PLACES = (0.24, 0.66)
# Triangles across, and how the middle line turns from the nose to the tail in both poses, degrees.
_ACROSS = 4
_TURNS = (60.0, -180.0)


@cache
def snake() -> Shape:
    """Return the snake before and after: the bulge moves from the head towards the tail, and the body bends.

    Triangles are about as long as the body is thick in the source, so that they are large where the bulge
    is then, and small elsewhere.
    """
    at = _columns()
    faces = _faces(len(at))
    along = np.repeat(at, _ACROSS + 1)
    source, target = (_posed(at, place, turn) for place, turn in zip(_PLACES, _TURNS, strict=True))
    middle = _ACROSS // 2
    eyes = np.array([middle - 1, middle + 1]) + 3 * (_ACROSS + 1)
    marks = {"nose": middle, "tail": (len(at) - 1) * (_ACROSS + 1) + middle}
    marks |= {"eye left": int(eyes[0]), "eye right": int(eyes[1])}
    for array in (source, target, faces, along):
        # One object serves every caller.
        array.setflags(write=False)
    return Shape(source, target, faces, topology.boundary(faces)[0], along, marks)


def _thick(at: Array, place: float) -> Array:
    """Half the width along the middle line: round ends, a body, and the bulge."""
    ends = np.sqrt(np.clip(1.0 - np.maximum(1.0 - at / 0.05, 0.0) ** 2, 0.0, 1.0))
    tail = np.clip((1.0 - at) / 0.25, 0.0, 1.0) ** 0.8
    return ends * tail * (_BODY + (_BULGE - _BODY) * np.exp(-(((at - place) / _SPREAD) ** 2)))


def _columns() -> Array:
    """Places along the middle line, as far apart as triangles are high there in the source."""
    fine = np.linspace(0.0, 1.0, 2001)
    gap = np.maximum(2.0 * _thick(fine, _PLACES[0]) / _ACROSS, 0.007)
    count = np.concatenate([[0.0], np.cumsum(np.diff(fine) / gap[1:])])
    return np.interp(np.linspace(0.0, count[-1], round(count[-1]) + 1), count, fine)


def _posed(at: Array, place: float, turn: float) -> Array:
    """The vertices, column by column from the nose, about the middle between nose and tail."""
    fine = np.linspace(0.0, 1.0, 2001)
    angle = np.radians(turn) * (fine - 0.5)
    step = (fine[1] - fine[0]) * np.exp(1j * angle)
    line = np.append(0.0, np.cumsum(0.5 * (step[1:] + step[:-1])))
    middle = np.interp(at, fine, np.real(line)) + 1j * np.interp(at, fine, np.imag(line))
    # A column at either end has a little width, so that no triangle is degenerate.
    half = np.maximum(_thick(at, place), 0.009)
    across = 1j * np.exp(1j * np.radians(turn) * (at - 0.5)) * half
    z = middle[:, None] + across[:, None] * np.linspace(-1.0, 1.0, _ACROSS + 1)
    z = 5.0 * (z - 0.5 * (middle[0] + middle[-1]))
    return np.stack([z.real, z.imag], axis=-1).reshape(-1, 2)


def _faces(columns: int) -> Array:
    """Two triangles for each cell, by turns along either diagonal."""
    j, i = np.meshgrid(np.arange(columns - 1), np.arange(_ACROSS), indexing="ij")
    a = j * (_ACROSS + 1) + i
    b, c, d = a + _ACROSS + 1, a + _ACROSS + 2, a + 1
    even = ((i + j) % 2 == 0)[..., None]
    first = np.where(even, np.stack([a, b, c], -1), np.stack([a, b, d], -1))
    second = np.where(even, np.stack([a, c, d], -1), np.stack([b, c, d], -1))
    return np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)])
