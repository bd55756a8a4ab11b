"""The soft shadow of a mesh on the ground: what it covers, blurred the more the higher it is."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.render import solids, style
from lietool.render.scene import Record, Surface

Array = NDArray[np.float64]
Index = NDArray[np.intp]

# Around a shadow, in its own sizes; cells on each side of its grid; samples of faces at most.
_AROUND, _CELLS, _SAMPLES = 0.30, 56, 300_000
# Slabs of height, from and to, in sizes of the mesh: how soft a shadow each throws, and how dark.
_SLABS = ((0.0, 0.08, 0.022, 1.0), (0.08, 0.3, 0.05, 0.7), (0.3, np.inf, 0.10, 0.45))


def shadow(V: ArrayLike, F: ArrayLike, ground: float | None = None, strength: float = 0.34) -> list[Record]:
    """Return the soft shadow of a mesh on the ground under it: the nearer the mesh, the sharper and darker.

    Parameters
    ----------
    V : array_like, shape (n, 3)
    F : array_like of int, shape (m, 3)
    ground : float, optional
        Its z; the mesh's lowest unless given.
    strength : float
        Opacity where the mesh touches the ground.
    """
    V, F = np.asarray(V, float), np.asarray(F, np.intp).reshape(-1, 3)
    if not len(F):
        return []
    z0 = float(V[:, 2].min()) if ground is None else ground
    low, high = V[:, :2].min(axis=0), V[:, :2].max(axis=0)
    size = max(float((high - low).max()), 0.25 * float(np.ptp(V[:, 2])), 1e-9)
    low = (low + high) / 2.0 - (0.5 + _AROUND) * size
    cell = (1.0 + 2.0 * _AROUND) * size / (_CELLS - 1)
    at, height, area = _samples(V, F, cell)
    above = np.maximum(height - z0, 0.0) / size
    lit = np.ones((_CELLS, _CELLS))
    for bottom, top, soft, dark in _SLABS:
        inside = (above >= bottom) & (above < top)
        cover = _splat((at[inside] - low) / cell, area[inside] / cell**2)
        blur = _blur(soft * size / cell)
        lit *= 1.0 - dark * np.clip(blur @ cover @ blur.T, 0.0, 1.0)
    gx, gy = np.meshgrid(*(low[k] + cell * np.arange(_CELLS) for k in range(2)), indexing="ij")
    points = np.stack([gx, gy, np.full_like(gx, z0)], axis=-1).reshape(-1, 3)
    dark = strength * (1.0 - lit).ravel()
    faces = solids.grid_faces(_CELLS, _CELLS)
    faces = faces[dark[faces].max(axis=1) > 0.004]
    return [Surface(points, faces, style.fade(style.SHADOW, dark), material="shadow")]


def _samples(V: Array, F: Index, cell: float) -> tuple[Array, Array, Array]:
    """Points (k, 2) spread over faces, their heights, and the area on the ground that each stands for."""
    corners = V[F]
    longest = np.linalg.norm(np.diff(corners[:, [0, 1, 2, 0], :2], axis=1), axis=-1).max()
    fine = int(np.clip(np.ceil(longest / cell), 1, max(np.sqrt(_SAMPLES / len(F)), 1)))
    i, j = np.meshgrid(np.arange(fine), np.arange(fine), indexing="ij")
    # The small triangles that a face is divided into: upright where i + j < fine, else upside down.
    upright = i + j < fine
    b = np.where(upright, i + 1.0 / 3.0, fine - i - 1.0 / 3.0) / fine
    c = np.where(upright, j + 1.0 / 3.0, fine - j - 1.0 / 3.0) / fine
    W = np.stack([1.0 - b - c, b, c], axis=-1).reshape(-1, 3)
    P = np.einsum("sc,mcx->msx", W, corners).reshape(-1, 3)
    e, f = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    area = 0.5 * np.abs(e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0])
    return P[:, :2], P[:, 2], np.repeat(area / len(W), len(W))


def _splat(at: Array, amount: Array) -> Array:
    """What falls into the cells of a grid, each amount shared among the four around its place."""
    base = np.clip(np.floor(at).astype(int), 0, _CELLS - 2)
    part = at - base
    total = np.zeros(_CELLS * _CELLS)
    for dx in (0, 1):
        for dy in (0, 1):
            share = np.abs(1 - dx - part[:, 0]) * np.abs(1 - dy - part[:, 1])
            place = (base[:, 0] + dx) * _CELLS + base[:, 1] + dy
            total += np.bincount(place, amount * share, _CELLS * _CELLS)
    return total.reshape(_CELLS, _CELLS)


def _blur(cells: float) -> Array:
    """The matrix that blurs a column by a bell curve of so many cells."""
    k = np.arange(_CELLS)
    bell = np.exp(-0.5 * ((k[:, None] - k[None, :]) / max(cells, 0.6)) ** 2)
    return bell / bell.sum(axis=1, keepdims=True).max()
