"""A sphere of glass with its graticule: the picture of S^3, of shells, of the ball of rotation vectors."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from lietool.render import solids, style
from lietool.render.camera import Camera
from lietool.render.scene import Lines, Record, Surface


def parallels(radius: float, latitudes: np.ndarray, n: int = 121) -> np.ndarray:
    """Return circles of latitude (radians) about the z axis, with NaN between them; shape (k, 3)."""
    angle = np.linspace(0.0, 2.0 * np.pi, n)
    return joined(
        radius
        * np.stack([np.cos(b) * np.cos(angle), np.cos(b) * np.sin(angle), np.sin(b) + 0.0 * angle], axis=-1)
        for b in latitudes
    )


def meridians(radius: float, longitudes: np.ndarray, n: int = 61) -> np.ndarray:
    """Return half circles from pole to pole at longitudes (radians), with NaN between them; shape (k, 3)."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, n)
    return joined(
        radius * np.stack([np.cos(angle) * np.cos(a), np.cos(angle) * np.sin(a), np.sin(angle)], axis=-1)
        for a in longitudes
    )


def joined(curves: Iterable[np.ndarray]) -> np.ndarray:
    """Return several polylines as one, with a row of NaN between them."""
    gap = np.full((1, 3), np.nan)
    parts = [part for curve in curves for part in (np.asarray(curve, float), gap)]
    return np.concatenate(parts[:-1])


def jumps(curve: np.ndarray, gap: float = 0.5) -> np.ndarray:
    """Return where a finely sampled curve (n, 3) does not go on: the indices of the points after a jump."""
    return np.flatnonzero(np.linalg.norm(np.diff(curve, axis=0), axis=-1) > gap) + 1


def globe(
    camera: Camera,
    radius: float = 1.0,
    center: tuple[float, float, float] = (0.0, 0.0, 0.0),
    color: str = style.GLASS,
    edge: str = style.GLASS_EDGE,
    alpha: float = 1.0,
    frame: ArrayLike | None = None,
) -> list[Record]:
    """Return a sphere of glass: shell, graticule every 30 degrees, equator, outline towards the camera.

    Parameters
    ----------
    camera : Camera
        Through which it will be seen: the outline depends on it.
    radius : float
    center : tuple of float
    color, edge : str
        Of the glass and of its outline.
    alpha : float
        Of the glass; 1 is the usual one.
    frame : array_like, shape (3, 3), optional
        A rotation that is applied to the graticule; its third column is then the direction of the pole.
    """
    at = np.asarray(center, float)
    vertices, faces, normals = solids.sphere(radius, center)
    steps = np.deg2rad([-60.0, -30.0, 30.0, 60.0])
    grid = joined([parallels(radius, steps), meridians(radius, np.arange(12) * np.pi / 6)])
    equator = parallels(radius, np.zeros(1))
    if frame is not None:
        grid, equator = grid @ np.asarray(frame, float).T, equator @ np.asarray(frame, float).T
    return [
        Surface(vertices, faces, color, normals, "glass", alpha),
        Lines(grid + at, edge, style.HAIR, style.GRATICULE_ALPHA),
        Lines(equator + at, edge, style.HAIR * 1.3, 0.75),
        Lines(camera.sphere_outline(at, radius), edge, style.EDGE),
    ]
