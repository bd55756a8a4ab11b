"""The letter F, flat and solid: the shape without symmetry that stands for "a shape" in every figure."""

import numpy as np

# Four squares high, three wide, the lower bar shorter: no symmetry is left once it has a front.
_STROKES = [(0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (1, 2), (1, 3), (3, 3), (3, 4), (0, 4)]
_TRIANGLES = [(0, 1, 2), (0, 2, 5), (2, 3, 4), (2, 4, 5), (0, 5, 6), (0, 6, 9), (6, 7, 8), (6, 8, 9)]


def outline() -> np.ndarray:
    """Return the outline of the flat letter.

    Returns
    -------
    ndarray, shape (10, 2)
        Counter-clockwise, height 1, centred on its bounding box.
    """
    return (np.array(_STROKES, float) - [1.5, 2.0]) / 4.0


def triangles() -> np.ndarray:
    """Return the triangles that fill the outline.

    Returns
    -------
    ndarray of int, shape (8, 3)
        Indices of its corners, counter-clockwise.
    """
    return np.array(_TRIANGLES)


def solid(depth: float = 0.25) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the letter as a solid: it stands in the y-z plane and has its thickness along x.

    Parameters
    ----------
    depth : float
        Thickness; the letter is 1 high.

    Returns
    -------
    vertices : ndarray, shape (20, 3)
    faces : ndarray of int, shape (36, 3)
    side : ndarray of int, shape (36,)
        0 for the front (towards +x), 1 for the back, 2 for the walls.
    """
    rim = outline()
    n = len(rim)
    front = np.column_stack([np.full(n, depth / 2), rim])
    back = np.column_stack([np.full(n, -depth / 2), rim])
    i = np.arange(n)
    j = (i + 1) % n
    walls = np.concatenate([np.stack([i, i + n, j], axis=-1), np.stack([j, i + n, j + n], axis=-1)])
    flat = triangles()
    faces = np.concatenate([flat, flat[:, ::-1] + n, walls])
    side = np.repeat([0, 1, 2], [len(flat), len(flat), len(walls)])
    return np.concatenate([front, back]), faces, side
